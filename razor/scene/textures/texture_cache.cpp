#include "razor/scene/textures/texture_cache.h"

#include "razor/scene/textures/picture.h"

namespace razor {

std::shared_ptr<const TexturePyramid> TextureCache::read(const std::filesystem::path& path, bool linear,
                                                         Texels kind) {
    auto& pyramid = pyramids_[{std::filesystem::absolute(path).lexically_normal().string(), linear, kind}];
    if (!pyramid)
        pyramid = std::make_shared<const TexturePyramid>(read_picture(path, linear, kind));
    return pyramid;
}

} // namespace razor
