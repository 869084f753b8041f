// Tiles, windows and tickets: windows change nothing that they need not, tiles meet only between them.
#include "tests/sim/unchanging.h"

#include <map>

namespace sim::test {
namespace {

Config tiled(integer tiles, integer cores, integer threads) {
    Config c;
    c.chip.tiles = tiles;
    c.chip.cores = cores;
    c.chip.threads = threads;
    c.core.window = 1;
    return c;
}

// Where operations act in source order, windows no longer than the shortest way to memory and back change no
// digit if MSHRs suffice. (Where they do not, threads wait for longer than operations may lie behind their
// turns, and that counts from the window's end.)
TEST(Tiles, WindowsUpToTheShortestRoundTripChangeNothing) {
    for (integer threads : {1, 3})
        expect_equal_in_windows(
            [&](integer window) {
                Config c = tiled(1, 4, threads);
                c.sim.window = window;
                c.l1.mshrs = c.l1.write_back_buffer = c.l2.mshrs = c.l2.write_back_buffer = 256;
                Shared s;
                return s.run(c, static_cast<int>(4 * threads),
                             [&](int w) { mixed_work(s.plain(), s.at(w), w, 60); });
            },
            std::to_string(threads) + " threads");
}

TEST(Tiles, EveryTileHasItsOwnL2) {
    Config c = tiled(4, 1, 1);
    Shared s;
    // All four read the same lines: four L2s miss.
    Report r = s.run(c, 4, [&](int) {
        for (int i = 0; i < 32; ++i)
            load(here, s.plain() + i * 16, 4, stamp{});
    });
    ASSERT_EQ(r.l2.size(), 4U);
    for (const CacheCounters& l2 : r.l2)
        EXPECT_EQ(l2.misses, 32U);
    EXPECT_EQ(r.memory.reads, 128U);
    c.chip.tiles = 1;
    c.chip.cores = 4;
    Shared t;
    EXPECT_EQ(t.run(c, 4,
                    [&](int) {
                        for (int i = 0; i < 32; ++i)
                            load(here, t.plain() + i * 16, 4, stamp{});
                    })
                  .memory.reads,
              32U);
}

TEST(Tiles, CountersReachedFromAllTilesLoseNothing) {
    for (integer quantum : {1, 100})
        for (integer tiles : {2, 5}) {
            Config c = tiled(tiles, 2, 2);
            c.sim.quantum = quantum;
            Shared s;
            int workers = static_cast<int>(4 * tiles);
            Report r = s.run(c, workers, [&](int) { count_up(s.at(0), 50); });
            EXPECT_EQ(s.at(0)->word, workers * 50);
            EXPECT_EQ(r.core.modifications, u(workers * 50));
            EXPECT_EQ(r.core.causality_waits, 0U);
        }
}

TEST(Tiles, OperationsOnAWordActInOrderOfTimeAcrossTiles) {
    Config c = tiled(4, 1, 2);
    Shared s;
    std::int32_t ticket[8] = {};
    // Apart by more than a window, whoever comes first is served first.
    s.run(c, 8, [&](int w) { ticket[w] = take_ticket(s.at(0), 400 * (8 - w)); });
    for (int w = 0; w < 8; ++w)
        EXPECT_EQ(ticket[w], 7 - w);
}

TEST(Tiles, WaitersInOtherTilesWakeAfterTheWordIsVisible) {
    Config c = tiled(3, 1, 1);
    c.coherence.visibility_cycles = 40;
    c.coherence.remote_cycles = 200;
    Shared s;
    Report r = s.run(c, 3, [&](int w) {
        if (w == 0)
            release_after(s.at(0), 500);
        else
            EXPECT_EQ(await(s.at(0)), 1);
    });
    EXPECT_GE(r.core.waits, 2U);
    for (const ThreadReport& t : r.threads) {
        if (t.worker > 0) {
            EXPECT_GE(t.finish, 740U);
        }
    }
}

TEST(Tiles, PublishedDataIsSeenInOtherTiles) {
    for (integer quantum : {1, 100}) {
        Config c = tiled(4, 2, 2);
        c.sim.quantum = quantum;
        Shared s;
        std::array<std::int32_t, 16> sums{};
        s.run(c, 16, [&](int w) {
            if (w == 0)
                publish_numbers(s.plain(), s.at(0), 200);
            else
                sums[u(w)] = sum_when_published(s.plain(), s.at(0), 200);
        });
        for (int w = 2; w < 16; ++w)
            EXPECT_EQ(sums[u(w)], sums[1]);
        EXPECT_NE(sums[1], 0);
    }
}

TEST(Tiles, APageIsMadeBetweenWindows) {
    struct Service : isa::page_service {
        void make_page(std::int32_t, std::int32_t, std::int32_t index) override { made.push_back(index); }
        std::vector<int> made;
    } service;
    Shared s;
    Report r = s.run(tiled(2, 1, 1), 2, [&](int w) { ask_for_page(service, 3, w); });
    EXPECT_EQ(service.made.size(), 6U);
    EXPECT_EQ(r.core.pages, 6U);
}

TEST(Tiles, ADeadlockAcrossTilesIsReported) {
    Shared s;
    EXPECT_THROW(s.run(tiled(2, 1, 1), 2, [&](int w) { await(s.at(w)); }), Deadlock);
}

// The frame's end: what lasts is written back, what dies with the frame is not, from L1s and L2s.
TEST(Tiles, TheFramesEndDropsTransientLines) {
    Config c = tiled(2, 1, 1);
    auto in_l1 = static_cast<int>(c.l1.size_bytes / c.l1.line_bytes);
    int lines = 3 * in_l1; // a tile: two thirds of them have been written back to its L2
    ASSERT_LT(lines * c.l1.line_bytes, c.l2.size_bytes);
    for (bool transient : {false, true}) {
        isa::address_space space(std::uint64_t{1} << 24);
        std::byte* data = space.add("data", -1, std::uint64_t{1} << 20, transient);
        Report r = Machine(c).run(space, 2, {{"work"}}, [&](int w) {
            for (int i = 0; i < lines; ++i)
                store(here, data + (w * lines + i) * c.l1.line_bytes, 4, stamp{}, stamp{});
        });
        EXPECT_EQ(r.memory.writes, transient ? 0U : u(2 * lines));
        EXPECT_EQ(r.l1_total().dropped, transient ? u(2 * in_l1) : 0U);
        EXPECT_EQ(r.l2_total().dropped, transient ? u(2 * (lines - in_l1)) : 0U);
        EXPECT_EQ(r.labels.phases.back(), "frame end");
    }
}

// A waiting thread takes issue slots from its neighbour: two in every spin_period cycles.
TEST(Tiles, SpinningSlowsTheOtherThreadOfTheCore) {
    auto cycles = [](int workers, integer period, int after = 0) {
        Config c = tiled(1, 1, 2);
        c.core.spin_period = period;
        c.core.predictor = "perfect";
        c.sim.window = 20000;
        Shared s;
        return s.run(c, workers, [&](int w) {
            if (w == 1) {
                await(s.at(0));
                return;
            }
            for (int i = 0; i < 5000; ++i)
                scalar_op(operation::integer, stamp{});
            release_after(s.at(0), 4);
            for (int i = 0; i < after; ++i)
                scalar_op(operation::integer, stamp{});
        });
    };
    double alone = static_cast<double>(cycles(1, 10).cycles);
    Report spinning = cycles(2, 10);
    EXPECT_NEAR(static_cast<double>(spinning.cycles) / alone, 1 / (1 - 2.0 / 10), 0.03);
    EXPECT_GT(spinning.core.spins, 400U);
    EXPECT_NEAR(static_cast<double>(cycles(2, 1000).cycles) / alone, 1.0, 0.03);
    // The rest of the window is free again once it has woken.
    EXPECT_NEAR(static_cast<double>(cycles(2, 10, 5000).cycles - spinning.cycles), 5000, 150);
}

// However often they would look, and however many they are: waiting threads take turns with the one that
// works.
TEST(Tiles, SpinningLeavesOthersTheirPart) {
    for (const int threads : {2, 16, 64})
        for (const integer width : {1, 2})
            for (const integer period : {1, 16}) {
                Config c = tiled(1, 1, threads);
                c.core.spin_period = period;
                c.core.issue_width = width;
                c.core.predictor = "perfect";
                Shared s;
                const Report r = s.run(c, threads, [&](int w) { // whose laws hold
                    if (w != 0) {
                        await(s.at(0));
                        return;
                    }
                    for (int i = 0; i < 5000; ++i)
                        scalar_op(operation::integer, stamp{});
                    release_after(s.at(0), 4);
                });
                EXPECT_LE(static_cast<double>(r.cycles), 5000.0 * threads * 1.1 + 2000)
                    << threads << " threads, period " << period << ", width " << width;
                EXPECT_GT(r.core.spins, 100U);
            }
}

// Others that take all slots for many windows leave none for looks.
TEST(Tiles, LooksAreCountedWhereThereAreSlots) {
    Config c = tiled(1, 1, 4);
    c.instructions[class_of(vector_kind(static_cast<std::size_t>(operation::multiply)))] = 1000;
    Shared s;
    const Report r = s.run(c, 4, [&](int w) { // whose laws hold
        if (w != 0) {
            await(s.at(0));
            return;
        }
        for (int i = 0; i < 50; ++i)
            vector_op(operation::multiply, stamp{});
        release_after(s.at(0), 4);
    });
    EXPECT_GT(r.core.spins, 0U);
    EXPECT_LE(r.core.instructions, r.cycles * static_cast<std::uint64_t>(c.core.issue_width));
}

// A quantum that is no shorter than a window does not cut it, wherever its multiples lie.
TEST(Tiles, LongQuantaAreWholeWindows) {
    std::map<integer, std::string> reports;
    for (integer quantum : {40, 61, 100, 100000, 39}) {
        Config c = tiled(2, 2, 3);
        c.sim.window = 40;
        c.sim.quantum = quantum;
        Shared s;
        Report r = s.run(c, 12, [&](int w) { mixed_work(s.plain(), s.at(0), w, 60); });
        r.config.sim.quantum = 0;
        reports[quantum] = print_json(r, false);
    }
    for (integer quantum : {61, 100, 100000})
        EXPECT_EQ(reports[quantum], reports[40]) << "quantum " << quantum;
    EXPECT_NE(reports[39], reports[40]);
}

struct NoPages : isa::page_service {
    void make_page(std::int32_t, std::int32_t, std::int32_t) override {}
};

// With words shared by all tiles, pages, levels and kinds; in long windows, as each takes a busy host some
// switches.
TEST(Tiles, ReportsDoNotDependOnHostThreads) {
    for (integer quantum : {0, 1000})
        for (bool sharing : {false, true})
            expect_equal_on_host_threads(
                [&](int host_threads) {
                    Config c = tiled(5, 2, 2);
                    c.core.window = 8;
                    c.sim.quantum = quantum;
                    c.sim.window = 1000;
                    Shared s;
                    NoPages pages;
                    Report r = Machine(c).run(
                        s.memory.space, 20, {{"work"}, {"one", "other"}},
                        [&](int w) {
                            mixed_work(s.plain(), s.at(sharing ? 0 : w / 4), w, 10);
                            ask_for_page(pages, 2, w);
                            set_kind(w % 2);
                            std::int32_t* own = s.plain() + 131072 * (w + 1);
                            note_level(own, 256, w % 3);
                            mixed_work(own, s.at(sharing ? w % 3 : w / 4), w, 5);
                        },
                        host_threads);
                    EXPECT_EQ(r.host_threads, std::min(host_threads, 5)); // tiles
                    return r;
                },
                "quantum " + std::to_string(quantum));
}

// Equal times have an order of their own: that in which the host comes to tiles, threads and requests is
// none.
TEST(Tiles, NoReportDependsOnTheHostsOrder) {
    const std::pair<const char*, std::function<void(Config&)>> machines[] = {
        {"fast", [](Config&) {}},
        {"switching on stalls", [](Config& c) { c.core.switch_policy = "stall"; }},
        {"noise", [](Config& c) { c.sim.jitter = 3; }},
        {"an L3 of two tiles", [](Config& c) { c.l3.size_bytes = 8192, c.l3.share = "4"; }},
        {"queues", [](Config& c) { c.memory.controller = "queued"; }},
        {"queues below an L3, on a mesh",
         [](Config& c) {
             c.memory.controller = "queued";
             c.l3.size_bytes = 8192, c.l3.share = "chip";
             c.network.topology = "mesh", c.network.link_bytes = 2;
         }},
    };
    for (const auto& [name, change] : machines)
        for (const int host_threads : {1, 2})
            expect_equal_in_any_order(
                [&, alter = change](std::uint32_t order) { // clang 14 captures no part of a pair by reference
                    Config c = busy_tiles();
                    alter(c);
                    return run_busy_tiles(c, host_threads, {.host_order = order});
                },
                name);
}

// What a worker throws reaches the caller also from another host thread, after all others were unwound.
TEST(Tiles, FailuresOnHostThreads) {
    for (int host_threads : {1, 3}) {
        Shared s;
        EXPECT_THROW(Machine(tiled(3, 1, 1))
                         .run(
                             s.memory.space, 3, {{"work"}},
                             [&](int w) {
                                 if (w == 2)
                                     throw std::runtime_error("worker 2");
                                 await(s.at(0));
                             },
                             host_threads),
                     std::runtime_error);
        EXPECT_THROW(Machine(tiled(3, 1, 1))
                         .run(
                             s.memory.space, 3, {{"work"}}, [&](int w) { await(s.at(w)); }, host_threads),
                     Deadlock);
    }
}

TEST(Tiles, TwoRunsAreEqual) {
    auto report = [] {
        Config c = tiled(4, 2, 2);
        c.core.window = 8;
        c.sim.quantum = 100;
        Shared s;
        return print_json(s.run(c, 16, [&](int w) { mixed_work(s.plain(), s.at(0), w, 60); }), false);
    };
    EXPECT_EQ(report(), report());
}

} // namespace
} // namespace sim::test
