#include "razor/scene/shapes/revolve.h"

#include "razor/scene/shapes/cage_builder.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace razor {

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
    if (profile.front().radius > 0) {
        cage.face(std::vector<int>(rings.front().rbegin(), rings.front().rend()));
    }
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
        for (std::size_t i = 0; i < std::size_t(segments); ++i) {
            const std::size_t j = (i + 1) % std::size_t(segments);
            const int a = rings[k][i], b = rings[k][j], c = rings[k + 1][j], d = rings[k + 1][i];
            if (a == b) {
                cage.face({a, c, d});
            } else if (c == d) {
                cage.face({a, b, c});
            } else {
                cage.face({a, b, c, d});
            }
        }
    }
    return cage.take();
}

} // namespace razor
