// Caches within a tile in order of time (sim/machine/tile_events.h): streams of several cores beside a plain
// event simulator, chains of waiting in closed form, and whole machines that nothing of the host moves.
#include "sim/machine/tile.h"
#include "sim/validation/reference_forms.h"
#include "tests/sim/tile_oracle.h"
#include "tests/sim/unchanging.h"

#include <fmt/core.h>

#include <map>
#include <memory>
#include <random>

namespace sim::test {
namespace {

constexpr cycle memory_cycles = 90;

/// The caches of one tile, and below them a memory that takes the same time for each line. Cores ask one
/// access after the other, each when the one before was accepted.
class Bench {
public:
    explicit Bench(const Config& c)
        : config_(c), space_(1 << 26), lines_(space_, 6), tile_(config_, 0, 1000, lines_, 1) {
        for (std::size_t core = 0; core < u(c.chip.cores); ++core) {
            l1s_.emplace_back(config_, 0, false, tile_.earliest, tile_.site, tile_.way_to(1, core),
                              tile_.tickets, tile_.attribution);
            tile_.cache_of(1, core).add_above(l1s_.back());
        }
        tile_.events->set_floors({~cycle{0} >> 1U, ~cycle{0} >> 1U}); // memory answers at once
        tile_.events->tell([this](cycle, const Cache*) { ++answers_; });
    }
    std::vector<std::vector<cycle>> run(const std::vector<std::vector<TileOracle::Access>>& programs) {
        struct Core {
            std::size_t next = 0;
            cycle at = 0, since = 0; // it tries; it first tried
            bool waits = false;      // for an answer too
            std::vector<cycle> times;
        };
        std::vector<Core> cores(programs.size());
        for (;;) {
            std::size_t first = cores.size();
            cycle now = ~cycle{0};
            bool busy = false;
            for (std::size_t c = 0; c < cores.size(); ++c) {
                if (cores[c].next == programs[c].size())
                    continue;
                busy = true;
                const cycle due = std::max<cycle>(cores[c].at, programs[c][cores[c].next].at);
                if (due < now)
                    first = c, now = due;
            }
            if (!busy)
                break;
            if (tile_.events->next <= now) {
                if (one_event())
                    for (Core& core : cores)
                        if (std::exchange(core.waits, false))
                            core.at = core.since;
                continue;
            }
            const TileOracle::Access& a = programs[first][cores[first].next];
            const Answer answer = l1s_[first].access(a.line, a.write, 1, now, 0);
            if (answer.refused) {
                cores[first].waits = answer.ready == Answer::unknown || maybe_sooner(answer.ready);
                cores[first].at = answer.ready == Answer::unknown ? answer.ready : latest(answer.ready);
                cores[first].since = now;
                continue;
            }
            cores[first].times.push_back(answer.ready);
            cores[first].at = now + 1;
            cores[first].waits = false;
            ++cores[first].next;
        }
        while (tile_.events->next != ~cycle{0})
            one_event();
        std::vector<std::vector<cycle>> out;
        for (Core& core : cores) {
            for (cycle& t : core.times)
                if (Answered a; is_ticket(t)) {
                    EXPECT_TRUE(tile_.tickets.find(t, a));
                    t = a.last;
                }
            out.push_back(core.times);
        }
        return out;
    }
    const CacheCounters& l1(std::size_t core) const { return l1s_[core].counters(); }
    const CacheCounters& cache(unsigned level) const { return tile_.caches[level].front().counters(); }

private:
    /// Returns whether anything was answered.
    bool one_event() {
        const std::uint64_t before = answers_;
        tile_.events->step();
        for (const Request& r : tile_.leaving.requests)
            if (r.read != Request::nothing) {
                tile_.tickets.answer(r.ticket, r.at + memory_cycles, Cause::memory);
                ++answers_;
            }
        tile_.leaving.requests.clear();
        if (answers_ == before)
            return false;
        tile_.events->try_again();
        return true;
    }

