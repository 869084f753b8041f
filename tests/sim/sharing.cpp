// Order among threads, shared words, the host's services.
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

Config several(integer cores, integer threads) {
    Config c;
    c.chip.cores = cores;
    c.chip.threads = threads;
    return c;
}

struct Shared {
    Memory memory;
    isa::shared<std::int32_t>* word(int i) const {
        return reinterpret_cast<isa::shared<std::int32_t>*>(memory.data) + i * 16;
    }
    std::int32_t* plain() const { return reinterpret_cast<std::int32_t*>(memory.more); }
    Report run(const Config& c, int workers, const std::function<void(int)>& f) const {
        return Machine(c).run(memory.space, workers, {{"work"}}, f);
    }
};

// Who is ahead in time gets the ticket first, whatever the order in which fibres began.
TEST(Sharing, AtomicsActInTimeOrder) {
    for (integer quantum : {0, 1, 100, 1000}) {
        Config c = several(4, 2);
        c.sim.quantum = quantum;
        Shared s;
        std::int32_t ticket[8] = {};
        s.run(c, 8, [&](int w) { ticket[w] = take_ticket(s.word(0), 20 * (8 - w)); });
        for (int w = 0; w < 8; ++w)
            EXPECT_EQ(ticket[w], 7 - w) << "quantum " << quantum;
    }
}

TEST(Sharing, CountsEveryIncrement) {
    for (integer quantum : {1, 100}) {
        Config c = several(4, 4);
        c.sim.quantum = quantum;
        Shared s;
        Report r = s.run(c, 16, [&](int) { count_up(s.word(0), 100); });
        EXPECT_EQ(s.word(0)->word, 1600);
        EXPECT_EQ(r.core.modifications, 1600U);
    }
}

TEST(Sharing, WaitersWakeWhenTheWordIsVisible) {
    Config c = several(2, 1);
    c.coherence.visibility_cycles = 40;
    Shared s;
    Report r = s.run(c, 2, [&](int w) {
        if (w == 0)
            release_after(s.word(0), 500);
        else
            EXPECT_EQ(await(s.word(0)), 1);
    });
    EXPECT_EQ(r.core.waits, 1U);
    EXPECT_EQ(r.core.causality_waits, 0U);
    const ThreadReport& waiter = r.threads[1];
    auto waited = waiter.stacks[0][static_cast<std::size_t>(Cause::synchronise)];
    EXPECT_GE(waited, 530U);
    EXPECT_LE(waited, 560U);
    EXPECT_EQ(r.core.spins, waited / u(c.core.spin_period));
}

// Writes act when no other thread is earlier, so that nobody reads what is written later, under a quantum
// either; and a reader gets a new value no sooner than it is visible.
TEST(Sharing, NobodyReadsTheFuture) {
    for (integer quantum : {1, 100, 10000}) {
        for (integer window : {1, 64}) {
            Config c = several(2, 1);
            c.sim.quantum = quantum;
            c.core.window = window;
            c.coherence.visibility_cycles = 300;
            Shared s;
            cycle seen = 0;
            Report r = s.run(c, 2, [&](int w) {
                if (w == 0) {
                    release_after(s.word(0), 800);
                } else {
                    while (seen == 0) {
                        before_atomic(here, atomic::load_acquire, s.word(0), stamp{}, stamp{});
                        bool there = s.word(0)->word == 1;
                        stamp t = after_atomic(here, atomic::load_acquire, s.word(0), false);
                        if (there)
                            seen = t.last;
                        isa::timing::branch(here, t, !there);
                    }
                }
            });
            EXPECT_EQ(r.core.causality_waits, 0U);
            EXPECT_GE(seen, 1100U);
            EXPECT_LE(seen, 1200U + u(quantum));
        }
    }
}

// A write of a shared word takes its line from all L1s; what was dirty there reaches the L2 first.
TEST(Sharing, WritesInvalidateOtherCopies) {
    Shared s;
    Config c = several(2, 1);
    c.sim.miss_causes = "on";
    Report r = s.run(c, 2, [&](int w) {
        auto look = [&](stamp after) {
            before_atomic(here, atomic::load_acquire, s.word(0), after, stamp{});
            return after_atomic(here, atomic::load_acquire, s.word(0), false);
        };
        if (w == 0) {
            stamp seen = look(stamp{});
            isa::timing::store(here, &s.word(0)[1], 4, seen, stamp{}); // the same line
            EXPECT_EQ(look(stamp{1000, 1000}).last, 1002U);            // still there
            EXPECT_GT(look(stamp{3000, 3000}).last, 3002U);            // gone
        } else {
            before_atomic(here, atomic::store_release, s.word(0), stamp{2000, 2000}, stamp{});
            after_atomic(here, atomic::store_release, s.word(0), true);
        }
    });
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[0].write_backs, 1U);
    EXPECT_EQ(r.l1[0].misses, 2U);
    EXPECT_EQ(r.l1[0].compulsory, 1U);
    EXPECT_EQ(r.l1[0].coherence, 1U);
}

TEST(Sharing, PublishedDataIsSeen) {
    for (integer quantum : {1, 100}) {
        Config c = several(4, 2);
        c.sim.quantum = quantum;
        Shared s;
        std::int32_t sums[8] = {};
        s.run(c, 8, [&](int w) {
            if (w == 0)
                publish_numbers(s.plain(), s.word(0), 64);
            else
                sums[w] = sum_when_published(s.plain(), s.word(0), 64);
        });
        for (int w = 1; w < 8; ++w)
            EXPECT_EQ(sums[w], 64 * 63 / 2);
    }
}

