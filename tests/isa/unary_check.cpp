// unary_check [STRIDE [NAME]]: every operation of one operand over all 2^32 operands (or every STRIDE-th), on all
// targets that this processor runs, beside `plain`, bit for bit; NaN equals NaN where an operation computes. NAME: of
// that operation alone. On all processors. Exits with 1 where one differs.
#include "operations.h"
#include "targets.h"

#include "isa/cpu.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#define ISA_TEST_DECLARE(target)                                                                                       \
    namespace isa_test::target {                                                                                       \
    operation_list operations();                                                                                       \
    }
ISA_TEST_TARGETS(ISA_TEST_DECLARE)

namespace {

using namespace isa_test;

struct target {
    const char* name;
    operation_list (*operations)();
};
#define ISA_TEST_ENTRY(name) target{#name, &name::operations},
constexpr target targets[] = {ISA_TEST_TARGETS(ISA_TEST_ENTRY)};

/// Of those that take floats all but what joins lanes or takes none; of those that take two integers, those that use
/// one.
bool is_unary(const operation& o) {
    static const std::set<std::string_view> not_of_one{"reduce_add", "reduce_min", "reduce_max", "vfloat(constant)"};
    static const std::set<std::string_view> of_one_integer{"i << 0",
                                                           "i << 7",
                                                           "i << 31",
                                                           "i >> 0",
                                                           "i >> 7",
                                                           "i >> 31",
                                                           "shift_right_logical 0",
                                                           "shift_right_logical 7",
                                                           "shift_right_logical 31",
                                                           "to_float",
                                                           "as_float",
                                                           "vint(scalar)",
                                                           "first_lanes",
                                                           "scalar -i",
                                                           "scalar ++i",
                                                           "scalar --i",
                                                           "scalar to_float",
                                                           "scalar as_float"};
    if (o.takes == shape::floats_1)
        return !not_of_one.contains(o.name);
    return o.takes == shape::integers_2 && of_one_integer.contains(o.name);
}

/// Whether it looks at lane 0 alone.
bool takes_lane_0(std::string_view name) { return name == "first_lanes" || name.ends_with("(scalar)"); }

bool same(kind is, std::uint32_t a, std::uint32_t b) {
    return a == b || (is == kind::floats && std::isnan(std::bit_cast<float>(a)) && std::isnan(std::bit_cast<float>(b)));
}

/// One operation, as `plain` and as the targets that this processor runs have it.
struct subject {
    const operation* oracle;
    int width;
    std::vector<const operation*> tested;
};

struct difference {
    std::size_t target;
    std::uint32_t operand, got, expected;
};
using differences = std::vector<difference>; // the first of each target

bool has(const differences& found, std::size_t target) {
    return std::any_of(found.begin(), found.end(), [&](const difference& one) { return one.target == target; });
}

/// Of the operands begin, begin + stride and so on, below end.
differences scan(const subject& s, std::uint64_t begin, std::uint64_t end, std::uint64_t stride) {
    differences found;
    operands x{};
    result got{}, expected{};
    const int lanes = takes_lane_0(s.oracle->name) ? 1 : s.width;
    for (std::uint64_t next = begin; next < end;) {
        const std::uint64_t first = next;
        for (int lane = 0; lane < lanes; ++lane, next += stride) {
            const auto bits = static_cast<std::uint32_t>(next);
            x.a[lane] = std::bit_cast<float>(bits);
            x.i[lane] = static_cast<std::int32_t>(bits);
        }
        s.oracle->run(x, expected);
        for (std::size_t t = 0; t < s.tested.size(); ++t) {
            s.tested[t]->run(x, got);
            const auto count = static_cast<std::size_t>(expected.count);
            if (got.count == expected.count && std::memcmp(got.word, expected.word, count * sizeof got.word[0]) == 0)
                continue;
            for (int lane = 0; lane < expected.count; ++lane)
                if (got.count != expected.count || !same(expected.is, got.word[lane], expected.word[lane])) {
                    if (!has(found, t))
                        found.push_back(
                            {t, static_cast<std::uint32_t>(first + stride * static_cast<std::uint64_t>(lane % lanes)),
                             got.word[lane], expected.word[lane]});
                    break;
                }
        }
    }
    return found;
}

differences scan_all(const subject& s, std::uint64_t stride) {
    const std::uint64_t count = std::max(1U, std::thread::hardware_concurrency()), all = 1ULL << 32;
    std::vector<differences> parts(count);
    std::vector<std::thread> threads;
    const std::uint64_t part = (all / count / stride + 1) * stride;
    for (std::uint64_t t = 0; t < count; ++t)
        threads.emplace_back([&, t] { parts[t] = scan(s, t * part, std::min(all, (t + 1) * part), stride); });
    for (std::thread& thread : threads)
        thread.join();
    differences found;
    for (const differences& one : parts)
        for (const difference& d : one)
            if (!has(found, d.target))
                found.push_back(d);
    return found;
}

} // namespace

int main(int argc, char** argv) {
    const std::uint64_t stride = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
    const std::string_view wanted = argc > 2 ? argv[2] : "";
    const operation_list oracle = plain::operations();
    std::vector<const target*> present;
    for (const target& t : targets)
        if (std::string_view(t.name) != "plain" && std::string_view(t.name) != "simulated" && isa::cpu_runs(t.name))
            present.push_back(&t);
    std::size_t failed = 0, compared = 0;
    for (int i = 0; stride != 0 && i < oracle.count; ++i) {
        const operation& expected = oracle.begin[i];
        if (!is_unary(expected) || (!wanted.empty() && wanted != expected.name))
            continue;
        std::printf("%-24s", expected.name);
        std::fflush(stdout);
        subject s{&expected, oracle.width, {}};
        for (const target* t : present)
            s.tested.push_back(&t->operations().begin[i]);
        const auto begin = std::chrono::steady_clock::now();
        const differences found = scan_all(s, stride);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        for (std::size_t t = 0; t < present.size(); ++t)
            if (!has(found, t))
                std::printf(" %s", present[t]->name);
        std::printf(": %.1f s\n", seconds.count());
        for (const difference& d : found)
            std::printf("  %s: of %08x %08x, not %08x\n", present[d.target]->name, d.operand, d.got, d.expected);
        compared += present.size();
        failed += found.size();
    }
    if (compared == 0) {
        std::fprintf(stderr, "usage: unary_check [STRIDE [NAME]], STRIDE from 1 on and NAME one of the operations'\n");
        return 2;
    }
    std::printf("%zu comparisons over %llu operands, %zu differ\n", compared,
                static_cast<unsigned long long>(((1ULL << 32) - 1) / stride + 1), failed);
    return failed == 0 ? 0 : 1;
}
