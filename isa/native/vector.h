// Native vectors of the vocabulary: vfloat, vint, vmask of isa::width lanes, as arrays of one target's
// registers. Lane-wise unless stated. IEEE 754 for NaN and infinities; a NaN result is quiet and its payload
// unspecified.
#pragma once

#include "isa/native/scalar.h"
#include "isa/native/unroll.h"
#include "isa/target.h"
#include ISA_REGISTERS

#include <concepts>
#include <cstdint>

namespace ISA_NATIVE {

static_assert(width % reg::lanes == 0);
inline constexpr int registers = width / reg::lanes;

namespace detail {
template <class F> [[gnu::always_inline]] inline void each_register(F f) { unroll<registers>(f); }
} // namespace detail

// Copies go register by register: g++ moves a whole array by way of memory.
struct vfloat {
    reg::F r[registers];
    vfloat() = default; // undefined lanes
    vfloat(const vfloat& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
    }
    vfloat& operator=(const vfloat& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
        return *this;
    }
    vfloat(float constant) {
        detail::each_register([&](int i) { r[i] = reg::broadcast(constant); });
    }
    vfloat(sfloat a) : vfloat(a.v) {} // broadcast
    vfloat(std::int32_t) = delete;
    vfloat(double) = delete;
};
struct vint {
    reg::I r[registers];
    vint() = default; // undefined lanes
    vint(const vint& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
    }
    vint& operator=(const vint& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
        return *this;
    }
    vint(std::int32_t constant) {
        detail::each_register([&](int i) { r[i] = reg::broadcast(constant); });
    }
    vint(sint a) : vint(a.v) {} // broadcast
    vint(float) = delete;
    vint(double) = delete;
};
struct vmask {
    reg::M r[registers];
    vmask() = default; // undefined lanes
    vmask(const vmask& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
    }
    vmask& operator=(const vmask& a) {
        detail::each_register([&](int i) { r[i] = a.r[i]; });
        return *this;
    }
    vmask(bool constant) {
        detail::each_register([&](int i) { r[i] = reg::from_bits(constant ? 0xffffffffU : 0U); });
    }
    vmask(sbool a) : vmask(a.v) {} // broadcast
    template <class T> vmask(T) = delete;
};

namespace detail {
template <class R, class Op, class... A> [[gnu::always_inline]] inline R map(Op op, const A&... a) {
    R r;
    each_register([&](int i) { r.r[i] = op(a.r[i]...); });
    return r;
}
} // namespace detail
// Always: out of line, all operands are stored before each operation and loaded in it, whether registers are left or
// not.
#define ISA_INLINE [[gnu::always_inline]] inline
#define ISA_OP(expression) [](auto... x) { return reg::expression(x...); }

// --- vfloat arithmetic: correctly rounded
ISA_INLINE vfloat operator+(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(add), a, b); }
ISA_INLINE vfloat operator-(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(sub), a, b); }
ISA_INLINE vfloat operator*(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(mul), a, b); }
ISA_INLINE vfloat operator/(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(div), a, b); }
/// a*b + c. One rounding; two on sse4.
ISA_INLINE vfloat fma(const vfloat& a, const vfloat& b, const vfloat& c) {
    return detail::map<vfloat>(ISA_OP(fma), a, b, c);
}
/// a*b - c. One rounding; two on sse4.
ISA_INLINE vfloat fms(const vfloat& a, const vfloat& b, const vfloat& c) {
    return detail::map<vfloat>(ISA_OP(fms), a, b, c);
}
/// c - a*b. One rounding; two on sse4.
ISA_INLINE vfloat fnma(const vfloat& a, const vfloat& b, const vfloat& c) {
    return detail::map<vfloat>(ISA_OP(fnma), a, b, c);
}
/// a*b - p: the exact rounding error of p = a*b on every target, sse4 too (barring overflow, and underflow of
/// the error).
ISA_INLINE vfloat product_error(const vfloat& a, const vfloat& b, const vfloat& p) {
    return detail::map<vfloat>(ISA_OP(product_error), a, b, p);
}
/// a < b ? a : b (b where either is NaN or both are zeros).
ISA_INLINE vfloat min(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(min), a, b); }
/// a > b ? a : b (b where either is NaN or both are zeros).
ISA_INLINE vfloat max(const vfloat& a, const vfloat& b) { return detail::map<vfloat>(ISA_OP(max), a, b); }
/// Correctly rounded; NaN below zero, -0 at -0.
ISA_INLINE vfloat sqrt(const vfloat& a) { return detail::map<vfloat>(ISA_OP(sqrt), a); }
/// Exact; NaN and infinities unchanged.
ISA_INLINE vfloat floor(const vfloat& a) { return detail::map<vfloat>(ISA_OP(floor), a); }
/// To the nearest integer, ties to even; exact; NaN and infinities unchanged.
ISA_INLINE vfloat round_even(const vfloat& a) { return detail::map<vfloat>(ISA_OP(round_even), a); }
/// 1/a and 1/sqrt(a) by true division and square root: one and two roundings.
ISA_INLINE vfloat reciprocal(const vfloat& a) { return vfloat(1.0F) / a; }
ISA_INLINE vfloat reciprocal_sqrt(const vfloat& a) { return vfloat(1.0F) / sqrt(a); }

