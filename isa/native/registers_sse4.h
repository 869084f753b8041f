// Registers of the sse4 target (SSE4.2): 4 lanes. A mask is a vector of all-ones and all-zero lanes. There is
// no fused multiply-add here: fma, fms and fnma round twice. Same sections and functions as
// registers_plain.h, whose comments say what each does.
#pragma once

#include "isa/native/unroll.h"
#include "isa/target.h"

#include <cstdint>
#include <nmmintrin.h>

namespace ISA_NATIVE::reg {

// --- types
inline constexpr int lanes = 4;
using F = __m128;
using I = __m128i;
using M = __m128;

inline F broadcast(float x) { return _mm_set1_ps(x); }
inline I broadcast(std::int32_t x) { return _mm_set1_epi32(x); }
inline I iota() { return _mm_setr_epi32(0, 1, 2, 3); }

// --- float arithmetic
inline F add(F a, F b) { return _mm_add_ps(a, b); }
inline F sub(F a, F b) { return _mm_sub_ps(a, b); }
inline F mul(F a, F b) { return _mm_mul_ps(a, b); }
inline F div(F a, F b) { return _mm_div_ps(a, b); }
inline F fma(F a, F b, F c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
inline F fms(F a, F b, F c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
inline F fnma(F a, F b, F c) { return _mm_sub_ps(c, _mm_mul_ps(a, b)); }
inline __m128d product_error_low(F a, F b, F p) { // in double a*b is exact, and so is its distance to p
    return _mm_sub_pd(_mm_mul_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(b)), _mm_cvtps_pd(p));
}
inline F product_error(F a, F b, F p) {
    __m128d low = product_error_low(a, b, p);
    __m128d high = product_error_low(_mm_movehl_ps(a, a), _mm_movehl_ps(b, b), _mm_movehl_ps(p, p));
    return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
inline F min(F a, F b) { return _mm_min_ps(a, b); }
inline F max(F a, F b) { return _mm_max_ps(a, b); }
inline F sqrt(F a) { return _mm_sqrt_ps(a); }
inline F floor(F a) { return _mm_floor_ps(a); }
inline F round_even(F a) { return _mm_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }

// --- float comparison
inline M lt(F a, F b) { return _mm_cmplt_ps(a, b); }
inline M le(F a, F b) { return _mm_cmple_ps(a, b); }
inline M eq(F a, F b) { return _mm_cmpeq_ps(a, b); }
inline M ne(F a, F b) { return _mm_cmpneq_ps(a, b); }
inline F select(M m, F a, F b) { return _mm_blendv_ps(b, a, m); }

// --- integers (32-bit, wrapping)
inline I add(I a, I b) { return _mm_add_epi32(a, b); }
inline I sub(I a, I b) { return _mm_sub_epi32(a, b); }
inline I mul(I a, I b) { return _mm_mullo_epi32(a, b); }
inline I bit_and(I a, I b) { return _mm_and_si128(a, b); }
inline I bit_or(I a, I b) { return _mm_or_si128(a, b); }
inline I bit_xor(I a, I b) { return _mm_xor_si128(a, b); }
inline I modulo_32(I n) { return _mm_and_si128(n, _mm_set1_epi32(31)); }
inline I shift_left(I a, I n) { // times a power of two, made as a float; 2^31 converts to the one bit it has, INT_MIN
    I power = _mm_add_epi32(_mm_slli_epi32(modulo_32(n), 23), _mm_set1_epi32(0x3f800000));
    return _mm_mullo_epi32(a, _mm_cvttps_epi32(_mm_castsi128_ps(power)));
}
template <class Op> inline I shift_each(I a, I n, Op shift) { // by the count of one lane at a time
    I low = _mm_unpacklo_epi32(modulo_32(n), _mm_setzero_si128());
    I high = _mm_unpackhi_epi32(modulo_32(n), _mm_setzero_si128());
    I lanes_01 = _mm_blend_epi16(shift(a, low), shift(a, _mm_unpackhi_epi64(low, low)), 0x0c);
    I lanes_23 = _mm_blend_epi16(shift(a, high), shift(a, _mm_unpackhi_epi64(high, high)), 0xc0);
    return _mm_blend_epi16(lanes_01, lanes_23, 0xf0);
}
inline I shift_right(I a, I n) {
    return shift_each(a, n, [](I x, I count) { return _mm_sra_epi32(x, count); });
}
inline I shift_right_logical(I a, I n) {
    return shift_each(a, n, [](I x, I count) { return _mm_srl_epi32(x, count); });
}
inline I shift_left(I a, int n) { return _mm_slli_epi32(a, n); }
inline I shift_right(I a, int n) { return _mm_srai_epi32(a, n); }
inline I shift_right_logical(I a, int n) { return _mm_srli_epi32(a, n); }
inline I min(I a, I b) { return _mm_min_epi32(a, b); }
inline I max(I a, I b) { return _mm_max_epi32(a, b); }
inline M lt(I a, I b) { return _mm_castsi128_ps(_mm_cmplt_epi32(a, b)); }
inline M eq(I a, I b) { return _mm_castsi128_ps(_mm_cmpeq_epi32(a, b)); }
inline I select(M m, I a, I b) { return _mm_castps_si128(_mm_blendv_ps(_mm_castsi128_ps(b), _mm_castsi128_ps(a), m)); }

// --- masks
inline M mask_and(M a, M b) { return _mm_and_ps(a, b); }
inline M mask_or(M a, M b) { return _mm_or_ps(a, b); }
inline M mask_xor(M a, M b) { return _mm_xor_ps(a, b); }
inline M mask_not(M a) { return _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1))); }
inline M le(I a, I b) { return mask_not(lt(b, a)); }
inline M ne(I a, I b) { return mask_not(eq(a, b)); }
inline std::uint32_t bits(M m) { return static_cast<std::uint32_t>(_mm_movemask_ps(m)); }
inline M from_bits(std::uint32_t b) {
    I lane_bit = _mm_setr_epi32(1, 2, 4, 8);
    return eq(bit_and(broadcast(static_cast<std::int32_t>(b)), lane_bit), lane_bit);
}

