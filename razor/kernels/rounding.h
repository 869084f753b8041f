// What single precision may be off by. Every operation returns what is exact times 1 + d, |d| <= u = 2^-24
// (half an ulp of 1), unless it underflows; n of them in a row what is exact times 1 + e, |e| <= gamma(n) = n
// u / (1 - n u) (Higham, Accuracy and Stability of Numerical Algorithms, 2002, lemma 3.1), and a sum whose
// terms went through n of them each is off by gamma(n) of the sum of their sizes. Beside a formula's bound
// stands how many they are; `sse4`, whose multiply-adds round twice, has one more for each of these.
#pragma once

namespace razor {

inline constexpr float unit_roundoff = 0x1p-24F;

constexpr double gamma_of(int roundings) {
    return roundings * 0x1p-24 / (1 - roundings * 0x1p-24);
}

/// Of up to 15 and 32 roundings, also where they are rounded with 1 themselves.
inline constexpr float few_roundings = 1.0e-6F;
inline constexpr float more_roundings = 2.0e-6F;
static_assert(few_roundings > gamma_of(15) && more_roundings > gamma_of(32));

/// What makes numbers more, or less, than they were before so many roundings.
inline constexpr float few_up = 1.0F + few_roundings;
inline constexpr float few_down = 1.0F - few_roundings;
inline constexpr float more_up = 1.0F + more_roundings;
inline constexpr float more_down = 1.0F - more_roundings;
static_assert(few_up - 1.0 > gamma_of(15) && 1.0 - few_down > gamma_of(15));
static_assert(more_up - 1.0 > gamma_of(32) && 1.0 - more_down > gamma_of(32));

} // namespace razor