// --- vfloat comparison: false where either is NaN, except !=
ISA_INLINE vmask operator<(const vfloat& a, const vfloat& b) { return detail::map<vmask>(ISA_OP(lt), a, b); }
ISA_INLINE vmask operator<=(const vfloat& a, const vfloat& b) { return detail::map<vmask>(ISA_OP(le), a, b); }
ISA_INLINE vmask operator>(const vfloat& a, const vfloat& b) { return b < a; }
ISA_INLINE vmask operator>=(const vfloat& a, const vfloat& b) { return b <= a; }
ISA_INLINE vmask operator==(const vfloat& a, const vfloat& b) { return detail::map<vmask>(ISA_OP(eq), a, b); }
ISA_INLINE vmask operator!=(const vfloat& a, const vfloat& b) { return detail::map<vmask>(ISA_OP(ne), a, b); }

// --- vint arithmetic: 32 bits, wraps
ISA_INLINE vint operator+(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(add), a, b); }
ISA_INLINE vint operator-(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(sub), a, b); }
ISA_INLINE vint operator*(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(mul), a, b); }
ISA_INLINE vint operator&(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(bit_and), a, b); }
ISA_INLINE vint operator|(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(bit_or), a, b); }
ISA_INLINE vint operator^(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(bit_xor), a, b); }
/// Shifts: counts modulo 32; >> is arithmetic.
ISA_INLINE vint operator<<(const vint& a, const vint& n) { return detail::map<vint>(ISA_OP(shift_left), a, n); }
ISA_INLINE vint operator>>(const vint& a, const vint& n) { return detail::map<vint>(ISA_OP(shift_right), a, n); }
ISA_INLINE vint shift_right_logical(const vint& a, const vint& n) {
    return detail::map<vint>(ISA_OP(shift_right_logical), a, n);
}
/// Shifts of all lanes by one constant from 0 to 31.
template <std::same_as<vint> V> ISA_INLINE vint operator<<(const V& a, int n) {
    return detail::map<vint>([n](reg::I x) { return reg::shift_left(x, n); }, a);
}
template <std::same_as<vint> V> ISA_INLINE vint operator>>(const V& a, int n) {
    return detail::map<vint>([n](reg::I x) { return reg::shift_right(x, n); }, a);
}
template <std::same_as<vint> V> ISA_INLINE vint shift_right_logical(const V& a, int n) {
    return detail::map<vint>([n](reg::I x) { return reg::shift_right_logical(x, n); }, a);
}
ISA_INLINE vint min(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(min), a, b); }
ISA_INLINE vint max(const vint& a, const vint& b) { return detail::map<vint>(ISA_OP(max), a, b); }

