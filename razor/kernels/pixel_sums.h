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

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
