// Where the rays through pixels' middles end, beside where they should.
#pragma once

#include "analysis/images/image_file.h"

#include <cstddef>

namespace analysis {

struct HitDifferences {
    std::size_t pixels = 0, wrong = 0; // wrong: one of both sees nothing, or another instance
    /// Of the others that see something: |z - r| / r of the distances along the ray. The mean holds
    /// silhouettes and folds, where a ray passes the surface that it should hit; the median does not.
    double mean_distance_error = 0, median_distance_error = 0; // NaN where there are none

    double wrong_share() const {
        return pixels == 0 ? 0 : static_cast<double>(wrong) / static_cast<double>(pixels);
    }
};

/// Of the channels pick.Z and pick.instance. Throws ImageError where one is missing, or sizes differ.
HitDifferences hit_differences(const ImageFile& picture, const ImageFile& reference);

} // namespace analysis
