#include "razor/scene/shapes/cage_builder.h"
#include "razor/scene/shapes/kinds.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 5> parameters{{
    {"teeth", 11, 3, 1000, true},
    {"bore", 0.38, 0.01, 0.6, false},     // radius
    {"root", 0.76, 0.65, 0.99, false},    // radius between the teeth
    {"thickness", 0.36, 1e-3, 10, false}, // along y
    {"sharpness", 2.2, 0, 10, false},     // of all rims
}};

/// Point indices of one flank of the wheel (top or bottom), two a tooth in each list.
struct Flank {
    std::vector<int> bore, root, tip;
};

Flank add_flank(CageBuilder& cage, std::span<const double> values, double y) {
    const int teeth = static_cast<int>(values[0]);
    Flank flank;
    const auto add = [&](double radius, double turn) {
        const double angle = 2 * std::numbers::pi * turn / teeth;
        return cage.point(radius * std::sin(angle), y, radius * std::cos(angle));
    };
    for (int tooth = 0; tooth < teeth; ++tooth) {
        for (const double side : {-1.0, 1.0}) {
            flank.bore.push_back(add(values[1], tooth + 0.25 * side));
            flank.root.push_back(add(values[2], tooth + 0.29 * side));
            flank.tip.push_back(add(1.0, tooth + 0.17 * side));
        }
    }
    return flank;
}

Mesh make(std::span<const double> values) {
    CageBuilder cage;
    const Flank top = add_flank(cage, values, 0.5 * values[3]);
    const Flank bottom = add_flank(cage, values, -0.5 * values[3]);
    const double sharpness = values[4];
    const std::size_t count = top.root.size();

    const auto flat = [&](std::span<const int> upper, std::span<const int> lower) {
        cage.face({upper[0], upper[1], upper[2], upper[3]});
        cage.face({lower[3], lower[2], lower[1], lower[0]});
    };
    // A wall below the rim edge a-b, seen from outside with a on the left.
    const auto wall = [&](int a, int b, int low_a, int low_b) {
        cage.face({low_a, low_b, b, a});
        cage.crease(a, b, sharpness);
        cage.crease(low_a, low_b, sharpness);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = (i + 1) % count;
        flat(std::array{top.bore[i], top.root[i], top.root[j], top.bore[j]},
             std::array{bottom.bore[i], bottom.root[i], bottom.root[j], bottom.bore[j]});
        wall(top.bore[j], top.bore[i], bottom.bore[j], bottom.bore[i]);
        if (i % 2 == 1) { // from one tooth to the next
            wall(top.root[i], top.root[j], bottom.root[i], bottom.root[j]);
            continue;
        }
        flat(std::array{top.root[i], top.tip[i], top.tip[j], top.root[j]},
             std::array{bottom.root[i], bottom.tip[i], bottom.tip[j], bottom.root[j]});
        wall(top.root[i], top.tip[i], bottom.root[i], bottom.tip[i]);
        wall(top.tip[i], top.tip[j], bottom.tip[i], bottom.tip[j]);
        wall(top.tip[j], top.root[j], bottom.tip[j], bottom.root[j]);
    }
    return cage.take();
}

} // namespace

ShapeKind gear_kind() {
    return {"gear", parameters, make};
}

} // namespace razor
