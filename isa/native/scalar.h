// Native scalars of the vocabulary: sfloat, sint, sbool. They hold one number each and convert from constants, but
// never back to C++ numbers or bool: branch(sbool) is the only way to decide anything.
#pragma once

#include "isa/target.h"

#include <cstdint>

namespace ISA_NATIVE {

struct sbool {
    bool v = false;
    sbool() = default;
    sbool(bool constant) : v(constant) {}
    template <class T> sbool(T) = delete;
};

struct sint {
    std::int32_t v = 0;
    sint() = default;
    sint(std::int32_t constant) : v(constant) {}
    sint(bool) = delete;
    sint(float) = delete;
    sint(double) = delete;
};

struct sfloat {
    float v = 0;
    sfloat() = default;
    sfloat(float constant) : v(constant) {}
    sfloat(std::int32_t) = delete;
    sfloat(bool) = delete;
    sfloat(double) = delete;
};

// --- sfloat arithmetic: correctly rounded, IEEE 754 for NaN and infinities (a NaN result is quiet, its payload
// unspecified)
inline sfloat operator+(sfloat a, sfloat b) { return a.v + b.v; }
inline sfloat operator-(sfloat a, sfloat b) { return a.v - b.v; }
inline sfloat operator*(sfloat a, sfloat b) { return a.v * b.v; }
inline sfloat operator/(sfloat a, sfloat b) { return a.v / b.v; }
/// Flips the sign bit, of NaN too.
inline sfloat operator-(sfloat a) {
    return __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, a.v) ^ 0x80000000U);
}
#if defined(ISA_TARGET_SSE4)
namespace detail {
inline float fused(float a, float b, float c) { return a * b + c; }
} // namespace detail
#else
namespace detail {
inline float fused(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
} // namespace detail
#endif
/// a*b + c. One rounding; two on sse4.
inline sfloat fma(sfloat a, sfloat b, sfloat c) { return detail::fused(a.v, b.v, c.v); }
/// a*b - c. One rounding; two on sse4.
inline sfloat fms(sfloat a, sfloat b, sfloat c) { return detail::fused(a.v, b.v, -c.v); }
/// c - a*b. One rounding; two on sse4.
inline sfloat fnma(sfloat a, sfloat b, sfloat c) { return detail::fused(-a.v, b.v, c.v); }
/// a*b - p: the exact rounding error of p = a*b on every target, sse4 too (barring overflow, and underflow of the
/// error).
inline sfloat product_error(sfloat a, sfloat b, sfloat p) {
    return static_cast<float>(static_cast<double>(a.v) * static_cast<double>(b.v) - static_cast<double>(p.v));
}
/// a < b ? a : b (b where either is NaN or both are zeros).
inline sfloat min(sfloat a, sfloat b) { return a.v < b.v ? a.v : b.v; }
/// a > b ? a : b (b where either is NaN or both are zeros).
inline sfloat max(sfloat a, sfloat b) { return a.v > b.v ? a.v : b.v; }
/// Clears the sign bit, of NaN too.
inline sfloat abs(sfloat a) { return __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, a.v) & 0x7fffffffU); }
/// Correctly rounded; NaN below zero, -0 at -0.
inline sfloat sqrt(sfloat a) { return __builtin_sqrtf(a.v); }
/// Exact; NaN and infinities unchanged.
inline sfloat floor(sfloat a) { return __builtin_floorf(a.v); }
/// To the nearest integer, ties to even; exact; NaN and infinities unchanged.
inline sfloat round_even(sfloat a) { return __builtin_rintf(a.v); }
/// 1/a and 1/sqrt(a) by true division and square root: one and two roundings.
inline sfloat reciprocal(sfloat a) { return 1.0F / a.v; }
inline sfloat reciprocal_sqrt(sfloat a) { return 1.0F / __builtin_sqrtf(a.v); }