// --- vint comparison
ISA_INLINE vmask operator<(const vint& a, const vint& b) { return detail::map<vmask>(ISA_OP(lt), a, b); }
ISA_INLINE vmask operator<=(const vint& a, const vint& b) { return detail::map<vmask>(ISA_OP(le), a, b); }
ISA_INLINE vmask operator>(const vint& a, const vint& b) { return b < a; }
ISA_INLINE vmask operator>=(const vint& a, const vint& b) { return b <= a; }
ISA_INLINE vmask operator==(const vint& a, const vint& b) { return detail::map<vmask>(ISA_OP(eq), a, b); }
ISA_INLINE vmask operator!=(const vint& a, const vint& b) { return detail::map<vmask>(ISA_OP(ne), a, b); }

// --- masks. && and || do not exist: use & and |.
ISA_INLINE vmask operator&(const vmask& a, const vmask& b) { return detail::map<vmask>(ISA_OP(mask_and), a, b); }
ISA_INLINE vmask operator|(const vmask& a, const vmask& b) { return detail::map<vmask>(ISA_OP(mask_or), a, b); }
ISA_INLINE vmask operator^(const vmask& a, const vmask& b) { return detail::map<vmask>(ISA_OP(mask_xor), a, b); }
ISA_INLINE vmask operator!(const vmask& a) { return detail::map<vmask>(ISA_OP(mask_not), a); }
vmask operator&&(const vmask&, const vmask&) = delete;
vmask operator||(const vmask&, const vmask&) = delete;

namespace detail {
inline std::uint64_t bits(const vmask& m) { // bit i = lane i
    std::uint64_t b = 0;
    each_register([&](int i) { b |= static_cast<std::uint64_t>(reg::bits(m.r[i])) << (i * reg::lanes); });
    return b;
}
inline vmask from_bits(std::uint64_t b) {
    vmask m;
    each_register([&](int i) { m.r[i] = reg::from_bits(static_cast<std::uint32_t>(b >> (i * reg::lanes))); });
    return m;
}
inline constexpr std::uint64_t all_lanes = width == 64 ? ~0ULL : (1ULL << (width % 64)) - 1;
} // namespace detail

inline sbool any(const vmask& m) { return reg::any(m.r); }
inline sbool all(const vmask& m) { return reg::all(m.r); }
inline sbool none(const vmask& m) { return !reg::any(m.r); }
/// Number of set lanes.
inline sint count(const vmask& m) { return __builtin_popcountll(detail::bits(m)); }
/// Lowest set lane; the width if there is none.
inline sint first(const vmask& m) {
    std::uint64_t b = detail::bits(m);
    return b == 0 ? width : __builtin_ctzll(b);
}
/// Clears the lowest set lane, if there is one.
inline vmask clear_first(const vmask& m) {
    std::uint64_t b = detail::bits(m);
    return detail::from_bits(b & (b - 1));
}
/// Lanes 0 ... n-1 (none for n <= 0, all for n >= width).
inline vmask first_lanes(sint n) {
    return detail::from_bits(n.v <= 0 ? 0 : n.v >= width ? detail::all_lanes : (1ULL << n.v) - 1);
}

/// m ? a : b.
ISA_INLINE vfloat select(const vmask& m, const vfloat& a, const vfloat& b) {
    return detail::map<vfloat>(ISA_OP(select), m, a, b);
}
ISA_INLINE vint select(const vmask& m, const vint& a, const vint& b) {
    return detail::map<vint>(ISA_OP(select), m, a, b);
}

