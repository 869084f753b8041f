// What pictures are made of, and how samples count in them.
#pragma once

#include <cstdint>

namespace razor {

/// Planes of the film, one float a pixel each, in this order.
enum FilmPlane : std::int32_t {
    film_beauty = 0,
    film_normal = 3,
    film_depth = 6,
    film_albedo = 7,
    film_planes = 10
};

/// What a film holds beside its planes where passes add to it: sums over each pixel's samples, planes of one
/// float a pixel. Of a filter with negative parts there are more: razor/kernels/film_filter.h.
inline constexpr int sum_planes = 11;          // beauty, normal, albedo, depth, how many hit something
inline constexpr int weighted_sum_planes = 18; // these, then weighted beauty and albedo, weights

/// Which camera samples of a screen tile's pixels a pass takes, where that is not the same for all tiles. The
/// sums of what was taken before are in the first set of planes, or (`swapped` is not 0) in the second.
struct TilePass {
    std::int32_t first, end; // equal: none
    std::int32_t packet_samples_log2;
    std::int32_t swapped;
};

/// Where samples lie, and what they count: evenly in their pixel; as a FilterBin says, all alike; or some of
/// them less than nothing.
enum FilterUse : std::int32_t { filter_pixel = 0, filter_even = 1, filter_weighted = 2 };
/// Of what is drawn along one axis, a part that is drawn once in filter_bins times.
struct FilterBin {
    float from, width; // pixels, from the pixel's corner
    float weight;
    float padding;
};
inline constexpr int filter_bins = 512;

} // namespace razor
