// Spatial sampling: a line is recorded always or never, so that distances of reuse can be estimated
// (Waldspurger et al., FAST 2015: SHARDS).
#pragma once

#include <cstdint>

namespace traces {

/// Uniform below 2^53: SplitMix64 of a line's number.
inline std::uint64_t hash_bits_of_line(std::uint64_t line) {
    std::uint64_t z = line + 0x9E3779B97F4A7C15U;
    z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
    z ^= z >> 31U;
    return z >> 11U;
}
/// Uniform in [0, 1).
inline double hash_of_line(std::uint64_t line) {
    return static_cast<double>(hash_bits_of_line(line)) * 0x1p-53;
}

} // namespace traces
