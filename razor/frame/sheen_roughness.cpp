#include "razor/frame/sheen_roughness.h"

#include "razor/scene/textures/shared_exponent.h"

#include <algorithm>
#include <limits>

namespace razor {

bool has_roughness_in_opacity(const Texture& texture) {
    return !texture.pattern && !texture.pyramid->levels[0].opacity.empty();
}

RoughnessRange sheen_roughness_range(const Texture& texture) {
    if (texture.pattern) {
        const float low = texture.pattern->low.y, high = texture.pattern->high.y;
        return {std::min(low, high), std::max(low, high)};
    }
    RoughnessRange range{std::numeric_limits<float>::max(), 0};
    for (const TextureLevel& level : texture.pyramid->levels)
        for (const std::uint32_t word : has_roughness_in_opacity(texture) ? level.opacity : level.texels) {
            const float value = unpack_shared_exponent(word).y;
            range = {std::min(range.least, value), std::max(range.most, value)};
        }
    return range;
}

} // namespace razor
