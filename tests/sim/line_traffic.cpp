// Lines of memory in closed form: figures worked out by hand for a seed of one cache of 1024 lines.
#include "sim/estimate/line_traffic.h"
#include "sim/config/machine_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim::test {
namespace {

/// `tiles` of one core, whose last cache holds 1024 lines, and of two threads.
Config machine_of(int tiles) {
    return parse_machine("[chip]\ncores = 1\nthreads = 2\ntiles = " + std::to_string(tiles) +
                             "\n[l2]\nsize_bytes = 65536\nline_bytes = 64\nways = 4\n",
                         "test");
}

/// Phases: what all do once; builds; what a screen tile takes; the frame's end. 1000 instructions each.
Seed plain_seed() {
    Seed s;
    s.phases = {{1000, 1, 40, 0, 0, 0, PhaseUse::once},
                {1000, 1, 600, 0, 600, 0, PhaseUse::builds},
                {1000, 1, 200, 0, 200, 0, PhaseUse::renders},
                {0, 1, 5, 30, 0, 0, PhaseUse::end}};
    s.at_work = 2;
    s.crowding.fill(1);
    return s;
}

/// Four screen tiles, which between them do what the seed did, builds `copies` times as often.
ScreenWork work_of(double copies) {
    ScreenWork w;
    w.once = {1000, 0, 0};
    w.tiles.assign(4, {0, 0, 250});
    w.built.assign(4, {0, 250 * copies, 0});
    return w;
}

std::vector<Seat> seats(int tiles) {
    std::vector<Seat> out;
    for (int t = 0; t < 2 * tiles; ++t)
        out.push_back({t / 2, t / 2});
    return out;
}

LineTraffic on(const Seed& s, int tiles, double copies) {
    return predict_lines(s, machine_of(1), machine_of(tiles), work_of(copies), seats(tiles));
}

TEST(LineTraffic, OfTheSeedsOwnMachineIsTheSeeds) {
    Seed s = plain_seed();
    EXPECT_NEAR(on(s, 1, 1).reads, 845, 1e-9);
    EXPECT_NEAR(on(s, 1, 1).writes, 30, 1e-9);
    // Also where lines come again, and where some are pushed out.
    s.phases[1].reads = 3000;
    s.phases[1].lines = 2000;
    s.phases[2].writes = 900;
    s.phases[2].before = 150;
    s.crowding[1] = 1.2;
    EXPECT_NEAR(on(s, 1, 1).reads, 3245, 1e-9);
    EXPECT_NEAR(on(s, 1, 1).writes, 930, 1e-6);
}

TEST(LineTraffic, GoesWithTheWorkOfEachPhase) {
    EXPECT_NEAR(on(plain_seed(), 4, 4).reads, 40 + 4 * 600 + 200 + 5, 1e-9);
}

TEST(LineTraffic, OfEachWorkerComesForEachWorker) {
    Seed s = plain_seed();
    s.worker_reads = 15;
    EXPECT_NEAR(on(s, 1, 1).reads, 845, 1e-9); // of which two workers read 15 each
    EXPECT_NEAR(on(s, 4, 1).reads, 845 + 6 * 15, 1e-9);
}

TEST(LineTraffic, LinesComeAgainWhereThereIsNoRoom) {
    Seed s = plain_seed();
    s.phases[1].reads = 4000;
    s.phases[1].lines = 1848; // 2048 with the others: half of them find no room
    s.crowding[1] = 1;
    // Each of two caches holds what its half touches.
    EXPECT_NEAR(on(s, 2, 1).reads, 40 + 1848 + 200 + 5, 1e-9);
    // Where builds are made twice, each touches 1948: 0.474 of them find no room.
    EXPECT_NEAR(on(s, 2, 2).reads, 40 + 2 * (1848 + 2152 * (1 - 1024.0 / 1948) / 0.5) + 200 + 5, 1e-6);
    // What comes again though all fits is for want of ways.
    s.phases[1].lines = 500;
    EXPECT_NEAR(on(s, 2, 1).reads, 40 + 4000 + 200 + 5, 1e-9);
}

TEST(LineTraffic, SeedsMayHaveSeveralLastCaches) {
    const char* private_caches = "[chip]\ncores = 2\nthreads = 2\ntiles = 1\n"
                                 "[l2]\nsize_bytes = 65536\nline_bytes = 64\nways = 4\nshare = \"core\"\n";
    const Config machine = parse_machine(private_caches, "test");
    Seed s = plain_seed();
    s.at_work = 4;
    s.phases[1].reads = 4000;
    s.phases[1].lines = 3896; // with the others 2048 a cache, each of which has room for half
    s.phases[2].reads = 3000;
    s.phases[1].writes = 700;
    const LineTraffic same = predict_lines(s, machine, machine, work_of(1), {{0, 0}, {0, 0}, {1, 0}, {1, 0}});
    EXPECT_NEAR(same.reads, 7045, 1e-9);
    EXPECT_NEAR(same.writes, 730, 1e-6);
    // Two more caches take half of the work and hold their parts.
    Config two = machine;
    two.chip.tiles = 2;
    const LineTraffic spread = predict_lines(s, machine, two, work_of(1), {{0, 0}, {1, 0}, {2, 1}, {3, 1}});
    EXPECT_NEAR(spread.reads, 40 + 3896 + 200 + 5, 1e-6);
}

TEST(LineTraffic, FewerThreadsLeaveMoreToEach) {
    Seed s = plain_seed();
    s.phases[1].reads = 4000;
    s.phases[1].lines = 1848;
    s.phases[2].lines = 4000; // so that room is as short with half of it
    s.crowding[1] = 1.25;     // alone, 3200 lines would be read
    const double room = (1 - 1024.0 / 1462) / (1 - 1024.0 / 5848);
    // Four tiles have a thread each that finds a screen tile.
    EXPECT_NEAR(on(s, 4, 1).reads, 40 + 1848 + (3200 - 1848) * room + 200 + 5, 1e-6);
    // Two tiles have two.
    const double less = (1 - 1024.0 / 2924) / (1 - 1024.0 / 5848);
    EXPECT_NEAR(on(s, 2, 1).reads, 40 + 1848 + (4000 - 1848) * less + 200 + 5, 1e-6);
}

TEST(LineTraffic, WhatAllDidOnceLiesWithOneOfThem) {
    Seed s = plain_seed();
    s.phases[1].lines = 700;
    s.phases[1].before = 60; // of which 40 are spared elsewhere
    EXPECT_NEAR(on(s, 1, 1).reads, 845, 1e-9);
    EXPECT_NEAR(on(s, 2, 1).reads, 845 + 60 / 2.0, 1e-9);
    EXPECT_NEAR(on(s, 4, 1).reads, 845 + 60 * 3 / 4.0, 1e-9);
    s.phases[1].before = 300; // but 100 lines were not read
    EXPECT_NEAR(on(s, 4, 1).reads, 845 + 100 * 3 / 4.0, 1e-9);
}

/// Lines that push others out of 256 sets of 4 ways, on which they fall one by one, each as likely as any.
double pushed_out(int lines) {
    constexpr int sets = 256, ways = 4;
    double pushed = 0;
    for (int k = ways + 1; k <= lines; ++k)
        pushed += (k - ways) *
                  std::exp(std::lgamma(lines + 1.0) - std::lgamma(k + 1.0) - std::lgamma(lines - k + 1.0) -
                           k * std::log(sets) + (lines - k) * std::log1p(-1.0 / sets));
    return sets * pushed;
}

TEST(LineTraffic, WritesWhatIsPushedOutOfEachCache) {
    Seed s = plain_seed();
    s.phases[1].reads = s.phases[1].lines = 1808; // of 2048 in all
    s.phases[1].writes = 512;
    EXPECT_NEAR(on(s, 1, 1).writes, 30 + 512, 1e-9);
    const LineTraffic two = on(s, 2, 2);
    EXPECT_NEAR(two.reads, 40 + 2 * 1808 + 200 + 5, 1e-9);
    EXPECT_NEAR(two.writes, 30 + 2 * pushed_out(20 + 1808 + 100) * 512 / pushed_out(2048), 1);
    // Of four caches each holds nearly all of its part.
    EXPECT_NEAR(on(s, 4, 1).writes, 30 + 4 * pushed_out(512) * 512 / pushed_out(2048), 1);
    EXPECT_LT(on(s, 4, 1).writes, 100);
    // Caches of tiles without a screen tile hold nothing.
    ScreenWork one_sided = work_of(1);
    for (std::size_t t = 2; t < 4; ++t) {
        one_sided.tiles[t] = one_sided.built[t] = {0, 0, 0};
        for (std::size_t p = 0; p < 3; ++p) {
            one_sided.tiles[t - 2][p] *= 2;
            one_sided.built[t - 2][p] *= 2;
        }
    }
    EXPECT_NEAR(predict_lines(s, machine_of(1), machine_of(2), one_sided, seats(2)).writes,
                30 + pushed_out(20 + 1808 + 200) * 512 / pushed_out(2048), 1);
    // A seed whose lines all fit says only what is written whatever fits.
    Seed small = plain_seed();
    small.phases[1].reads = small.phases[2].reads = 10;
    small.phases[2].writes = 7;
    EXPECT_EQ(on(small, 4, 9).writes, 37);
}

} // namespace
} // namespace sim::test
