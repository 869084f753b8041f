#include "razor/scene/shapes/shapes.h"

#include "razor/scene/shapes/kinds.h"

#include <algorithm>
#include <array>

namespace razor {

std::span<const ShapeKind> shape_kinds() {
    static const std::array kinds{plane_kind(), box_kind(),    pawn_kind(),   bowl_kind(),
                                  gear_kind(),  knot_kind(),   urchin_kind(), sponge_kind(),
                                  dish_kind(),  canopy_kind(), limb_kind()};
    return kinds;
}

const ShapeKind* find_shape_kind(std::string_view name) {
    const auto kinds = shape_kinds();
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const ShapeKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

Mesh make_shape(std::string_view kind, const std::vector<std::pair<std::string, double>>& parameters) {
    std::vector<double> values;
    for (const auto& [name, value] : parameters) {
        values.push_back(value);
    }
    return find_shape_kind(kind)->make(values);
}

} // namespace razor
