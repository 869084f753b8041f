// Registers of the avx2 target (AVX2, FMA3, BMI2): 8 lanes. A mask is a vector of all-ones and all-zero
// lanes. Same sections and functions as registers_plain.h, whose comments say what each does.
#pragma once

#include "isa/native/fold_256.h"
#include "isa/native/unroll.h"
#include "isa/target.h"

#include <cstdint>
#include <immintrin.h>

namespace ISA_NATIVE::reg {

// --- types
inline constexpr int lanes = 8;
using F = __m256;
using I = __m256i;
using M = __m256;

inline F broadcast(float x) { return _mm256_set1_ps(x); }
inline I broadcast(std::int32_t x) { return _mm256_set1_epi32(x); }
inline I iota() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }

// --- float arithmetic
inline F add(F a, F b) { return _mm256_add_ps(a, b); }
inline F sub(F a, F b) { return _mm256_sub_ps(a, b); }
inline F mul(F a, F b) { return _mm256_mul_ps(a, b); }
inline F div(F a, F b) { return _mm256_div_ps(a, b); }
inline F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
inline F fms(F a, F b, F c) { return _mm256_fmsub_ps(a, b, c); }
inline F fnma(F a, F b, F c) { return _mm256_fnmadd_ps(a, b, c); }
inline F product_error(F a, F b, F p) { return _mm256_fmsub_ps(a, b, p); }
inline F min(F a, F b) { return _mm256_min_ps(a, b); }
inline F max(F a, F b) { return _mm256_max_ps(a, b); }
inline F sqrt(F a) { return _mm256_sqrt_ps(a); }
inline F floor(F a) { return _mm256_floor_ps(a); }
inline F round_even(F a) { return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }

// --- float comparison
inline M lt(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
inline M le(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
inline M eq(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
inline M ne(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_NEQ_UQ); }
inline F select(M m, F a, F b) { return _mm256_blendv_ps(b, a, m); }

// --- integers (32-bit, wrapping)
inline I add(I a, I b) { return _mm256_add_epi32(a, b); }
inline I sub(I a, I b) { return _mm256_sub_epi32(a, b); }
inline I mul(I a, I b) { return _mm256_mullo_epi32(a, b); }
inline I bit_and(I a, I b) { return _mm256_and_si256(a, b); }
inline I bit_or(I a, I b) { return _mm256_or_si256(a, b); }
inline I bit_xor(I a, I b) { return _mm256_xor_si256(a, b); }
inline I modulo_32(I n) { return _mm256_and_si256(n, _mm256_set1_epi32(31)); }
inline I shift_left(I a, I n) { return _mm256_sllv_epi32(a, modulo_32(n)); }
inline I shift_right(I a, I n) { return _mm256_srav_epi32(a, modulo_32(n)); }
inline I shift_right_logical(I a, I n) { return _mm256_srlv_epi32(a, modulo_32(n)); }
inline I shift_left(I a, int n) { return _mm256_slli_epi32(a, n); }
inline I shift_right(I a, int n) { return _mm256_srai_epi32(a, n); }
inline I shift_right_logical(I a, int n) { return _mm256_srli_epi32(a, n); }
inline I min(I a, I b) { return _mm256_min_epi32(a, b); }
inline I max(I a, I b) { return _mm256_max_epi32(a, b); }
inline M lt(I a, I b) { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a)); }
inline M eq(I a, I b) { return _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)); }
inline I select(M m, I a, I b) {
    return _mm256_castps_si256(_mm256_blendv_ps(_mm256_castsi256_ps(b), _mm256_castsi256_ps(a), m));
}

// --- masks
inline M mask_and(M a, M b) {
    M m = _mm256_and_ps(a, b);
#if defined(__clang__)
    asm("" : "+x"(m)); // clang would pack comparisons to 16 bits and back to join them anew in each block
#endif
    return m;
}
inline M mask_or(M a, M b) { return _mm256_or_ps(a, b); }
inline M mask_xor(M a, M b) { return _mm256_xor_ps(a, b); }
inline M mask_not(M a) { return _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))); }
inline M le(I a, I b) { return mask_not(lt(b, a)); }
inline M ne(I a, I b) { return mask_not(eq(a, b)); }
inline std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm256_movemask_ps(m)); }
inline M from_bits(std::uint32_t b) {
    I lane_bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return eq(bit_and(broadcast(static_cast<std::int32_t>(b)), lane_bit), lane_bit);
}

// --- conversion
inline I to_int(F a) { return _mm256_cvttps_epi32(a); }
inline F to_float(I a) { return _mm256_cvtepi32_ps(a); }
inline I as_int(F a) { return _mm256_castps_si256(a); }
inline F as_float(I a) { return _mm256_castsi256_ps(a); }

