// Pictures as textures: PNG (every kind), JPEG (grey and YCbCr or RGB), TGA (every kind), OpenEXR (red,
// green, blue or luminance, and opacity), Radiance (RGBE). By their first bytes, whatever their names, but
// for TGA, whose files begin with nothing of their own: what ends in .tga and is none of the others, and what
// else has a header that could be one. What metadata say of gamma, primaries or turns is passed over;
// Radiance's EXPOSURE and COLORCORR, which its pixels were multiplied by, are divided out.
#pragma once

#include "razor/scene/texture.h"

#include <filesystem>
#include <string_view>

namespace razor {

/// A side of a picture, and texels of it, at most.
inline constexpr int most_picture_side = 32768;
inline constexpr std::int64_t most_texels = std::int64_t{1} << 29;

/// Throws UserError "name: cause; mend" where a picture of `bytes` bytes says that it is larger than the
/// limits, or than any so short can be. Before anything of that size is allocated.
void check_picture_size(std::string_view name, std::int64_t width, std::int64_t height, std::size_t bytes);

/// What they hold as linear colours. `linear`: it is no sRGB colour; OpenEXR and Radiance never are. Colours
/// above 65408 count as that. Throws UserError "name: cause; mend": damaged, cut short, too large, or of a
/// kind that is not read.
///
/// Heights: red, as the file has it (`linear` is passed over), or its grey or luminance; OpenEXR's may be
/// negative.
TexturePyramid decode_png(std::string_view bytes, std::string_view name, bool linear,
                          Texels kind = Texels::colours);
TexturePyramid decode_jpeg(std::string_view bytes, std::string_view name, bool linear,
                           Texels kind = Texels::colours);
TexturePyramid decode_tga(std::string_view bytes, std::string_view name, bool linear,
                          Texels kind = Texels::colours);
TexturePyramid decode_exr(std::string_view bytes, std::string_view name, Texels kind = Texels::colours);
TexturePyramid decode_radiance(std::string_view bytes, std::string_view name, Texels kind = Texels::colours);

/// Whether these bytes begin as a TGA picture could.
bool may_be_tga(std::string_view bytes);

/// Whichever of these it is. `name`: of the file or the part of one, for messages.
TexturePyramid decode_picture(std::string_view bytes, std::string_view name, bool linear,
                              Texels kind = Texels::colours);

/// A file.
TexturePyramid read_picture(const std::filesystem::path& path, bool linear, Texels kind = Texels::colours);

} // namespace razor
