#include "razor/check/scene_report.h"

#include "razor/frame/scene_geometry.h"
#include "razor/frame/view.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace razor::check {
namespace {

constexpr double few_bits = 8;      // an edge of fewer has corners that are seen to be off
constexpr double large_range = 1e6; // of radiances
constexpr double far_off = 0.1;     // pixels

/// From a number of that size to the next one of single precision.
double spacing(double size) {
    return size > 0 ? std::ldexp(1.0, std::ilogb(size) - 23) : 0;
}

double longest_edge(const Mesh& mesh) {
    double longest = 0;
    std::size_t first = 0;
    for (const int size : mesh.face_sizes) {
        const auto n = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < n; ++i) {
            const auto a = static_cast<std::size_t>(mesh.face_vertices[first + i]);
            const auto b = static_cast<std::size_t>(mesh.face_vertices[first + (i + 1) % n]);
            longest = std::max(longest, glm::length(mesh.points[a] - mesh.points[b]));
        }
        first += n;
    }
    return longest;
}

std::string mesh_name(const Scene& scene, int mesh) {
    return fmt::format("mesh '{}'", printable(scene.meshes[static_cast<std::size_t>(mesh)].name, 60));
}

SceneGeometry geometry_of(const Scene& scene) {
    return locate_scene(scene, std::vector<bool>(scene.meshes.size(), true));
}

std::vector<PrecisionBudget> precision_of(const Scene& scene, const SceneGeometry& geometry) {
    std::vector<PrecisionBudget> budgets(scene.meshes.size());
    const Camera& camera = scene.camera;
    const double pixel = pixel_footprint(camera, scene.settings);
    for (std::size_t n = 0; n < geometry.instances.size(); ++n) {
        const Instance& instance = geometry.instances[n];
        const Box& box = geometry.boxes[n];
        PrecisionBudget p;
        p.mesh = instance.mesh;
        const glm::dvec3 corner =
            glm::max(glm::abs(box.low - geometry.origin), glm::abs(box.high - geometry.origin));
        p.from_centre = std::max({corner.x, corner.y, corner.z});
        const double near = glm::length(camera.position - glm::clamp(camera.position, box.low, box.high));
        p.error = 0.5 * std::max(spacing(p.from_centre), spacing(near));
        p.edge_length = instance.edge_length;
        p.bits = p.error > 0 ? std::log2(p.edge_length / (2 * p.error)) : 24;
        const double footprint = camera.projection == Projection::orthographic ? pixel : pixel * near;
        p.error_pixels = footprint > 0 ? p.error / footprint : 0;
        PrecisionBudget& worst = budgets[static_cast<std::size_t>(instance.mesh)];
        p.instances = worst.instances + 1;
        if (worst.instances == 0 || p.bits < worst.bits)
            worst = p;
        else
            worst.instances = p.instances;
    }
    std::erase_if(budgets, [](const PrecisionBudget& p) { return p.instances == 0; });
    return budgets;
}

class Findings {
public:
    explicit Findings(const Scene& scene) : scene_(scene), geometry_(geometry_of(scene)) {}

    std::vector<SceneFinding> all() {
        precision();
        levels();
        lights();
        materials();
        return std::move(found_);
    }

private:
    void add(Severity severity, std::string kind, std::string object, std::string what, std::string means,
             std::string mend) {
        found_.push_back({severity, std::move(kind), std::move(object), std::move(what), std::move(means),
                          std::move(mend)});
    }

    void precision() {
        for (const PrecisionBudget& p : precision_of(scene_, geometry_)) {
            if (p.bits >= few_bits && p.error_pixels < far_off)
                continue;
            add(Severity::warning, "precision", mesh_name(scene_, p.mesh),
                fmt::format(
                    "{:.3g} units from the scene's centre single precision tells {:.2g} units apart: {:.1f} "
                    "bits for edges of {:.2g}",
                    p.from_centre, 2 * p.error, std::max(p.bits, 0.0), p.edge_length),
                p.error_pixels > 0
                    ? fmt::format("hits are off by up to {:.2g} units, {:.2g} pixels where it is nearest",
                                  p.error, p.error_pixels)
                    : fmt::format("hits are off by up to {:.2g} units", p.error),
                "bring what is far apart nearer together, or leave out what makes the scene so large");
        }
    }

