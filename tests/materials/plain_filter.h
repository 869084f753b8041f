// Reconstruction filters again, in double and as their authors state them. Nothing here is shared with the
// renderer.
#pragma once

#include "razor/scene/filter.h"

#include <glm/vec2.hpp>

#include <functional>

namespace razor::test {

/// Where a sample of a pixel lies, in pixels from its middle, and by what it counts: the mean of light times
/// that is the integral of filter times light over the integral of the filter.
struct FilmSample {
    glm::dvec2 place{0};
    double factor = 1;
};

/// Places of density |f|.
class PlainFilter {
public:
    explicit PlainFilter(const Filter& filter);
    /// `next()`: evenly in [0, 1). As many calls as it takes, two where the filter is a box.
    FilmSample choose(const std::function<double()>& next) const;

private:
    double at(int axis, double x) const;

    Filter filter_;
    double most_ = 0;   // at least |f|, of each axis
    double factor_ = 1; // the integral of |f| over that of f
};

} // namespace razor::test
