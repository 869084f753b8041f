// Pictures as light, for metrics: linear R, G, B, whatever the file stored.
#pragma once

#include "analysis/images/image_file.h"

#include <array>
#include <string>
#include <vector>

namespace analysis {

struct LinearImage {
    int width = 0, height = 0;
    std::array<std::vector<float>, 3> planes; // R, G, B; rows from the top

    LinearImage() = default;
    LinearImage(int width, int height) : width(width), height(height) {
        planes.fill(std::vector<float>(size()));
    }

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Whether whole numbers are stored (PNG): values on a display, at most 1. Otherwise they are radiance.
bool is_display_referred(const ImageFile& image);

/// The channels R, G, B, or Y three times. Whole numbers are decoded from sRGB (IEC 61966-2-1) to [0, 1].
/// Throws ImageError where neither is there; `name` is the picture's in that message.
LinearImage linear_rgb(const ImageFile& image, const std::string& name);

} // namespace analysis
