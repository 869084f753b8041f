// What textures say of how rough sheen is.
#pragma once

#include "razor/scene/texture.h"

namespace razor {

/// By its opacity; else, of pictures without and of patterns, by its green.
bool has_roughness_in_opacity(const Texture& texture);

/// Between what its values lie, however it is filtered.
struct RoughnessRange {
    float least, most;
};
RoughnessRange sheen_roughness_range(const Texture& texture);

} // namespace razor
