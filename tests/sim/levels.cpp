// Several levels of caches, shared, inclusive and exclusive: against a simulator of their own (exact
// integers), and in exact cycles.
#include "tests/sim/hierarchy_oracle.h"
#include "tests/sim/references.h"
#include "tests/sim/unchanging.h"

#include <array>
#include <filesystem>

namespace sim::test {
namespace {

constexpr integer kib = 1024;

CacheConfig cache(const CacheConfig& d, integer size, integer ways, integer line, const std::string& share,
                  const std::string& inclusion) {
    CacheConfig c = d;
    c.size_bytes = size;
    c.ways = ways;
    c.line_bytes = line;
    c.share = share;
    c.inclusion = inclusion;
    return c;
}

struct Named {
    std::string name;
    Config config;
};

/// Two kinds of every policy, alone and above each other, within a tile and beyond.
std::vector<Named> hierarchies() {
    std::vector<Named> out;
    auto add = [&](const std::string& name, integer tiles, integer cores, integer line) -> Config& {
        Config c = simple();
        c.chip.tiles = tiles;
        c.chip.cores = cores;
        c.l1.size_bytes = 2 * kib;
        c.l1.ways = 2;
        c.l1.line_bytes = line;
        out.push_back({name, c});
        return out.back().config;
    };
    for (const char* l2 : {"none", "inclusive", "exclusive"})
        for (const char* l3 : {"none", "inclusive", "exclusive"}) {
            Config& c = add(std::string("L2 ") + l2 + ", L3 " + l3, 1, 4, 64);
            c.l2 = cache(c.l2, 4 * kib, 4, 64, "core", l2);
            c.l3 = cache(c.l3, 16 * kib, 8, 64, "tile", l3);
        }
    for (const char* l2 : {"none", "inclusive"})
        for (const char* l3 : {"none", "inclusive"}) {
            Config& c = add(std::string("longer lines, L2 ") + l2 + ", L3 " + l3, 1, 4, 32);
            c.l2 = cache(c.l2, 6 * kib, 3, 64, "2", l2);
            c.l3 = cache(c.l3, 16 * kib, 8, 256, "tile", l3);
            Config& b = add(std::string("beyond, longer lines, L2 ") + l2 + ", L3 " + l3, 2, 2, 32);
            b.l2 = cache(b.l2, 6 * kib, 3, 64, "core", l2);
            b.l3 = cache(b.l3, 16 * kib, 8, 256, "chip", l3);
        }
    for (const char* l3 : {"none", "inclusive"})
        for (const char* share : {"4", "chip"}) {
            Config& c = add(std::string("of ") + share + " cores, L3 " + l3, 4, 2, 64);
            c.l2 = cache(c.l2, 8 * kib, 4, 64, "tile", "none");
            c.l3 = cache(c.l3, 16 * kib, 16, 64, share, l3);
        }
    Config& five = add("five levels", 2, 4, 64);
    five.l2 = cache(five.l2, 4 * kib, 4, 64, "core", "exclusive");
    five.l3 = cache(five.l3, 16 * kib, 4, 64, "2", "inclusive");
    five.l4 = cache(five.l4, 24 * kib, 6, 64, "tile", "exclusive");
    five.l5 = cache(five.l5, 64 * kib, 8, 128, "chip", "none");
    for (std::size_t i = 0, all = out.size(); i < all; ++i) // caches that wait for their memory
        if (out[i].config.tile_levels() != out[i].config.cache_levels()) {
            out.push_back(out[i]);
            out.back().name += ", queued memory";
            out.back().config.memory.controller = "queued";
        }
    return out;
}

/// All caches of a machine and its memory, without cores.
class Caches {
public:
    explicit Caches(const Config& c)
        : config_(c), space_(1 << 20),
          lines_(space_, static_cast<unsigned>(std::countr_zero(u(c.l1.line_bytes)))),
          beyond_(Beyond::make(c, [this](std::uint32_t tile, cycle ticket, const Answer& a) {
              tiles_[tile].tickets.answer(ticket, a.ready, a.from);
          })) {
        for (std::uint32_t t = 0; t < u(c.chip.tiles); ++t) {
            Tile& tile = tiles_.emplace_back(c, t, 1000, lines_, 1);
            for (std::size_t core = 0; core < u(c.chip.cores); ++core) {
                Cache& l2 = tile.cache_of(1, core);
                l2.add_above(
                    l1_.emplace_back(c, 0, false, tile.earliest, site_, l2, tile.tickets, tile.attribution));
            }
        }
        beyond_->connect(tiles_);
    }
    void access(std::uint64_t core, std::uint64_t address, bool write) {
        now_ += 100000;
        Tile& tile = tiles_[core / u(config_.chip.cores)];
        tile.earliest = now_;
        ASSERT_FALSE(l1_[core].access(address / u(config_.l1.line_bytes), write, 1, now_, 0).refused);
        beyond_->accept(tile.leaving.requests);
        beyond_->serve(Beyond::everything);
        tile.tickets.forget(now_);
    }
    std::vector<CacheCounters> counters(unsigned level) {
        std::vector<CacheCounters> out;
        if (level == 0)
            for (const Cache& c : l1_)
                out.push_back(c.counters());
        else if (level == config_.tile_levels())
            for (const SharedCache& shared : beyond_->caches())
                out.push_back(shared.cache.counters());
        else
            for (const Tile& tile : tiles_)
                for (const Cache& c : tile.caches[level])
                    out.push_back(c.counters());
        return out;
    }
    std::uint64_t misplaced() const {
        std::uint64_t lines = beyond_->misplaced();
        for (const Tile& tile : tiles_)
            for (unsigned level = 1; level < config_.tile_levels(); ++level)
                for (const Cache& c : tile.caches[level])
                    lines += c.misplaced();
        return lines;
    }
    MemoryCounters memory() const { return beyond_->counters(); }

private:
    Config config_;
    cycle now_ = 0;
    isa::address_space space_;
    SiteAtHand site_;
    LineMap lines_;
    std::deque<Tile> tiles_;
    std::deque<Cache> l1_;
    std::unique_ptr<Beyond> beyond_;
};

HierarchyOracle oracle(const Config& c) {
    std::vector<HierarchyOracle::Level> levels;
    for (unsigned i = 0; i < c.cache_levels(); ++i) {
        const CacheConfig& l = c.cache(i);
        levels.push_back({u(l.size_bytes), u(l.ways), u(l.line_bytes), u(c.cores_sharing(i)), l.inclusion,
                          c.beyond_tiles(i)});
    }
    return {levels, u(c.all_cores())};
}

void compare(const Config& c, const std::vector<Reference>& stream) {
    check_consistency(c, "test");
    Caches caches(c);
    HierarchyOracle o = oracle(c);
    std::mt19937 random(5);
    const std::uint64_t line = u(c.l1.line_bytes);
    std::uint64_t core = 0;
    for (const Reference& r : stream) {
        if (random() % 8 == 0)
            core = random() % u(c.all_cores());
        for (std::uint64_t a = r.address / line * line; a < r.address + r.bytes; a += line) {
            caches.access(core, a, r.write);
            o.access(core, a, r.write);
        }
    }
    EXPECT_EQ(caches.misplaced(), 0U);
    for (unsigned level = 0; level < c.cache_levels(); ++level) {
        const std::vector<CacheCounters> all = caches.counters(level);
        ASSERT_EQ(all.size(), o.caches(level));
        for (std::size_t i = 0; i < all.size(); ++i) {
            SCOPED_TRACE("L" + std::to_string(level + 1) + " number " + std::to_string(i));
            const CacheCounters& got = all[i];
            const HierarchyOracle::Counts& want = o.counts(level, i);
            EXPECT_EQ(got.reads, want.reads);
            EXPECT_EQ(got.writes, want.writes);
            EXPECT_EQ(got.hits, want.hits);
            EXPECT_EQ(got.misses, want.misses);
            EXPECT_EQ(got.fills, want.fills);
            EXPECT_EQ(got.write_backs, want.write_backs);
            EXPECT_EQ(got.clean_victims, want.clean_victims);
            EXPECT_EQ(got.back_invalidations, want.back_invalidations);
            EXPECT_EQ(got.moved_up, want.moved_up);
        }
    }
    EXPECT_EQ(caches.memory().reads, o.memory_reads);
    EXPECT_EQ(caches.memory().writes, o.memory_writes);
}

TEST(LevelsOracle, SyntheticStream) {
    const std::vector<Reference> stream = synthetic(40000);
    for (const Named& h : hierarchies()) {
        SCOPED_TRACE(h.name);
        compare(h.config, stream);
    }
}

TEST(LevelsOracle, RecordedTrace) {
    if (!std::filesystem::exists(recorded_trace))
        GTEST_SKIP() << "no " << recorded_trace;
    const std::vector<Reference> stream = read_trace(recorded_trace);
    ASSERT_EQ(stream.size(), 31507U + 12338U);
    for (const Named& h : hierarchies()) {
        SCOPED_TRACE(h.name);
        compare(h.config, stream);
    }
}

// --- exact cycles

Config three(const std::string& share) {
    Config c = simple();
    c.memory.clock_ps = c.chip.clock_ps;
    c.l3 = cache(c.l3, 1024 * kib, 16, 64, share, "none");
    return c;
}
/// Each load's address waits for the load before; `lines` lines one after the other, `turns` times over.
Report chase(const Config& c, int lines, int turns) {
    return run_on(c, [=](std::byte* base, int) {
        stamp s;
        for (int t = 0; t < turns; ++t)
            for (int i = 0; i < lines; ++i)
                s = load(here, base + i * 64, 4, s);
    });
}

TEST(Levels, PointerChasesAddTheLatenciesOfAllLevels) {
    for (const char* share : {"tile", "chip"}) {
        const Config c = three(share);
        const auto of = [&](int lines) {
            return (chase(c, lines, 3).cycles - chase(c, lines, 2).cycles) / u(lines);
        };
        const cycle l1 = u(c.l1.latency), l2 = l1 + u(c.l2.latency), l3 = l2 + u(c.l3.latency);
        EXPECT_EQ(of(8), l1) << share;
        EXPECT_EQ(of(static_cast<int>(2 * c.l1.size_bytes / 64)), l2) << share;
        EXPECT_EQ(of(static_cast<int>(2 * c.l2.size_bytes / 64)), l3) << share;
        const Report r = chase(c, static_cast<int>(2 * c.l2.size_bytes / 64), 3);
        EXPECT_GT(cause(r, Cause::l3), 0U);
        EXPECT_EQ(r.memory.reads, u(2 * c.l2.size_bytes / 64));
    }
}

TEST(Levels, AMissPaysAllLevelsAndMemory) {
    for (const char* share : {"tile", "chip"}) {
        const Config c = three(share);
        EXPECT_EQ(chase(c, 1, 1).cycles,
                  u(c.l1.latency + c.l2.latency + c.l3.latency + c.memory.controller_cycles + c.memory.tRCD +
                    c.memory.tCL + c.memory.burst_clocks()))
            << share;
    }
}

// Independent loads that hit the L3: Little's law with the L2's MSHRs, and its banks.
TEST(Levels, BeyondTilesMshrsAndBanksLimit) {
    for (const integer mshrs : {1, 4}) {
        Config c = three("chip");
        c.l1.mshrs = c.l2.mshrs = mshrs;
        const int lines = static_cast<int>(2 * c.l2.size_bytes / 64);
        const auto cycles = [&](int turns) {
            return run_on(c,
                          [=](std::byte* base, int) {
                              for (int t = 0; t < turns; ++t)
                                  for (int i = 0; i < lines; ++i)
                                      load(here, base + i * 64, 4, stamp{});
                          })
                .cycles;
        };
        const double each = static_cast<double>(cycles(3) - cycles(2)) * static_cast<double>(mshrs) / lines;
        EXPECT_NEAR(each, static_cast<double>(c.l1.latency + c.l2.latency + c.l3.latency), 1) << mshrs;
    }
    Config c = three("chip");
    c.l1.mshrs = c.l2.mshrs = c.l3.mshrs = 256;
    c.l3.banks = 1;
    c.l3.bank_bytes = 4;
    const int lines = static_cast<int>(2 * c.l2.size_bytes / 64);
    const Report r = run_on(c, [=](std::byte* base, int) {
        for (int t = 0; t < 4; ++t)
            for (int i = 0; i < lines; ++i)
                load(here, base + i * 64, 4, stamp{});
    });
    const std::uint64_t accesses = r.l3[0].reads + r.l3[0].writes;
    EXPECT_GE(r.cycles, accesses * 16); // a line takes the bank for 16 cycles
    EXPECT_LE(r.cycles, accesses * 16 * 102 / 100);
}

// Cores whose L2s are their own hand a counter over through the L3.
TEST(Levels, SharedWordsMoveBetweenL2sOfCores) {
    for (const char* share : {"tile", "chip"}) {
        Config c = three(share);
        c.chip.cores = 2;
        c.l2.share = "core";
        Memory memory;
        auto* counter = reinterpret_cast<word*>(memory.data);
        const Report r = Machine(c).run(memory.space, 2, {{"work"}}, [&](int) { count_up(counter, 50); });
        EXPECT_EQ(counter->word, 100);
        EXPECT_EQ(r.l2.size(), 2U);
        EXPECT_GT(r.l2[0].invalidations, 10U) << share;
        EXPECT_GT(r.l2[1].invalidations, 10U) << share;
        EXPECT_GT(r.l3[0].hits, 20U) << share;
        EXPECT_EQ(r.memory.reads, 1U) << share;
    }
}

TEST(Levels, ReportsDoNotDependOnHostThreads) {
    for (const char* inclusion : {"none", "inclusive"})
        for (const char* share : {"chip", "4"})
            expect_equal_on_host_threads(
                [&](int host_threads) {
                    Config c = busy_tiles();
                    c.l3 = cache(c.l3, 8 * kib, 4, 64, share, inclusion);
                    const Report r = run_busy_tiles(c, host_threads);
                    EXPECT_GT(r.l3[0].hits, 0U);
                    return r;
                },
                std::string(inclusion) + share);
}

// What the program says is dead need not be written back from beyond the tiles either.
TEST(Levels, DiscardReachesBeyondTheTile) {
    for (const bool discarded : {false, true}) {
        Config c = three("chip");
        c.l1.size_bytes = c.l2.size_bytes = 4 * kib;
        const Report r = write_and_displace(c, discarded);
        EXPECT_EQ(r.memory.writes, discarded ? 0U : 512U);
    }
}

TEST(Levels, BadLevelsAreOneClearLine) {
    const std::string l3 = "[chip]\ntiles = 2\n[l3]\nsize_bytes = 1048576\n";
    EXPECT_EQ(mistake(l3), "");
    EXPECT_NE(mistake("[l4]\nsize_bytes = 1048576\n").find("give l3.size_bytes too"), std::string::npos);
    EXPECT_NE(mistake(l3 + "[l4]\nsize_bytes = 1048576\n").find("the last level alone"), std::string::npos);
    EXPECT_NE(mistake(l3 + "line_bytes = 32\n").find("less than l2.line_bytes"), std::string::npos);
    EXPECT_NE(mistake(l3 + "share = 3\n").find("does not divide chip.cores"), std::string::npos);
    EXPECT_NE(mistake(l3 + "share = 6\n").find("whole tiles"), std::string::npos);
    EXPECT_NE(mistake(l3 + "share = 2\n").find("make it a multiple"), std::string::npos);
    EXPECT_NE(mistake("[l2]\nshare = 8\n").find("the L2 lies in a tile"), std::string::npos);
    EXPECT_NE(mistake(l3 + "inclusion = \"exclusive\"\n").find("a tile or less"), std::string::npos);
    const std::string in_tile = l3 + "share = \"tile\"\ninclusion = \"exclusive\"\n";
    EXPECT_EQ(mistake(in_tile), "");
    EXPECT_NE(mistake(in_tile + "line_bytes = 128\n").find("l2.line_bytes"), std::string::npos);
    EXPECT_NE(mistake(in_tile + "[l2]\nwrite_policy = \"through\"\n").find("l2.write_policy must be back"),
              std::string::npos);
    EXPECT_NE(mistake(in_tile + "prefetcher = \"next\"\n").find("l3.prefetcher must be none"),
              std::string::npos);
    EXPECT_NE(
        mistake("[l2]\ninclusion = \"inclusive\"\nprefetcher = \"next\"\n").find("only the L1 may have"),
        std::string::npos);
    EXPECT_NE(mistake(l3 + "prefetcher = \"stride\"\n").find("nobody knows"), std::string::npos);
}

} // namespace
} // namespace sim::test
