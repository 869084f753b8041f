// Elementary functions: within their bounds on a sample of all floats, special values, and the same bits on
// every target that fuses, for vectors as for scalars.
#include "math_targets.h"

#include "isa/cpu.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace isa_test {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class Math : public testing::TestWithParam<math_target> {
protected:
    void SetUp() override {
        if (!isa::cpu_runs(GetParam().name))
            GTEST_SKIP() << "this processor does not run " << GetParam().name;
    }
    static const math_function& function(const math_target& t, const std::string& name) {
        for (const math_function& f : t.functions())
            if (name == f.name)
                return f;
        throw std::runtime_error("no function " + name);
    }
    float call(const std::string& name, float x, float y = 0) const {
        std::vector<float> xs(64, x), ys(64, y), r(64), s(64);
        function(GetParam(), name).vectors(xs.data(), ys.data(), r.data(), 64);
        function(GetParam(), name).scalars(xs.data(), ys.data(), s.data(), 64);
        bool both_nan = std::isnan(r[0]) && std::isnan(s[0]); // whose payload and sign are unspecified
        EXPECT_TRUE(both_nan || std::memcmp(&r[0], &s[0], 4) == 0) << name << " " << x;
        return r[0];
    }
};

std::vector<float> sample_of_all_floats(std::size_t n) {
    std::vector<float> x(n);
    std::uint32_t bits = 0;
    for (float& v : x) {
        v = std::bit_cast<float>(bits);
        bits += 16381U * 7U;
    }
    return x;
}

TEST_P(Math, WithinBounds) {
    std::vector<float> x = sample_of_all_floats(40960), y(x.size()), r(x.size());
    for (const math_bound& b : math_bounds) {
        function(GetParam(), b.name).vectors(x.data(), y.data(), r.data(), static_cast<int>(x.size()));
        for (std::size_t i = 0; i < x.size(); ++i) {
            double exact = std::abs(x[i]) <= b.domain ? b.exact(static_cast<double>(x[i])) : std::nan("");
            ASSERT_LE(ulp_error(r[i], exact), b.ulp) << b.name << "(" << x[i] << ") = " << r[i];
        }
    }
}

TEST_P(Math, PowWithinBound) {
    std::mt19937 random(1);
    std::vector<float> x(40960), y(x.size()), r(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = std::bit_cast<float>(static_cast<std::uint32_t>(random() & 0x7fffffffU));
        double log2_x = std::log2(static_cast<double>(x[i]));
        double result = static_cast<double>(static_cast<std::int32_t>(random())) / 0x1p31 * 150; // log2 of it
        y[i] = static_cast<float>(result / log2_x);
    }
    function(GetParam(), "pow").vectors(x.data(), y.data(), r.data(), static_cast<int>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
        double exact = std::pow(static_cast<double>(x[i]), static_cast<double>(y[i]));
        ASSERT_LE(ulp_error(r[i], exact), pow_bound) << "pow(" << x[i] << ", " << y[i] << ") = " << r[i];
    }
}

// In all quadrants, of all sizes, and next to the axes and diagonals.
TEST_P(Math, Atan2WithinBound) {
    std::mt19937 random(1);
    std::vector<float> x(40960), y(x.size()), r(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double angle = static_cast<double>(random()) / 0x1p32 * 6.283185307179586;
        const double size = std::ldexp(1.0, static_cast<int>(random() % 240) - 120);
        const double aside = i % 4 == 0 ? std::ldexp(1.0, -static_cast<int>(random() % 100)) : 1;
        x[i] = static_cast<float>(size * std::cos(angle));
        y[i] = static_cast<float>(size * std::sin(angle) * aside);
        if (i % 16 == 3)
            y[i] = std::nextafter(x[i], i % 32 == 3 ? inf : 0);
    }
    function(GetParam(), "atan2").vectors(y.data(), x.data(), r.data(), static_cast<int>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double exact = std::atan2(static_cast<double>(y[i]), static_cast<double>(x[i]));
        ASSERT_LE(ulp_error(r[i], exact), atan2_bound) << "atan2(" << y[i] << ", " << x[i] << ") = " << r[i];
    }
}

TEST_P(Math, SameBitsAsPlain) {
    if (std::string(GetParam().name) == "sse4")
        GTEST_SKIP() << "sse4 rounds fused operations twice";
    std::vector<float> x = sample_of_all_floats(40960), y(x.rbegin(), x.rend()), r(x.size()), s(x.size()), p(x.size());
    for (const math_function& f : plain::math_functions()) {
        f.vectors(x.data(), y.data(), p.data(), static_cast<int>(x.size()));
        function(GetParam(), f.name).vectors(x.data(), y.data(), r.data(), static_cast<int>(x.size()));
        function(GetParam(), f.name).scalars(x.data(), y.data(), s.data(), static_cast<int>(x.size()));
        for (std::size_t i = 0; i < x.size(); ++i) {
            ASSERT_TRUE((std::isnan(r[i]) && std::isnan(p[i])) || std::memcmp(&r[i], &p[i], 4) == 0)
                << f.name << " " << x[i];
            ASSERT_TRUE((std::isnan(s[i]) && std::isnan(p[i])) || std::memcmp(&s[i], &p[i], 4) == 0)
                << f.name << " " << x[i];
        }
    }
}

