#include "razor/frame/emitters.h"

#include "razor/frame/light_records.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace razor {

using glm::dvec3;

/// Points (i, j) of a patch at j * (steps + 1) + i, mesh coordinates.
struct Emitters::Grid {
    int steps;
    bool triangle; // of corners (0, 0), (1, 0), (1, 1) alone
    std::vector<dvec3> points;
};

namespace {

/// Of a bilinear patch or of a flat one, in the order of PatchRecord.
std::array<dvec3, 4> corners_of(const Mesh& mesh, const Topology& t, const PatchRecord& p) {
    const auto at = [&](int point) { return mesh.points[static_cast<std::size_t>(point)]; };
    std::array<dvec3, 4> corners{};
    if ((p.side_flags[0] & side_half) == 0) {
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] = at(p.corner[k]);
        return corners;
    }
    const FaceRecord& face = t.faces[static_cast<std::size_t>(p.face)];
    const auto corner = [&](int k) {
        const int around = (k + face.corner_count) % face.corner_count;
        return at(t.controls[static_cast<std::size_t>(face.control_first + around)]);
    };
    dvec3 centre(0);
    for (int k = 0; k < face.corner_count; ++k)
        centre += corner(k) / double(face.corner_count);
    return {corner(p.sub), (corner(p.sub) + corner(p.sub + 1)) * 0.5, centre,
            (corner(p.sub - 1) + corner(p.sub)) * 0.5};
}

} // namespace

Emitters::Emitters(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies,
                   const std::vector<Instance>& instances, const std::vector<dvec3>& materials)
    : meshes_(meshes), topologies_(topologies), emitted_(materials) {
    for (const dvec3& e : emitted_)
        bright_.push_back((e.x + e.y + e.z) / 3);
    makers_.resize(meshes.size());
    group_patches(instances);
    for (;; steps_ /= 2) {
        count_ = 0;
        for (const Instance& i : instances)
            for (const PatchRecord& p : topologies_[static_cast<std::size_t>(i.mesh)].patches)
                if (is_light(i, p)) {
                    const auto steps = static_cast<std::size_t>(steps_of(p));
                    count_ += p.kind == PatchKind::flat_triangle ? 1 : 2 * steps * steps;
                }
        if (count_ <= most_emitters || steps_ == 1)
            return;
    }
}

Emitters::~Emitters() = default;

void Emitters::group_patches(const std::vector<Instance>& instances) {
    std::vector<std::size_t> lights; // patches of each instance
    for (const Instance& i : instances) {
        const std::vector<PatchRecord>& all = topologies_[static_cast<std::size_t>(i.mesh)].patches;
        lights.push_back(static_cast<std::size_t>(
            std::count_if(all.begin(), all.end(), [&](const PatchRecord& p) { return is_light(i, p); })));
    }
    const std::size_t all = std::accumulate(lights.begin(), lights.end(), std::size_t{0});
    patches_a_group_ = std::max<std::size_t>(1, (all + most_emitter_groups - 1) / most_emitter_groups);
    for (const std::size_t n : lights)
        groups_ += (n + patches_a_group_ - 1) / patches_a_group_;
}

bool Emitters::is_light(const Instance& i, const PatchRecord& p) const {
    const int material =
        i.material >= 0
            ? i.material
            : meshes_[static_cast<std::size_t>(i.mesh)].face_materials[static_cast<std::size_t>(p.face)];
    return static_cast<std::size_t>(material) < bright_.size() &&
           bright_[static_cast<std::size_t>(material)] > 0;
}

int Emitters::steps_of(const PatchRecord& p) const {
    return p.kind == PatchKind::catmull_clark || p.kind == PatchKind::bilinear ? steps_ : 1;
}

const Emitters::Weights& Emitters::weights_of(std::size_t mesh, int face_class, int sub) {
    const auto [known, is_new] = weights_.try_emplace({mesh, face_class, sub});
    Weights& w = known->second;
    if (!is_new)
        return w;
    std::unique_ptr<PageMaker>& maker = makers_[mesh];
    if (!maker)
        maker = std::make_unique<PageMaker>(meshes_[mesh], topologies_[mesh]);
    const FaceClass& c = topologies_[mesh].classes[static_cast<std::size_t>(face_class)];
    PageKey key;
    key.face_class = face_class;
    key.local = sub;
    key.exponent_u = key.exponent_v = block_log2;
    w.of_points.resize(page_floats(key, c.control_count));
    w.stride = w.of_points.size() / static_cast<std::size_t>(c.control_count);
    maker->make(key, w.of_points.data());
    return w;
}

