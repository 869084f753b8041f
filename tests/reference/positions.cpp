#include "tests/reference/positions.h"

#include "razor/surface/pages.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace razor::reference {

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

class Bilinear final : public Positions {
public:
    Bilinear(const Mesh& mesh, const Topology& topology, const Shape& shape)
        : mesh_(mesh), topology_(topology), shape_(shape) {}

    glm::dvec3 cage_point(int point) const override { return bent(mesh_.points[at(point)]); }
    glm::dvec3 face_centre(int face) const override { return bent(centre(face)); }
    glm::dvec3 on_curve(int curve, int k, int depth) const override {
        const CurveRecord& c = topology_.curves[at(curve)];
        bool spoke = (c.flags & curve_spoke) != 0;
        glm::dvec3 begin = spoke ? middle(c.end0) : mesh_.points[at(c.end0)];
        glm::dvec3 end = spoke ? centre(c.end1) : mesh_.points[at(c.end1)];
        return bent(glm::mix(begin, end, std::ldexp(k, -depth)));
    }
    glm::dvec3 inside_patch(int patch, int i, int j, int nu, int nv) const override {
        glm::dvec3 low = glm::mix(corner(patch, 0), corner(patch, 1), std::ldexp(i, -nu));
        glm::dvec3 high = glm::mix(corner(patch, 3), corner(patch, 2), std::ldexp(i, -nu));
        return bent(glm::mix(low, high, std::ldexp(j, -nv)));
    }

private:
    glm::dvec3 bent(const glm::dvec3& p) const { return shape_ ? shape_(p) : p; }
    glm::dvec3 middle(int curve) const {
        const CurveRecord& c = topology_.curves[at(curve)];
        return 0.5 * (mesh_.points[at(c.end0)] + mesh_.points[at(c.end1)]);
    }
    glm::dvec3 centre(int face) const {
        const FaceRecord& f = topology_.faces[at(face)];
        glm::dvec3 sum(0);
        for (int i = 0; i < f.corner_count; ++i)
            sum += mesh_.points[at(mesh_.face_vertices[at(f.curve_first + i)])];
        return sum / static_cast<double>(f.corner_count);
    }
    glm::dvec3 corner(int patch, int k) const {
        const PatchRecord& p = topology_.patches[at(patch)];
        bool part = (p.side_flags[0] & side_half) != 0;
        if (part && k != 0)
            return k == 2 ? centre(p.corner[k]) : middle(p.corner[k]);
        return mesh_.points[at(p.corner[k])];
    }

    const Mesh& mesh_;
    const Topology& topology_;
    Shape shape_;
};

class Limit final : public Positions {
public:
    Limit(const Mesh& mesh, const Topology& topology)
        : mesh_(mesh), topology_(topology), maker_(mesh, topology) {}

    glm::dvec3 cage_point(int point) const override {
        const VertexRecord& v = topology_.points[at(point)];
        return vertex(v.owner_face, v.owner_corner);
    }
    glm::dvec3 face_centre(int face) const override {
        return vertex(face, topology_.faces[at(face)].corner_count);
    }
    glm::dvec3 on_curve(int curve, int k, int depth) const override {
        const CurveRecord& c = topology_.curves[at(curve)];
        PageKey key{.face_class = face_class(c.owner_face),
                    .kind = PageKind::curve,
                    .local = c.owner_local,
                    .reversed = (c.flags & curve_owner_reversed) != 0,
                    .exponent_u = depth,
                    .strip_u = k >> block_log2};
        return weigh(c.owner_face, key, curve_row, at(k & (block_quads - 1)));
    }
    glm::dvec3 inside_patch(int patch, int i, int j, int nu, int nv) const override {
        const PatchRecord& p = topology_.patches[at(patch)];
        int column = i >> block_log2;
        int row = j >> block_log2;
        PageKey key{.face_class = face_class(p.face),
                    .kind = PageKind::block,
                    .local = p.sub,
                    .exponent_u = nu,
                    .strip_u = column,
                    .exponent_v = nv,
                    .strip_v = row};
        int width = (1 << std::min(nu, block_log2)) + 1;
        int number = (j - row * block_quads) * width + i - column * block_quads;
        return weigh(p.face, key, 0, at(number));
    }

private:
    int face_class(int face) const { return topology_.faces[at(face)].face_class; }
    glm::dvec3 vertex(int face, int corner) const {
        PageKey key{.face_class = face_class(face), .kind = PageKind::vertex, .local = corner};
        return weigh(face, key, 1, 0);
    }
    /// `row` floats a control point; 0: what the page has.
    glm::dvec3 weigh(int face, const PageKey& k, std::size_t row, std::size_t column) const {
        const FaceRecord& f = topology_.faces[at(face)];
        Key id{k.face_class, static_cast<int>(k.kind),
               k.local,      k.reversed,
               k.exponent_u, k.strip_u,
               k.exponent_v, k.strip_v};
        std::vector<float>& weights = pages_[id];
        if (weights.empty()) {
            weights.resize(page_floats(k, f.control_count));
            maker_.make(k, weights.data());
        }
        if (row == 0)
            row = weights.size() / at(f.control_count);
        glm::dvec3 sum(0);
        for (int i = 0; i < f.control_count; ++i)
            sum += double{weights[at(i) * row + column]} *
                   mesh_.points[at(topology_.controls[at(f.control_first + i)])];
        return sum;
    }

    const Mesh& mesh_;
    const Topology& topology_;
    PageMaker maker_;
    using Key = std::tuple<int, int, int, bool, int, int, int, int>;
    mutable std::map<Key, std::vector<float>> pages_;
};

} // namespace

std::unique_ptr<Positions> bilinear_positions(const Mesh& mesh, const Topology& topology,
                                              const Shape& shape) {
    return std::make_unique<Bilinear>(mesh, topology, shape);
}

std::unique_ptr<Positions> limit_positions(const Mesh& mesh, const Topology& topology) {
    return std::make_unique<Limit>(mesh, topology);
}

} // namespace razor::reference