    Config config_;
    isa::address_space space_;
    LineMap lines_;
    Tile tile_;
    std::deque<Cache> l1s_;
    std::uint64_t answers_ = 0;
};

Config bench_machine(integer cores, bool l3) {
    Config c = plain_reference();
    c.chip.cores = cores;
    c.l1 = {};
    c.l1.line_bytes = c.l2.line_bytes = c.l3.line_bytes = 64;
    c.l1.ways = 2, c.l1.size_bytes = 8 * 64, c.l1.latency = 3, c.l1.mshrs = 3;
    c.l2.ways = 4, c.l2.size_bytes = 32 * 64, c.l2.latency = 11, c.l2.banks = 2, c.l2.bank_bytes = 16;
    c.l2.mshrs = 2;
    if (l3) {
        c.l3.ways = 4, c.l3.size_bytes = 64 * 64, c.l3.latency = 20, c.l3.banks = 1, c.l3.bank_bytes = 32;
        c.l3.share = "tile";
    }
    c.l1.write_back_buffer = c.l2.write_back_buffer = c.l3.write_back_buffer = 1000;
    check_consistency(c, "test");
    return c;
}

TileOracle::Level level_of(const CacheConfig& c, bool l1, bool last) {
    return {u(c.size_bytes / c.line_bytes),
            u(c.ways),
            u(c.latency),
            last ? 0 : u(c.mshrs),
            l1 ? 1 : u(c.banks),
            l1 ? 1 : u((c.line_bytes + c.bank_bytes - 1) / c.bank_bytes)};
}

void expect_counts(const CacheCounters& c, const TileOracle::Counts& o, const std::string& what) {
    EXPECT_EQ((TileOracle::Counts{c.reads, c.writes, c.hits, c.misses, c.fills, c.write_backs}), o)
        << fmt::format("{}: {} {} {} {} {} {}; oracle {} {} {} {} {} {}", what, c.reads, c.writes, c.hits,
                       c.misses, c.fills, c.write_backs, o.reads, o.writes, o.hits, o.misses, o.fills,
                       o.write_backs);
}

TEST(TileEvents, RandomStreamsBesideAPlainEventSimulator) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 40; ++trial) {
        const bool l3 = trial % 2 == 1;
        const std::size_t cores = 1 + random() % 4;
        Config c = bench_machine(static_cast<integer>(cores), l3);
        c.l1.mshrs = 1 + static_cast<integer>(random() % 4);
        c.l2.mshrs = 1 + static_cast<integer>(random() % 4);
        c.l2.banks = integer{1} << random() % 3;
        std::vector<std::vector<TileOracle::Access>> programs(cores);
        const std::uint64_t pause = 1 + random() % 30, span = 20 + random() % 150;
        for (auto& program : programs) {
            cycle at = random() % 5;
            for (int i = 0; i < 600; ++i) {
                at += random() % 3 == 0 ? random() % pause : 1;
                program.push_back({at, random() % span, random() % 3 == 0});
            }
        }
        std::vector<TileOracle::Level> below = {level_of(c.l2, false, !l3)};
        if (l3)
            below.push_back(level_of(c.l3, false, true));
        TileOracle oracle(cores, level_of(c.l1, true, false), below, memory_cycles);
        Bench bench(c);
        const auto times = bench.run(programs);
        const auto expected = oracle.run(programs);
        const std::string what = fmt::format("trial {}", trial);
        for (std::size_t core = 0; core < cores; ++core) {
            ASSERT_EQ(times[core].size(), expected[core].size()) << what;
            for (std::size_t i = 0; i < times[core].size(); ++i)
                ASSERT_EQ(times[core][i], expected[core][i])
                    << fmt::format("{}, core {}, access {}: line {}", what, core, i, programs[core][i].line);
        }
        for (std::size_t core = 0; core < cores; ++core)
            expect_counts(bench.l1(core), oracle.counts(core), what + ", an L1");
        expect_counts(bench.cache(1), oracle.counts(cores), what + ", the L2");
        if (l3)
            expect_counts(bench.cache(2), oracle.counts(cores + 1), what + ", the L3");
    }
}

// The L2's MSHRs are held until the answer is there, as are those of the L1s; who waits for one goes first.
TEST(TileEvents, AChainThroughOneMshrOfTheL2) {
    Config c = bench_machine(3, true);
    c.l2.mshrs = 1;
    c.l2.banks = 4;
    Bench bench(c);
    const auto times = bench.run({{{0, 0, false}}, {{1, 1, false}}, {{2, 2, false}}});
    const cycle asks = u(c.l2.latency + c.l3.latency) + memory_cycles;
    EXPECT_EQ(times[0][0], u(c.l1.latency) + asks);
    EXPECT_EQ(times[1][0], times[0][0] + asks);
    EXPECT_EQ(times[2][0], times[1][0] + asks);
}

// --- machines

Config machine() {
    Config c = plain_reference();
    c.chip.cores = 2, c.chip.threads = 2, c.core.window = 1;
    c.l1.size_bytes = 1024, c.l1.ways = 2;
    c.l2.size_bytes = 8192, c.l2.banks = 2, c.l2.bank_bytes = 16;
    c.l1.mshrs = 4;
    c.l1.write_back_buffer = 2;
    c.memory.tREFI = 1000;
    return c;
}

/// In windows of another length, which reports do not know.
Report run_in_windows(Config c, integer window, const std::function<void(int)>& worker, Shared& s) {
    check_consistency(c, "test");
    c.sim.window = window;
    Engine engine(c, s.memory.space, static_cast<int>(c.chip.cores * c.chip.threads), {{"work"}}, 1, {},
                  worker);
    running_engine = &engine;
    Report r = engine.run();
    running_engine = nullptr;
    running_hart = nullptr;
    check_laws(r);
    return r;
}

