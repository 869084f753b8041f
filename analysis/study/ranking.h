// Places of points by a figure, as far as their runs tell them apart.
#pragma once

#include "analysis/study/spread.h"

#include <cstddef>
#include <span>
#include <vector>

namespace analysis {

/// Runs of a point without which nothing is said of its place: the least and the greatest of fewer say too
/// little of what noise does. Of three runs each, all of one point lie below all of an equal one in one case
/// of twenty.
inline constexpr std::size_t least_ranked_runs = 3;

/// From 1, the best.
struct Place {
    std::size_t best = 0, worst = 0; // which it may be; 0: it has no figure, or too few runs

    bool known() const { return best != 0; }
    bool sure() const { return known() && best == worst; }
};

/// Whether each run of `a` lies below each of `b`.
bool surely_below(const Spread& a, const Spread& b);

/// Of each point, the smaller the better: behind all that are surely below it, before all that it is surely
/// below; among the others no order is given.
std::vector<Place> rank(std::span<const Spread> points);

/// The same of minus the values: where more is better.
Spread negated(const Spread& spread);

} // namespace analysis