// --- sfloat comparison: false where either is NaN, except !=
inline sbool operator<(sfloat a, sfloat b) { return a.v < b.v; }
inline sbool operator<=(sfloat a, sfloat b) { return a.v <= b.v; }
inline sbool operator>(sfloat a, sfloat b) { return a.v > b.v; }
inline sbool operator>=(sfloat a, sfloat b) { return a.v >= b.v; }
inline sbool operator==(sfloat a, sfloat b) { return a.v == b.v; }
inline sbool operator!=(sfloat a, sfloat b) { return a.v != b.v; }

// --- sint arithmetic: 32 bits, wraps
inline std::uint32_t word(sint a) { return static_cast<std::uint32_t>(a.v); }
inline sint wrapped(std::uint32_t x) { return static_cast<std::int32_t>(x); }
inline sint operator+(sint a, sint b) { return wrapped(word(a) + word(b)); }
inline sint operator-(sint a, sint b) { return wrapped(word(a) - word(b)); }
inline sint operator*(sint a, sint b) { return wrapped(word(a) * word(b)); }
inline sint operator-(sint a) { return wrapped(0U - word(a)); }
inline sint operator&(sint a, sint b) { return a.v & b.v; }
inline sint operator|(sint a, sint b) { return a.v | b.v; }
inline sint operator^(sint a, sint b) { return a.v ^ b.v; }
/// Shift counts are taken modulo 32.
inline sint operator<<(sint a, sint n) { return wrapped(word(a) << (word(n) & 31U)); }
/// Arithmetic shift.
inline sint operator>>(sint a, sint n) { return a.v >> (word(n) & 31U); }
inline sint shift_right_logical(sint a, sint n) { return wrapped(word(a) >> (word(n) & 31U)); }
inline sint min(sint a, sint b) { return a.v < b.v ? a.v : b.v; }
inline sint max(sint a, sint b) { return a.v > b.v ? a.v : b.v; }
inline sint& operator+=(sint& a, sint b) { return a = a + b; }
inline sint& operator-=(sint& a, sint b) { return a = a - b; }
inline sint& operator++(sint& a) { return a = a + sint(1); }
inline sint& operator--(sint& a) { return a = a - sint(1); }
inline sfloat& operator+=(sfloat& a, sfloat b) { return a = a + b; }

// --- sint comparison
inline sbool operator<(sint a, sint b) { return a.v < b.v; }
inline sbool operator<=(sint a, sint b) { return a.v <= b.v; }
inline sbool operator>(sint a, sint b) { return a.v > b.v; }
inline sbool operator>=(sint a, sint b) { return a.v >= b.v; }
inline sbool operator==(sint a, sint b) { return a.v == b.v; }
inline sbool operator!=(sint a, sint b) { return a.v != b.v; }

// --- sbool. && and || would hide a branch: use & and |, which evaluate both sides.
inline sbool operator&(sbool a, sbool b) { return a.v && b.v; }
inline sbool operator|(sbool a, sbool b) { return a.v || b.v; }
inline sbool operator^(sbool a, sbool b) { return a.v != b.v; }
inline sbool operator!(sbool a) { return !a.v; }
sbool operator&&(sbool, sbool) = delete;
sbool operator||(sbool, sbool) = delete;

/// m ? a : b, without a branch.
inline sfloat select(sbool m, sfloat a, sfloat b) { return m.v ? a : b; }
inline sint select(sbool m, sint a, sint b) { return m.v ? a : b; }

// --- conversion
/// Towards zero; NaN and what does not fit give INT_MIN.
inline sint to_int(sfloat a) {
    return a.v >= -2147483648.0F && a.v < 2147483648.0F ? static_cast<std::int32_t>(a.v) : (-0x7fffffff - 1);
}
/// To nearest, ties to even.
inline sfloat to_float(sint a) { return static_cast<float>(a.v); }
/// The same 32 bits.
inline sint as_int(sfloat a) { return __builtin_bit_cast(std::int32_t, a.v); }
inline sfloat as_float(sint a) { return __builtin_bit_cast(float, a.v); }

// --- control
/// The one way from a vocabulary value to a C++ decision: if (branch(x < y)), for (sint i = 0; branch(i < n); ++i).
inline bool branch(sbool condition) { return condition.v; }

} // namespace ISA_NATIVE
