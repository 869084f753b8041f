// Three numbers, scalar or one a lane.
#pragma once

#include "razor/kernels/context.h"

namespace razor::ISA_TARGET {

struct vvec {
    vfloat x, y, z;
};
struct svec {
    sfloat x, y, z;
};

inline vvec operator+(const vvec& a, const vvec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline vvec operator-(const vvec& a, const vvec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vvec operator*(const vvec& a, const vfloat& s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline vfloat dot(const vvec& a, const vvec& b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
inline vvec cross(const vvec& a, const vvec& b) {
    return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
/// a + s * b. Always inline: else a `b` that is the same in all lanes is written out lane by lane for each
/// call.
[[gnu::always_inline]] inline vvec madd(const vfloat& s, const vvec& b, const vvec& a) {
    return {fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z)};
}
inline vvec select(const vmask& m, const vvec& a, const vvec& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
inline vvec permute(const vvec& a, const vint& index) {
    return {permute(a.x, index), permute(a.y, index), permute(a.z, index)};
}
/// Unit length, or `fallback` where the length is zero or not finite.
inline vvec normalise(const vvec& a, const vvec& fallback) {
    vfloat square = dot(a, a);
    vmask good = square > 0.0F;
    good = good & (square < 3.0e38F);
    vvec unit = a * reciprocal_sqrt(select(good, square, vfloat(1.0F)));
    return select(good, unit, fallback);
}

inline vvec abs(const vvec& a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}
inline vfloat largest(const vvec& a) {
    return max(a.x, max(a.y, a.z));
}
/// Along axis 0, 1 or 2.
inline sfloat component(const svec& a, sint axis) {
    sfloat of = select(axis == 1, a.y, a.z);
    return select(axis == 0, a.x, of);
}
inline sfloat largest(const svec& a) {
    return max(a.x, max(a.y, a.z));
}

inline svec operator+(const svec& a, const svec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline svec operator-(const svec& a, const svec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline svec operator*(const svec& a, sfloat s) {
    return {a.x * s, a.y * s, a.z * s};
}

inline sfloat dot(const svec& a, const svec& b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

inline svec load_svec(pointer<const float> p) {
    svec v;
    v.x = load(p);
    v.y = load(p + 1);
    v.z = load(p + 2);
    return v;
}
inline void store_svec(pointer<float> to, const svec& p) {
    store(to, p.x);
    store(to + 1, p.y);
    store(to + 2, p.z);
}
inline vvec load_broadcast_vec(pointer<const float> p) {
    vvec v;
    v.x = load_broadcast(p);
    v.y = load_broadcast(p + 1);
    v.z = load_broadcast(p + 2);
    return v;
}
inline vvec broadcast(const svec& a) {
    vvec v;
    v.x = vfloat(a.x);
    v.y = vfloat(a.y);
    v.z = vfloat(a.z);
    return v;
}

} // namespace razor::ISA_TARGET