Emitters::Grid Emitters::grid_of(const Mesh& mesh, std::size_t m, const PatchRecord& p) {
    const Topology& t = topologies_[m];
    Grid g{steps_of(p), p.kind == PatchKind::flat_triangle, {}};
    const auto side = static_cast<std::size_t>(g.steps) + 1;
    g.points.assign(side * side, dvec3(0));
    if (p.kind == PatchKind::catmull_clark) {
        const FaceRecord& face = t.faces[static_cast<std::size_t>(p.face)];
        const Weights& w = weights_of(m, face.face_class, p.sub);
        const auto skip = static_cast<std::size_t>(block_quads / g.steps);
        for (std::size_t k = 0; k < static_cast<std::size_t>(face.control_count); ++k) {
            const int control = t.controls[static_cast<std::size_t>(face.control_first) + k];
            const dvec3 point = mesh.points[static_cast<std::size_t>(control)];
            const float* row = w.of_points.data() + k * w.stride;
            for (std::size_t j = 0; j < side; ++j)
                for (std::size_t i = 0; i < side; ++i)
                    g.points[j * side + i] += double{row[j * skip * block_side + i * skip]} * point;
        }
        return g;
    }
    const std::array<dvec3, 4> c = corners_of(mesh, t, p);
    for (std::size_t j = 0; j < side; ++j)
        for (std::size_t i = 0; i < side; ++i) {
            const double u = double(i) / g.steps, v = double(j) / g.steps;
            g.points[j * side + i] = (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
        }
    return g;
}

EmitterTables Emitters::tabulate(const Scene& scene, const SceneGeometry& geometry,
                                 const std::vector<std::int32_t>& first_patches) {
    EmitterTables t;
    std::vector<double> power; // of each triangle
    for (std::size_t n = 0; n < geometry.instances.size(); ++n) {
        const Instance& i = geometry.instances[n];
        const auto m = static_cast<std::size_t>(i.mesh);
        const bool mirrored = glm::determinant(i.linear) < 0;
        const dvec3 at = dvec3(i.origin) + dvec3(i.offset) - i.linear * geometry.mesh_origins[m];
        const std::vector<PatchRecord>& patches = topologies_[m].patches;
        std::size_t in_group = most_emitters; // of patches; full
        for (std::size_t k = 0; k < patches.size(); ++k) {
            const PatchRecord& p = patches[k];
            if (!is_light(i, p))
                continue;
            if (in_group == most_emitters || (in_group >= patches_a_group_ && t.bounds.back().power > 0)) {
                EmitterGroup group{};
                group.first_patch = first_patches[n] + static_cast<std::int32_t>(k);
                group.first = static_cast<std::int32_t>(t.records.size());
                t.groups.push_back(group);
                t.bounds.emplace_back();
                in_group = 0;
            }
            ++in_group;
            const auto material = static_cast<std::size_t>(
                i.material >= 0 ? i.material : meshes_[m].face_materials[static_cast<std::size_t>(p.face)]);
            const bool one_sided = is_one_sided(scene.materials[material]);
            Grid g = grid_of(scene.meshes[m], m, p);
            for (dvec3& point : g.points)
                point = i.linear * point + at;
            const auto side = static_cast<std::size_t>(g.steps) + 1;
            const double diagonal = std::max(glm::length(g.points.back() - g.points.front()),
                                             glm::length(g.points[side - 1] - g.points[side * (side - 1)]));
            const auto add = [&](const dvec3& a, const dvec3& b, const dvec3& c) {
                EmitterRecord r{};
                const dvec3 u = (mirrored ? c : b) - a, v = (mirrored ? b : c) - a;
                put(r.corner, a);
                put(r.edge_u, u);
                put(r.edge_v, v);
                r.margin = static_cast<float>(g.steps > 1 ? diagonal / (4 * g.steps) : 0);
                r.instance = static_cast<std::int32_t>(n);
                r.material = static_cast<std::int32_t>(material);
                const dvec3 across = glm::cross(u, v);
                const double area = glm::length(across) / 2;
                t.records.push_back(r);
                t.area += area;
                power.push_back(area * bright_[material]);
                if (!(power.back() > 0))
                    return;
                LightBounds bounds;
                for (const dvec3& corner : {a, b, c})
                    bounds.box.add(corner);
                if (one_sided)
                    bounds.normals = {glm::normalize(across), 0};
                bounds.emission = std::numbers::pi / 2;
                bounds.power = power.back();
                t.bounds.back().add(bounds);
            };
            for (std::size_t v = 0; v + 1 < side; ++v)
                for (std::size_t u = 0; u + 1 < side; ++u) {
                    const dvec3* low = g.points.data() + v * side + u;
                    const dvec3* high = low + side;
                    add(low[0], low[1], high[1]);
                    if (!g.triangle)
                        add(low[0], high[1], high[0]);
                }
        }
    }
    set_chances(power, t);
    return t;
}

/// `power`: of each triangle.
void Emitters::set_chances(const std::vector<double>& power, EmitterTables& t) const {
    t.density.assign(bright_.size(), 0.0F);
    const double all = std::accumulate(power.begin(), power.end(), 0.0);
    if (!(all > 0)) {
        t.records.clear();
        t.groups.clear();
        t.bounds.clear();
        t.area = 0;
        return;
    }
    for (std::size_t m = 0; m < bright_.size(); ++m)
        t.density[m] = static_cast<float>(bright_[m] / all);
    for (EmitterRecord& r : t.records) {
        const auto material = static_cast<std::size_t>(r.material);
        const double domain = all / bright_[material];
        r.domain = static_cast<float>(domain);
        put(r.radiance, emitted_[material] * (domain / std::numbers::pi));
    }
    for (std::size_t g = 0; g < t.groups.size(); ++g) {
        EmitterGroup& group = t.groups[g];
        const auto first = static_cast<std::size_t>(group.first);
        const std::size_t end =
            g + 1 < t.groups.size() ? static_cast<std::size_t>(t.groups[g + 1].first) : t.records.size();
        const double own = t.bounds[g].power;
        group.count = static_cast<std::int32_t>(end - first);
        group.sums = static_cast<std::int32_t>(t.sums.size());
        group.chance = static_cast<float>(own / all);
        double sum = 0;
        t.sums.push_back(0);
        for (std::size_t k = first; k < end; ++k) {
            sum += power[k];
            t.sums.push_back(own > 0 ? static_cast<float>(std::min(sum / own, 1.0)) : 1.0F);
        }
        t.sums.back() = 1;
    }
}

} // namespace razor
