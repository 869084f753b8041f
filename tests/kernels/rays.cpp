#include "tests/kernels/rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace razor::test {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Point normalised(const Point& d) {
    double length = std::sqrt(double{d[0]} * d[0] + double{d[1]} * d[1] + double{d[2]} * d[2]);
    if (!(length > 0))
        return {0, 0, 1};
    Point r{};
    for (std::size_t k = 0; k < 3; ++k)
        r[k] = static_cast<float>(d[k] / length);
    return r;
}

} // namespace

RayMaker::RayMaker(const std::vector<Triangle>& triangles, std::vector<Point> origins, unsigned seed)
    : triangles_(triangles),
      origins_(std::move(origins)), low_{infinity, infinity, infinity}, high_{-infinity, -infinity,
                                                                              -infinity},
      random_(seed) {
    for (const Triangle& t : triangles)
        for (const Point& p : t.vertex) {
            Point q = scene(t, p);
            for (std::size_t k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], q[k]);
                high_[k] = std::max(high_[k], q[k]);
            }
        }
}

float RayMaker::uniform(float low, float high) {
    float f = static_cast<float>(random_() >> 8) / 16777216.0F;
    return low + f * (high - low);
}
int RayMaker::pick(int n) {
    return static_cast<int>(random_() % static_cast<unsigned>(n));
}
const Triangle& RayMaker::any_triangle() {
    return triangles_[static_cast<std::size_t>(pick(static_cast<int>(triangles_.size())))];
}
Point RayMaker::scene(const Triangle& t, const Point& p) const {
    const Point& o = origins_[static_cast<std::size_t>(t.instance)];
    return {p[0] + o[0], p[1] + o[1], p[2] + o[2]};
}

Point RayMaker::random_point() {
    Point p{};
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = uniform(low_[k] - 0.1F * (high_[k] - low_[k]), high_[k] + 0.1F * (high_[k] - low_[k]));
    return p;
}
Point RayMaker::random_direction() {
    Point d{};
    float square = 0;
    do {
        d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    } while (square > 1 || square < 0.01F);
    return normalised(d);
}
Point RayMaker::direction_at_feature(const Point& origin) {
    const Triangle& t = any_triangle();
    auto i = static_cast<std::size_t>(pick(3));
    Point a = scene(t, t.vertex[i]);
    Point b = scene(t, t.vertex[(i + 1) % 3]);
    float f = pick(2) == 0 ? 0.0F : uniform(0, 1);
    Point d{};
    for (std::size_t k = 0; k < 3; ++k)
        d[k] = a[k] + f * (b[k] - a[k]) - origin[k];
    return normalised(d);
}

Ray RayMaker::random_ray() {
    return {random_point(), random_direction()};
}

/// Directions of few bits, whose slopes are exact; lengths are near enough to 1.
static Point exact_direction(RayMaker& m) {
    constexpr float slopes[] = {0, 0.25F, -0.25F, 0.5F, -0.5F, 0.125F, -0.625F};
    Point d{};
    auto axis = static_cast<std::size_t>(m.pick(3));
    d[axis] = m.pick(2) == 0 ? 1.0F : -1.0F;
    d[(axis + 1) % 3] = slopes[m.pick(7)];
    d[(axis + 2) % 3] = slopes[m.pick(7)];
    return d;
}

Ray RayMaker::at_vertex() {
    const Triangle& t = any_triangle();
    Point p = scene(t, t.vertex[static_cast<std::size_t>(pick(3))]);
    Ray r;
    r.direction = exact_direction(*this);
    // A power of two near the size of the coordinates keeps the origin's low bits.
    float size = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2]), 1e-3F});
    float back = std::exp2(std::floor(std::log2(size))) * static_cast<float>(pick(3));
    for (std::size_t k = 0; k < 3; ++k)
        r.origin[k] = p[k] - back * r.direction[k];
    if (pick(4) == 0) {
        r.origin = random_point();
        Point d{};
        for (std::size_t k = 0; k < 3; ++k)
            d[k] = p[k] - r.origin[k];
        r.direction = normalised(d);
    }
    return r;
}

Ray RayMaker::at_edge() {
    Ray r;
    if (pick(2) == 0) {
        r.origin = random_point();
        r.direction = direction_at_feature(r.origin);
        return r;
    }
    const Triangle& t = any_triangle();
    auto i = static_cast<std::size_t>(pick(3));
    Point a = scene(t, t.vertex[i]);
    Point b = scene(t, t.vertex[(i + 1) % 3]);
    r.direction = exact_direction(*this);
    for (std::size_t k = 0; k < 3; ++k)
        r.origin[k] = 0.5F * a[k] + 0.5F * b[k] - 0.5F * r.direction[k];
    return r;
}

Ray RayMaker::along_axis() {
    Ray r;
    auto axis = static_cast<std::size_t>(pick(3));
    r.origin = random_point();
    if (pick(2) == 0) { // its other coordinates are a vertex's
        const Triangle& t = any_triangle();
        r.origin = scene(t, t.vertex[static_cast<std::size_t>(pick(3))]);
        r.origin[axis] -= static_cast<float>(pick(3));
    }
    for (std::size_t k = 0; k < 3; ++k)
        r.direction[k] = pick(2) == 0 ? 0.0F : -0.0F;
    r.direction[axis] = pick(2) == 0 ? 1.0F : -1.0F;
    return r;
}

Ray RayMaker::from_surface() {
    const Triangle& t = any_triangle();
    float u = uniform(0, 1);
    float v = uniform(0, 1 - u);
    Ray r;
    for (std::size_t k = 0; k < 3; ++k)
        r.origin[k] = (1 - u - v) * t.vertex[0][k] + u * t.vertex[1][k] + v * t.vertex[2][k];
    r.origin = scene(t, r.origin);
    r.direction = random_direction();
    return r;
}

Ray RayMaker::odd_range() {
    Ray r = pick(2) == 0 ? from_surface() : random_ray();
    constexpr std::pair<float, float> ranges[] = {
        {0, 0},        {0, 1e-20F}, {1e-6F, 1e-3F},        {0.5F, 0.5F},    {1, 0.5F},
        {0, infinity}, {-1, 1e30F}, {-infinity, infinity}, {0.25F, 1.0e38F}};
    auto [low, high] = ranges[pick(9)];
    r.t_min = low;
    r.t_max = high;
    return r;
}

Ray RayMaker::not_a_ray() {
    Ray r = random_ray();
    auto k = static_cast<std::size_t>(pick(3));
    switch (pick(9)) {
    case 0:
        r.direction = {0, 0, 0};
        break;
    case 1:
        r.direction[k] = nan;
        break;
    case 2:
        r.direction[k] = infinity;
        break;
    case 3:
        r.origin[k] = nan;
        break;
    case 4:
        r.origin[k] = -infinity;
        break;
    case 5:
        r.t_min = nan;
        break;
    case 6:
        r.t_max = nan;
        break;
    case 7:
        r.direction = {1e-30F, -1e-30F, 1e-42F};
        break;
    default:
        r.direction = {3e38F, 3e38F, -3e38F};
        break;
    }
    return r;
}

} // namespace razor::test
