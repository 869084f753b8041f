// The same kernel in intrinsics, operation by operation over all lanes, as data of the logical width are written by
// hand: what the vocabulary's order of operations costs, without the vocabulary.
#include "packet.h"
#include "registers.h"

#include "isa/native/unroll.h"

namespace isa_cost::ISA_TARGET {

namespace {

using ISA_TARGET::fma, ISA_TARGET::fms, ISA_TARGET::mul, ISA_TARGET::sub; // of one register

struct wide {
    F r[registers];
};
struct wide_mask {
    M r[registers];
};
struct vec {
    wide x, y, z;
};

template <class R = wide, class Op> inline R each(Op op) {
    R a;
    isa::ISA_TARGET::unroll<registers>([&](int i) __attribute__((always_inline)) { a.r[i] = op(i); });
    return a;
}
inline wide load_all(const float* p) {
    return each([&](int i) { return load(p + i * lanes); });
}
inline wide broadcast_all(float x) {
    return each([&](int) { return broadcast(x); });
}
inline wide sub(const wide& a, const wide& b) {
    return each([&](int i) { return sub(a.r[i], b.r[i]); });
}
inline wide mul(const wide& a, const wide& b) {
    return each([&](int i) { return mul(a.r[i], b.r[i]); });
}
inline wide fma(const wide& a, const wide& b, const wide& c) {
    return each([&](int i) { return fma(a.r[i], b.r[i], c.r[i]); });
}
inline wide fms(const wide& a, const wide& b, const wide& c) {
    return each([&](int i) { return fms(a.r[i], b.r[i], c.r[i]); });
}
inline wide_mask and_le(const wide_mask& m, const wide& a, const wide& b) {
    return each<wide_mask>([&](int i) { return both(m.r[i], le(a.r[i], b.r[i])); });
}
inline wide_mask and_lt(const wide_mask& m, const wide& a, const wide& b) {
    return each<wide_mask>([&](int i) { return both(m.r[i], lt(a.r[i], b.r[i])); });
}
inline vec rays_of(const float (*p)[32], int i) { return {load_all(p[0] + i), load_all(p[1] + i), load_all(p[2] + i)}; }
inline vec corner_of(const float* p) { return {broadcast_all(p[0]), broadcast_all(p[1]), broadcast_all(p[2])}; }
inline wide dot(const vec& a, const vec& b) { return fma(a.x, b.x, fma(a.y, b.y, mul(a.z, b.z))); }
inline vec cross(const vec& a, const vec& b) {
    wide x = mul(a.z, b.y), y = mul(a.x, b.z), z = mul(a.y, b.x);
    return {fms(a.y, b.z, x), fms(a.z, b.x, y), fms(a.x, b.y, z)};
}

} // namespace

bool wide_intrinsics(const triangle& tri, rays& r, int at);
bool wide_intrinsics(const triangle& tri, rays& r, int at) {
    vec direction = rays_of(r.direction, at);
    vec e2 = corner_of(tri.edge[1]);
    vec p = cross(direction, e2);
    vec e1 = corner_of(tri.edge[0]);
    wide determinant = dot(e1, p);
    wide inverse = each([&](int i) { return div(broadcast(1.0F), determinant.r[i]); });
    vec s = rays_of(r.origin, at);
    vec corner = corner_of(tri.corner);
    s = {sub(s.x, corner.x), sub(s.y, corner.y), sub(s.z, corner.z)};
    wide u = mul(dot(s, p), inverse);
    vec q = cross(s, e1);
    wide v = mul(dot(direction, q), inverse);
    wide t = mul(dot(e2, q), inverse);
    wide far_t = load_all(r.far_t + at);
    wide zero = broadcast_all(0.0F);
    wide_mask hit = each<wide_mask>([&](int i) { return le(zero.r[i], u.r[i]); });
    hit = and_le(hit, zero, v);
    wide sum = each([&](int i) { return add(u.r[i], v.r[i]); });
    hit = and_le(hit, sum, broadcast_all(1.0F));
    hit = and_lt(hit, zero, t);
    hit = and_lt(hit, t, far_t);
    if (!any(hit.r))
        return false;
    const auto all = [&](auto op) { isa::ISA_TARGET::unroll<registers>(op); };
    all([&](int i) { replace(r.far_t + at + i * lanes, hit.r[i], t.r[i], far_t.r[i]); });
    all([&](int i) { store(r.u + at + i * lanes, hit.r[i], u.r[i]); });
    all([&](int i) { store(r.v + at + i * lanes, hit.r[i], v.r[i]); });
    return true;
}

} // namespace isa_cost::ISA_TARGET
