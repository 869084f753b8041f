// Every operation, on every target this processor runs, equals `plain` bit for bit. One program a logical
// width.
#include "operations.h"
#include "targets.h"

#include "isa/cpu.h"

#include <gtest/gtest.h>

#include <sys/mman.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#define ISA_TEST_DECLARE(target)                                                                                       \
    namespace isa_test::target {                                                                                       \
    operation_list operations();                                                                                       \
    }
ISA_TEST_TARGETS(ISA_TEST_DECLARE)

namespace isa_test {
namespace {

struct target {
    const char* name;
    operation_list (*operations)();
};
#define ISA_TEST_ENTRY(name) target{#name, &name::operations},
constexpr target targets[] = {ISA_TEST_TARGETS(ISA_TEST_ENTRY)};

std::mt19937 random_bits(12345);

const std::uint32_t special_floats[] = {
    0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000, 0x80800000, 0x3f800000, 0xbf800000,
    0x3f800001, 0x3f7fffff, 0x3f000000, 0xbf000000, 0x3fc00000, 0xbfc00000, 0x40200000, 0x3fb504f3, 0x3eaaaaab,
    0x4b000000, 0x4b000001, 0xcaffffff, 0x4effffff, 0x4f000000, 0xcf000000, 0xcf000001, 0x5f000000, 0x7f7fffff,
    0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345, 0x7f800001, 0x1f800000, 0x0f000000,
};
const std::int32_t special_integers[] = {
    0,
    1,
    -1,
    2,
    7,
    31,
    32,
    33,
    63,
    64,
    65,
    100,
    -2,
    -31,
    -32,
    0x7fffffff,
    -0x7fffffff - 1,
    -0x7fffffff,
    0x55555555,
    0x1000001,
    16777217,
    -16777219,
    0x7fffffc0,
    12345678,
};

/// Runs one case on both targets and compares. NaN equals NaN; sse4 rounds fused operations twice.
class comparison {
public:
    comparison(const target& t, const operation& tested, const operation& oracle, int width)
        : t_(t), tested_(tested), oracle_(oracle), width_(width) {}

    void operator()(const operands& x) {
        result got{}, expected{};
        tested_.run(x, got);
        oracle_.run(x, expected);
        ASSERT_EQ(got.count, expected.count);
        if (tested_.sign != 0 && std::string(t_.name) == "sse4")
            unfused(x, expected);
        for (int lane = 0; lane < got.count; ++lane) {
            if (got.word[lane] == expected.word[lane])
                continue;
            if (got.is == kind::floats && std::isnan(std::bit_cast<float>(got.word[lane])) &&
                std::isnan(std::bit_cast<float>(expected.word[lane])))
                continue;
            int in = lane % width_;
            FAIL() << t_.name << ", width " << width_ << ", " << tested_.name << ", lane " << lane << ": " << std::hex
                   << got.word[lane] << ", not " << expected.word[lane] << "; a "
                   << std::bit_cast<std::uint32_t>(x.a[in]) << " b " << std::bit_cast<std::uint32_t>(x.b[in]) << " c "
                   << std::bit_cast<std::uint32_t>(x.c[in]) << " i " << x.i[in] << " j " << x.j[in] << " m " << x.m[in];
        }
    }

private:
    /// The stated meaning on sse4: the product rounded, then the sum rounded. Within half a unit in the last
    /// place of the product of what is rounded once.
    void unfused(const operands& x, result& r) const {
        for (int lane = 0; lane < r.count; ++lane) {
            float product = x.a[lane] * x.b[lane];
            float c = tested_.sign_c < 0 ? -x.c[lane] : x.c[lane];
            float twice = tested_.sign < 0 ? c - product : product + c;
            float once = std::bit_cast<float>(r.word[lane]);
            if (std::isfinite(once) && std::isfinite(twice)) {
                double ulp_product = std::ldexp(1.0, std::max(std::ilogb(product), -126) - 23);
                double ulp_result = std::ldexp(1.0, std::max({std::ilogb(once), std::ilogb(twice), -126}) - 23);
                double bound = (product == 0 ? 0x1p-150 : 0.5 * ulp_product) + ulp_result;
                EXPECT_LE(std::abs(static_cast<double>(once) - static_cast<double>(twice)), bound);
            }
            r.word[lane] = std::bit_cast<std::uint32_t>(twice);
        }
    }

