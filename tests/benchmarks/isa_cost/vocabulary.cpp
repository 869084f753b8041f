#include "packet.h"

#include "isa/isa.h"

namespace isa_cost::ISA_TARGET {

using namespace isa::ISA_TARGET;

namespace {

struct vec {
    vfloat x, y, z;
};
inline vec load_rays(pointer<const float> p, sint at) {
    vfloat x = load_vector(p + at);
    vfloat y = load_vector(p + 32 + at);
    vfloat z = load_vector(p + 64 + at);
    return {x, y, z};
}
inline vec load_corner(pointer<const float> p) {
    vfloat x = load_broadcast(p);
    vfloat y = load_broadcast(p + 1);
    vfloat z = load_broadcast(p + 2);
    return {x, y, z};
}
inline vfloat dot(const vec& a, const vec& b) {
    vfloat d = a.z * b.z;
    d = fma(a.y, b.y, d);
    return fma(a.x, b.x, d);
}
inline vec cross(const vec& a, const vec& b) {
    vfloat x = a.z * b.y;
    vfloat y = a.x * b.z;
    vfloat z = a.y * b.x;
    return {fms(a.y, b.z, x), fms(a.z, b.x, y), fms(a.x, b.y, z)};
}

} // namespace

bool vocabulary(const triangle& tri, rays& r, int at);
bool vocabulary(const triangle& tri, rays& r, int at) {
    vec direction = load_rays(pointer<const float>(r.direction[0]), at);
    vec e2 = load_corner(pointer<const float>(tri.edge[1]));
    vec p = cross(direction, e2);
    vec e1 = load_corner(pointer<const float>(tri.edge[0]));
    vfloat determinant = dot(e1, p);
    vfloat inverse = reciprocal(determinant);
    vec s = load_rays(pointer<const float>(r.origin[0]), at);
    vec corner = load_corner(pointer<const float>(tri.corner));
    s = {s.x - corner.x, s.y - corner.y, s.z - corner.z};
    vfloat u = dot(s, p);
    u = u * inverse;
    vec q = cross(s, e1);
    vfloat v = dot(direction, q);
    v = v * inverse;
    vfloat t = dot(e2, q);
    t = t * inverse;
    vfloat far_t = load_vector(pointer<const float>(r.far_t + at));
    vmask hit = u >= vfloat(0.0F);
    hit = hit & (v >= vfloat(0.0F));
    hit = hit & (u + v <= vfloat(1.0F));
    hit = hit & (t > vfloat(0.0F));
    hit = hit & (t < far_t);
    if (!branch(any(hit)))
        return false;
    store_vector(pointer<float>(r.far_t + at), select(hit, t, far_t));
    store_vector(pointer<float>(r.u + at), u, hit);
    store_vector(pointer<float>(r.v + at), v, hit);
    return true;
}

} // namespace isa_cost::ISA_TARGET
