#include "razor/scene/shapes/revolve.h"

#include "razor/scene/shapes/cage_builder.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace razor {

namespace {

/// Of each ring the length of the profile up to it, as a part of all.
std::vector<double> along_profile(std::span<const ProfilePoint> profile) {
    std::vector<double> lengths{0};
    for (std::size_t k = 1; k < profile.size(); ++k) {
        const double length =
            std::hypot(profile[k].radius - profile[k - 1].radius, profile[k].height - profile[k - 1].height);
        lengths.push_back(lengths.back() + length);
    }
    const double all = lengths.back();
    for (double& length : lengths) {
        length /= all;
    }
    return lengths;
}

} // namespace

Mesh revolve(std::span<const ProfilePoint> profile, int segments) {
    CageBuilder cage;
    std::vector<std::vector<int>> rings; // a pole is a ring that repeats one point
    for (const ProfilePoint& at : profile) {
        std::vector<int> ring;
        for (int i = 0; i < segments; ++i) {
            const double angle = 2 * std::numbers::pi * i / segments;
            const bool pole = at.radius == 0 && i > 0;
            ring.push_back(
                pole ? ring[0]
                     : cage.point(at.radius * std::sin(angle), at.height, at.radius * std::cos(angle)));
        }
        for (int i = 0; i < segments && at.radius > 0; ++i) {
            cage.crease(ring[std::size_t(i)], ring[std::size_t((i + 1) % segments)], at.sharpness);
        }
        rings.push_back(std::move(ring));
    }
    const std::vector<double> along = along_profile(profile);
    if (profile.front().radius > 0) {
        std::vector<glm::dvec2> disk;
        for (int i = segments; i-- > 0;) {
            const double angle = 2 * std::numbers::pi * i / segments;
            disk.emplace_back(0.5 + 0.5 * std::sin(angle), 0.5 + 0.5 * std::cos(angle));
        }
        cage.face(std::vector<int>(rings.front().rbegin(), rings.front().rend()), disk);
    }
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
        for (std::size_t i = 0; i < std::size_t(segments); ++i) {
            const std::size_t j = (i + 1) % std::size_t(segments);
            const int a = rings[k][i], b = rings[k][j], c = rings[k + 1][j], d = rings[k + 1][i];
            const double left = double(i) / segments, right = double(i + 1) / segments;
            const double low = along[k], high = along[k + 1], middle = 0.5 * (left + right);
            if (a == b) {
                cage.face({a, c, d}, {{middle, low}, {right, high}, {left, high}});
            } else if (c == d) {
                cage.face({a, b, c}, {{left, low}, {right, low}, {middle, high}});
            } else {
                cage.face({a, b, c, d}, {{left, low}, {right, low}, {right, high}, {left, high}});
            }
        }
    }
    return cage.take();
}

} // namespace razor
