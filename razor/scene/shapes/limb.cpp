#include "razor/scene/shapes/kinds.h"
#include "razor/scene/shapes/revolve.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace razor {
namespace {

constexpr std::array<ShapeParameter, 5> parameters{{
    {"segments", 10, 3, 1000, true},  // around
    {"rings", 2, 1, 1000, true},      // along, between the round ends
    {"length", 2, 1e-6, 1e9, false},  // from the joint, the origin, down to the other end's centre
    {"joint", 0.4, 1e-6, 1e9, false}, // radius there
    {"end", 0.3, 1e-6, 1e9, false},   // radius at the other end
}};

constexpr int cap_rings = 3; // of a round end, without its pole

/// A tapered capsule that hangs from its joint.
Mesh make(std::span<const double> values) {
    const int rings = static_cast<int>(values[1]);
    const double length = values[2], joint = values[3], end = values[4];
    std::vector<ProfilePoint> profile{{0, -length - end, 0}};
    const auto cap = [&](double radius, double height, int ring, int side) {
        const double angle = std::numbers::pi / 2 * ring / (cap_rings + 1); // from the rim
        profile.push_back({radius * std::cos(angle), height + side * radius * std::sin(angle), 0});
    };
    for (int k = cap_rings; k > 0; --k) {
        cap(end, -length, k, -1);
    }
    for (int k = 0; k <= rings; ++k) {
        const double x = static_cast<double>(k) / rings;
        profile.push_back({end + (joint - end) * x, length * (x - 1), 0});
    }
    for (int k = 1; k <= cap_rings; ++k) {
        cap(joint, 0, k, 1);
    }
    profile.push_back({0, joint, 0});
    return revolve(profile, static_cast<int>(values[0]));
}

} // namespace

ShapeKind limb_kind() {
    return {"limb", parameters, make};
}

} // namespace razor
