// Registers of the avx512 target (F, DQ, BW, VL): 16 lanes, or 8 where the logical width is 8. A mask is a
// mask register. Same sections and functions as registers_plain.h, whose comments say what each does.
#pragma once

#include "isa/native/fold_256.h"
#include "isa/native/unroll.h"
#include "isa/target.h"

#include <cstdint>
#include <immintrin.h>

// Intrinsics of both register sizes differ in their prefix only.
#if ISA_WIDTH == 8
#define ISA_MM(name) _mm256_##name
#define ISA_K(name) name##_mask8
#define ISA_K_U8(name) name##_mask8_u8
#else
#define ISA_MM(name) _mm512_##name
#define ISA_K(name) name##_mask16
#define ISA_K_U8(name) name##_mask16_u8
#endif

namespace ISA_NATIVE::reg {

// --- types
#if ISA_WIDTH == 8
inline constexpr int lanes = 8;
using F = __m256;
using I = __m256i;
using M = __mmask8;
using signed_lanes = __v8si;
using unsigned_lanes = __v8su;
#else
inline constexpr int lanes = 16;
using F = __m512;
using I = __m512i;
using M = __mmask16;
using signed_lanes = __v16si;
using unsigned_lanes = __v16su;
#endif
inline constexpr M every_lane = static_cast<M>(~0U);

inline F broadcast(float x) { return ISA_MM(set1_ps)(x); }
inline I broadcast(std::int32_t x) { return ISA_MM(set1_epi32)(x); }
inline I iota() {
#if ISA_WIDTH == 8
    return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
#else
    return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

// --- float arithmetic
inline F add(F a, F b) { return ISA_MM(add_ps)(a, b); }
inline F sub(F a, F b) { return ISA_MM(sub_ps)(a, b); }
inline F mul(F a, F b) { return ISA_MM(mul_ps)(a, b); }
inline F div(F a, F b) { return ISA_MM(div_ps)(a, b); }
inline F fma(F a, F b, F c) { return ISA_MM(fmadd_ps)(a, b, c); }
inline F fms(F a, F b, F c) { return ISA_MM(fmsub_ps)(a, b, c); }
inline F fnma(F a, F b, F c) { return ISA_MM(fnmadd_ps)(a, b, c); }
inline F product_error(F a, F b, F p) { return ISA_MM(fmsub_ps)(a, b, p); }
inline F min(F a, F b) { return ISA_MM(maskz_min_ps)(every_lane, a, b); }
inline F max(F a, F b) { return ISA_MM(maskz_max_ps)(every_lane, a, b); }
inline F sqrt(F a) { return ISA_MM(maskz_sqrt_ps)(every_lane, a); }
inline F floor(F a) { return ISA_MM(maskz_roundscale_ps)(every_lane, a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
inline F round_even(F a) {
    return ISA_MM(maskz_roundscale_ps)(every_lane, a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}

// --- float comparison
inline M lt(F a, F b) { return ISA_MM(cmp_ps_mask)(a, b, _CMP_LT_OQ); }
inline M le(F a, F b) { return ISA_MM(cmp_ps_mask)(a, b, _CMP_LE_OQ); }
inline M eq(F a, F b) { return ISA_MM(cmp_ps_mask)(a, b, _CMP_EQ_OQ); }
inline M ne(F a, F b) { return ISA_MM(cmp_ps_mask)(a, b, _CMP_NEQ_UQ); }
inline F select(M m, F a, F b) { return ISA_MM(mask_blend_ps)(m, b, a); }

// --- integers (32-bit, wrapping)
inline I add(I a, I b) { return ISA_MM(add_epi32)(a, b); }
inline I sub(I a, I b) { return ISA_MM(sub_epi32)(a, b); }
inline I mul(I a, I b) { return ISA_MM(mullo_epi32)(a, b); }
#if ISA_WIDTH == 8
inline I bit_and(I a, I b) { return _mm256_and_si256(a, b); }
inline I bit_or(I a, I b) { return _mm256_or_si256(a, b); }
inline I bit_xor(I a, I b) { return _mm256_xor_si256(a, b); }
#else
inline I bit_and(I a, I b) { return _mm512_and_si512(a, b); }
inline I bit_or(I a, I b) { return _mm512_or_si512(a, b); }
inline I bit_xor(I a, I b) { return _mm512_xor_si512(a, b); }
#endif
inline I modulo_32(I n) { return bit_and(n, broadcast(31)); }
inline I shift_left(I a, I n) { return ISA_MM(maskz_sllv_epi32)(every_lane, a, modulo_32(n)); }
inline I shift_right(I a, I n) { return ISA_MM(maskz_srav_epi32)(every_lane, a, modulo_32(n)); }
inline I shift_right_logical(I a, I n) { return ISA_MM(maskz_srlv_epi32)(every_lane, a, modulo_32(n)); }
// By operators of the compilers: the intrinsics want a literal even where nothing is inlined.
inline I shift_left(I a, int n) { return reinterpret_cast<I>(reinterpret_cast<signed_lanes>(a) << n); }
inline I shift_right(I a, int n) { return reinterpret_cast<I>(reinterpret_cast<signed_lanes>(a) >> n); }
inline I shift_right_logical(I a, int n) {
    return reinterpret_cast<I>(reinterpret_cast<unsigned_lanes>(a) >> static_cast<unsigned>(n));
}
inline I min(I a, I b) { return ISA_MM(maskz_min_epi32)(every_lane, a, b); }
inline I max(I a, I b) { return ISA_MM(maskz_max_epi32)(every_lane, a, b); }
inline M lt(I a, I b) { return ISA_MM(cmplt_epi32_mask)(a, b); }
inline M le(I a, I b) { return ISA_MM(cmple_epi32_mask)(a, b); }
inline M eq(I a, I b) { return ISA_MM(cmpeq_epi32_mask)(a, b); }
inline M ne(I a, I b) { return ISA_MM(cmpneq_epi32_mask)(a, b); }
inline I select(M m, I a, I b) { return ISA_MM(mask_blend_epi32)(m, b, a); }

// --- masks
inline M mask_and(M a, M b) { return ISA_K(_kand)(a, b); }
inline M mask_or(M a, M b) { return ISA_K(_kor)(a, b); }
inline M mask_xor(M a, M b) { return ISA_K(_kxor)(a, b); }
inline M mask_not(M a) { return ISA_K(_knot)(a); }
inline std::uint32_t bits(M m) { return m; }
inline M from_bits(std::uint32_t b) { return static_cast<M>(b); }

// --- conversion
inline I to_int(F a) { return ISA_MM(maskz_cvttps_epi32)(every_lane, a); }
inline F to_float(I a) { return ISA_MM(maskz_cvtepi32_ps)(every_lane, a); }
#if ISA_WIDTH == 8
inline I as_int(F a) { return _mm256_castps_si256(a); }
inline F as_float(I a) { return _mm256_castsi256_ps(a); }
#else
inline I as_int(F a) { return _mm512_castps_si512(a); }
inline F as_float(I a) { return _mm512_castsi512_ps(a); }
#endif

// --- memory
inline F load(const float* p) { return ISA_MM(loadu_ps)(p); }
inline I load(const std::int32_t* p) { return ISA_MM(loadu_epi32)(p); }
inline F load(const float* p, M m) { return ISA_MM(maskz_loadu_ps)(m, p); }
inline I load(const std::int32_t* p, M m) { return ISA_MM(maskz_loadu_epi32)(m, p); }
inline void store(float* p, F a) { ISA_MM(storeu_ps)(p, a); }
inline void store(std::int32_t* p, I a) { ISA_MM(storeu_epi32)(p, a); }
inline void store(float* p, F a, M m) { ISA_MM(mask_storeu_ps)(p, m, a); }
inline void store(std::int32_t* p, I a, M m) { ISA_MM(mask_storeu_epi32)(p, m, a); }
// A gather takes as long without any lane: short lists leave most registers of a vector idle.
#if ISA_WIDTH == 8
inline F gather(const float* p, I index, M m) {
    return m == 0 ? broadcast(0.0F) : _mm256_mmask_i32gather_ps(broadcast(0.0F), m, index, p, 4);
}
inline I gather(const std::int32_t* p, I index, M m) {
    if (m == 0)
        return broadcast(0);
    return _mm256_mmask_i32gather_epi32(broadcast(0), m, index, p, 4);
}
#else
inline F gather(const float* p, I index, M m) {
    return m == 0 ? broadcast(0.0F) : _mm512_mask_i32gather_ps(broadcast(0.0F), m, index, p, 4);
}
inline I gather(const std::int32_t* p, I index, M m) {
    if (m == 0)
        return broadcast(0);
    return _mm512_mask_i32gather_epi32(broadcast(0), m, index, p, 4);
}
#endif
inline void scatter(float* p, I index, F a, M m) { ISA_MM(mask_i32scatter_ps)(p, m, index, a, 4); }
inline void scatter(std::int32_t* p, I index, I a, M m) { ISA_MM(mask_i32scatter_epi32)(p, m, index, a, 4); }

// --- within one register
#if ISA_WIDTH == 8
template <class Op> inline auto fold(F a, Op op) { return fold_256(a, op); }
template <class Op> inline auto fold(I a, Op op) { return fold_256(a, op); }
#else
template <class Op> inline auto fold(F a, Op op) {
    return fold_256(op(_mm512_maskz_extractf32x8_ps(0xff, a, 0), _mm512_maskz_extractf32x8_ps(0xff, a, 1)), op);
}
template <class Op> inline auto fold(I a, Op op) {
    return fold_256(op(_mm512_maskz_extracti32x8_epi32(0xff, a, 0), _mm512_maskz_extracti32x8_epi32(0xff, a, 1)), op);
}
#endif
inline float reduce_add(F a) { return fold(a, fold_add()); }
inline float reduce_min(F a) { return fold(a, fold_min()); }
inline float reduce_max(F a) { return fold(a, fold_max()); }
inline std::int32_t reduce_add(I a) { return fold(a, fold_add()); }
inline std::int32_t reduce_min(I a) { return fold(a, fold_min()); }
inline std::int32_t reduce_max(I a) { return fold(a, fold_max()); }

} // namespace ISA_NATIVE::reg

#include "isa/native/through_memory.h"

namespace ISA_NATIVE::reg {

// --- across registers
template <int n> inline bool any(const M (&m)[n]) {
    if constexpr (n == 1)
        return ISA_K_U8(_kortestz)(m[0], m[0]) == 0;
    else if constexpr (n == 2)
        return ISA_K_U8(_kortestz)(m[0], m[1]) == 0;
    else
        return ISA_K_U8(_kortestz)(mask_or(m[0], m[1]), mask_or(m[2], m[3])) == 0;
}
template <int n> inline bool all(const M (&m)[n]) {
    M x = m[0];
    unroll<n - 1>([&](int i) { x = mask_and(x, m[i + 1]); });
    return ISA_K_U8(_kortestc)(x, x) != 0;
}
inline F permute_1(F a, I index) { return ISA_MM(maskz_permutexvar_ps)(every_lane, index, a); }
inline I permute_1(I a, I index) { return ISA_MM(maskz_permutexvar_epi32)(every_lane, index, a); }
inline F permute_2(F a, F b, I index) { return ISA_MM(permutex2var_ps)(a, index, b); }
inline I permute_2(I a, I b, I index) { return ISA_MM(permutex2var_epi32)(a, index, b); }
template <class R, int n> inline void permute(R (&to)[n], const R (&a)[n], const I (&index)[n]) {
    unroll<n>([&](int i) {
        if constexpr (n == 1)
            to[i] = permute_1(a[0], index[i]);
        else if constexpr (n == 2)
            to[i] = permute_2(a[0], a[1], index[i]);
        else
            to[i] = select(ISA_MM(test_epi32_mask)(index[i], broadcast(2 * lanes)), permute_2(a[2], a[3], index[i]),
                           permute_2(a[0], a[1], index[i]));
    });
}
inline F keep(M m, F a) { return ISA_MM(maskz_mov_ps)(m, a); }
inline I keep(M m, I a) { return ISA_MM(maskz_mov_epi32)(m, a); }
inline F compress_1(F a, M m) { return ISA_MM(maskz_compress_ps)(m, a); }
inline I compress_1(I a, M m) { return ISA_MM(maskz_compress_epi32)(m, a); }
template <class R, int n> inline void compress(R (&to)[n], const R (&a)[n], const M (&m)[n]) {
    if constexpr (n == 1) {
        to[0] = compress_1(a[0], m[0]);
    } else if constexpr (n == 2) { // the second part, rotated to where the first ends, fills its end and the rest
        I count = broadcast(static_cast<std::int32_t>(_mm_popcnt_u32(m[0])));
        M first = lt(iota(), count);
        R rotated = permute_1(compress_1(a[1], m[1]), sub(iota(), count));
        to[0] = select(first, compress_1(a[0], m[0]), rotated);
        to[1] = keep(first, rotated);
    } else {
        through_memory::compress(to, a, m, [](R x, M k) { return compress_1(x, k); });
    }
}
template <class R, int n> inline auto extract(const R (&a)[n], int lane) { return through_memory::extract(a, lane); }

} // namespace ISA_NATIVE::reg
#undef ISA_MM
#undef ISA_K
#undef ISA_K_U8
