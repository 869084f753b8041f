#include "tests/kernels/oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace razor::test {

namespace {

int largest_component(const Point& d) {
    const int axis = std::abs(d[1]) > std::abs(d[0]) ? 1 : 0;
    return std::abs(d[2]) > std::abs(d[static_cast<std::size_t>(axis)]) ? 2 : axis;
}

/// A ray's own frame: z along an axis.
struct Sheared {
    std::size_t kz, kx, ky;
    float shear_x, shear_y, scale_z;
    Point origin; // permuted, scene coordinates

    Sheared(const Ray& r, int axis) : kz(static_cast<std::size_t>(axis)) {
        const Point& d = r.direction;
        kx = (kz + 1) % 3;
        ky = (kx + 1) % 3;
        scale_z = 1.0F / d[kz];
        shear_x = d[kx] * scale_z;
        shear_y = d[ky] * scale_z;
        origin = {r.origin[kx], r.origin[ky], r.origin[kz]};
    }
};

struct Projected {
    float x, y, z;
};

struct Arithmetic {
    bool fused;
    float multiply_add(float a, float b, float c) const { return fused ? std::fma(a, b, c) : a * b + c; }
    /// c - a b
    float minus_product(float a, float b, float c) const { return fused ? std::fma(-a, b, c) : c - a * b; }
};

/// Exact in sign: where the rounded products are equal, their rounding errors decide.
float edge_function(const Projected& p, const Projected& q) {
    float a = p.x * q.y;
    float b = p.y * q.x;
    if (a != b)
        return a - b;
    return std::fma(p.x, q.y, -a) - std::fma(p.y, q.x, -b);
}

bool usable(const Ray& r) {
    float size = std::abs(r.origin[0]) + std::abs(r.origin[1]) + std::abs(r.origin[2]);
    double square = 0;
    for (float d : r.direction)
        square += double{d} * d;
    return size < 3.0e38F && square > 0.5 && square < 2 && r.t_min <= r.t_max;
}

} // namespace

Oracle::Oracle(Frame& frame, bool fused) : Oracle(triangles_of(frame), instance_origins(frame), fused) {}

Oracle::Oracle(std::vector<Triangle> triangles, std::vector<Point> origins, bool fused)
    : triangles_(std::move(triangles)), origins_(std::move(origins)), fused_(fused) {}

std::vector<int> shear_axes(const std::vector<Ray>& rays, int width) {
    std::vector<int> axes(rays.size(), 0);
    const auto packet = static_cast<std::size_t>(width);
    for (std::size_t begin = 0; begin < rays.size(); begin += packet) {
        const std::size_t end = std::min(begin + packet, rays.size());
        std::vector<bool> grouped(rays.size(), false);
        for (std::size_t first = begin; first < end; ++first) {
            if (grouped[first] || !usable(rays[first]))
                continue;
            const int axis = largest_component(rays[first].direction);
            for (std::size_t i = first; i < end; ++i) {
                const Point& d = rays[i].direction;
                const float most = std::abs(d[static_cast<std::size_t>(largest_component(d))]);
                if (!grouped[i] && usable(rays[i]) &&
                    std::abs(d[static_cast<std::size_t>(axis)]) >= 0.5F * most) {
                    grouped[i] = true;
                    axes[i] = axis;
                }
            }
        }
    }
    return axes;
}

