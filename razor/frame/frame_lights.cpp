// Lights in frame memory: those that have rays of their own, those that are chosen from, and surfaces.
#include "razor/frame/frame_memory.h"

#include "razor/frame/light_records.h"
#include "razor/frame/light_tree.h"
#include "razor/frame/scratch.h"
#include "razor/scene/error.h"
#include "razor/scene/textures/shared_exponent.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace razor {
namespace {

/// Of all that it shows; 1 of none.
glm::vec3 mean_of_map(const Scene& scene, const TextureMap& map) {
    if (map.texture < 0)
        return glm::vec3(1);
    const Texture& texture = scene.textures[static_cast<std::size_t>(map.texture)];
    if (texture.pattern)
        return glm::vec3((texture.pattern->low + texture.pattern->high) / 2.0F); // about
    return unpack_shared_exponent(texture.pyramid->levels.back().texels.front());
}

/// Why rays to lights would go where it is not, or nothing.
std::string not_sampled(const Scene& scene, const Material& m) {
    if (is_displaced(m))
        return "is displaced, and rays to lights go to where its surface was before";
    if (m.alpha_cutoff == 0 || m.albedo_map.texture < 0)
        return "";
    const Texture& texture = scene.textures[static_cast<std::size_t>(m.albedo_map.texture)];
    return texture.pattern || texture.pyramid->levels[0].opacity.empty()
               ? ""
               : "has holes (alpha_cutoff), from which rays to lights would come back bright";
}

bool is_used(const std::vector<Mesh>& meshes, const std::vector<Instance>& instances, int material) {
    return std::any_of(instances.begin(), instances.end(), [&](const Instance& i) {
        const std::vector<int>& faces = meshes[static_cast<std::size_t>(i.mesh)].face_materials;
        return i.material >= 0 ? i.material == material
                               : std::find(faces.begin(), faces.end(), material) != faces.end();
    });
}

/// Rays of neighbouring hits to one light are traced together, those to lights that each hit has chosen cost
/// about twelve times as much (tests/benchmarks/many_lights.py): where there are fewer lights, a ray to each
/// is both less noisy and faster.
constexpr std::size_t lights_a_choice = 12;

bool worth_choosing(std::size_t lights, const Settings& s) {
    return s.light_choices > 0 && lights > lights_a_choice * static_cast<std::size_t>(s.light_choices);
}

/// The largest power of two below a number of intervals: see find_interval() in razor/kernels/sky_map.h.
std::int32_t largest_step(std::size_t count) {
    return count < 2 ? 0 : static_cast<std::int32_t>(std::bit_floor(count - 1));
}

} // namespace

void Frame::Impl::place_lights(const Scene& scene) {
    most_lights = scene.lights.size();
    header->lights.set(region<LightRecord>("scene graph", -1, most_lights));
    chooses_lights = scene.settings.light_samples > 0 && worth_choosing(most_lights, scene.settings);
    if (chooses_lights) {
        header->chosen_lights.set(region<LightRecord>("scene graph", -1, most_lights));
        header->light_nodes.set(region<LightNode>("scene graph", -1, 2 * most_lights));
    }
    place_emitters(scene);
    if (chooses_lights || emitters)
        for (int w = 0; w < options.workers; ++w)
            header->workers.get()[w].cuts.set(
                coloured<float>("packets", w, 2 * light_cut_floats, colour_cuts));
}

std::vector<bool> Frame::Impl::choose_lights(const Scene& scene) {
    std::vector<bool> chosen(scene.lights.size(), false);
    if (!chooses_lights)
        return chosen;
    Settings once = scene.settings;
    once.light_samples = 1;
    std::vector<LightBounds> lights;
    std::vector<LightRecord> records;
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
        if (std::optional<LightRecord> record = light_record(scene.lights[l], once, geometry.origin);
            record && has_place(scene.lights[l])) {
            lights.push_back(bounds_of(scene.lights[l], geometry.origin));
            records.push_back(*record);
            chosen[l] = true;
        }
    if (!worth_choosing(lights.size(), scene.settings))
        return std::vector<bool>(scene.lights.size(), false);
    const std::vector<LightNode> nodes = light_tree(lights);
    if (nodes.empty())
        return std::vector<bool>(scene.lights.size(), false);
    std::copy(records.begin(), records.end(), header->chosen_lights.get());
    std::copy(nodes.begin(), nodes.end(), header->light_nodes.get());
    header->light_node_count = static_cast<std::int32_t>(nodes.size());
    header->light_choices = scene.settings.light_choices;
    return chosen;
}

