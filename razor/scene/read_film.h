// The [film] table of scene files: the filter that the picture is reconstructed with, by its kind's name, and
// what a filter of that kind has: radius = [x, y] in pixels; sigma of a gaussian; b and c of mitchell; tau of
// lanczos. What is not stated is pbrt's preset (razor/scene/filter.h).
#pragma once

#include "razor/scene/filter.h"
#include "razor/scene/toml_table.h"

#include <string>

namespace razor {

/// Throws UserError naming the place.
Filter read_filter(TomlTable table);

/// The table, all of it.
std::string to_toml(const Filter& filter);

} // namespace razor