// --- memory
inline F load(const float* p) { return _mm256_loadu_ps(p); }
inline I load(const std::int32_t* p) { return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)); }
inline F load(const float* p, M m) { return _mm256_maskload_ps(p, as_int(m)); }
inline I load(const std::int32_t* p, M m) { return _mm256_maskload_epi32(p, as_int(m)); }
inline void store(float* p, F a) { _mm256_storeu_ps(p, a); }
inline void store(std::int32_t* p, I a) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a); }
inline void store(float* p, F a, M m) { _mm256_maskstore_ps(p, as_int(m), a); }
inline void store(std::int32_t* p, I a, M m) { _mm256_maskstore_epi32(p, as_int(m), a); }
// A gather takes as long without any lane: short lists leave most registers of a vector idle.
inline F gather(const float* p, I index, M m) {
    if (bits(m) == 0)
        return _mm256_setzero_ps();
    return _mm256_mask_i32gather_ps(_mm256_setzero_ps(), p, index, m, 4);
}
inline I gather(const std::int32_t* p, I index, M m) {
    if (bits(m) == 0)
        return _mm256_setzero_si256();
    return _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), p, index, as_int(m), 4);
}
template <class T, class R> inline void scatter_lanes(T* p, I index, R a, M m) {
    alignas(32) std::int32_t to[lanes];
    alignas(32) T from[lanes];
    store(to, index);
    store(from, a);
    for (std::uint32_t b = bits(m); b != 0; b &= b - 1) {
        int i = __builtin_ctz(b);
        p[to[i]] = from[i];
    }
}
inline void scatter(float* p, I index, F a, M m) { scatter_lanes(p, index, a, m); }
inline void scatter(std::int32_t* p, I index, I a, M m) { scatter_lanes(p, index, a, m); }

// --- within one register
inline float reduce_add(F a) { return fold_256(a, fold_add()); }
inline float reduce_min(F a) { return fold_256(a, fold_min()); }
inline float reduce_max(F a) { return fold_256(a, fold_max()); }
inline std::int32_t reduce_add(I a) { return fold_256(a, fold_add()); }
inline std::int32_t reduce_min(I a) { return fold_256(a, fold_min()); }
inline std::int32_t reduce_max(I a) { return fold_256(a, fold_max()); }

} // namespace ISA_NATIVE::reg

#include "isa/native/through_memory.h"

namespace ISA_NATIVE::reg {

// --- across registers
template <int n> inline bool any(const M (&m)[n]) {
    M x = m[0];
    unroll<n - 1>([&](int i) { x = mask_or(x, m[i + 1]); });
    return _mm256_movemask_ps(x) != 0;
}
template <int n> inline bool all(const M (&m)[n]) {
    M x = m[0];
    unroll<n - 1>([&](int i) { x = mask_and(x, m[i + 1]); });
    return _mm256_movemask_ps(x) == 0xff;
}
inline F permute_1(F a, I index) { return _mm256_permutevar8x32_ps(a, index); }
inline I permute_1(I a, I index) { return _mm256_permutevar8x32_epi32(a, index); }
template <class R, int n> inline R permute_n(const R* a, I index) { // index modulo n * lanes
    if constexpr (n == 1)
        return permute_1(a[0], index);
    else // the sign of the shifted index says which half
        return select(as_float(shift_left(index, n == 2 ? 28 : 27)), permute_n<R, n / 2>(a + n / 2, index),
                      permute_n<R, n / 2>(a, index));
}
template <class R, int n> inline void permute(R (&to)[n], const R (&a)[n], const I (&index)[n]) {
    if constexpr (n <= 4)
        unroll<n>([&](int i) { to[i] = permute_n<R, n>(a, index[i]); });
    else
        through_memory::permute(to, a, index);
}
template <class R> inline R compress_1(R a, M m) { // the numbers of the set lanes, packed byte by byte
    std::uint64_t set = _pdep_u64(bits(m), 0x0101010101010101U) * 0xff;
    std::uint64_t from = _pext_u64(0x0706050403020100U, set);
    return permute_1(a, _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(from))));
}
template <class R, int n> inline void compress(R (&to)[n], const R (&a)[n], const M (&m)[n]) {
    through_memory::compress(to, a, m, [](R x, M k) { return compress_1(x, k); });
}
template <class R, int n> inline auto extract(const R (&a)[n], int lane) { return through_memory::extract(a, lane); }

} // namespace ISA_NATIVE::reg
