// OpenEXR pictures: one file, all planes as 32-bit channels, floats or, where numbers are names, UINT (no_id,
// 4294967295, where there is none), ZIP-compressed, text attributes in the header. Names of channels are
// LAYER.CHANNEL, those of the beauty R, G, B. The display window is the whole picture, the data window what
// is there of it; colours are of Rec. 709's primaries (`chromaticities`), and where the camera is known
// worldToCamera, worldToNDC and screenWindowWidth say what it was. There is no time or place of making: the
// same picture is the same file.
#pragma once

#include "razor/image/image.h"

#include <filesystem>

namespace razor {

/// Writes all planes; the file is whole or not there. Throws UserError where it cannot be written.
void write_exr(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes = {});

/// Reads all channels, UINT ones as ids and others as floats, in the file's (alphabetical) order, window and
/// camera; `attributes`, if
/// given, receives the text attributes. Throws UserError where the file is none or damaged.
Film read_exr(const std::filesystem::path& path, ImageAttributes* attributes = nullptr);

} // namespace razor
