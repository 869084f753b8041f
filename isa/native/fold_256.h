// Reduction of one 256-bit register, shared by the avx2 and avx512 headers: lane i with lane i + 4, then + 2,
// then + 1.
#pragma once

#include "isa/target.h"

#include <cstdint>
#include <immintrin.h>

namespace ISA_NATIVE::reg {

struct fold_add {
    __m256 operator()(__m256 a, __m256 b) const { return _mm256_add_ps(a, b); }
    __m128 operator()(__m128 a, __m128 b) const { return _mm_add_ps(a, b); }
    __m256i operator()(__m256i a, __m256i b) const { return _mm256_add_epi32(a, b); }
    __m128i operator()(__m128i a, __m128i b) const { return _mm_add_epi32(a, b); }
};
struct fold_min {
    __m256 operator()(__m256 a, __m256 b) const { return _mm256_min_ps(a, b); }
    __m128 operator()(__m128 a, __m128 b) const { return _mm_min_ps(a, b); }
    __m256i operator()(__m256i a, __m256i b) const { return _mm256_min_epi32(a, b); }
    __m128i operator()(__m128i a, __m128i b) const { return _mm_min_epi32(a, b); }
};
struct fold_max {
    __m256 operator()(__m256 a, __m256 b) const { return _mm256_max_ps(a, b); }
    __m128 operator()(__m128 a, __m128 b) const { return _mm_max_ps(a, b); }
    __m256i operator()(__m256i a, __m256i b) const { return _mm256_max_epi32(a, b); }
    __m128i operator()(__m128i a, __m128i b) const { return _mm_max_epi32(a, b); }
};

template <class Op> inline float fold_256(__m256 a, Op op) {
    __m128 x = op(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    x = op(x, _mm_movehl_ps(x, x));
    return _mm_cvtss_f32(op(x, _mm_shuffle_ps(x, x, 1)));
}
template <class Op> inline std::int32_t fold_256(__m256i a, Op op) {
    __m128i x = op(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    x = op(x, _mm_shuffle_epi32(x, 0x4e));
    return _mm_cvtsi128_si32(op(x, _mm_shuffle_epi32(x, 0xb1)));
}

} // namespace ISA_NATIVE::reg