// --- conversion
inline I to_int(F a) { return _mm_cvttps_epi32(a); }
inline F to_float(I a) { return _mm_cvtepi32_ps(a); }
inline I as_int(F a) { return _mm_castps_si128(a); }
inline F as_float(I a) { return _mm_castsi128_ps(a); }

// --- memory
inline F load(const float* p) { return _mm_loadu_ps(p); }
inline I load(const std::int32_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
inline void store(float* p, F a) { _mm_storeu_ps(p, a); }
inline void store(std::int32_t* p, I a) { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a); }
inline F join(float a, float b, float c, float d) { return _mm_setr_ps(a, b, c, d); }
inline I join(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) { return _mm_setr_epi32(a, b, c, d); }
// Masked-off lanes read a zero of our own instead: no branch, and no access to what may not be there. They are joined
// in registers: g++ would put an array of them together 64 bits at a time, each half read back from where it was
// stored.
template <class T, class Index> inline auto load_lanes(const T* p, Index index, M m) {
    static constexpr T zero = 0;
    std::uint32_t b = bits(m);
    auto lane = [&](int i) { return *((b >> i & 1U) != 0 ? p + index(i) : &zero); };
    return join(lane(0), lane(1), lane(2), lane(3));
}
inline F load(const float* p, M m) {
    return load_lanes(
        p, [](int i) { return i; }, m);
}
inline I load(const std::int32_t* p, M m) {
    return load_lanes(
        p, [](int i) { return i; }, m);
}
template <class T> inline auto gather_lanes(const T* p, I index, M m) {
    alignas(16) std::int32_t from[lanes];
    store(from, index);
    return load_lanes(
        p, [&](int i) { return from[i]; }, m);
}
inline F gather(const float* p, I index, M m) { return gather_lanes(p, index, m); }
inline I gather(const std::int32_t* p, I index, M m) { return gather_lanes(p, index, m); }
template <class T, class R> inline void scatter_lanes(T* p, I index, R a, M m) {
    alignas(16) std::int32_t to[lanes];
    alignas(16) T from[lanes];
    store(to, index);
    store(from, a);
    for (std::uint32_t b = bits(m); b != 0; b &= b - 1) {
        int i = __builtin_ctz(b);
        p[to[i]] = from[i];
    }
}
template <class T, class R> inline void store_lanes(T* p, R a, M m) {
    alignas(16) T from[lanes];
    store(from, a);
    for (std::uint32_t b = bits(m); b != 0; b &= b - 1) {
        int i = __builtin_ctz(b);
        p[i] = from[i];
    }
}
inline void store(float* p, F a, M m) { store_lanes(p, a, m); }
inline void store(std::int32_t* p, I a, M m) { store_lanes(p, a, m); }
inline void scatter(float* p, I index, F a, M m) { scatter_lanes(p, index, a, m); }
inline void scatter(std::int32_t* p, I index, I a, M m) { scatter_lanes(p, index, a, m); }

