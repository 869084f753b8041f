// The same kernel in intrinsics: every register's chain on its own, then what depends on all of them.
#include "packet.h"
#include "registers.h"

namespace isa_cost::ISA_TARGET {

namespace {

struct vec {
    F x, y, z;
};
inline vec rays_of(const float (*p)[32], int i) { return {load(p[0] + i), load(p[1] + i), load(p[2] + i)}; }
inline vec corner_of(const float* p) { return {broadcast(p[0]), broadcast(p[1]), broadcast(p[2])}; }
inline F dot(const vec& a, const vec& b) { return fma(a.x, b.x, fma(a.y, b.y, mul(a.z, b.z))); }
inline vec cross(const vec& a, const vec& b) {
    F x = mul(a.z, b.y), y = mul(a.x, b.z), z = mul(a.y, b.x);
    return {fms(a.y, b.z, x), fms(a.z, b.x, y), fms(a.x, b.y, z)};
}

} // namespace

bool intrinsics(const triangle& tri, rays& r, int at);
bool intrinsics(const triangle& tri, rays& r, int at) {
    F t[registers], u[registers], v[registers], far_t[registers];
    M hit[registers];
#pragma GCC unroll 8
    for (int i = 0; i < registers; ++i) {
        vec direction = rays_of(r.direction, at + i * lanes);
        vec e2 = corner_of(tri.edge[1]);
        vec p = cross(direction, e2);
        vec e1 = corner_of(tri.edge[0]);
        F inverse = div(broadcast(1.0F), dot(e1, p));
        vec s = rays_of(r.origin, at + i * lanes);
        vec corner = corner_of(tri.corner);
        s = {sub(s.x, corner.x), sub(s.y, corner.y), sub(s.z, corner.z)};
        u[i] = mul(dot(s, p), inverse);
        vec q = cross(s, e1);
        v[i] = mul(dot(direction, q), inverse);
        t[i] = mul(dot(e2, q), inverse);
        far_t[i] = load(r.far_t + at + i * lanes);
        F zero = broadcast(0.0F);
        hit[i] = both(le(zero, u[i]), le(zero, v[i]));
        hit[i] = both(hit[i], le(add(u[i], v[i]), broadcast(1.0F)));
        hit[i] = both(hit[i], lt(zero, t[i]));
        hit[i] = both(hit[i], lt(t[i], far_t[i]));
    }
    if (!any(hit))
        return false;
#pragma GCC unroll 8
    for (int i = 0; i < registers; ++i) {
        replace(r.far_t + at + i * lanes, hit[i], t[i], far_t[i]);
        store(r.u + at + i * lanes, hit[i], u[i]);
        store(r.v + at + i * lanes, hit[i], v[i]);
    }
    return true;
}

} // namespace isa_cost::ISA_TARGET
