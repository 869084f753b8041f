// Small pictures for tests.
#pragma once

#include "analysis/images/linear_image.h"

#include <algorithm>
#include <functional>
#include <random>

namespace analysis {

inline LinearImage constant(int width, int height, float r, float g, float b) {
    LinearImage out(width, height);
    std::fill(out.planes[0].begin(), out.planes[0].end(), r);
    std::fill(out.planes[1].begin(), out.planes[1].end(), g);
    std::fill(out.planes[2].begin(), out.planes[2].end(), b);
    return out;
}

/// Uniform values in [0, scale).
inline LinearImage noise(int width, int height, unsigned seed, float scale = 1) {
    LinearImage out(width, height);
    std::mt19937 random(seed);
    for (auto& plane : out.planes) {
        for (float& value : plane) {
            value = scale * static_cast<float>(random() >> 8) * 0x1p-24F;
        }
    }
    return out;
}

/// `image` with every value v replaced by f(v).
inline LinearImage mapped(LinearImage image, const std::function<float(float)>& f) {
    for (auto& plane : image.planes) {
        for (float& value : plane) {
            value = f(value);
        }
    }
    return image;
}

inline std::vector<bool> all_of(const LinearImage& image) {
    return std::vector<bool>(image.size(), true);
}

} // namespace analysis
