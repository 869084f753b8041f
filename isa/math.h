// Elementary functions of the vocabulary, for vfloat and sfloat on every target: polynomials over vocabulary
// operations, so that they cost what they cost in the simulated machine too. Coefficients are Chebyshev interpolants in
// float. Bounds are in units in the last place of the exact result (2^-149 where that is subnormal), over all floats
// where not said otherwise; tests/isa/math_error.cpp measures them. avx2, avx512, plain and simulated agree bit for
// bit; sse4 keeps the same bounds.
#pragma once

#include "isa/isa.h"

#include <concepts>
#include <limits>

namespace isa::ISA_TARGET {

template <class F>
concept real_value = std::same_as<F, vfloat> || std::same_as<F, sfloat>;

namespace detail {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// ((highest * x + ...) * x + lowest): Horner's scheme.
template <real_value F, class... Float> inline F polynomial(const F& x, float highest, Float... rest) {
    F sum = highest;
    ((sum = fma(sum, x, F(rest))), ...);
    return sum;
}

/// a * 2^k for an integer k from -252 to 254, in two steps so that only the last one rounds.
template <real_value F> inline F scale(const F& a, const F& k) {
    auto n = to_int(k);
    auto half = n >> 1;
    auto rest = n - half;
    half = half + 127;
    rest = rest + 127;
    F b = a * as_float(half << 23);
    return b * as_float(rest << 23);
}

/// x = 2^k * (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)), for positive finite x.
template <real_value F> struct split {
    F k, f;
    explicit split(const F& x) {
        auto subnormal = x < F(1.17549435e-38F);
        auto bits = as_int(select(subnormal, x * F(8388608.0F), x));
        auto exponent = (bits - 0x3f3504f3) >> 23;
        bits = bits - (exponent << 23);
        k = to_float(exponent);
        k = select(subnormal, k - F(23.0F), k);
        f = as_float(bits) - F(1.0F);
    }
};

/// log(1 + f) - f on the interval of split.
template <real_value F> inline F log_tail(const F& f) {
    F p = polynomial(f, 0.0697161183F, -0.114797339F, 0.116854198F, -0.124256872F, 0.142490581F, -0.166678026F,
                     0.200007156F, -0.24999997F, 0.333333313F);
    F square = f * f;
    F cube = square * f;
    p = p * cube;
    return fnma(square, F(0.5F), p);
}

/// What logarithms give where x is not a positive finite number.
template <real_value F> inline F log_special(const F& x, const F& log_x) {
    F r = select(x < F(infinity), log_x, x);
    r = select(x < F(0.0F), F(not_a_number), r);
    return select(x == F(0.0F), F(-infinity), r);
}

/// 2^(k + r) for an integer k and r from -1/2 to 1/2.
template <real_value F> inline F exp2_split(const F& k, const F& r) {
    F p = polynomial(r, 1.52973244e-05F, 0.000154614449F, 0.0013333502F, 0.00961805694F, 0.0555041097F, 0.240226507F,
                     0.693147182F);
    p = fma(p, r, F(1.0F));
    return scale(p, k);
}

/// x = n * pi/2 + high + low with |high| <= pi/4 or a little more, for |x| <= 100000. pi/2 is 72 bits; products and the
/// leading sums are exact, so that the relative error stays below 2^-24 where x is next to a multiple of pi/2.
template <real_value F> struct quarter_turns {
    F high, low;
    decltype(to_int(F())) n;
    explicit quarter_turns(const F& x) {
        F k = round_even(x * F(0.636619747F));
        n = to_int(k);
        F p = k * F(1.57079637F);
        F p_error = product_error(k, F(1.57079637F), p);
        F q = k * F(-4.37113883e-08F);
        F q_error = product_error(k, F(-4.37113883e-08F), q);
        low = fnma(k, F(-1.71512451e-15F), -q_error);
        F a = x - p;
        F b = difference(a, p_error);
        F c = difference(b, q);
        high = c + low;
        c = c - high;
        low = c + low;
    }

private:
    /// a - b rounded; what was rounded off joins low (Knuth's two-sum).
    F difference(const F& a, const F& b) {
        F d = a - b;
        F b_part = a - d;
        F a_part = d + b_part;
        F error = b_part - b;
        a_part = a - a_part;
        error = a_part + error;
        low = low + error;
        return d;
    }
};

/// sin(high + low) and cos(high + low) for |high| <= pi/4 or a little more.
template <real_value F> inline F sin_near(const F& high, const F& low) {
    F square = high * high;
    F p = polynomial(square, 2.72420925e-06F, -0.000198400259F, 0.00833333191F, -0.166666672F);
    F cube = square * high;
    p = fma(p, cube, low);
    return high + p;
}
template <real_value F> inline F cos_near(const F& high, const F& low) {
    F square = high * high;
    F p = polynomial(square, 2.45414776e-05F, -0.00138882722F, 0.0416666642F);
    F fourth = square * square;
    F half = square * F(0.5F);
    F most = F(1.0F) - half;
    F lost = F(1.0F) - most;
    lost = lost - half;
    lost = fnma(high, low, lost);
    p = fma(p, fourth, lost);
    return most + p;
}

/// log2(x) = high + low to some 35 bits, for positive finite x. With s = f / (2 + f) and c = 2 / log(2),
/// log2(1 + f) = c * (s + s^3/3 + s^5/5 ...): the first two terms are kept with their errors, the rest is small.
template <real_value F> struct precise_log2 {
    F high, low;
    explicit precise_log2(const F& x) {
        const F c = 2.88539004F, c_low = 3.85192607e-08F, third = 0.961796701F, third_low = -7.02846181e-09F;
        split<F> parts(x);
        F d = parts.f + F(2.0F);
        F d_error = d - F(2.0F);
        d_error = parts.f - d_error;
        F s = parts.f / d;
        F product = s * d;
        F s_error = parts.f - product;
        s_error = s_error - product_error(s, d, product);
        s_error = fnma(s, d_error, s_error);
        s_error = s_error / d;
        F square = s * s;
        F square_error = product_error(s, s, square);
        F cube = square * s;
        F cube_error = product_error(square, s, cube);
        cube_error = fma(square_error, s, cube_error);
        F rest = polynomial(square, 0.332637161F, 0.412063271F, 0.577078223F);
        rest = rest * square;
        rest = rest * cube;
        F first = s * c;
        F second = cube * third;
        low = product_error(s, c, first);
        low = low + product_error(cube, third, second);
        low = fma(s, c_low, low);
        low = fma(cube, third_low, low);
        low = fma(cube_error, third, low);
        low = fma(s_error, c, low);
        F s_error_cubed = square * s_error; // what it adds to the second term
        low = fma(s_error_cubed, c, low);
        low = low + rest;
        high = sum(first, second);
        high = sum(parts.k, high);
        F all = high + low;
        F taken = all - high;
        low = low - taken;
        high = all;
    }

private:
    /// a + b rounded, for a = 0 or |a| >= |b|; what was rounded off joins low.
    F sum(const F& a, const F& b) {
        F r = a + b;
        F taken = r - a;
        low = low + (b - taken);
        return r;
    }
};

} // namespace detail

/// e^x. 1 ulp. 0 below -103.98, infinity above 88.72; NaN for NaN.
template <real_value F> inline F exp(const F& x) {
    F y = max(F(-104.5F), x);
    y = min(F(89.0F), y);
    F k = round_even(y * F(1.44269502F));
    F r = fnma(k, F(0.693359375F), y);
    r = fnma(k, F(-0.000212194442F), r);
    F p = detail::polynomial(r, 0.00019891269F, 0.00139339F, 0.00833331048F, 0.041666463F, 0.166666672F, 0.5F);
    F square = r * r;
    p = fma(p, square, r);
    return detail::scale(p + F(1.0F), k);
}

/// 2^x. 1.25 ulp, exact for integers. 0 at and below -150, infinity from 128; NaN for NaN.
template <real_value F> inline F exp2(const F& x) {
    F y = max(F(-151.0F), x);
    y = min(F(129.0F), y);
    F k = round_even(y);
    return detail::exp2_split(k, y - k);
}

/// Natural logarithm. 1 ulp. -infinity at both zeros; NaN below zero and for NaN; infinity at infinity.
template <real_value F> inline F log(const F& x) {
    detail::split<F> s(x);
    F tail = detail::log_tail(s.f);
    tail = fma(s.k, F(-0.000212194442F), tail);
    F sum = s.f + tail;
    return detail::log_special(x, fma(s.k, F(0.693359375F), sum));
}

/// Logarithm to base 2. 1.5 ulp, exact for powers of two. Special values as for log.
template <real_value F> inline F log2(const F& x) {
    detail::split<F> s(x);
    F tail = detail::log_tail(s.f);
    F sum = s.f + tail;
    sum = fma(sum, F(0.442695051F), tail);
    sum = s.f + sum;
    return detail::log_special(x, sum + s.k);
}

/// Sine of x radians. 1 ulp for |x| <= 100000; NaN beyond, for infinities and NaN. -0 at -0.
template <real_value F> inline F sin(const F& x) {
    detail::quarter_turns<F> q(x);
    F s = detail::sin_near(q.high, q.low);
    F c = detail::cos_near(q.high, q.low);
    F r = select((q.n & 1) == 0, s, c);
    r = as_float(as_int(r) ^ ((q.n & 2) << 30));
    F size = abs(x);
    r = select(size < F(0.000244140625F), x, r);
    return select(size <= F(100000.0F), r, F(detail::not_a_number));
}

/// Cosine of x radians. 1 ulp for |x| <= 100000; NaN beyond, for infinities and NaN.
template <real_value F> inline F cos(const F& x) {
    detail::quarter_turns<F> q(x);
    F s = detail::sin_near(q.high, q.low);
    F c = detail::cos_near(q.high, q.low);
    F r = select((q.n & 1) == 0, c, s);
    r = as_float(as_int(r) ^ (((q.n + 1) & 2) << 30));
    return select(abs(x) <= F(100000.0F), r, F(detail::not_a_number));
}

/// x to the power y, for x >= 0. 1.25 ulp (sampled: pairs are too many to try all). NaN for x < 0, even where y is an
/// integer, and where either is NaN, but 1 where y is a zero or x is 1. At x = 0: infinity for y < 0, 0 for y > 0.
template <real_value F> inline F pow(const F& x, const F& y) {
    detail::precise_log2<F> log2_x(x);
    F high = detail::log_special(x, log2_x.high);
    // y * log2(x)
    F t = high * y;
    F t_error = product_error(high, y, t);
    t_error = fma(log2_x.low, y, t_error);
    t_error = select(abs(t) < F(200.0F), t_error, F(0.0F));
    t = max(F(-200.0F), t);
    t = min(F(200.0F), t);
    F k = round_even(t);
    F r = t - k;
    F result = detail::exp2_split(k, r + t_error);
    auto one = (y == F(0.0F));
    one = one | (x == F(1.0F));
    return select(one, F(1.0F), result);
}

/// The angle from the x axis to (x, y), from -pi to pi: what atan(y / x) is in its quadrant. 2 ulp (sampled). As of
/// IEEE's atan2 at zeros of either sign and where one is infinite; NaN where both are, and for NaN.
template <real_value F> inline F atan2(const F& y, const F& x) {
    F width = abs(x);
    F height = abs(y);
    F longer = max(width, height);
    F shorter = min(width, height);
    F divisor = select(longer == F(0.0F), F(1.0F), longer);
    F q = shorter / divisor;
    F square = q * q;
    F p = detail::polynomial(square, -0.00238699722F, 0.0135077713F, -0.0358715393F, 0.0625016913F, -0.0865688026F,
                             0.110337645F, -0.142785683F, 0.199997395F, -0.333333313F);
    F cube = square * q;
    F angle = fma(p, cube, q);
    F rest = angle + F(4.37113883e-08F); // pi/2 = 1.57079637 - 4.37113883e-08
    F from_y = F(1.57079637F) - rest;
    angle = select(height > width, from_y, angle);
    rest = angle + F(8.74227766e-08F);
    F from_back = F(3.14159274F) - rest;
    angle = select(as_int(x) < 0, from_back, angle);
    auto sign = as_int(y) & std::int32_t(0x80000000U);
    angle = as_float(as_int(angle) | sign);
    auto numbers = x == x;
    numbers = numbers & (y == y);
    return select(numbers, angle, F(detail::not_a_number));
}

} // namespace isa::ISA_TARGET