// --- conversion
/// Towards zero; NaN and what does not fit give INT_MIN.
ISA_INLINE vint to_int(const vfloat& a) { return detail::map<vint>(ISA_OP(to_int), a); }
/// To nearest, ties to even.
ISA_INLINE vfloat to_float(const vint& a) { return detail::map<vfloat>(ISA_OP(to_float), a); }
/// The same 32 bits.
ISA_INLINE vint as_int(const vfloat& a) { return detail::map<vint>(ISA_OP(as_int), a); }
ISA_INLINE vfloat as_float(const vint& a) { return detail::map<vfloat>(ISA_OP(as_float), a); }
/// Flips, or clears, the sign bit, of NaN too.
ISA_INLINE vfloat operator-(const vfloat& a) { return as_float(as_int(a) ^ vint(std::int32_t(0x80000000U))); }
ISA_INLINE vfloat abs(const vfloat& a) { return as_float(as_int(a) & vint(0x7fffffff)); }

// --- across lanes
/// 0, 1, 2, ... width-1.
inline vint lane_index() {
    vint r;
    detail::each_register([&](int i) { r.r[i] = reg::add(reg::iota(), reg::broadcast(std::int32_t{i * reg::lanes})); });
    return r;
}
namespace detail {
template <int n, class R, class Op> inline R folded(const R* a, Op op) { // n registers, registers / n apart
    if constexpr (n == 1)
        return a[0];
    else
        return op(folded<n / 2>(a, op), folded<n / 2>(a + registers / n, op));
}
} // namespace detail
/// Reductions fold lane i with lane i + n/2 for n = width, width/2, ... 2: one order on every target.
inline sfloat reduce_add(const vfloat& a) { return reg::reduce_add(detail::folded<registers>(a.r, ISA_OP(add))); }
/// By min and max above, in the same order (so a NaN in some lane may or may not reach the result).
inline sfloat reduce_min(const vfloat& a) { return reg::reduce_min(detail::folded<registers>(a.r, ISA_OP(min))); }
inline sfloat reduce_max(const vfloat& a) { return reg::reduce_max(detail::folded<registers>(a.r, ISA_OP(max))); }
inline sint reduce_add(const vint& a) { return reg::reduce_add(detail::folded<registers>(a.r, ISA_OP(add))); }
inline sint reduce_min(const vint& a) { return reg::reduce_min(detail::folded<registers>(a.r, ISA_OP(min))); }
inline sint reduce_max(const vint& a) { return reg::reduce_max(detail::folded<registers>(a.r, ISA_OP(max))); }

namespace detail {
template <class T> struct lanes_of { alignas(64) T v[width]; };
inline lanes_of<float> spread(const vfloat& a) {
    lanes_of<float> s;
    each_register([&](int i) { reg::store(s.v + i * reg::lanes, a.r[i]); });
    return s;
}
inline lanes_of<std::int32_t> spread(const vint& a) {
    lanes_of<std::int32_t> s;
    each_register([&](int i) { reg::store(s.v + i * reg::lanes, a.r[i]); });
    return s;
}
} // namespace detail
/// Lane i of the result is lane index[i] (modulo the width) of a.
inline vfloat permute(const vfloat& a, const vint& index) {
    vfloat r;
    reg::permute(r.r, a.r, index.r);
    return r;
}
inline vint permute(const vint& a, const vint& index) {
    vint r;
    reg::permute(r.r, a.r, index.r);
    return r;
}
/// The lanes of a that m names, in order, from lane 0 on; the rest are 0.
inline vfloat compress(const vfloat& a, const vmask& m) {
    vfloat r;
    reg::compress(r.r, a.r, m.r);
    return r;
}
inline vint compress(const vint& a, const vmask& m) {
    vint r;
    reg::compress(r.r, a.r, m.r);
    return r;
}
/// One lane (modulo the width).
inline sfloat extract(const vfloat& a, sint lane) { return reg::extract(a.r, lane.v); }
inline sint extract(const vint& a, sint lane) { return reg::extract(a.r, lane.v); }

#undef ISA_OP
#undef ISA_INLINE

} // namespace ISA_NATIVE
