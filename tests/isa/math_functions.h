// The elementary functions as the tests call them: arrays in, arrays out, for one target; and what they are
// held to.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace isa_test {

/// r[i] = f(x[i], y[i]) for i < n, a multiple of 64. y is read by functions of two arguments only.
using array_function = void (*)(const float* x, const float* y, float* r, int n);

struct math_function {
    const char* name;
    array_function vectors, scalars;
};

struct math_function_list {
    const math_function *first, *last;
    const math_function* begin() const { return first; }
    const math_function* end() const { return last; }
};

struct math_bound {
    const char* name;
    double (*exact)(double);
    double ulp;   // most units in the last place
    float domain; // where the bound holds: |x| up to here; NaN beyond
};
inline constexpr math_bound math_bounds[] = {
    {"exp", [](double x) { return std::exp(x); }, 1.0, std::numeric_limits<float>::infinity()},
    {"exp2", [](double x) { return std::exp2(x); }, 1.25, std::numeric_limits<float>::infinity()},
    {"log", [](double x) { return std::log(x); }, 1.0, std::numeric_limits<float>::infinity()},
    {"log2", [](double x) { return std::log2(x); }, 1.5, std::numeric_limits<float>::infinity()},
    {"sin", [](double x) { return std::sin(x); }, 1.0, 100000.0F},
    {"cos", [](double x) { return std::cos(x); }, 1.0, 100000.0F},
};
inline constexpr double pow_bound = 1.25;
inline constexpr double atan2_bound = 2.0;

/// Distance from the exact value in units in the last place of the exact one; infinity where only one of them
/// is a NaN. An infinite result counts as 2^128.
inline double ulp_error(float got, double exact) {
    if (std::isnan(got) || std::isnan(exact))
        return std::isnan(got) && std::isnan(exact) ? 0 : std::numeric_limits<double>::infinity();
    auto finite = [](double v) { return std::clamp(v, -0x1p128, 0x1p128); };
    double e = finite(exact);
    int exponent = e == 0 ? -126 : std::clamp(std::ilogb(e), -126, 127);
    return std::abs(finite(static_cast<double>(got)) - e) / std::ldexp(1.0, exponent - 23);
}

} // namespace isa_test
