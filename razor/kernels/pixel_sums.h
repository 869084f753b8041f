// What the samples of pixels add up to.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Sums over the samples of one packet of pixels, of each lane's or of each pixel's.
struct PixelSums {
    vvec beauty, normal, albedo;
    vfloat depth, hits;
};

/// The same of a filter with negative parts: as if all samples counted alike, and as they count.
struct WeightedSums {
    PixelSums even;
    vvec beauty, albedo;
    vfloat weight;
};

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
