#include "analysis/metrics/finite.h"

#include <algorithm>
#include <cmath>

namespace analysis {

NotFinite count_not_finite(const LinearImage& image) {
    NotFinite out;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const auto any = [&](const auto& test) {
            return std::any_of(image.planes.begin(), image.planes.end(),
                               [&](const std::vector<float>& plane) { return test(plane[i]); });
        };
        if (any([](float value) { return std::isnan(value); })) {
            ++out.nan;
        } else if (any([](float value) { return std::isinf(value); })) {
            ++out.infinite;
        }
    }
    return out;
}

std::vector<bool> finite_in_both(const LinearImage& a, const LinearImage& b) {
    std::vector<bool> mask(a.size(), true);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < mask.size(); ++i) {
            mask[i] = mask[i] && std::isfinite(a.planes[c][i]) && std::isfinite(b.planes[c][i]);
        }
    }
    return mask;
}

void equate_outside(const std::vector<bool>& mask, LinearImage& a, LinearImage& b) {
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < mask.size(); ++i) {
            if (!mask[i]) {
                float& value_a = a.planes[c][i];
                float& value_b = b.planes[c][i];
                const float common = std::isfinite(value_b)   ? value_b
                                     : std::isfinite(value_a) ? value_a
                                                              : 0.0F;
                value_a = value_b = common;
            }
        }
    }
}

} // namespace analysis