    /// Of edges as long as the mesh's longest, which limit curves are not much longer than.
    void levels() {
        std::vector<bool> told(scene_.meshes.size());
        for (const Instance& instance : geometry_.instances) {
            const auto m = static_cast<std::size_t>(instance.mesh);
            const double ratio = longest_edge(scene_.meshes[m]) / instance.mesh_edge_length;
            if (told[m] || scene_.meshes[m].scheme == Scheme::bilinear)
                continue;
            if (ratio > 2 * std::ldexp(1.0, max_exponent_limit)) {
                told[m] = true;
                add(Severity::warning, "levels", mesh_name(scene_, instance.mesh),
                    fmt::format(
                        "edges of {:.2g} units are asked for, of faces {:.2g} long: 2^{:.1f} parts of 2^{}",
                        instance.edge_length, ratio * instance.edge_length, std::log2(ratio),
                        max_exponent_limit),
                    fmt::format("its finest edges are {:.3g} times as long as asked for",
                                std::ldexp(ratio, -max_exponent_limit)),
                    "give its cage more faces, or a longer edge_length");
            }
        }
    }

    /// Whether all that there is lies behind a light that shines to one side, or beside its cone.
    bool turned_away(const Light& l) const {
        const bool rectangle = l.kind == LightKind::rectangle;
        if (!rectangle && l.kind != LightKind::disk && (l.kind != LightKind::spot || l.cone_angle > 90))
            return false;
        const glm::dvec3 to = rectangle ? glm::cross(l.edge_u, l.edge_v) : l.direction;
        const glm::dvec3 from = rectangle ? l.corner : l.position;
        return std::all_of(geometry_.boxes.begin(), geometry_.boxes.end(), [&](const Box& box) {
            const glm::dvec3 furthest = glm::mix(box.low, box.high, glm::greaterThan(to, glm::dvec3(0)));
            return glm::dot(furthest - from, to) <= 0;
        });
    }

    void lights() {
        float least = std::numeric_limits<float>::max(), most = 0;
        bool any =
            std::max({scene_.sky.x, scene_.sky.y, scene_.sky.z}) > 0 && scene_.settings.sky_samples > 0;
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const Light& l = scene_.lights[i];
            const std::string name = fmt::format("light {} ({})", i, word_of(light_words, l.kind));
            const float power = std::max({l.radiance.x, l.radiance.y, l.radiance.z});
            const bool flat =
                (l.kind == LightKind::rectangle && glm::length(glm::cross(l.edge_u, l.edge_v)) == 0) ||
                ((l.kind == LightKind::disk || l.kind == LightKind::sphere) && l.radius == 0);
            if (flat)
                add(Severity::warning, "zero_area_light", name, "it has no area", "it gives no light",
                    "give it a size, or make it a point");
            if (power <= 0)
                add(Severity::note, "dark_light", name, fmt::format("its {} is 0", emission_name(l.kind)),
                    "it gives no light, and costs none", "leave it out");
            if (flat || power <= 0)
                continue;
            if (!geometry_.boxes.empty() && turned_away(l))
                add(Severity::warning, "light_turned_away", name,
                    "all surfaces lie behind it, where it does not shine", "it gives no light",
                    l.kind == LightKind::rectangle
                        ? "exchange edge_u and edge_v: it shines to the side of cross(edge_u, edge_v)"
                        : "turn its direction round");
            any = any || scene_.settings.light_samples > 0;
            if (l.kind == LightKind::point || l.kind == LightKind::spot || l.kind == LightKind::directional)
                continue; // of other units
            least = std::min(least, power);
            most = std::max(most, power);
        }
        if (most > large_range * least)
            add(Severity::warning, "light_range", "lights",
                fmt::format("radiances go from {:.2g} to {:.2g}", least, most),
                "what reflects the brightest is noise before the dimmest is seen",
                "bring them nearer together, or leave the dimmest out");
        any = any || std::any_of(scene_.materials.begin(), scene_.materials.end(), [](const Material& m) {
                  return std::max({m.emission.x, m.emission.y, m.emission.z}) > 0;
              });
        if (!any)
            add(Severity::warning, "no_light", "scene",
                "no light, no sky and no surface that shines gives any light", "the picture is black",
                "add a light, or a sky");
    }

    void materials() {
        std::set<int> used;
        for (const Instance& instance : geometry_.instances)
            used.insert(instance.material);
        for (const Mesh& mesh : scene_.meshes) {
            used.insert(mesh.face_materials.begin(), mesh.face_materials.end());
            if (mesh.face_materials.empty())
                used.insert(mesh.material);
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const Material& m = scene_.materials[i];
            const std::string name = fmt::format("material '{}'", printable(m.name, 60));
            if (!used.contains(static_cast<int>(i))) {
                add(Severity::note, "unused_material", name, "nothing is made of it", "it is not seen",
                    "leave it out");
                continue;
            }
            const bool matte = m.metallic < 1 && m.transmission < 1;
            if (matte && std::min({m.albedo.x, m.albedo.y, m.albedo.z}) >= 1 && m.albedo_map.texture < 0 &&
                scene_.settings.diffuse_bounces > 0)
                add(Severity::warning, "albedo_one", name, "its albedo is 1",
                    fmt::format(
                        "light between such surfaces never ends, and {} bounces cut it off: pictures are "
                        "darker than they are",
                        scene_.settings.diffuse_bounces),
                    "give it at most 0.9, which no real surface but fresh snow has");
        }
    }

    const Scene& scene_;
    SceneGeometry geometry_;
    std::vector<SceneFinding> found_;
};

