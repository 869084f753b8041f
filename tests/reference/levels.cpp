#include "tests/reference/levels.h"

#include "tests/reference/positions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace razor::reference {

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}
int trailing_zeros(int i) {
    return std::countr_zero(static_cast<unsigned>(i));
}

/// A relief of waves; level k leaves out those shorter than two of its edges. A pure function of the anchor.
glm::dvec3 displacement(const glm::dvec3& a, double size, double edge) {
    double height = 0;
    for (double frequency : {6.0, 12.0, 24.0, 48.0}) {
        double wave = 6.28 / frequency;
        double keep = std::clamp(wave / (2 * edge) - 1, 0.0, 1.0);
        height += keep * std::sin(frequency * a.x + 1) * std::sin(frequency * a.y) *
                  std::sin(frequency * a.z + 2) * 6 / frequency;
    }
    return size * height * glm::normalize(a);
}

} // namespace

Levels::Levels(const Case& scene, const LevelOptions& options) : scene_(scene), options_(options) {
    scene_.mesh.scheme = Scheme::catmull_clark; // for its patches: n-gons become sub-faces, none is flat
    topology_ = analyse_topology(scene_.mesh);
    std::unique_ptr<Positions> positions = scene_.limit
                                               ? limit_positions(scene_.mesh, topology_)
                                               : bilinear_positions(scene_.mesh, topology_, scene_.shape);
    make_curves(*positions);
    make_patches(*positions);
    for (const Vertex& v : vertices_)
        if (v.index != every_level)
            top_ = std::max(top_, v.index + 1);
    make_positions();
}

int Levels::edge_exponent(const CurveRecord& curve, int number) const {
    if (!options_.exponents.empty())
        return std::clamp(options_.exponents[at(number) % options_.exponents.size()], 0, options_.largest);
    const std::vector<glm::dvec3>& points = scene_.mesh.points;
    double length = glm::length(points[at(curve.end1)] - points[at(curve.end0)]) / options_.e0;
    return static_cast<int>(std::clamp(std::floor(std::log2(length) + 0.5), 0.0, double(options_.largest)));
}

int Levels::curve_exponent(int curve) const {
    const CurveRecord& c = topology_.curves[at(curve)];
    if ((c.flags & curve_spoke) == 0)
        return edge_exponent(c, curve);
    const FaceRecord& face = topology_.faces[at(c.owner_face)];
    int largest = 1;
    for (int i = 0; i < face.corner_count; ++i) {
        int edge = topology_.face_curves[at(face.curve_first + i)];
        largest = std::max(largest, edge_exponent(topology_.curves[at(edge)], edge));
    }
    return largest - 1;
}

