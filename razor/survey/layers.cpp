#include "razor/survey/layers.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace razor {
namespace {

using G = LayerGroup;

struct Group {
    std::string_view name;
    LayerSource source;
};
constexpr std::array<Group, layer_groups> groups{{{"pick", LayerSource::sight},
                                                  {"lod", LayerSource::sight},
                                                  {"patch", LayerSource::sight},
                                                  {"kd", LayerSource::sight},
                                                  {"steps", LayerSource::packet},
                                                  {"bytes", LayerSource::touch},
                                                  {"packet", LayerSource::tile},
                                                  {"shading", LayerSource::tile},
                                                  {"time", LayerSource::tile}}};

constexpr Missing never = Missing::never, minus_one = Missing::minus_one, infinite = Missing::infinite;

constexpr Layer layers[] = {
    {"pick.mesh", G::pick, true, minus_one, "number of the mesh, in the scene's order"},
    {"pick.instance", G::pick, true, minus_one, "which drawing of a mesh, in the graph's order"},
    {"pick.face", G::pick, true, minus_one, "number of the cage's face, in the mesh's order"},
    {"pick.part", G::pick, true, minus_one,
     "which patch of the face: an n-gon's corner, a cut polygon's triangle"},
    {"pick.u", G::pick, false, minus_one, "place on the patch: 0 at its corner 0, 1 at corner 1"},
    {"pick.v", G::pick, false, minus_one, "place on the patch: 0 at its corner 0, 1 at corner 3"},
    {"pick.Z", G::pick, false, infinite, "distance along the ray, world units"},
    {"lod.level", G::lod, false, infinite, "log2 of the edge length of the level hit, world units"},
    {"lod.depth", G::lod, false, minus_one, "how many levels that is above the instance's finest"},
    {"lod.asked", G::lod, false, infinite,
     "log2 of the edge length asked for, with its fraction; -infinite: the finest"},
    {"patch.id", G::patch, true, minus_one, "number of the patch in its mesh"},
    {"patch.block", G::patch, true, minus_one, "number of the block in its patch and level"},
    {"kd.depth", G::kd, false, minus_one, "kd planes above the leaf in which the ray ended"},
    {"kd.finer", G::kd, false, minus_one, "how often the way there went on to a cell's finer blocks"},
    {"steps.nodes", G::steps, false, never, "kd nodes visited: of a packet, over its rays; likewise:"},
    {"steps.boxes", G::steps, false, never, "boxes of listed blocks tested"},
    {"steps.blocks", G::steps, false, never, "blocks tested"},
    {"steps.blended", G::steps, false, never, "of these, tests against blended vertices"},
    {"steps.cells", G::steps, false, never, "cells of 2 x 2 quads tested"},
    {"steps.quads", G::steps, false, never, "quads tested"},
    {"bytes.touched", G::bytes, false, never, "lines of memory that tracing touched, x 64 bytes, over rays"},
    {"bytes.tree", G::bytes, false, never, "of these, kd nodes and item lists"},
    {"bytes.grids", G::bytes, false, never, "of these, grids"},
    {"packet.utilisation", G::packet, false, never, "rays over lanes, of all packets; 0: there are none"},
    {"packet.camera", G::packet, false, never, "of packets of camera rays"},
    {"packet.shadow", G::packet, false, never, "of packets of shadow rays"},
    {"packet.bounce", G::packet, false, never, "of packets of bounces"},
    {"shading.hits", G::shading, false, never, "hits shaded, a pixel"},
    {"shading.shadow_rays", G::shading, false, never, "shadow rays, a pixel"},
    {"shading.bounces", G::shading, false, never, "rays reflected or let through, a pixel"},
    {"time.microseconds", G::time, false, never, "the host's time, a pixel"}};

} // namespace

std::span<const Layer> all_layers() {
    return layers;
}

bool is_missing(const Layer& layer, float value) {
    return (layer.missing == Missing::minus_one && value == -1) ||
           (layer.missing == Missing::infinite && value == std::numeric_limits<float>::infinity());
}

const Layer* find_layer(std::string_view name) {
    const auto found = std::find_if(std::begin(layers), std::end(layers),
                                    [&](const Layer& layer) { return layer.name == name; });
    return found == std::end(layers) ? nullptr : found;
}

std::string_view group_name(LayerGroup group) {
    return groups[static_cast<std::size_t>(group)].name;
}

LayerSource source_of(LayerGroup group) {
    return groups[static_cast<std::size_t>(group)].source;
}

bool LayerSet::has(LayerSource source) const {
    for (int g = 0; g < layer_groups; ++g)
        if (const auto group = static_cast<LayerGroup>(g); has(group) && source_of(group) == source)
            return true;
    return false;
}

LayerSet parse_layers(std::string_view option, std::string_view text, bool touches) {
    std::vector<std::string_view> words{"all"};
    for (const Group& group : groups)
        words.push_back(group.name);
    LayerSet set;
    for (std::string_view rest = text;;) {
        const std::size_t comma = rest.find(',');
        const std::string_view word = rest.substr(0, comma);
        const auto found = std::find(words.begin(), words.end(), word);
        if (found == words.end())
            throw UserError(fmt::format("{} '{}' is unknown; {}", option, printable(word),
                                        or_known(word, words, "There are")));
        for (int g = 0; g < layer_groups; ++g) {
            const auto group = static_cast<LayerGroup>(g);
            const bool again = group != LayerGroup::time && (touches || group != LayerGroup::bytes);
            if (word == group_name(group) || (word == "all" && again))
                set.add(group);
        }
        if (comma == std::string_view::npos)
            break;
        rest = rest.substr(comma + 1);
    }
    if (set.has(LayerGroup::bytes) && !touches)
        throw UserError(fmt::format("{} bytes: this build has no simulated kernels, which tell what they "
                                    "touch; build with `simulated` among RAZOR_TARGETS",
                                    option));
    return set;
}

std::string describe_layers() {
    std::string text;
    for (const Layer& layer : layers)
        text += fmt::format("  {:<20} {}\n", layer.name, layer.meaning);
    return text;
}

} // namespace razor
