#include "razor/program/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace razor {
namespace {

/// One thing that a scene may need or not.
struct Feature {
    const char* name;
    bool present;
};

std::vector<Feature> features_of(const Scene& scene, const FrameStatistics& frame) {
    const Settings& s = scene.settings;
    const auto has_light = [&](LightKind kind) {
        return s.light_samples > 0 &&
               std::any_of(scene.lights.begin(), scene.lights.end(),
                           [&](const Light& l) { return l.kind == kind && l.radiance != glm::vec3(0); });
    };
    const bool sky = std::max({scene.sky.x, scene.sky.y, scene.sky.z}) > 0 && s.sky_samples > 0;
    const bool glossy = frame.look == look_glossy || frame.look == look_glossy_mapped;
    const bool mapped = frame.look == look_mapped || frame.look == look_glossy_mapped;
    using enum LightKind;
    return {{"grids with hanging vertices", frame.grids == grids_hanging},
            {"blending between levels of detail",
             s.lod == Lod::recursive || s.lod == Lod::camera || s.lod == Lod::paper},
            {"lens", has_lens(scene.camera)},
            {"rectangle lights", has_light(rectangle)},
            {"disk lights", has_light(disk)},
            {"sphere lights", has_light(sphere)},
            {"point lights and spots", has_light(point) || has_light(spot)},
            {"directional lights", has_light(directional)},
            {"surfaces as lights", frame.mesh_lights},
            {"lights that rays are given by chance", frame.chosen_lights},
            {"light of the sky", sky},
            {"map of the sky", scene.sky_map.texture >= 0},
            {"reflection, transmission and emission", glossy},
            {"diffuse interreflection", s.diffuse_bounces > 0},
            {"sheen", frame.sheen},
            {"maps of sheen", frame.sheen_maps},
            {"surfaces of one side", frame.one_sided},
            {"textures or materials of faces", mapped},
            {"procedural textures", frame.patterns},
            {"bump maps", frame.bumps},
            {"displacement", frame.displacement}};
}

double percent(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

} // namespace

std::vector<std::pair<std::string, bool>> features_in_use(const Scene& scene, const FrameStatistics& frame) {
    std::vector<std::pair<std::string, bool>> features;
    for (const Feature& f : features_of(scene, frame))
        features.emplace_back(f.name, f.present);
    return features;
}

std::string features_text(const Scene& scene, const FrameStatistics& frame) {
    std::string text;
    const std::vector<Feature> features = features_of(scene, frame);
    for (const bool present : {true, false}) {
        std::vector<const char*> names;
        for (const Feature& feature : features)
            if (feature.present == present)
                names.push_back(feature.name);
        text += fmt::format("{}: {}\n", present ? "in use" : "left out", fmt::join(names, ", "));
    }
    return text;
}

std::string explain(const Scene& scene, const RenderStatistics& statistics) {
    const FrameStatistics& f = statistics.frame;
    std::string text = fmt::format("plan: {}\n", f.plan);
    const auto out = std::back_inserter(text);
    text += features_text(scene, f);
    fmt::format_to(out,
                   "tables: materials {}, texture coordinates {}, places at rest {}, textures {:.1f} MiB\n",
                   f.material_records > 0 ? fmt::format("{}", f.material_records) : "none",
                   f.textured_meshes > 0 ? fmt::format("of {} meshes", f.textured_meshes) : "none",
                   f.meshes_at_rest > 0 ? fmt::format("of {} meshes", f.meshes_at_rest) : "none",
                   static_cast<double>(f.texture_bytes) / (1 << 20));
    const Counters& c = f.counters;
    const std::int64_t patches_opened = c.patches_opened - statistics.budget.regenerated_patches;
    const std::int64_t nodes = f.inner_nodes + f.leaves + f.unsplit_nodes;
    const auto never = [&](const char* what, std::int64_t left, std::int64_t all) {
        fmt::format_to(out, "never {}: {} of {} ({:.1f} %)\n", what, left, all, percent(left, all));
    };
    never("opened, instances", f.instances * f.trees - f.instances_opened, f.instances * f.trees);
    never("opened, patches", f.patches - patches_opened, f.patches);
    never("split, kd nodes that were made", f.unsplit_nodes, nodes);
    never("shaded, blocks that were made", c.blocks_made - c.normal_blocks, c.blocks_made);
    if (c.textured_hits > 0) {
        const std::int64_t at_hits = c.shading_evaluations - c.grid_evaluations;
        fmt::format_to(
            out,
            "textures: {} hits, evaluated {} times at vertices of grids ({:.1f} % of lanes at work) and {} "
            "at hits: {:.3f} a hit\n",
            c.textured_hits, c.grid_evaluations, percent(c.grid_evaluations, c.grid_lanes), at_hits,
            static_cast<double>(c.shading_evaluations) / static_cast<double>(c.textured_hits));
    }
    return text;
}

} // namespace razor