// But for whether a line that comes with the answer counts as in flight, and the cause of waiting for it.
TEST(TileEvents, WindowsUpToTheShortestRoundTripChangeNothing) {
    for (const char* share : {"tile", "core"})
        expect_equal_in_windows(
            [&](integer window) {
                Config c = machine();
                c.l1.mshrs = c.l1.write_back_buffer = c.l2.mshrs = c.l2.write_back_buffer = 256;
                c.l2.share = share;
                Shared s;
                return run_in_windows(
                    c, window, [&](int w) { mixed_work(s.plain(), s.at(w), w, 60); }, s);
            },
            share,
            [](const Report& r) {
                std::string out = fmt::format("{} {}", r.cycles, r.drained);
                for (const ThreadReport& t : r.threads)
                    out += fmt::format(" {}", t.finish);
                for (unsigned level = 0; level < r.config.cache_levels(); ++level)
                    for (const CacheCounters& c : r.caches(level))
                        for (const auto& row : cache_counters)
                            if (row.count != &CacheCounters::hits_in_flight)
                                out += fmt::format(" {}", c.*row.count);
                return out;
            });
}

Config several_tiles() {
    Config c = machine();
    c.chip.tiles = 3;
    c.core.window = 8;
    c.l3 = c.l2;
    c.l3.size_bytes = 32768, c.l3.share = "tile", c.l3.latency = 30, c.l3.inclusion = "inclusive";
    c.l2.share = "core", c.l2.mshrs = 2, c.l2.write_back_buffer = 1;
    c.l1.mshrs = 2, c.l1.write_back_buffer = 1;
    c.core.store_buffer = 4;
    return c;
}

TEST(TileEvents, HostThreadsAndTheHostsOrderChangeNothing) {
    const auto run = [](int host_threads, std::uint32_t order) {
        const Shared s;
        return s.run(several_tiles(), 12, [&](int w) { mixed_work(s.plain(), s.at(w / 4), w, 15); },
                     host_threads, {.host_order = order});
    };
    expect_equal_on_host_threads([&](int threads) { return run(threads, 0); }, "three levels");
    expect_equal_in_any_order([&](std::uint32_t order) { return run(1, order); }, "three levels");
}

// What an exclusive level gives up dirty stays so, wherever its line has gone meanwhile: in the end every
// line is dirty somewhere.
TEST(TileEvents, DirtyLinesThatMoveUpAreNotLost) {
    Config c = machine();
    c.chip.cores = c.chip.threads = 1;
    c.l2.inclusion = "exclusive";
    c.l1.size_bytes = 256, c.l1.ways = 1; // four lines
    constexpr int lines = 40;
    const Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < lines; ++i)
            store(here, base + i * 64, 4, stamp{}, stamp{});
        for (int round = 0; round < 5; ++round)
            for (int i = 0; i < lines; ++i)
                load(here, base + (i * 7 % lines) * 64, 4, stamp{}); // up, and out before it has come
    });
    EXPECT_GT(r.l2[0].moved_up, u(lines));
    EXPECT_EQ(r.memory.writes, 0U);
    EXPECT_EQ(r.l1[0].dropped + r.l2[0].dropped, u(lines));
}

// What an inclusive level recalls while it is on its way back there is not lost either: each line that was
// stored to once goes to memory or is dirty in the end.
TEST(TileEvents, DirtyLinesThatAreRecalledOnTheirWayAreNotLost) {
    Config c = machine();
    c.chip.cores = 4;
    c.chip.threads = 1;
    c.l1.size_bytes = 256, c.l1.ways = 1;
    c.l3 = c.l2;
    c.l2.share = "core", c.l3.share = "tile";
    c.l2.inclusion = c.l3.inclusion = "inclusive";
    c.l2.size_bytes = 512, c.l2.ways = 1, c.l2.banks = 1, c.l2.bank_bytes = 4; // its bank makes them wait
    c.l3.size_bytes = 1024, c.l3.ways = 1;
    constexpr int lines = 40;
    const Shared s;
    const Report r = s.run(c, 4, [&](int w) {
        std::byte* base = reinterpret_cast<std::byte*>(s.plain()) + w * lines * 64;
        for (int i = 0; i < lines; ++i) {
            store(here, base + i * 64, 4, stamp{}, stamp{});
            load(here, base + (i * 13 % (i + 1)) * 64, 4, stamp{});
        }
        for (int i = 0; i < 4 * lines; ++i)
            load(here, base + (i * 7 % lines) * 64, 4, stamp{});
    });
    std::uint64_t dirty = 0;
    for (unsigned level = 0; level < 3; ++level)
        for (const CacheCounters& cache : r.caches(level))
            dirty += cache.dropped;
    EXPECT_GT(r.caches(2).front().write_backs, u(2 * lines));
    EXPECT_EQ(r.memory.writes + dirty, u(4 * lines));
}

// Read-modify-writes of a word by several cores follow each other.
TEST(TileEvents, NoReadModifyWriteIsLostAndEachTakesItsTime) {
    Config c = machine();
    c.chip.cores = 4;
    c.coherence.atomic_cycles = 50;
    const Shared s;
    const Report r = s.run(c, 8, [&](int) { count_up(s.at(0), 25); });
    EXPECT_EQ(s.at(0)->word, 200);
    EXPECT_GE(r.cycles, 200 * 50U);
}

} // namespace
} // namespace sim::test