void Levels::make_curves(const Positions& positions) {
    for (std::size_t p = 0; p < scene_.mesh.points.size(); ++p)
        vertices_.push_back({positions.cage_point(static_cast<int>(p))});
    std::vector<int> centre(topology_.faces.size(), -1);
    for (int f = 0; f < static_cast<int>(topology_.faces.size()); ++f)
        if (topology_.faces[at(f)].corner_count != 4) {
            centre[at(f)] = vertex_count();
            vertices_.push_back({positions.face_centre(f)});
        }
    for (int c = 0; c < static_cast<int>(topology_.curves.size()); ++c)
        curves_.push_back({curve_exponent(c), 0, {}});
    for (const PatchRecord& record : topology_.patches) {
        int along[4], half[4];
        for (int s = 0; s < 4; ++s) {
            half[s] = (record.side_flags[s] & side_half) != 0 ? 1 : 0;
            along[s] = curves_[at(record.side_curve[s])].exponent - half[s];
        }
        Patch patch;
        patch.nu = std::max({along[0], along[2], 0});
        patch.nv = std::max({along[1], along[3], 0});
        for (int s = 0; s < 4; ++s) {
            int& depth = curves_[at(record.side_curve[s])].depth;
            depth = std::max(depth, (s % 2 == 0 ? patch.nu : patch.nv) + half[s]);
        }
        patches_.push_back(patch);
    }
    for (int c = 0; c < static_cast<int>(curves_.size()); ++c) {
        const CurveRecord& record = topology_.curves[at(c)];
        Curve& curve = curves_[at(c)];
        bool spoke = (record.flags & curve_spoke) != 0;
        const Curve* edge = spoke ? &curves_[at(record.end0)] : nullptr; // edges come first
        int count = 1 << curve.depth;
        curve.vertices.assign(at(count) + 1, -1);
        curve.vertices.front() = spoke ? edge->vertices[edge->vertices.size() / 2] : record.end0;
        curve.vertices.back() = spoke ? centre[at(record.end1)] : record.end1;
        for (int step = count / 2; step > 0; step /= 2) // coarse to fine: parents first
            for (int k = step; k < count; k += 2 * step) {
                curve.vertices[at(k)] = vertex_count();
                vertices_.push_back({positions.on_curve(c, k, curve.depth),
                                     curve.exponent - curve.depth + trailing_zeros(k),
                                     {curve.vertices[at(k - step)], curve.vertices[at(k + step)]}});
            }
    }
}

void Levels::make_patches(const Positions& positions) {
    for (int p = 0; p < static_cast<int>(patches_.size()); ++p) {
        Patch& patch = patches_[at(p)];
        const PatchRecord& record = topology_.patches[at(p)];
        int last_u = 1 << patch.nu;
        int last_v = 1 << patch.nv;
        patch.grid.assign(at((last_u + 1) * (last_v + 1)), -1);
        auto slot = [&](int i, int j) -> int& { return patch.grid[at(j * (last_u + 1) + i)]; };
        for (int s = 0; s < 4; ++s) {
            int curve = record.side_curve[s];
            int depth = curves_[at(curve)].depth;
            int exponent = s % 2 == 0 ? patch.nu : patch.nv;
            int half = (record.side_flags[s] & side_half) != 0 ? 1 : 0;
            bool reversed = (record.side_flags[s] & side_reversed) != 0;
            int step = 1 << (depth - exponent - half);
            Patch::Side& side = patch.sides[at(s)];
            side = {curve, reversed ? 1 << depth : 0, reversed ? -step : step};
            for (int i = 0; i <= 1 << exponent; ++i) {
                int v = curves_[at(curve)].vertices[at(side.begin + i * side.step)];
                if (s % 2 == 0)
                    slot(i, s == 0 ? 0 : last_v) = v;
                else
                    slot(s == 3 ? 0 : last_u, i) = v;
            }
        }
        for (int birth = patch.coarsest() - 1; birth >= 0; --birth) {
            int s = 1 << birth;
            for (int j = s; j < last_v; j += s)
                for (int i = s; i < last_u; i += s) {
                    int di = (i & s) != 0 ? s : 0;
                    int dj = (j & s) != 0 ? s : 0;
                    if (di == 0 && dj == 0)
                        continue;
                    slot(i, j) = vertex_count();
                    vertices_.push_back({positions.inside_patch(p, i, j, patch.nu, patch.nv),
                                         birth,
                                         {slot(i - di, j - dj), slot(i + di, j + dj)}});
                }
        }
    }
}

void Levels::make_positions() {
    for (int k = 0; k <= top_; ++k) {
        std::vector<glm::dvec3> own, all;
        for (const Vertex& v : vertices_) {
            glm::dvec3 p = v.anchor;
            if (displaced())
                p += displacement(v.anchor, scene_.relief, std::ldexp(options_.e0, k));
            own.push_back(p);
            all.push_back(v.index >= k ? p : 0.5 * (all[at(v.parents[0])] + all[at(v.parents[1])]));
        }
        position_.push_back(own);
        discrete_.push_back(all);
    }
}

} // namespace razor::reference
