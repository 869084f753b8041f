// A picture's file by its extension: .exr with all planes, .png for looking at.
#pragma once

#include "razor/image/image.h"
#include "razor/image/tone.h"

#include <filesystem>

namespace razor {

/// Throws UserError if `path` is no picture file by its extension, or could not be written later. Call before
/// rendering.
void check_output(const std::filesystem::path& path);

/// Whether the extension is .png, in letters of any case.
bool is_png(const std::filesystem::path& path);

/// Writes the picture in the format of the extension; the file is whole or not there.
/// `tone` is of pictures for looking at alone.
void write_image(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes,
                 const Tone& tone = {});

} // namespace razor