TEST_P(Math, SpecialValues) {
    EXPECT_EQ(call("exp", 0.0F), 1.0F);
    EXPECT_EQ(call("exp", -inf), 0.0F);
    EXPECT_EQ(call("exp", inf), inf);
    EXPECT_EQ(call("exp", 1e30F), inf);
    EXPECT_TRUE(std::isnan(call("exp", nan)));
    EXPECT_EQ(call("exp2", -149.0F), 0x1p-149F);
    EXPECT_EQ(call("exp2", 127.0F), 0x1p127F);
    EXPECT_EQ(call("exp2", 128.0F), inf);
    EXPECT_EQ(call("exp2", -inf), 0.0F);
    EXPECT_TRUE(std::isnan(call("exp2", nan)));
    for (const char* name : {"log", "log2"}) {
        EXPECT_EQ(call(name, 1.0F), 0.0F);
        EXPECT_EQ(call(name, 0.0F), -inf);
        EXPECT_EQ(call(name, -0.0F), -inf);
        EXPECT_EQ(call(name, inf), inf);
        EXPECT_TRUE(std::isnan(call(name, -1.0F)));
        EXPECT_TRUE(std::isnan(call(name, -inf)));
        EXPECT_TRUE(std::isnan(call(name, nan)));
    }
    for (int k = -149; k < 128; ++k)
        EXPECT_EQ(call("log2", std::ldexp(1.0F, k)), static_cast<float>(k));
    for (const char* name : {"sin", "cos"})
        for (float x : {inf, -inf, nan, 100001.0F, -1e9F, std::numeric_limits<float>::max()})
            EXPECT_TRUE(std::isnan(call(name, x))) << x;
    EXPECT_TRUE(std::signbit(call("sin", -0.0F)));
    EXPECT_EQ(call("sin", 0x1p-149F), 0x1p-149F);
    EXPECT_EQ(call("cos", -0.0F), 1.0F);
    for (float x : {0.0F, -0.0F, 0x1p-149F, 1.0F, 2.5F, inf}) {
        EXPECT_EQ(call("pow", x, 0.0F), 1.0F);
        EXPECT_EQ(call("pow", x, -0.0F), 1.0F);
    }
    for (float y : {0.5F, -3.0F, inf, -inf, nan})
        EXPECT_EQ(call("pow", 1.0F, y), 1.0F);
    EXPECT_EQ(call("pow", nan, 0.0F), 1.0F);
    EXPECT_EQ(call("pow", 0.0F, 2.0F), 0.0F);
    EXPECT_EQ(call("pow", 0.0F, -2.0F), inf);
    EXPECT_EQ(call("pow", inf, 2.0F), inf);
    EXPECT_EQ(call("pow", inf, -2.0F), 0.0F);
    EXPECT_EQ(call("pow", 2.0F, inf), inf);
    EXPECT_EQ(call("pow", 0.5F, inf), 0.0F);
    EXPECT_EQ(call("pow", 2.0F, 1e30F), inf);
    EXPECT_TRUE(std::isnan(call("pow", -1.0F, 2.0F)));
    EXPECT_TRUE(std::isnan(call("pow", nan, 2.0F)));
    EXPECT_TRUE(std::isnan(call("pow", 2.0F, nan)));
    for (const float x : {0.0F, -0.0F, 1.0F, -1.0F, inf, -inf})
        for (const float y : {0.0F, -0.0F, 1.0F, -1.0F, inf, -inf}) {
            const float angle = call("atan2", y, x);
            if (std::isinf(x) && std::isinf(y)) {
                EXPECT_TRUE(std::isnan(angle));
                continue;
            }
            EXPECT_NEAR(angle, std::atan2(y, x), 2.4e-7F) << y << ' ' << x;
            EXPECT_EQ(std::signbit(angle), std::signbit(y)) << y << ' ' << x;
        }
    EXPECT_TRUE(std::isnan(call("atan2", nan, 1.0F)));
    EXPECT_TRUE(std::isnan(call("atan2", 1.0F, nan)));
}

INSTANTIATE_TEST_SUITE_P(Targets, Math, testing::ValuesIn(math_targets), [](const auto& p) { return p.param.name; });

} // namespace
} // namespace isa_test
