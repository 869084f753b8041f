// Noise: 0 or 1 cycle a line that an L1 asks for, half of them late, by seed and nothing else.
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <cmath>

namespace sim::test {
namespace {

constexpr int lines = 20000;

/// Each load waits for the one before it, and all but the first `lines` find their line in the L2 alone.
Report chase(integer seed) {
    Config c = simple();
    c.sim.jitter = seed;
    c.l2.size_bytes = integer{1} << 22;
    c.l1.size_bytes = 4096;
    return run_on(c, [](std::byte* p, int) {
        stamp s;
        for (int round = 0; round < 2; ++round)
            for (int i = 0; i < lines; ++i)
                s = load(here, p + i * 64, 4, s);
    });
}

TEST(Jitter, AddsHalfACycleALine) {
    const Report quiet = chase(0);
    EXPECT_EQ(quiet.jitter.lines, 0U);
    EXPECT_EQ(quiet.jitter.cycles, 0U);
    std::uint64_t last = 0;
    for (integer seed : {1, 2, 3, 2147483647}) {
        const Report r = chase(seed);
        EXPECT_EQ(r.l1_total().misses, u(2 * lines));
        EXPECT_EQ(r.jitter.lines, u(2 * lines));
        // Five standard deviations of so many fair coins.
        EXPECT_NEAR(static_cast<double>(r.jitter.cycles), lines, 5 * 0.5 * std::sqrt(2.0 * lines)) << seed;
        EXPECT_NE(r.jitter.cycles, last);
        last = r.jitter.cycles;
    }
}

// Lines that the L2 holds: a chain is longer by exactly what was added.
TEST(Jitter, AChainIsLongerByWhatWasAdded) {
    const auto found_in_l2 = [](integer seed) {
        Config c = simple();
        c.sim.jitter = seed;
        c.l1.size_bytes = 4096;
        std::uint64_t added = 0;
        cycle begin = 0, end = 0;
        const Report r = run_on(c, [&](std::byte* p, int) {
            stamp s;
            for (int i = 0; i < 1000; ++i)
                s = load(here, p + i * 64, 4, s);
            begin = when(s);
            added = running_hart->tile->jitters.front().cycles();
            for (int i = 0; i < 1000; ++i)
                s = load(here, p + i * 64, 4, s);
            end = when(s);
            added = running_hart->tile->jitters.front().cycles() - added;
        });
        EXPECT_EQ(r.l2_total().misses, 1000U);
        return std::pair(end - begin, added);
    };
    const auto [quiet, none] = found_in_l2(0);
    EXPECT_EQ(none, 0U);
    for (integer seed : {1, 5, 77}) {
        const auto [noisy, added] = found_in_l2(seed);
        EXPECT_GT(added, 400U);
        EXPECT_EQ(noisy, quiet + added);
    }
}

TEST(Jitter, HostThreadsAndRunsChangeNothing) {
    const auto mixed = [](integer seed, int host_threads) {
        Config c;
        c.chip.tiles = 3;
        c.chip.cores = 2;
        c.sim.jitter = seed;
        Memory memory;
        Report r = Machine(c).run(
            memory.space, 12, {{"work"}},
            [&](int w) {
                mixed_work(reinterpret_cast<std::int32_t*>(memory.more),
                           reinterpret_cast<word*>(memory.data) + 16 * w, w, 40);
            },
            host_threads);
        EXPECT_EQ(r.config.sim.jitter, seed);
        return r;
    };
    const Report serial = mixed(9, 1);
    for (int host_threads : {1, 2, 3})
        EXPECT_EQ(print_json(mixed(9, host_threads), false), print_json(serial, false)) << host_threads;
    const Report other = mixed(10, 1), quiet = mixed(0, 1);
    EXPECT_NE(other.cycles, serial.cycles);
    EXPECT_NE(quiet.cycles, serial.cycles);
    EXPECT_EQ(other.core.vops, serial.core.vops);
    EXPECT_EQ(quiet.core.vops, serial.core.vops);
}

TEST(Jitter, OneThatWasNotNotedBreaksALaw) {
    Report r = chase(4);
    --r.jitter.lines;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r.jitter = {u(2 * lines), u(2 * lines) + 1};
    EXPECT_THROW(check_laws(r), std::logic_error);
}

} // namespace
} // namespace sim::test