/// With one worker.
FrameStatistics render_small(Scene scene, int part, const KernelTable& kernels) {
    Settings& s = scene.settings;
    s.crop = {};
    s.width = std::max(1, s.width / part);
    s.height = std::max(1, s.height / part);
    s.samples = 1;
    s.noise_threshold = 0;
    Frame frame(scene, {});
    frame.render(kernels, 0);
    return frame.statistics();
}

std::int64_t built_bytes(const FrameStatistics& s) {
    return s.grid_bytes + s.node_bytes + s.list_bytes;
}

} // namespace

std::vector<PrecisionBudget> precision_of(const Scene& scene) {
    return precision_of(scene, geometry_of(scene));
}

std::vector<SceneFinding> findings_of(const Scene& scene) {
    return Findings(scene).all();
}

MemoryEstimate estimate_memory(const Scene& scene, const KernelTable& kernels) {
    MemoryEstimate e;
    const Settings& s = scene.settings;
    const auto pixels = [&](int part) {
        return static_cast<std::int64_t>(std::max(1, s.width / part)) * std::max(1, s.height / part);
    };
    for (const int part : {4, 2}) {
        e.frame = render_small(scene, part, kernels);
        e.from.emplace_back(pixels(part), built_bytes(e.frame));
    }
    const auto [few, little] = e.from[0];
    const auto [many, much] = e.from[1];
    const auto grown = static_cast<double>(std::max(much - little, std::int64_t{0}));
    const auto more = static_cast<double>(pixels(1) - many);
    const double linear = grown / static_cast<double>(std::max<std::int64_t>(many - few, 1)) * more;
    const double power =
        grown / static_cast<double>(std::max<std::int64_t>(little, 1)) * static_cast<double>(much);
    e.built_least = much + static_cast<std::int64_t>(std::min(linear, power));
    e.built_most = much + static_cast<std::int64_t>(std::max(linear, power));
    e.lasting = e.frame.scene_graph_bytes + e.frame.topology_bytes + e.frame.control_point_bytes;
    e.textures = e.frame.texture_bytes;
    const Crop part = shown_part(s);
    e.film =
        static_cast<std::int64_t>(make_film(1, 1).planes.size() * sizeof(float)) * part.width * part.height;
    return e;
}

} // namespace razor::check
