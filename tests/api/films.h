// Films compared bit for bit, with messages.
#pragma once

#include "razor/api/renderer.h"

#include <gtest/gtest.h>

#include <cstring>

namespace razor {

inline bool same_bits(const Plane& a, const Plane& b) {
    return a.ids == b.ids && a.values.size() == b.values.size() &&
           (a.values.empty() ||
            std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0);
}

inline void expect_same_bits(const Film& film, const Film& expected, const std::string& what) {
    ASSERT_EQ(film.width, expected.width) << what;
    ASSERT_EQ(film.planes.size(), expected.planes.size()) << what;
    for (const Plane& plane : expected.planes) {
        const Plane* const same = film.find(plane.name);
        ASSERT_NE(same, nullptr) << what << ": " << plane.name;
        EXPECT_TRUE(same_bits(*same, plane)) << what << ": " << plane.name;
    }
}

/// Whether the beauty of both is the same.
inline bool same_beauty(const Film& a, const Film& b) {
    return a.width == b.width && same_bits(*a.find("R"), *b.find("R")) &&
           same_bits(*a.find("G"), *b.find("G")) && same_bits(*a.find("B"), *b.find("B"));
}

/// A scene with all that can be edited.
inline constexpr const char* small_scene = R"(
name = "small"
[settings]
size = [48, 32]
samples = 2
light_samples = 1
sky_samples = 1
[camera]
position = [0, 3, 9]
target = [0, 0.5, 0]
[sky]
radiance = [0.3, 0.4, 0.5]
[[light]]
corner = [-2, 5, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
radiance = 9
[[texture]]
name = "veins"
pattern = "marble"
[[material]]
name = "stone"
albedo = [0.5, 0.4, 0.3]
albedo_map = "veins"
[[material]]
name = "metal"
albedo = [0.9, 0.6, 0.3]
metallic = 1
roughness = 0.3
[[mesh]]
name = "floor"
shape = "plane"
scheme = "bilinear"
scale = 8
[[mesh]]
name = "pawn"
shape = "pawn"
material = "stone"
[[mesh]]
name = "gear"
shape = "gear"
material = "metal"
[[group]]
name = "pair"
[[group.object]]
name = "left"
mesh = "pawn"
translate = [-1, 0, 0]
[[group.object]]
name = "right"
mesh = "pawn"
translate = [1, 0, 0]
[[object]]
name = "front"
group = "pair"
translate = [0, 0, 1.5]
[[object]]
name = "back"
group = "pair"
translate = [0, 0, -1.5]
[[object]]
name = "wheel"
mesh = "gear"
translate = [0, 2, 0]
[[object.key]]
time = 0
rotate = [0, 0, 0]
[[object.key]]
time = 1
rotate = [0, 0, 90]
)";

} // namespace razor