    const target& t_;
    const operation& tested_;
    const operation& oracle_;
    int width_;
};

float any_float() { return std::bit_cast<float>(static_cast<std::uint32_t>(random_bits())); }
/// Magnitudes near each other, so that sums cancel and roundings meet.
float moderate_float() {
    return std::ldexp(static_cast<float>(static_cast<std::int32_t>(random_bits())), -31 + int(random_bits() % 8));
}

void fill_random(operands& x, bool moderate) {
    for (int lane = 0; lane < room; ++lane) {
        x.a[lane] = moderate ? moderate_float() : any_float();
        x.b[lane] = moderate ? moderate_float() : any_float();
        x.c[lane] = moderate ? moderate_float() : any_float();
        x.i[lane] = static_cast<std::int32_t>(random_bits());
        x.j[lane] = static_cast<std::int32_t>(random_bits());
        x.m[lane] = static_cast<std::int32_t>(random_bits() & 1U);
        x.n[lane] = static_cast<std::int32_t>(random_bits() & 1U);
    }
}
void set_mask(std::int32_t (&m)[room], std::uint64_t bits) {
    for (int lane = 0; lane < most_lanes; ++lane)
        m[lane] = static_cast<std::int32_t>(bits >> lane & 1U);
}

/// All tuples of n numbers below `count`, one a lane, the lanes of a call beginning with another tuple each
/// time.
template <class F> void tuples(int count, int n, int width, operands& x, comparison& check, F set) {
    int total = 1;
    for (int k = 0; k < n; ++k)
        total *= count;
    // What spreads a scalar looks at lane 0 only: small sets go through it one by one, large ones a stride apart.
    int step = total > 5000 ? width : 1;
    for (int start = 0; start < total; start += step) {
        for (int lane = 0; lane < width; ++lane)
            set(x, lane, (start + lane) % total);
        check(x);
        if (testing::Test::HasFatalFailure())
            return;
    }
}

void run_specials(const operation& o, int width, comparison& check) {
    operands x{};
    fill_random(x, false);
    constexpr int floats = std::size(special_floats), integers = std::size(special_integers);
    auto special = [](int n) { return std::bit_cast<float>(special_floats[n % floats]); };
    if (o.takes == shape::floats_1)
        tuples(floats, 1, width, x, check, [&](operands& y, int lane, int n) { y.a[lane] = special(n); });
    if (o.takes == shape::floats_2)
        tuples(floats, 2, width, x, check, [&](operands& y, int lane, int n) {
            y.a[lane] = special(n);
            y.b[lane] = special(n / floats);
        });
    if (o.takes == shape::floats_3)
        tuples(floats, 3, width, x, check, [&](operands& y, int lane, int n) {
            y.a[lane] = special(n);
            y.b[lane] = special(n / floats);
            y.c[lane] = special(n / floats / floats);
        });
    if (o.takes == shape::integers_2)
        tuples(integers, 2, width, x, check, [&](operands& y, int lane, int n) {
            y.i[lane] = special_integers[n % integers];
            y.j[lane] = special_integers[n / integers];
        });
}

void run_masks(const operation& o, int width, comparison& check) {
    operands x{};
    fill_random(x, false);
    auto with = [&](std::uint64_t m, std::uint64_t n) {
        set_mask(x.m, m);
        set_mask(x.n, n);
        check(x);
        return !testing::Test::HasFatalFailure();
    };
    if (o.takes == shape::masks && width == 8) { // every pair
        for (std::uint64_t pair = 0; pair < 65536; ++pair)
            if (!with(pair & 255U, pair >> 8U))
                return;
    } else if (width <= 16) { // every pattern
        for (std::uint64_t m = 0; m < 1ULL << width; m += o.takes == shape::masks || width == 8 ? 1 : 7)
            if (!with(m, m * 0x9e3779b97f4a7c15ULL >> 40U))
                return;
    } else {
        for (int lane = 0; lane < width; ++lane)
            for (std::uint64_t run : {1ULL, 3ULL, 0xffULL, 0xffffULL, ~0ULL})
                if (!with(run << lane, ~(run << lane)) || !with(~(run << lane), ~0ULL >> (63 - lane)))
                    return;
        with(0, ~0ULL);
        with(~0ULL, 0);
    }
}

class Operations : public testing::TestWithParam<target> {};

TEST_P(Operations, EqualPlain) {
    const target& t = GetParam();
    if (!isa::cpu_runs(t.name))
        GTEST_SKIP() << "this processor does not run " << t.name;
    operation_list tested = t.operations(), oracle = plain::operations();
    ASSERT_EQ(tested.count, oracle.count);
    for (int k = 0; k < tested.count; ++k) {
        const operation& o = tested.begin[k];
        ASSERT_STREQ(o.name, oracle.begin[k].name);
        comparison check(t, o, oracle.begin[k], tested.width);
        operands x{};
        for (int round = 0; round < 1000; ++round) {
            fill_random(x, round % 2 == 1);
            check(x);
            if (HasFatalFailure())
                return;
        }
        run_specials(o, tested.width, check);
        if (o.takes == shape::masks || o.takes == shape::mixed)
            run_masks(o, tested.width, check);
        if (HasFatalFailure())
            return;
    }
}

/// One page that may be touched between two that may not.
class guarded_page {
public:
    guarded_page() : all_(mmap(nullptr, 3 * size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
        mprotect(begin(), size, PROT_READ | PROT_WRITE);
    }
    guarded_page(const guarded_page&) = delete;
    guarded_page& operator=(const guarded_page&) = delete;
    ~guarded_page() { munmap(all_, 3 * size); }
    float* begin() const { return reinterpret_cast<float*>(static_cast<char*>(all_) + size); }
    float* end() const { return begin() + size / sizeof(float); }

private:
    static constexpr std::size_t size = 4096;
    void* all_;
};

TEST_P(Operations, MaskedOffLanesAreNotTouched) {
    const target& t = GetParam();
    if (!isa::cpu_runs(t.name))
        GTEST_SKIP() << "this processor does not run " << t.name;
    operation_list o = t.operations();
    guarded_page page;
    for (float* p = page.begin(); p != page.end(); ++p)
        *p = 1.0F + static_cast<float>(p - page.begin());
    operands x{};
    for (int lane = 0; lane < o.width; ++lane)
        x.b[lane] = -1.0F - static_cast<float>(lane);
    for (int round = 0; round < 4096; ++round) {
        std::uint64_t bits =
            round < 256 ? static_cast<std::uint64_t>(round) : random_bits() | std::uint64_t{random_bits()} << 32U;
        if (o.width < 64)
            bits &= (1ULL << o.width) - 1;
        if (bits == 0)
            continue;
        set_mask(x.m, bits);
        int lowest = std::countr_zero(bits), highest = 63 - std::countl_zero(bits);
        for (float* p : {page.begin() - lowest, page.end() - highest - 1}) { // the other lanes lie beyond the page
            o.masked_load(p, x.m, x.a);
            for (int lane = 0; lane < o.width; ++lane)
                ASSERT_EQ(x.a[lane], x.m[lane] != 0 ? p[lane] : 0.0F) << t.name;
            o.masked_store(p, x.m, x.b);
            for (int lane = lowest; lane <= highest; ++lane) {
                ASSERT_EQ(p[lane], x.m[lane] != 0 ? x.b[lane] : 1.0F + static_cast<float>(p + lane - page.begin()));
                p[lane] = 1.0F + static_cast<float>(p + lane - page.begin());
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Operations, testing::ValuesIn(targets), [](const auto& p) { return p.param.name; });

} // namespace
} // namespace isa_test