TEST(Sharing, DeadlockIsReported) {
    Shared s;
    try {
        s.run(several(2, 2), 3, [&](int) { await(s.word(0)); });
        FAIL();
    } catch (const Deadlock& e) {
        std::string what = e.what();
        EXPECT_NE(what.find("worker 2"), std::string::npos) << what;
        EXPECT_NE(what.find("data"), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos);
    }
    EXPECT_NO_THROW(s.run(several(1, 1), 1, [](int) {}));
}

TEST(Sharing, TrapsUnwindEverybodyAndSurface) {
    for (integer quantum : {1, 100}) {
        Config c = several(4, 2);
        c.sim.quantum = quantum;
        Shared s;
        int unwound = 0;
        try {
            s.run(c, 8, [&](int w) {
                struct Guard {
                    int* count;
                    ~Guard() { ++*count; }
                } guard{&unwound};
                if (w == 3)
                    trap_while_holding(s.word(1), 42);
                await(s.word(0));
            });
            FAIL();
        } catch (const isa::trapped& t) {
            EXPECT_EQ(t.code, 42);
        }
        EXPECT_EQ(unwound, 8);
        EXPECT_EQ(s.word(1)->word, 7); // the guard of the one that trapped let go
    }
}

// Guards write words that other tiles reach as well: while they unwind nothing may wait for a window's end.
TEST(Sharing, TrapsUnwindGuardsOfWordsThatTilesShare) {
    for (int host_threads : {1, 2}) {
        Config c = several(4, 1);
        c.chip.tiles = 2;
        c.chip.placement = "spread";
        Shared s;
        try {
            Machine(c).run(
                s.memory.space, 8, {{"work"}},
                [&](int w) {
                    count_up(s.word(1), 2); // it is the whole chip's
                    if (w == 3)
                        trap_while_holding(s.word(1), 42);
                    await_while_holding(s.word(1), s.word(0));
                },
                host_threads);
            FAIL();
        } catch (const isa::trapped& t) {
            EXPECT_EQ(t.code, 42);
        }
        EXPECT_EQ(s.word(1)->word, 7);
    }
}

struct Pages final : isa::page_service {
    std::vector<std::array<std::int32_t, 3>> made;
    bool fail = false;
    void make_page(std::int32_t space, std::int32_t kind, std::int32_t index) override {
        if (fail)
            throw std::runtime_error("no page");
        made.push_back({space, kind, index});
    }
};

TEST(Sharing, PagesAreMadeWhileTimeStandsStill) {
    Pages pages;
    auto body = [&](bool ask) {
        Shared s;
        return s.run(several(2, 2), 4, [&](int w) { ask_for_page(pages, ask ? 1 : 0, w); });
    };
    Report with = body(true), without = body(false);
    EXPECT_EQ(pages.made.size(), 4U);
    EXPECT_EQ(with.core.pages, 4U);
    EXPECT_EQ(with.cycles, without.cycles);
    pages.fail = true;
    EXPECT_THROW(body(true), std::runtime_error);
}

TEST(Machine, TwoRunsAreEqualToTheDigit) {
    for (integer quantum : {1, 100}) {
        for (const char* policy : {"fine", "stall"}) {
            Config c = several(4, 4);
            c.sim.quantum = quantum;
            c.core.switch_policy = policy;
            c.core.vector_registers = 4;
            c.core.window = 8;
            c.core.predictor = "counters";
            auto once = [&] {
                Shared s;
                return print_json(s.run(c, 16, [&](int w) { mixed_work(s.plain(), s.word(0), w, 20); }),
                                  false);
            };
            std::string first = once();
            EXPECT_EQ(first, once());
            EXPECT_NE(first.find("\"cycles\""), std::string::npos);
        }
    }
}

TEST(Machine, AQuantumChangesLittle) {
    Config c = several(4, 4);
    auto cycles = [&](integer quantum) {
        c.sim.quantum = quantum;
        Shared s;
        return static_cast<double>(
            s.run(c, 16, [&](int w) { mixed_work(s.plain(), s.word(0), w, 200); }).cycles);
    };
    double exact = cycles(1);
    EXPECT_NEAR(cycles(100) / exact, 1.0, 0.08); // all threads meet at one counter: the worst case
}

TEST(Machine, PhasesSumToTheWhole) {
    Memory memory;
    Report r = Machine(several(1, 1)).run(memory.space, 1, {{"one", "two"}}, [](int) {
        scalar_op(operation::add, stamp{});
        EXPECT_EQ(set_phase(1), 0);
        scalar_op(operation::add, stamp{});
        scalar_op(operation::add, stamp{});
        EXPECT_EQ(set_phase(0), 1);
    });
    EXPECT_EQ(r.work[0].vops, 1U);
    EXPECT_EQ(r.work[1].vops, 2U);
}

TEST(Machine, PlacementPutsWorkersWhereItSays) {
    Config c = several(4, 2);
    Report spread = run(
        c, [](int) {}, 3);
    EXPECT_EQ(spread.threads[2].worker, 1); // core 1, thread 0
    c.chip.placement = "pack";
    Report pack = run(
        c, [](int) {}, 3);
    EXPECT_EQ(pack.threads[1].worker, 1);
    EXPECT_EQ(pack.threads[2].worker, 2);
}

} // namespace
} // namespace sim::test
