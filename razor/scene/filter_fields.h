// The members of a filter that mean something for its kind, by the names that scene files have for them.
#pragma once

#include "razor/scene/filter.h"
#include "razor/scene/ranges.h"

namespace razor {

/// visit(name, value, range) of what filters of that kind have besides a radius.
template <class AnyFilter, class Visit> void visit_filter_parameters(AnyFilter& filter, Visit visit) {
    switch (filter.kind) {
    case FilterKind::gaussian:
        visit("sigma", filter.sigma, filter_radius_range);
        break;
    case FilterKind::mitchell:
        visit("b", filter.b, unit_range);
        visit("c", filter.c, unit_range);
        break;
    case FilterKind::lanczos:
        visit("tau", filter.tau, filter_radius_range);
        break;
    case FilterKind::box:
    case FilterKind::triangle:
        break;
    }
}

} // namespace razor
