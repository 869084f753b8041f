// 8-bit sRGB pictures of the beauty, for looking at.
#pragma once

#include "razor/image/image.h"
#include "razor/image/tone.h"

#include <cstdint>
#include <filesystem>

namespace razor {

/// Linear light to an 8-bit sRGB value: clamped to [0, 1], IEC 61966-2-1 transfer, rounded to nearest; NaN
/// gives 0.
std::uint8_t to_srgb8(float linear);

/// Writes planes R, G, B as `tone` shows them; attributes become compressed text chunks. The file is whole or
/// not there. Throws UserError where it cannot be written.
void write_png(const std::filesystem::path& path, const Film& film, const ImageAttributes& attributes = {},
               const Tone& tone = {});

} // namespace razor
