#include "tests/kernels/reference_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor::test {

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

} // namespace

ReferenceSurface::ReferenceSurface(Frame& frame, const Mesh& mesh)
    : frame_(frame), topology_(analyse_topology(mesh)), straight_(mesh.scheme == Scheme::bilinear),
      edge_length_(frame.header().instances.get()[0].mesh_edge_length) {
    if (!straight_)
        maker_ = std::make_unique<PageMaker>(mesh, topology_);
    for (int i = 0; i < static_cast<int>(mesh.points.size()); ++i)
        largest_ = std::max({largest_, std::abs(point(i).x), std::abs(point(i).y), std::abs(point(i).z)});
}

glm::dvec3 ReferenceSurface::point(int i) const {
    const float* p = frame_.header().points.get() + std::ptrdiff_t{3} * i;
    return {p[0], p[1], p[2]};
}

int ReferenceSurface::edge_exponent(int curve) const {
    const CurveRecord& c = topology_.curves[at(curve)];
    double length = 0;
    if (straight_) {
        length = glm::length(point(c.end1) - point(c.end0));
    } else {
        const VertexRecord &a = topology_.points[at(c.end0)], &z = topology_.points[at(c.end1)];
        const glm::dvec3 middle = owner_point(c, 1, 1);
        length = glm::length(limit_point(a.owner_face, a.owner_corner) - middle) +
                 glm::length(limit_point(z.owner_face, z.owner_corner) - middle);
    }
    return static_cast<int>(std::clamp(std::floor(std::log2(length / edge_length_) + 0.5), 0.0,
                                       static_cast<double>(topology_.max_exponent)));
}

int ReferenceSurface::exponent(int curve) const {
    const CurveRecord& c = topology_.curves[at(curve)];
    if ((c.flags & curve_spoke) == 0)
        return edge_exponent(curve);
    const FaceRecord& face = topology_.faces[at(c.owner_face)];
    int largest = 1;
    for (int i = 0; i < face.corner_count; ++i)
        largest = std::max(largest, edge_exponent(topology_.face_curves[at(face.curve_first + i)]));
    return largest - 1;
}

std::array<int, 2> ReferenceSurface::grid(const PatchRecord& patch) const {
    if (patch.kind >= PatchKind::flat_quad)
        return {0, 0};
    int e[4];
    for (int s = 0; s < 4; ++s)
        e[s] = exponent(patch.side_curve[s]) - ((patch.side_flags[s] & side_half) != 0 ? 1 : 0);
    int nu = std::max({e[0], e[2], 0});
    int nv = std::max({e[1], e[3], 0});
    return {std::max(nu, nv - block_log2), std::max(nv, nu - block_log2)};
}

const std::vector<float>& ReferenceSurface::page(const PageKey& k, int control_count) const {
    Key key{
        k.face_class, static_cast<int>(k.kind), k.local, k.reversed, k.exponent_u, k.strip_u, k.exponent_v,
        k.strip_v};
    std::vector<float>& weights = pages_[key];
    if (weights.empty()) {
        weights.resize(page_floats(k, control_count));
        maker_->make(k, weights.data());
    }
    return weights;
}

glm::dvec3 ReferenceSurface::weigh(const FaceRecord& face, const float* weights, std::size_t row,
                                   std::size_t column) const {
    glm::dvec3 sum{0};
    for (int i = 0; i < face.control_count; ++i)
        sum += static_cast<double>(weights[at(i) * row + column]) *
               point(topology_.controls[at(face.control_first + i)]);
    return sum;
}

glm::dvec3 ReferenceSurface::limit_point(int face, int corner) const {
    const FaceRecord& f = topology_.faces[at(face)];
    PageKey key{.face_class = f.face_class, .kind = PageKind::vertex, .local = corner};
    return weigh(f, page(key, f.control_count).data(), 1, 0);
}

glm::dvec3 ReferenceSurface::centre(int face) const {
    const FaceRecord& f = topology_.faces[at(face)];
    if (!straight_)
        return limit_point(face, f.corner_count);
    glm::dvec3 sum{0};
    for (int i = 0; i < f.corner_count; ++i)
        sum += point(topology_.controls[at(f.control_first + i)]);
    return sum / static_cast<double>(f.corner_count);
}

glm::dvec3 ReferenceSurface::middle(int curve) const {
    int n = flat_exponent(curve);
    return n > 0 ? curve_point(curve, 1 << (n - 1)) : (curve_point(curve, 0) + curve_point(curve, 1)) * 0.5;
}

glm::dvec3 ReferenceSurface::curve_point(int curve, int k) const {
    const CurveRecord& c = topology_.curves[at(curve)];
    int n = flat_exponent(curve);
    if (k == 0 || k == 1 << n) {
        int end = k == 0 ? c.end0 : c.end1;
        if ((c.flags & curve_spoke) != 0)
            return k == 0 ? middle(end) : centre(end);
        const VertexRecord& v = topology_.points[at(end)];
        return straight_ ? point(end) : limit_point(v.owner_face, v.owner_corner);
    }
    return owner_point(c, n, k);
}

glm::dvec3 ReferenceSurface::owner_point(const CurveRecord& c, int n, int k) const {
    const FaceRecord& face = topology_.faces[at(c.owner_face)];
    PageKey key{.face_class = face.face_class,
                .kind = PageKind::curve,
                .local = c.owner_local,
                .reversed = (c.flags & curve_owner_reversed) != 0,
                .exponent_u = n,
                .strip_u = k >> block_log2};
    return weigh(face, page(key, face.control_count).data(), curve_row, at(k & (block_quads - 1)));
}

glm::dvec3 ReferenceSurface::corner(const PatchRecord& patch, std::size_t k) const {
    bool part = (patch.side_flags[0] & side_half) != 0;
    if (part && k != 0)
        return k == 2 ? centre(patch.corner[k]) : middle(patch.corner[k]);
    return point(patch.corner[k]);
}

glm::dvec3 ReferenceSurface::grid_point(const PatchRecord& patch, int i, int j) const {
    auto [nu, nv] = grid(patch);
    if (straight_) {
        double u = std::ldexp(i, -nu);
        double v = std::ldexp(j, -nv);
        glm::dvec3 low = glm::mix(corner(patch, 0), corner(patch, 1), u);
        glm::dvec3 high = glm::mix(corner(patch, 3), corner(patch, 2), u);
        return glm::mix(low, high, v);
    }
    const FaceRecord& face = topology_.faces[at(patch.face)];
    int column = std::min(i >> block_log2, (1 << std::max(nu - block_log2, 0)) - 1);
    int row = std::min(j >> block_log2, (1 << std::max(nv - block_log2, 0)) - 1);
    PageKey key{.face_class = face.face_class,
                .kind = PageKind::block,
                .local = patch.sub,
                .exponent_u = nu,
                .strip_u = column,
                .exponent_v = nv,
                .strip_v = row};
    const std::vector<float>& weights = page(key, face.control_count);
    int width = (1 << std::min(nu, block_log2)) + 1;
    int vertex = (j - row * block_quads) * width + i - column * block_quads;
    return weigh(face, weights.data(), weights.size() / at(face.control_count), at(vertex));
}

} // namespace razor::test
