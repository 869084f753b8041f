// Planes of films that are to be looked at: which there are, and one in colours.
#pragma once

#include "razor/image/false_colour.h"
#include "razor/image/image.h"
#include "razor/survey/layers.h"

#include <optional>
#include <string>
#include <string_view>

namespace razor::api {

/// The plane that "lod.level", or "lod" for its group's first, "depth.Z" or "samples" means. Throws
/// UserError, which begins with `option`, and names all there are.
std::string plane_name(std::string_view option, std::string_view text);
/// From the least to the largest of its values that are finite and not missing.
ValueRange plane_range(const Film& film, std::string_view plane);
/// A plane in colours, for a .png: dark where it is low, bright where it is high, black where it is missing;
/// numbers that are names have a colour each. Throws std::invalid_argument if the film has no such plane.
Film in_colours(const Film& film, std::string_view plane, const std::optional<ValueRange>& range = {});

} // namespace razor::api
