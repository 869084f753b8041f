#include "razor/api/layers.h"

#include "razor/scene/error.h"
#include "razor/scene/nearest.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>
#include <vector>

namespace razor::api {
namespace {

const Plane& find(const Film& film, std::string_view name) {
    const Plane* const plane = film.find(name);
    if (plane == nullptr)
        throw std::invalid_argument(fmt::format("the film has no plane {}", name));
    return *plane;
}

/// Planes that every picture has are missing where they are infinite.
std::function<bool(float)> missing_of(std::string_view plane) {
    return [layer = find_layer(plane)](float value) { return layer != nullptr && is_missing(*layer, value); };
}

} // namespace

std::string plane_name(std::string_view option, std::string_view text) {
    std::vector<std::string> names;
    for (const Layer& layer : all_layers()) {
        if (text == group_name(layer.group) || text == layer.name)
            return std::string(layer.name);
        names.emplace_back(layer.name);
    }
    for (const Plane& plane : make_film(1, 1).planes) {
        if (text == plane.name)
            return plane.name;
        names.push_back(plane.name);
    }
    names.emplace_back("samples"); // of adaptive sampling
    if (text == names.back())
        return names.back();
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw UserError(
        fmt::format("{} '{}' is no layer; {}", option, printable(text), or_known(text, known, "There are")));
}

ValueRange plane_range(const Film& film, std::string_view plane) {
    return range_of(find(film, plane), missing_of(plane));
}

Film in_colours(const Film& film, std::string_view plane, const std::optional<ValueRange>& range) {
    const Layer* const layer = find_layer(plane);
    return false_coloured(film, find(film, plane), layer != nullptr && layer->names,
                          range ? *range : plane_range(film, plane), missing_of(plane));
}

} // namespace razor::api
