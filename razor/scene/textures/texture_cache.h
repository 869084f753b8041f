// Pictures that have been read: no file twice.
#pragma once

#include "razor/scene/texture.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>

namespace razor {

class TextureCache {
public:
    /// See read_picture(). Throws UserError.
    std::shared_ptr<const TexturePyramid> read(const std::filesystem::path& path, bool linear,
                                               Texels kind = Texels::colours);

private:
    std::map<std::tuple<std::string, bool, Texels>, std::shared_ptr<const TexturePyramid>> pyramids_;
};

} // namespace razor