void Frame::Impl::fill_lights(const Scene& scene) {
    const Settings& s = scene.settings;
    header->light_count = header->light_node_count = header->light_choices = 0;
    if (s.light_samples == 0)
        return;
    const std::vector<bool> chosen = choose_lights(scene);
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
        if (std::optional<LightRecord> record = light_record(scene.lights[l], s, geometry.origin);
            record && !chosen[l]) {
            record->dimension = light_dimension(static_cast<int>(l));
            header->lights.get()[header->light_count++] = *record;
        }
}

void Frame::Impl::place_emitters(const Scene& scene) {
    std::vector<glm::dvec3> emitted(scene.materials.size(), glm::dvec3(0));
    bool mapped = false;
    for (std::size_t m = 0; m < emitted.size(); ++m) {
        const Material& material = scene.materials[m];
        if (!material.light)
            continue;
        emitted[m] = material.emission * mean_of_map(scene, material.emission_map);
        if (const std::string why = not_sampled(scene, material);
            !why.empty() && emitted[m] != glm::dvec3(0) &&
            is_used(meshes, geometry.instances, static_cast<int>(m)))
            throw UserError(fmt::format("{}: material '{}' is a light and {}; leave `light` out, so that "
                                        "bounces find it (diffuse_bounces)",
                                        scene.name, material.name, why));
        mapped = mapped || material.emission_map.texture >= 0;
    }
    const glm::dvec3 dark(0);
    if (std::all_of(emitted.begin(), emitted.end(), [&](const glm::dvec3& e) { return e == dark; }))
        return;
    emitters = std::make_unique<Emitters>(meshes, topologies, geometry.instances, emitted);
    if (emitters->count() == 0) {
        emitters.reset();
        return;
    }
    header->emitters.set(region<EmitterRecord>("scene graph", -1, emitters->count()));
    header->emitter_groups.set(region<EmitterGroup>("scene graph", -1, emitters->groups()));
    header->emitter_nodes.set(region<LightNode>("scene graph", -1, 2 * emitters->groups()));
    header->emitter_sums.set(region<float>("scene graph", -1, emitters->count() + emitters->groups()));
    header->emitter_maps = mapped ? 1 : 0;
}

void Frame::Impl::fill_emitters(const Scene& scene) {
    if (!emitters)
        return;
    FrameHeader& h = *header;
    const int samples = scene.settings.light_samples;
    std::vector<std::int32_t> first_patches;
    for (std::size_t n = 0; n < geometry.instances.size(); ++n)
        first_patches.push_back(h.instances.get()[n].first_patch);
    EmitterTables t = samples > 0 ? emitters->tabulate(scene, geometry, first_patches) : EmitterTables{};
    const std::vector<LightNode> nodes = light_tree(t.bounds);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (nodes[n].second < 0)
            t.groups[static_cast<std::size_t>(-1 - nodes[n].second)].leaf = static_cast<std::int32_t>(n);
    std::copy(t.records.begin(), t.records.end(), h.emitters.get());
    std::copy(t.groups.begin(), t.groups.end(), h.emitter_groups.get());
    std::copy(nodes.begin(), nodes.end(), h.emitter_nodes.get());
    std::copy(t.sums.begin(), t.sums.end(), h.emitter_sums.get());
    h.emitter_count = static_cast<std::int32_t>(t.records.size());
    h.emitter_group_count = static_cast<std::int32_t>(t.groups.size());
    h.emitter_group_step = largest_step(t.groups.size());
    h.emitter_step = 0;
    for (const EmitterGroup& g : t.groups)
        h.emitter_step = std::max(h.emitter_step, largest_step(static_cast<std::size_t>(g.count)));
    h.emitter_samples = samples;
    h.emitter_spacing = sample_spacing(scene.settings, t.area, samples);
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        h.materials.get()[m].light_density = m < t.density.size() ? t.density[m] : 0.0F;
}

} // namespace razor