template <class Visit> void Oracle::each_hit(const Ray& ray, int axis, Visit visit) const {
    if (!usable(ray))
        return;
    Sheared s(ray, axis);
    Arithmetic with{fused_};
    auto take = [&](const Triangle& t, float distance, float u, float v) {
        if (distance >= ray.t_min && distance <= ray.t_max)
            visit(Hit{t.patch, t.number, distance, u, v});
    };
    // Edge k of a triangle, from p to q, lies on a longer flat edge but for its vertices' rounding: whatever
    // is between the two, over the length of the shorter, is a hit on the shorter.
    auto meet_gap = [&](const Triangle& t, std::size_t k, Projected p, Projected q, Projected from,
                        Projected to) {
        bool second = t.number % 2 != 0;
        if (second && k != 0) { // the grid's sides run along its rows and columns
            std::swap(p, q);
            std::swap(from, to);
        }
        bool steep = std::abs(to.y - from.y) > std::abs(to.x - from.x);
        float begin = steep ? p.y : p.x;
        float end = steep ? q.y : q.x;
        float whole = steep ? to.y - from.y : to.x - from.x;
        if (std::min(begin, end) > 0 || std::max(begin, end) < 0)
            return;
        float a = edge_function(p, q) * (end < begin ? -1.0F : 1.0F);
        float b = edge_function(from, to) * (whole < 0 ? -1.0F : 1.0F);
        if (whole == 0)
            b = 1;
        if (!(std::min(a, b) <= 0 && std::max(a, b) >= 0))
            return;
        float place = begin == end ? 0 : begin / (begin - end);
        float distance = with.multiply_add(place, q.z - p.z, p.z) * s.scale_z;
        if (!second)
            take(t, distance, k == 0 ? place : 1.0F - place, k == 0 ? 0 : place);
        else
            take(t, distance, k == 2 ? 0 : place, k == 2 ? place : 1.0F - place);
    };
    for (const Triangle& t : triangles_) {
        const Point& m = origins_[static_cast<std::size_t>(t.instance)];
        float ox = s.origin[0] - m[s.kx];
        float oy = s.origin[1] - m[s.ky];
        float oz = s.origin[2] - m[s.kz];
        auto project = [&](const Point& v) {
            Projected p{};
            p.z = v[s.kz] - oz;
            p.x = with.minus_product(s.shear_x, p.z, v[s.kx] - ox);
            p.y = with.minus_product(s.shear_y, p.z, v[s.ky] - oy);
            return p;
        };
        Projected p[3] = {project(t.vertex[0]), project(t.vertex[1]), project(t.vertex[2])};
        float f[3]; // opposite vertex 0, 1, 2
        for (std::size_t k = 0; k < 3; ++k)
            f[k] = edge_function(p[(k + 1) % 3], p[(k + 2) % 3]);
        bool positive = f[0] >= 0 && f[1] >= 0 && f[2] >= 0;
        bool negative = f[0] <= 0 && f[1] <= 0 && f[2] <= 0;
        float determinant = f[0] + f[1] + f[2];
        if ((positive || negative) && determinant != 0) {
            float inverse = 1.0F / determinant;
            float depth = with.multiply_add(f[0], p[0].z, with.multiply_add(f[1], p[1].z, f[2] * p[2].z));
            take(t, depth * s.scale_z * inverse, f[1] * inverse, f[2] * inverse);
        }
        for (std::size_t k = 0; k < 3; ++k)
            if (t.edge[k].hang > 0)
                meet_gap(t, k, p[k], p[(k + 1) % 3], project(t.edge[k].from), project(t.edge[k].to));
    }
}

Hit Oracle::closest(const Ray& ray) const {
    return closest(ray, largest_component(ray.direction));
}

Hit Oracle::closest(const Ray& ray, int axis) const {
    Hit best;
    each_hit(ray, axis, [&](const Hit& h) {
        bool nearer = best.patch < 0 || h.t < best.t;
        if (h.t == best.t)
            nearer = nearer || h.patch < best.patch || (h.patch == best.patch && h.triangle < best.triangle);
        if (nearer)
            best = h;
    });
    return best;
}

int Oracle::crossings(const Ray& ray) const {
    int n = 0;
    each_hit(ray, largest_component(ray.direction), [&](const Hit&) { ++n; });
    return n;
}

bool Oracle::inside(const Point& p) const {
    constexpr Point directions[3] = {
        {0.6831F, 0.2971F, 0.6671F}, {-0.3117F, 0.8837F, -0.3491F}, {0.1973F, -0.4127F, 0.8893F}};
    for (const Point& d : directions)
        if (crossings({p, d}) % 2 == 0)
            return false;
    return true;
}

} // namespace razor::test
