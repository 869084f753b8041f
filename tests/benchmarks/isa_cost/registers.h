// Short names for a target's intrinsics, which the hand-written kernels share.
#pragma once

#if defined(ISA_TARGET_SSE4)
#include <nmmintrin.h>
#else
#include <immintrin.h>
#endif

namespace isa_cost::ISA_TARGET {

#if defined(ISA_TARGET_SSE4)
inline constexpr int lanes = 4, registers = ISA_WIDTH / lanes;
using F = __m128;
using M = __m128;
inline F load(const float* p) { return _mm_loadu_ps(p); }
inline F broadcast(float x) { return _mm_set1_ps(x); }
inline F add(F a, F b) { return _mm_add_ps(a, b); }
inline F sub(F a, F b) { return _mm_sub_ps(a, b); }
inline F mul(F a, F b) { return _mm_mul_ps(a, b); }
inline F div(F a, F b) { return _mm_div_ps(a, b); }
inline F fma(F a, F b, F c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
inline F fms(F a, F b, F c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
inline M lt(F a, F b) { return _mm_cmplt_ps(a, b); }
inline M le(F a, F b) { return _mm_cmple_ps(a, b); }
inline M both(M a, M b) { return _mm_and_ps(a, b); }
inline bool any(const M* m) {
    M x = m[0];
#pragma GCC unroll 8
    for (int i = 1; i < registers; ++i)
        x = _mm_or_ps(x, m[i]);
    return _mm_movemask_ps(x) != 0;
}
inline void replace(float* p, M m, F a, F old) { _mm_storeu_ps(p, _mm_blendv_ps(old, a, m)); }
inline void store(float* p, M m, F a) {
    alignas(16) float from[4];
    _mm_store_ps(from, a);
    for (unsigned b = static_cast<unsigned>(_mm_movemask_ps(m)); b != 0; b &= b - 1)
        p[__builtin_ctz(b)] = from[__builtin_ctz(b)];
}
#elif defined(ISA_TARGET_AVX2)
inline constexpr int lanes = 8, registers = ISA_WIDTH / lanes;
using F = __m256;
using M = __m256;
inline F load(const float* p) { return _mm256_loadu_ps(p); }
inline F broadcast(float x) { return _mm256_set1_ps(x); }
inline F add(F a, F b) { return _mm256_add_ps(a, b); }
inline F sub(F a, F b) { return _mm256_sub_ps(a, b); }
inline F mul(F a, F b) { return _mm256_mul_ps(a, b); }
inline F div(F a, F b) { return _mm256_div_ps(a, b); }
inline F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
inline F fms(F a, F b, F c) { return _mm256_fmsub_ps(a, b, c); }
inline M lt(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline M le(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
inline M both(M a, M b) { return _mm256_and_ps(a, b); }
inline bool any(const M* m) {
    M x = m[0];
#pragma GCC unroll 4
    for (int i = 1; i < registers; ++i)
        x = _mm256_or_ps(x, m[i]);
    return _mm256_movemask_ps(x) != 0;
}
inline void replace(float* p, M m, F a, F old) { _mm256_storeu_ps(p, _mm256_blendv_ps(old, a, m)); }
inline void store(float* p, M m, F a) { _mm256_maskstore_ps(p, _mm256_castps_si256(m), a); }
#else
inline constexpr int lanes = 16, registers = ISA_WIDTH / lanes;
using F = __m512;
using M = __mmask16;
inline F load(const float* p) { return _mm512_loadu_ps(p); }
inline F broadcast(float x) { return _mm512_set1_ps(x); }
inline F add(F a, F b) { return _mm512_add_ps(a, b); }
inline F sub(F a, F b) { return _mm512_sub_ps(a, b); }
inline F mul(F a, F b) { return _mm512_mul_ps(a, b); }
inline F div(F a, F b) { return _mm512_div_ps(a, b); }
inline F fma(F a, F b, F c) { return _mm512_fmadd_ps(a, b, c); }
inline F fms(F a, F b, F c) { return _mm512_fmsub_ps(a, b, c); }
inline M lt(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline M le(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
inline M both(M a, M b) { return _kand_mask16(a, b); }
inline bool any(const M* m) { return _kortestz_mask16_u8(m[0], m[registers - 1]) == 0; }
inline void replace(float* p, M m, F a, F old) { _mm512_storeu_ps(p, _mm512_mask_blend_ps(m, old, a)); }
inline void store(float* p, M m, F a) { _mm512_mask_storeu_ps(p, m, a); }
#endif

} // namespace isa_cost::ISA_TARGET
