#include "analysis/traces/line_filter.h"

#include "traces/sample.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace analysis {
namespace {

std::uint64_t one_by_one(const std::uint64_t* lines, std::uint64_t offset, std::uint64_t limit) {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < filtered_lines; ++i)
        below |= std::uint64_t{traces::hash_bits_of_line(lines[i] + offset) < limit} << i;
    return below;
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] __m256i all_four(std::uint64_t value) {
    return _mm256_set1_epi64x(static_cast<long long>(value));
}

/// The low 64 bits of products, of halves: there is no such instruction.
[[gnu::target("avx2")]] __m256i product(__m256i a, std::uint64_t factor) {
    const __m256i low = all_four(factor), high = all_four(factor >> 32U);
    const __m256i crossed =
        _mm256_add_epi64(_mm256_mul_epu32(_mm256_srli_epi64(a, 32), low), _mm256_mul_epu32(a, high));
    return _mm256_add_epi64(_mm256_mul_epu32(a, low), _mm256_slli_epi64(crossed, 32));
}

/// hash_bits_of_line() of four lines at once, and what is read next on its way from memory.
[[gnu::target("avx2")]] std::uint64_t by_fours(const std::uint64_t* lines, std::uint64_t offset,
                                               std::uint64_t limit) {
    constexpr std::size_t lanes = 4, ahead = 512; // lines
    const __m256i added = all_four(offset + 0x9E3779B97F4A7C15U), limits = all_four(limit);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < filtered_lines; i += lanes) {
        if (i % 8 == 0)
            _mm_prefetch(reinterpret_cast<const char*>(lines + i + ahead), _MM_HINT_T0);
        __m256i z = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lines + i));
        z = _mm256_add_epi64(z, added);
        z = product(_mm256_xor_si256(z, _mm256_srli_epi64(z, 30)), 0xBF58476D1CE4E5B9U);
        z = product(_mm256_xor_si256(z, _mm256_srli_epi64(z, 27)), 0x94D049BB133111EBU);
        z = _mm256_srli_epi64(_mm256_xor_si256(z, _mm256_srli_epi64(z, 31)), 11);
        const __m256d less = _mm256_castsi256_pd(_mm256_cmpgt_epi64(limits, z));
        below |= static_cast<std::uint64_t>(_mm256_movemask_pd(less)) << i;
    }
    return below;
}

const bool has_fours = __builtin_cpu_supports("avx2");
#endif

} // namespace

std::uint64_t lines_below(const std::uint64_t* lines, std::uint64_t offset, std::uint64_t limit) {
#if defined(__x86_64__)
    if (has_fours)
        return by_fours(lines, offset, limit);
#endif
    return one_by_one(lines, offset, limit);
}

} // namespace analysis
