// Intervals: closed forms of what lies in which, sums that are the run's, and nothing that hangs on the host.
#include "sim/machine/intervals.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <nlohmann/json.hpp>

namespace sim::test {
namespace {

Report run_with(const Config& c, std::uint64_t interval, const std::function<void(std::byte*, int)>& worker,
                int workers = 1, int host_threads = 1) {
    Memory memory;
    return Machine(c).run(memory.space, workers, {{"work"}}, [&](int w) { worker(memory.data, w); },
                          host_threads, {.interval = interval});
}
std::uint64_t part(const Interval& i, Cause c) {
    return i.stack[static_cast<std::size_t>(c)];
}

// An addition a cycle: every interval holds as many as cycles, the last one what is left.
TEST(Intervals, HoldTheOperationsOfTheirCycles) {
    Config c = simple();
    c.core.window = 1; // operations count when their operands are there
    c.sim.window = 50;
    const Report r = run_with(c, 120, [](std::byte*, int) { // rounded up to 150
        stamp s;
        for (int i = 0; i < 1000; ++i)
            s = scalar_op(operation::integer, s);
    });
    EXPECT_EQ(r.interval, 150U);
    EXPECT_EQ(r.cycles, 1000U);
    ASSERT_EQ(r.intervals.size(), 8U); // 6 x 150, 100, and what comes after
    for (std::size_t i = 0; i < 7; ++i) {
        const Interval& row = r.intervals[i];
        EXPECT_EQ(row.begin, 150 * i);
        EXPECT_EQ(row.end, std::min<cycle>(150 * (i + 1), 1000));
        EXPECT_EQ(row.vops, row.end - row.begin);
        EXPECT_EQ(row.instructions, row.end - row.begin);
        EXPECT_EQ(part(row, Cause::busy), row.end - row.begin);
    }
    EXPECT_EQ(r.intervals[7].vops, 0U);
    EXPECT_EQ(r.intervals[7].end, r.drained);
}

// One wait of many intervals: each has its own part of it, whenever its cause became known.
TEST(Intervals, HoldTheirPartOfALongWait) {
    Config c = simple();
    c.sim.window = 100;
    c.latency[static_cast<std::size_t>(operation::divide)] = 1234;
    const Report r = run_with(c, 100, [](std::byte*, int) {
        stamp s = scalar_op(operation::divide, stamp{});
        for (int i = 0; i < 16; ++i)
            s = scalar_op(operation::integer, s);
    });
    EXPECT_EQ(r.cycles, 1250U);
    ASSERT_EQ(r.intervals.size(), 14U);
    EXPECT_EQ(part(r.intervals[0], Cause::busy), 1U);
    EXPECT_EQ(part(r.intervals[0], Cause::compute), 99U);
    for (std::size_t i = 1; i < 12; ++i)
        EXPECT_EQ(part(r.intervals[i], Cause::compute), 100U) << i;
    EXPECT_EQ(part(r.intervals[12], Cause::compute), 34U);
    EXPECT_EQ(part(r.intervals[12], Cause::busy), 16U);
}

// A thread that waits for a word looks at it all the time, not when it wakes.
TEST(Intervals, HoldTheLooksOfTheirTime) {
    Config c = simple();
    c.chip.cores = 2;
    c.sim.window = 100;
    c.core.spin_period = 10;
    const Report r = run_with(
        c, 1000,
        [](std::byte* p, int w) {
            auto* words = reinterpret_cast<word*>(p);
            if (w == 0)
                release_after(words, 10000);
            else
                sim::test::await(words);
        },
        2);
    EXPECT_GT(r.core.spins, 990U);
    // 1000 cycles of work, four a sfloat addition, and 100 looks of two instructions.
    for (std::size_t i = 1; i < 9; ++i)
        EXPECT_NEAR(static_cast<double>(r.intervals[i].instructions), 250 + 200, 30) << i;
}

Report mixed(std::uint64_t interval, int host_threads, integer window = 0, integer quantum = 1) {
    Config c;
    c.chip.tiles = 3;
    c.chip.cores = 2;
    c.sim.window = window;
    c.sim.quantum = quantum;
    c.l1.size_bytes = 2048;
    return run_with(
        c, interval,
        [](std::byte* p, int w) {
            mixed_work(reinterpret_cast<std::int32_t*>(p + (1 << 20)), reinterpret_cast<word*>(p), w,
                       30 + 10 * w);
        },
        12, host_threads);
}

// The laws are checked by every run (check_intervals); here for intervals of every kind.
TEST(Intervals, SumToTheRunAndChangeNothing) {
    for (integer window : {0, 1000})
        for (integer quantum : {1, 100, 10000}) {
            const Report plain = mixed(0, 1, window, quantum);
            for (std::uint64_t interval : {1U, 777U, 5000U, 1000000000U}) {
                Report r = mixed(interval, 1, window, quantum);
                EXPECT_EQ(r.intervals.size() > 3, interval <= 5000) << interval;
                r.interval = 0;
                r.intervals.clear();
                EXPECT_EQ(print_json(r, false), print_json(plain, false));
            }
        }
}

TEST(Intervals, DoNotHangOnHostThreads) {
    const std::string serial = print_intervals(mixed(500, 1));
    EXPECT_GT(std::count(serial.begin(), serial.end(), '\n'), 10);
    EXPECT_EQ(print_intervals(mixed(500, 2)), serial);
    EXPECT_EQ(print_intervals(mixed(500, 3)), serial);
}

TEST(Intervals, ALawFindsWhatIsLost) {
    const Report whole = mixed(500, 1);
    check_laws(whole);
    ASSERT_GT(whole.intervals.size(), 4U);
    for (const auto& c : interval_counters) {
        Report r = whole;
        ++(r.intervals[2].*c.count);
        EXPECT_THROW(check_laws(r), std::logic_error) << c.name;
    }
    Report r = whole;
    ++r.intervals[1].stack[0];
    EXPECT_THROW(check_laws(r), std::logic_error);
    --r.intervals[2].stack[0];
    EXPECT_THROW(check_laws(r), std::logic_error) << "sums are right, intervals are not";
    r = whole;
    r.intervals.erase(r.intervals.begin() + 1);
    EXPECT_THROW(check_laws(r), std::logic_error);
}

} // namespace
} // namespace sim::test
