// Samples of a film that is filtered: where each lies and what it counts (razor/frame/filter_table.h), and
// what the samples of pixels add up to where some count negative.
//
// The mean of weighted samples would leave noise even on an evenly lit wall, since the mean of their weights
// is 1 only in the long run. So a pixel's value is the mean of weighted samples and, for what its weights
// lack of 1, the mean of the samples as they are: exact where all samples agree, and without a division that
// few samples could make one by nearly 0. Its bias is the covariance of both means, less than that of one
// sample's weight and light over the number of samples.
#pragma once

#include "razor/kernels/pixel_sums.h"
#include "razor/kernels/sampling.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// A bin's word of what is drawn along one axis.
inline vfloat filter_word(pointer<FilterBin> bins, const vint& bin, int word, const vmask& m) {
    pointer<float> words = as<float>(bins) + word;
    return gather(words, bin << 2, m);
}
[[gnu::noinline]] inline vfloat draw_along(pointer<FilterBin> bins, const vfloat& u, const vmask& m) {
    vfloat scaled = u * float(filter_bins);
    vint bin = to_int(scaled);
    vfloat along = scaled - to_float(bin);
    vfloat from = filter_word(bins, bin, 0, m);
    vfloat width = filter_word(bins, bin, 1, m);
    return fma(along, width, from);
}

/// From the pixel's corner to where the sample of that place in the unit square lies.
inline vpoint draw_filtered(const Context& c, const vpoint& square, const vmask& m) {
    pointer<FilterBin> bins = load(field(c.frame, &FrameHeader::filter_table));
    vpoint at;
    at.u = draw_along(bins, square.u, m);
    at.v = draw_along(bins + filter_bins, square.v, m);
    return at;
}

/// What it counts: 1 in the mean of all.
inline vfloat filter_weight(const Context& c, const vpoint& square, const vmask& m) {
    pointer<FilterBin> bins = load(field(c.frame, &FrameHeader::filter_table));
    vint column = to_int(square.u * float(filter_bins));
    vint row = to_int(square.v * float(filter_bins));
    vfloat across = filter_word(bins, column, 2, m);
    return across * filter_word(bins + filter_bins, row, 2, m);
}

inline PixelSums no_sums() {
    vfloat zero(0.0F);
    return {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero, zero};
}
inline WeightedSums no_weighted_sums() {
    vfloat zero(0.0F);
    return {no_sums(), {zero, zero, zero}, {zero, zero, zero}, zero};
}

/// Adds one sample a lane, and empties it for the next. Normals and depths are means over what is hit: they
/// are of the filter's absolute value, so that none of them is divided by nearly 0.
[[gnu::noinline]] inline void add_weighted(const Context& c, const vpoint& square, const vmask& m,
                                           PixelSums& sample, WeightedSums& sums) {
    vfloat weight = filter_weight(c, square, m);
    sums.beauty = madd(weight, sample.beauty, sums.beauty);
    sums.albedo = madd(weight, sample.albedo, sums.albedo);
    sums.weight = sums.weight + weight;
    sums.even.beauty = sums.even.beauty + sample.beauty;
    sums.even.normal = sums.even.normal + sample.normal;
    sums.even.albedo = sums.even.albedo + sample.albedo;
    sums.even.depth = sums.even.depth + sample.depth;
    sums.even.hits = sums.even.hits + sample.hits;
    sample = no_sums();
}

/// Of `samples` a pixel: what stands for their sum.
inline PixelSums sums_of(const WeightedSums& sums, sint samples) {
    vfloat share = reciprocal(vfloat(to_float(samples)));
    vfloat missing = fnma(sums.weight, share, vfloat(1.0F));
    PixelSums all = sums.even;
    all.beauty = madd(missing, sums.even.beauty, sums.beauty);
    all.albedo = madd(missing, sums.even.albedo, sums.albedo);
    return all;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
