// The cages that Razor can make by itself, by name, for scene files (`shape = "..."`).
#pragma once

#include "razor/scene/scene.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace razor {

/// One number that shapes a cage.
struct ShapeParameter {
    std::string_view name;
    double preset = 0;
    double least = 0, most = 0;
    bool whole = false; // counts are whole numbers
};

struct ShapeKind {
    std::string_view name;
    std::span<const ShapeParameter> parameters;
    Mesh (*make)(std::span<const double> values); // one value a parameter, in their order, all in range
};

std::span<const ShapeKind> shape_kinds();

/// The kind of that name, or null.
const ShapeKind* find_shape_kind(std::string_view name);

/// Makes a shape of a known kind; `parameters` holds all of its parameters in their order.
Mesh make_shape(std::string_view kind, const std::vector<std::pair<std::string, double>>& parameters);

} // namespace razor
