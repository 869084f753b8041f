// The same kernel in intrinsics: every register's chain on its own, then what depends on all of them.
#include "packet.h"

#if defined(ISA_TARGET_SSE4)
#include <nmmintrin.h>
#else
#include <immintrin.h>
#endif

namespace isa_cost::ISA_TARGET {

namespace {

#if defined(ISA_TARGET_SSE4)
constexpr int lanes = 4, registers = ISA_WIDTH / lanes;
using F = __m128;
using M = __m128;
F load(const float* p) { return _mm_loadu_ps(p); }
F broadcast(float x) { return _mm_set1_ps(x); }
F add(F a, F b) { return _mm_add_ps(a, b); }
F sub(F a, F b) { return _mm_sub_ps(a, b); }
F mul(F a, F b) { return _mm_mul_ps(a, b); }
F div(F a, F b) { return _mm_div_ps(a, b); }
F fma(F a, F b, F c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
F fms(F a, F b, F c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
M lt(F a, F b) { return _mm_cmplt_ps(a, b); }
M le(F a, F b) { return _mm_cmple_ps(a, b); }
M both(M a, M b) { return _mm_and_ps(a, b); }
bool any(const M* m) {
    M x = m[0];
#pragma GCC unroll 8
    for (int i = 1; i < registers; ++i)
        x = _mm_or_ps(x, m[i]);
    return _mm_movemask_ps(x) != 0;
}
void replace(float* p, M m, F a, F old) { _mm_storeu_ps(p, _mm_blendv_ps(old, a, m)); }
void store(float* p, M m, F a) {
    alignas(16) float from[4];
    _mm_store_ps(from, a);
    for (unsigned b = static_cast<unsigned>(_mm_movemask_ps(m)); b != 0; b &= b - 1)
        p[__builtin_ctz(b)] = from[__builtin_ctz(b)];
}
#elif defined(ISA_TARGET_AVX2)
constexpr int lanes = 8, registers = ISA_WIDTH / lanes;
using F = __m256;
using M = __m256;
F load(const float* p) { return _mm256_loadu_ps(p); }
F broadcast(float x) { return _mm256_set1_ps(x); }
F add(F a, F b) { return _mm256_add_ps(a, b); }
F sub(F a, F b) { return _mm256_sub_ps(a, b); }
F mul(F a, F b) { return _mm256_mul_ps(a, b); }
F div(F a, F b) { return _mm256_div_ps(a, b); }
F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
F fms(F a, F b, F c) { return _mm256_fmsub_ps(a, b, c); }
M lt(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
M le(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
M both(M a, M b) { return _mm256_and_ps(a, b); }
bool any(const M* m) {
    M x = m[0];
#pragma GCC unroll 4
    for (int i = 1; i < registers; ++i)
        x = _mm256_or_ps(x, m[i]);
    return _mm256_movemask_ps(x) != 0;
}
void replace(float* p, M m, F a, F old) { _mm256_storeu_ps(p, _mm256_blendv_ps(old, a, m)); }
void store(float* p, M m, F a) { _mm256_maskstore_ps(p, _mm256_castps_si256(m), a); }
#else
constexpr int lanes = 16, registers = ISA_WIDTH / lanes;
using F = __m512;
using M = __mmask16;
F load(const float* p) { return _mm512_loadu_ps(p); }
F broadcast(float x) { return _mm512_set1_ps(x); }
F add(F a, F b) { return _mm512_add_ps(a, b); }
F sub(F a, F b) { return _mm512_sub_ps(a, b); }
F mul(F a, F b) { return _mm512_mul_ps(a, b); }
F div(F a, F b) { return _mm512_div_ps(a, b); }
F fma(F a, F b, F c) { return _mm512_fmadd_ps(a, b, c); }
F fms(F a, F b, F c) { return _mm512_fmsub_ps(a, b, c); }
M lt(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
M le(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
M both(M a, M b) { return _kand_mask16(a, b); }
bool any(const M* m) { return _kortestz_mask16_u8(m[0], m[registers - 1]) == 0; }
void replace(float* p, M m, F a, F old) { _mm512_storeu_ps(p, _mm512_mask_blend_ps(m, old, a)); }
void store(float* p, M m, F a) { _mm512_mask_storeu_ps(p, m, a); }
#endif

struct vec {
    F x, y, z;
};
vec rays_of(const float (*p)[32], int i) { return {load(p[0] + i), load(p[1] + i), load(p[2] + i)}; }
vec corner_of(const float* p) { return {broadcast(p[0]), broadcast(p[1]), broadcast(p[2])}; }
F dot(const vec& a, const vec& b) { return fma(a.x, b.x, fma(a.y, b.y, mul(a.z, b.z))); }
vec cross(const vec& a, const vec& b) {
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