// --- within one register
template <class Op> inline float fold(F a, Op op) {
    F x = op(a, _mm_movehl_ps(a, a));
    return _mm_cvtss_f32(op(x, _mm_shuffle_ps(x, x, 1)));
}
template <class Op> inline std::int32_t fold(I a, Op op) {
    I x = op(a, _mm_shuffle_epi32(a, 0x4e));
    return _mm_cvtsi128_si32(op(x, _mm_shuffle_epi32(x, 0xb1)));
}
inline float reduce_add(F a) {
    return fold(a, [](F x, F y) { return add(x, y); });
}
inline float reduce_min(F a) {
    return fold(a, [](F x, F y) { return min(x, y); });
}
inline float reduce_max(F a) {
    return fold(a, [](F x, F y) { return max(x, y); });
}
inline std::int32_t reduce_add(I a) {
    return fold(a, [](I x, I y) { return add(x, y); });
}
inline std::int32_t reduce_min(I a) {
    return fold(a, [](I x, I y) { return min(x, y); });
}
inline std::int32_t reduce_max(I a) {
    return fold(a, [](I x, I y) { return max(x, y); });
}

} // namespace ISA_NATIVE::reg

#include "isa/native/through_memory.h"

namespace ISA_NATIVE::reg {

// --- across registers
template <int n> inline bool any(const M (&m)[n]) {
    M x = m[0];
    unroll<n - 1>([&](int i) { x = mask_or(x, m[i + 1]); });
    return _mm_movemask_ps(x) != 0;
}
template <int n> inline bool all(const M (&m)[n]) {
    M x = m[0];
    unroll<n - 1>([&](int i) { x = mask_and(x, m[i + 1]); });
    return _mm_movemask_ps(x) == 0xf;
}
template <class R, int n> inline void permute(R (&to)[n], const R (&a)[n], const I (&index)[n]) {
    through_memory::permute(to, a, index);
}
inline I compress_1(I a, M m) { // moves bytes by a table of the 16 masks: lane k takes the k-th set lane
    static constexpr struct table {
        alignas(16) std::uint8_t bytes[16][16] = {};
        constexpr table() {
            for (unsigned mask = 0; mask < 16; ++mask)
                for (unsigned lane = 0, to = 0; lane < 4; ++lane)
                    if ((mask >> lane & 1U) != 0)
                        for (unsigned byte = 0; byte < 4; ++byte)
                            bytes[mask][to++] = static_cast<std::uint8_t>(4 * lane + byte);
        }
    } packing;
    return _mm_shuffle_epi8(a, _mm_load_si128(reinterpret_cast<const __m128i*>(packing.bytes[bits(m)])));
}
inline F compress_1(F a, M m) { return as_float(compress_1(as_int(a), m)); }
template <class R, int n> inline void compress(R (&to)[n], const R (&a)[n], const M (&m)[n]) {
    through_memory::compress(to, a, m, [](R x, M k) { return compress_1(x, k); });
}
template <class R, int n> inline auto extract(const R (&a)[n], int lane) { return through_memory::extract(a, lane); }

} // namespace ISA_NATIVE::reg
