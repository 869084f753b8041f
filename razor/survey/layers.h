// The layers that a picture can have beside what shading makes: what its pixels show, and what they cost.
// They come in groups; each layer is a plane, named as OpenEXR does: group, dot, channel.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace razor {

enum class LayerGroup : std::uint8_t { pick, lod, patch, kd, steps, bytes, packet, shading, time };
inline constexpr int layer_groups = 9;

/// From whom a group has its figures.
enum class LayerSource : std::uint8_t {
    sight,  // one ray through each pixel's centre
    packet, // what packets of such rays count; one figure for all pixels of a packet
    touch,  // likewise, of the lines of memory that they touch
    tile    // the frame's own rays of each kind; one figure for all pixels of a screen tile
};

/// What a layer has where the ray hits nothing; of names that is no_id.
enum class Missing : std::uint8_t { never, minus_one, infinite };

struct Layer {
    std::string_view name;
    LayerGroup group;
    bool names; // its numbers name things (Plane::ids): neighbouring ones have nothing in common
    Missing missing;
    std::string_view meaning; // with the unit
};
/// All there are, group by group in their order.
std::span<const Layer> all_layers();
/// Whether it says that nothing is hit.
bool is_missing(const Layer& layer, float value);
/// The layer of that name, or null.
const Layer* find_layer(std::string_view name);

std::string_view group_name(LayerGroup group);
LayerSource source_of(LayerGroup group);

class LayerSet {
public:
    bool empty() const { return bits_ == 0; }
    bool has(LayerGroup group) const { return (bits_ >> static_cast<unsigned>(group) & 1U) != 0; }
    /// Some group of that source.
    bool has(LayerSource source) const;
    void add(LayerGroup group) { bits_ |= 1U << static_cast<unsigned>(group); }

private:
    unsigned bits_ = 0;
};

/// "pick,lod": the groups of these names. "all": all whose figures a later run gives again, thus without the
/// host's time; what this program cannot find (`touches` false: lines of memory) is not among them. Throws
/// UserError that names the groups, and begins with `option`.
LayerSet parse_layers(std::string_view option, std::string_view text, bool touches);

/// "  pick.mesh  number of the mesh ...\n" and so on, for help texts.
std::string describe_layers();

} // namespace razor
