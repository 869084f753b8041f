#include "tests/kernels/oracle.h"

#include <cmath>
#include <cstdint>

namespace razor::test {

namespace {

/// A ray's own frame: z along its largest component.
struct Sheared {
    std::size_t kx, ky, kz;
    float shear_x, shear_y, scale_z;
    Point origin; // permuted, scene coordinates

    explicit Sheared(const Ray& r) {
        const Point& d = r.direction;
        kz = 0;
        if (std::abs(d[1]) > std::abs(d[0]))
            kz = 1;
        if (std::abs(d[2]) > std::abs(d[kz]))
            kz = 2;
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

Oracle::Oracle(Frame& frame, bool fused)
    : triangles_(triangles_of(frame)), origins_(mesh_origins(frame)), fused_(fused) {}

template <class Visit> void Oracle::each_hit(const Ray& ray, Visit visit) const {
    if (!usable(ray))
        return;
    Sheared s(ray);
    Arithmetic with{fused_};
    for (const Triangle& t : triangles_) {
        const Point& m = origins_[static_cast<std::size_t>(t.mesh)];
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
        for (std::size_t k = 0; k < 3; ++k) {
            const FlatEdge& e = t.edge[(k + 1) % 3];
            if (e.hang == 0) {
                f[k] = edge_function(p[(k + 1) % 3], p[(k + 2) % 3]);
            } else {
                f[k] = edge_function(project(e.from), project(e.to)) * std::ldexp(1.0F, -e.hang);
            }
        }
        bool positive = f[0] >= 0 && f[1] >= 0 && f[2] >= 0;
        bool negative = f[0] <= 0 && f[1] <= 0 && f[2] <= 0;
        if (!positive && !negative)
            continue;
        float determinant = f[0] + f[1] + f[2];
        if (determinant == 0)
            continue;
        float inverse = 1.0F / determinant;
        float depth = with.multiply_add(f[0], p[0].z, with.multiply_add(f[1], p[1].z, f[2] * p[2].z));
        float distance = depth * s.scale_z * inverse;
        if (distance >= ray.t_min && distance <= ray.t_max)
            visit(Hit{t.patch, t.number, distance, f[1] * inverse, f[2] * inverse});
    }
}

Hit Oracle::closest(const Ray& ray) const {
    Hit best;
    each_hit(ray, [&](const Hit& h) {
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
    each_hit(ray, [&](const Hit&) { ++n; });
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
