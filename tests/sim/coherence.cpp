// Coherence of plain data: who has which line, as a table of states says (coherence_oracle.h), what that
// takes, and that nothing else depends on it.
#include "sim/machine/energy.h"
#include "sim/validation/coherence_forms.h"
#include "tests/sim/coherence_oracle.h"
#include "tests/sim/networks.h"
#include "tests/sim/unchanging.h"

#include <fmt/format.h>

#include <map>
#include <random>

namespace sim::test {
namespace {

Config coherent(Config c) {
    c.coherence.plain = "directory";
    for (CacheConfig* level : {&c.l2, &c.l3, &c.l4, &c.l5})
        if (level->size_bytes != 0 && level->share != "chip")
            level->inclusion = "inclusive";
    return c;
}

struct Step {
    int tile, core, line;
    bool write;
};

/// Each step's core acts when its turn comes, 4,000 cycles after the last.
Report act(Config c, const std::vector<Step>& steps, int lines_apart = 1) {
    c.latency[static_cast<std::size_t>(operation::add)] = 1000;
    c.chip.threads = 1;
    c.chip.placement = "pack";
    c.sim.miss_causes = "on";
    const int cores = static_cast<int>(c.chip.cores);
    return run_on(
        c,
        [=](std::byte* base, int worker) {
            stamp clock;
            for (const Step& s : steps) {
                std::byte* p = base + s.line * lines_apart * 64;
                if (s.tile * cores + s.core == worker) {
                    if (s.write)
                        store(here, p, 4, clock, stamp{});
                    else
                        load(here, p, 4, clock);
                }
                for (int i = 0; i < 4; ++i)
                    clock = scalar_op(operation::add, clock);
            }
        },
        static_cast<int>(c.all_cores()));
}

std::vector<Step> random_steps(std::uint32_t seed, int count, const Config& c, int lines) {
    std::mt19937 random(seed);
    std::vector<Step> out;
    for (int i = 0; i < count; ++i)
        out.push_back({static_cast<int>(random() % u(c.chip.tiles)),
                       static_cast<int>(random() % u(c.chip.cores)),
                       static_cast<int>(random() % static_cast<std::uint32_t>(lines)), random() % 3 == 0});
    return out;
}

OracleCounts counts_of(const Report& r) {
    const CacheCounters l1 = r.cache_total(0), l2 = r.cache_total(1);
    const CoherenceCounters& d = r.coherence;
    OracleCounts out;
    out.l1_misses = l1.misses;
    out.l1_upgrades = l1.upgrades;
    out.l1_invalidations = l1.invalidations;
    out.l1_downgrades = l1.downgrades;
    out.l1_coherence = l1.coherence;
    out.l2_misses = l2.misses;
    out.l2_upgrades = l2.upgrades;
    out.l2_invalidations = l2.invalidations;
    out.l2_downgrades = l2.downgrades;
    out.l2_coherence = l2.coherence;
    out.reads = d.reads;
    out.writes = d.writes;
    out.exclusive = d.exclusive;
    out.shared = d.shared;
    out.forwards_dirty = d.forwards_dirty;
    out.forwards_clean = d.forwards_clean;
    out.invalidations = d.invalidations;
    out.fetched = l2.fills - d.supplied();
    out.recalled_lines = d.recalled_lines;
    out.recalls = d.recalls;
    return out;
}

void expect_equal(const OracleCounts& a, const OracleCounts& b, const std::string& what) {
    EXPECT_EQ(a.l1_misses, b.l1_misses) << what;
    EXPECT_EQ(a.l1_upgrades, b.l1_upgrades) << what;
    EXPECT_EQ(a.l1_invalidations, b.l1_invalidations) << what;
    EXPECT_EQ(a.l1_downgrades, b.l1_downgrades) << what;
    EXPECT_EQ(a.l1_coherence, b.l1_coherence) << what;
    EXPECT_EQ(a.l2_misses, b.l2_misses) << what;
    EXPECT_EQ(a.l2_upgrades, b.l2_upgrades) << what;
    EXPECT_EQ(a.l2_invalidations, b.l2_invalidations) << what;
    EXPECT_EQ(a.l2_downgrades, b.l2_downgrades) << what;
    EXPECT_EQ(a.l2_coherence, b.l2_coherence) << what;
    EXPECT_EQ(a.reads, b.reads) << what;
    EXPECT_EQ(a.writes, b.writes) << what;
    EXPECT_EQ(a.exclusive, b.exclusive) << what;
    EXPECT_EQ(a.shared, b.shared) << what;
    EXPECT_EQ(a.forwards_dirty, b.forwards_dirty) << what;
    EXPECT_EQ(a.forwards_clean, b.forwards_clean) << what;
    EXPECT_EQ(a.invalidations, b.invalidations) << what;
    EXPECT_EQ(a.fetched, b.fetched) << what;
    EXPECT_EQ(a.recalled_lines, b.recalled_lines) << what;
    EXPECT_EQ(a.recalls, b.recalls) << what;
}

TEST(Coherence, CountsEqualATableOfStates) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        Config c = simple();
        c.chip.tiles = 1 + seed % 4;
        c.chip.cores = 1 + seed / 4;
        c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[seed % 4];
        if (seed % 3 == 0)
            c = with_l3(c, 2);
        c = coherent(c);
        const std::vector<Step> steps = random_steps(seed, 500, c, 5);
        CoherenceOracle oracle(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores));
        for (const Step& s : steps)
            oracle.access(s.tile, s.core, s.line, s.write);
        expect_equal(counts_of(act(c, steps)), oracle.counts(), fmt::format("seed {}", seed));
    }
}

/// A directory's sets, least recently asked for first, before a table of states that has room for all.
class SmallDirectory {
public:
    SmallDirectory(const Config& c)
        : oracle_(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores)),
          ways_(u(c.coherence.directory_ways)),
          homes_(static_cast<int>(c.l3.size_bytes != 0 ? c.l3.banks : c.memory.channels)),
          sets_(static_cast<int>(c.coherence.directory_entries / c.coherence.directory_ways)) {}

    void access(const Step& s) {
        CoherenceOracle after = oracle_;
        after.access(s.tile, s.core, s.line, s.write);
        if (after.counts().asked() != oracle_.counts().asked()) {
            const int home = s.line % homes_; // lines lie side by side in channels and banks
            std::vector<int>& set =
                lines_[home * sets_ + static_cast<int>(Directory::set_of(u(s.line), u(sets_)))];
            if (std::erase(set, s.line) == 0 && set.size() == ways_) {
                oracle_.recall(set.front());
                set.erase(set.begin());
            }
            set.push_back(s.line);
        }
        oracle_.access(s.tile, s.core, s.line, s.write);
    }
    const OracleCounts& counts() const { return oracle_.counts(); }

private:
    CoherenceOracle oracle_;
    std::size_t ways_;
    int homes_, sets_;
    std::map<int, std::vector<int>> lines_;
};

TEST(Coherence, SmallDirectoriesRecallWhatTheyHaveNoRoomFor) {
    std::uint64_t recalls = 0, written = 0;
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        Config c = simple();
        c.chip.tiles = 1 + seed % 4;
        c.chip.cores = 1 + seed / 4 % 3;
        c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[seed % 4];
        if (seed % 3 == 0)
            c = with_l3(c, 2);
        c = coherent(c);
        c.coherence.directory_ways = 1 + seed % 3;
        c.coherence.directory_entries = c.coherence.directory_ways * (1 + seed / 3 % 2);
        EXPECT_NO_THROW(check_consistency(c, "small"));
        const std::vector<Step> steps = random_steps(seed, 500, c, 9);
        SmallDirectory small(c);
        for (const Step& s : steps)
            small.access(s);
        const Report r = act(c, steps);
        expect_equal(counts_of(r), small.counts(), fmt::format("seed {}", seed));
        EXPECT_EQ(r.coherence.recalls_stale + r.coherence.crowded, 0U);
        recalls += r.coherence.recalls;
        written += r.coherence.written_back;

        // One with room for all of them is a full map.
        const Report all = act(
            [&] {
                Config more = c;
                more.coherence.directory_ways = 9;
                more.coherence.directory_entries = 18;
                return more;
            }(),
            steps);
        c.coherence.directory_entries = 0;
        const Report full = act(c, steps);
        EXPECT_EQ(all.coherence.recalls, 0U);
        EXPECT_EQ(all.cycles, full.cycles);
        EXPECT_EQ(all.core.loads, full.core.loads);
        expect_equal(counts_of(all), counts_of(full), "full");
    }
    EXPECT_GT(recalls, 2000U);
    EXPECT_GT(written, 500U);
}

// A line gets an entry beyond its set where the only other one is just being asked for; the next that needs
// room there has both leave.
TEST(Coherence, CrowdedSetsEmptyAgain) {
    Config c = simple();
    c.chip.tiles = 3;
    c = coherent(c);
    c.chip.threads = c.chip.cores = 1;
    c.chip.placement = "pack";
    c.latency[static_cast<std::size_t>(operation::add)] = 10;
    c.coherence.directory_entries = c.coherence.directory_ways = 1;
    const Report r = run_on(
        c,
        [](std::byte* base, int worker) {
            stamp clock;
            const auto wait = [&clock](int cycles) {
                for (int i = 0; i < cycles / 10; ++i)
                    clock = scalar_op(operation::add, clock);
            };
            if (worker == 0)
                load(here, base, 4, clock);
            wait(2000);
            if (worker == 2)
                load(here, base, 4, clock);
            wait(6000);
            if (worker == 1)
                load(here, base + 64, 4, clock);
            wait(20);
            if (worker == 0)
                store(here, base, 4, clock, stamp{}); // a right, on its way when the other is looked up
            wait(8000);
            if (worker == 2)
                load(here, base + 128, 4, clock);
        },
        3);
    EXPECT_EQ(r.coherence.crowded, 1U);
    EXPECT_EQ(r.coherence.recalled_lines, 2U);
    EXPECT_EQ(r.coherence.recalls_received, 2U);
    EXPECT_EQ(r.coherence.written_back, 1U);
}

TEST(Directory, LinesOfAHomeUseAllSets) {
    // Lines whose home is the same: every k-th, or runs of them, as banks, channels and bank groups lie.
    for (const std::uint64_t sets : {16U, 64U, 100U})
        for (const auto& [run, apart] :
             {std::pair(1U, 1U), std::pair(1U, 8U), std::pair(4U, 32U), std::pair(2U, 64U)}) {
            std::vector<int> lines(sets);
            for (std::uint64_t i = 0; i < 64 * sets; ++i)
                ++lines[Directory::set_of(i / run * apart + i % run, sets)];
            EXPECT_GE(*std::min_element(lines.begin(), lines.end()), 32)
                << sets << ' ' << run << ' ' << apart;
            EXPECT_LE(*std::max_element(lines.begin(), lines.end()), 128)
                << sets << ' ' << run << ' ' << apart;
        }
}

/// Tiles that see each other's requests.
Config snooping(Config c, integer buses) {
    c = coherent(c);
    c.coherence.plain = "snoop";
    c.network.topology = "bus";
    c.network.buses = buses;
    return c;
}

TEST(Coherence, CountsOfCachesThatSnoopEqualTheTableToo) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        Config c = simple();
        c.chip.tiles = 2 + seed % 4;
        c.chip.cores = 1 + seed / 4;
        c = snooping(c, c.chip.tiles % 2 == 0 ? 1 + static_cast<integer>(seed / 4) % 2 : 1);
        const std::vector<Step> steps = random_steps(seed, 500, c, 5);
        CoherenceOracle oracle(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores));
        for (const Step& s : steps)
            oracle.access(s.tile, s.core, s.line, s.write);
        const Report r = act(c, steps);
        expect_equal(counts_of(r), oracle.counts(), fmt::format("seed {}", seed));
        EXPECT_EQ(r.coherence.forwards_stale + r.coherence.invalidations_stale, 0U);
    }
}

// Who drops a line without a word says so when asked: the next one to read it has it alone.
TEST(Coherence, CachesThatSnoopSayWhatTheyDropped) {
    for (const bool snoops : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c.l2.ways = 1;
        c = snoops ? snooping(c, 1) : coherent(c);
        const int sets = static_cast<int>(c.l2.size_bytes / c.l2.line_bytes);
        // Both read the line, the first drops it, and so does the second, which then reads it again.
        const Report r = act(c, {{0, 0, 0, false},
                                 {1, 0, 0, false},
                                 {0, 0, sets, false},
                                 {1, 0, 2 * sets, false},
                                 {1, 0, 0, false}});
        EXPECT_EQ(r.coherence.exclusive, snoops ? 4U : 3U);
        EXPECT_EQ(r.coherence.snoops, snoops ? 5U : 0U);
    }
}

// What one tile reads of what another has changed, memory has as well, without a message.
TEST(Coherence, MemoryTakesWhatPasses) {
    Config c = simple();
    c.chip.tiles = 4;
    c = snooping(c, 2);
    const Report r = act(c, {{0, 0, 0, true}, {3, 0, 0, false}});
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
    EXPECT_EQ(r.coherence.written_back, 1U);
    EXPECT_EQ(r.memory.reads, 1U);
    EXPECT_EQ(r.memory.writes, 1U);
    EXPECT_EQ(r.network.counters.writes, 0U);
    EXPECT_EQ(r.coherence.passed_on, 2U);
    EXPECT_EQ(r.coherence.snoops, 2 * 3U);
}

TEST(Coherence, NothingIsAskedWhereItIsOff) {
    Config c = simple();
    c.chip.tiles = 3;
    const std::vector<Step> steps = random_steps(1, 200, c, 5);
    const Report r = act(c, steps);
    EXPECT_EQ(r.cache_total(0).invalidations + r.cache_total(0).upgrades + r.cache_total(1).coherence, 0U);
    EXPECT_EQ(r.cache_total(1).misses, 15U) << "a line each";
    EXPECT_GT(act(coherent(c), steps).cache_total(1).coherence, 15U);
}

// An L1 that writes through asks nobody below for the right, but the L2 does; copies of the tile's other
// cores go.
TEST(Coherence, WritesThroughTakeOthersCopies) {
    for (const char* miss : {"allocate", "around"}) {
        Config c = simple();
        c.chip.tiles = c.chip.cores = 2;
        c.l1.write_policy = "through";
        c.l1.write_miss = miss;
        c = coherent(c);
        const auto counts = [&c](const std::vector<Step>& steps) { return act(c, steps); };
        Report r = counts({{0, 0, 0, false}, {0, 1, 0, false}, {0, 0, 0, true}, {0, 1, 0, false}});
        EXPECT_EQ(r.l1[1].invalidations, 1U);
        EXPECT_EQ(r.l1[1].misses, 2U);
        EXPECT_EQ(r.l1[0].misses, 1U);
        EXPECT_EQ(r.cache_total(1).upgrades, 0U) << "the tile has it alone";
        r = counts({{0, 0, 0, false}, {1, 0, 0, false}, {1, 1, 0, false}, {0, 0, 0, true}, {1, 1, 0, false}});
        EXPECT_EQ(r.cache_total(0).upgrades, 0U);
        EXPECT_EQ(r.l2[0].upgrades, 1U);
        EXPECT_EQ(r.l2[1].invalidations, 1U);
        EXPECT_EQ(r.l1[2].invalidations + r.l1[3].invalidations, 2U);
        EXPECT_EQ(r.coherence.forwards_dirty, 1U);
        r = counts({{0, 0, 0, false}, {1, 0, 0, true}});
        EXPECT_EQ(r.l1[0].invalidations, 1U);
        EXPECT_EQ(r.coherence.writes, 1U);
    }
}

// Three caches of a tile one below the other: who asks goes all the way down, and back up on the other side.
TEST(Coherence, InnerLevelsGiveLinesUpToo) {
    Config c = simple();
    c.chip.tiles = 2;
    c.chip.cores = 4;
    c.l2.share = "2";
    c.l3.size_bytes = 64 * kib;
    c.l3.share = "tile";
    c.l3.ways = 4;
    c.l3.line_bytes = 2 * c.l2.line_bytes;
    c = coherent(c);
    // Within the tile, from the other pair: the line comes from the L1 that changed it.
    Report r = act(c, {{0, 0, 0, true}, {0, 2, 0, false}, {0, 3, 0, true}});
    EXPECT_EQ(r.l1[0].downgrades, 1U);
    EXPECT_EQ(r.l2[0].downgrades, 1U);
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[2].invalidations, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 0U);
    EXPECT_EQ(r.coherence.writes, 1U);
    EXPECT_EQ(r.coherence.reads + r.coherence.upgrades, 0U) << "the tile has it";
    // From the other tile: two lines of the L2s are one of the L3.
    r = act(c, {{0, 0, 0, true}, {0, 2, 1, true}, {1, 1, 1, true}});
    EXPECT_EQ(r.l1[0].invalidations, 1U);
    EXPECT_EQ(r.l1[2].invalidations, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 1U);
    EXPECT_EQ(r.l3[0].invalidations, 1U);
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
}

// A line that left without a word is asked of who had it in vain, one that was written back is not.
TEST(Coherence, WhatLeavesDirtyIsKnown) {
    for (const bool write : {false, true}) {
        Config c = simple();
        c.chip.tiles = 2;
        c.l2.ways = 1;
        c = coherent(c);
        const int sets = static_cast<int>(c.l2.size_bytes / c.l2.line_bytes);
        const Report r = act(c, {{0, 0, 0, write}, {0, 0, sets, false}, {1, 0, 0, false}});
        EXPECT_EQ(r.l2[0].write_backs, write ? 1U : 0U);
        EXPECT_EQ(r.coherence.forwards_stale, write ? 0U : 1U);
        EXPECT_EQ(r.coherence.forwards, r.coherence.forwards_stale);
        EXPECT_EQ(r.memory.reads, 3U);
    }
}

/// Loads and stores of few lines by all threads, as chance wants it.
Report contend(const Config& c, std::uint32_t seed, int host_threads = 1, const RunOptions& options = {}) {
    Memory memory;
    return Machine(c).run(
        memory.space, static_cast<int>(c.all_threads()), {{"work"}},
        [&](int w) {
            std::mt19937 random(seed * 1000 + static_cast<std::uint32_t>(w));
            stamp last;
            for (int i = 0; i < 150; ++i) {
                std::byte* p = memory.data + random() % 40 * 64 + random() % 16 * 4;
                std::byte* far = memory.more + random() % 4096 * 64;
                switch (random() % 6) {
                case 0:
                    store(here, p, 4, last, stamp{});
                    break;
                case 1:
                    store_vector(here, p, all_lanes, last, stamp{}, stamp{});
                    break;
                case 2:
                    load(here, far, 4, last);
                    break;
                case 3:
                    isa::timing::prefetch(here, p, last);
                    break;
                case 4:
                    load(here, p, 4, stamp{});
                    break;
                default:
                    last = load(here, p, 4, last);
                }
            }
        },
        host_threads, options);
}

/// Tiles that fight for lines, with caches that keep few of them.
Config fighting(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto pick = [&](std::initializer_list<integer> all) { return all.begin()[random() % all.size()]; };
    Config c;
    c.chip.tiles = pick({2, 3, 5, 8});
    c.chip.cores = pick({1, 2, 4});
    c.chip.threads = pick({1, 2});
    c.core.window = pick({1, 8, 60});
    c.core.store_buffer = pick({0, 4});
    c.l1.size_bytes = pick({256, 1024, 8192});
    c.l1.ways = 2;
    c.l1.line_bytes = pick({32, 64});
    c.l1.mshrs = pick({1, 4, 16});
    c.l1.write_policy = pick({0, 3}) == 0 ? "through" : "back";
    c.l1.prefetcher = "none";
    c.l2.size_bytes = pick({1024, 4096, 65536});
    c.l2.ways = 4;
    c.l2.line_bytes = pick({64, 128});
    c.l2.mshrs = pick({1, 3, 16});
    c.l2.write_back_buffer = pick({1, 8});
    if (c.chip.cores == 4 && pick({0, 1}) == 0) {
        c.l2.share = std::string("2");
        if (pick({0, 1}) == 0) {
            c.l3.size_bytes = 8192;
            c.l3.line_bytes = 128;
            c.l3.ways = 4;
            c.l3.share = std::string("tile");
        }
    }
    if (c.l3.size_bytes == 0 && pick({0, 1}) == 0) {
        c.l3.size_bytes = pick({8192, 262144});
        c.l3.line_bytes = 128;
        c.l3.ways = 8;
        c.l3.mshrs = pick({1, 16});
        c.l3.share = std::string("chip");
        c.l3.inclusion = pick({0, 1}) == 0 ? "none" : "inclusive";
    }
    c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[random() % 4];
    c.network.link_bytes = pick({2, 32});
    c.coherence.directory_cycles = pick({1, 6, 200});
    c.memory.channels = pick({1, 2});
    c.sim.quantum = pick({0, 10, 1000});
    c.sim.window = pick({0, 0, 30, 500, 5000});
    c.sim.miss_causes = pick({0, 1}) == 0 ? "on" : "off";
    c.sim.jitter = pick({0, 1});
    return coherent(c);
}

/// The same with directories that have room for few lines.
Config fighting_for_entries(std::uint32_t seed) {
    Config c = fighting(seed);
    c.coherence.directory_ways = std::array{1, 2, 4}[seed % 3];
    c.coherence.directory_entries = c.coherence.directory_ways * std::array{1, 4, 16}[seed / 3 % 3];
    return c;
}

/// What so many of these machines count together; the laws say that every copy is known, and that one cache
/// alone may write a line.
CoherenceCounters fight(Config (*machine)(std::uint32_t), std::uint32_t seeds) {
    CoherenceCounters sum;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        const Config c = machine(seed);
        EXPECT_NO_THROW(check_consistency(c, "fighting")) << seed;
        Report r;
        EXPECT_NO_THROW(r = contend(c, seed)) << seed;
        for (const auto& row : coherence_counters)
            sum.*row.count += r.coherence.*row.count;
    }
    return sum;
}

TEST(Coherence, TilesThatFightKeepTheLaws) {
    const CoherenceCounters all = fight(fighting, 300);
    EXPECT_GT(all.lost_upgrades, 100U);
    EXPECT_GT(all.silent_upgrades, 100U);
    EXPECT_GT(all.invalidations_stale, 100U);
    EXPECT_GT(all.forwards_dirty, 1000U);
    EXPECT_GT(all.wait_cycles, 1000U);
}

TEST(Coherence, TilesThatFightForEntriesKeepTheLaws) {
    const CoherenceCounters all = fight(fighting_for_entries, 300);
    EXPECT_GT(all.recalls_received, 10000U);
    EXPECT_GT(all.recalls_stale, 1000U);
    EXPECT_GT(all.crowded, 100U);
    EXPECT_GT(all.lost_upgrades, 100U);
}

/// The same on buses.
Config fighting_on_buses(std::uint32_t seed) {
    Config c = fighting(seed);
    if (c.l3.share == "chip")
        c.l3.size_bytes = 0;
    c.coherence.snoop_cycles = std::array{1, 6, 200}[seed % 3];
    return snooping(c, c.chip.tiles == 8   ? integer{1} << (seed / 3 % 4)
                       : c.chip.tiles == 2 ? 1 + seed % 2
                                           : 1);
}

TEST(Coherence, TilesThatFightOnBusesKeepTheLaws) {
    const CoherenceCounters all = fight(fighting_on_buses, 200);
    EXPECT_GT(all.lost_upgrades, 50U);
    EXPECT_GT(all.silent_upgrades, 50U);
    EXPECT_GT(all.forwards_dirty, 1000U);
    EXPECT_GT(all.passed_on, 1000U);
}

TEST(Coherence, ReportsDoNotDependOnTheHost) {
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        const Config c = seed <= 8    ? fighting(seed)
                         : seed <= 12 ? fighting_for_entries(seed)
                                      : fighting_on_buses(seed);
        expect_equal_on_host_threads([&](int threads) { return contend(c, seed, threads); },
                                     fmt::format("seed {}", seed));
        expect_equal_in_any_order(
            [&](std::uint32_t order) { return contend(c, seed, 1, {.host_order = order}); },
            fmt::format("seed {}", seed));
    }
}

// A word's writer takes its line from a tile that read plain data in it, and who writes words has their
// lines.
TEST(Coherence, SharedWordsAreInTheDirectory) {
    Config c = simple();
    c.chip.tiles = 2;
    c = coherent(c);
    const Shared s;
    const Report r = s.run(c, 2, [&](int w) {
        load(here, s.at(0), 4, stamp{});
        if (w == 0)
            release_after(s.at(0), 20000);
    });
    EXPECT_EQ(r.coherence.claims, 1U);
    EXPECT_EQ(r.coherence.invalidations_received, 1U);
    EXPECT_EQ(r.l2[1].invalidations, 1U);
    expect_equal_on_host_threads(
        [&](int host_threads) {
            Config busy = coherent(busy_tiles());
            busy.network.topology = "ring";
            const Report words = run_busy_tiles(busy, host_threads);
            EXPECT_GT(words.coherence.writes, 100U);
            return words;
        },
        "words");
}

// Two tiles that share a line write it in one window: the second one's line is taken while it asks for the
// right, comes again, and stays.
TEST(Coherence, WhatIsAskedForAgainStays) {
    Config c = simple();
    c.chip.tiles = 2;
    c.sim.window = 5000;
    c.latency[static_cast<std::size_t>(operation::add)] = 5000;
    c.latency[static_cast<std::size_t>(operation::multiply)] = 50;
    const Report r = run_on(
        coherent(c),
        [](std::byte* base, int w) {
            load(here, base, 4, stamp{});
            const stamp later = scalar_op(operation::add, stamp{});
            store(here, base, 4, w == 0 ? later : scalar_op(operation::multiply, later), stamp{});
            stamp s = later;
            for (int i = 0; i < 4; ++i)
                s = scalar_op(operation::add, s);
            if (w == 1)
                load(here, base, 4, s);
        },
        2);
    EXPECT_EQ(r.coherence.upgrades, 2U);
    EXPECT_EQ(r.coherence.lost_upgrades, 1U);
    EXPECT_EQ(r.coherence.invalidations_stale, 1U);
    EXPECT_EQ(r.coherence.forwards_dirty, 1U);
    EXPECT_EQ(r.l2[1].misses, 1U);
    EXPECT_EQ(r.l2[0].invalidations, 1U);
}

// What is written back when a frame ends stays in its cache, and the next frame finds it there.
TEST(Coherence, LinesOutliveAFrame) {
    isa::address_space space{std::uint64_t{1} << 20};
    std::byte* data = space.add("data", -1, std::uint64_t{1} << 16, false);
    Config c = simple();
    c.chip.tiles = 2;
    c = coherent(c);
    Report r;
    ASSERT_NO_THROW(r = Machine(c).run(space, 2, {{"work"}},
                                       [&](int w) {
                                           for (int i = 0; i < 8; ++i)
                                               store(here, data + (w * 8 + i) * 64, 4, stamp{}, stamp{});
                                       },
                                       1, {.frames = 2}));
    EXPECT_EQ(r.memory.writes, 16U);
    EXPECT_EQ(r.cache_total(1).misses, 0U);
    EXPECT_EQ(r.coherence.upgrades + r.coherence.silent_upgrades + r.coherence.writes, 0U);
}

// One access at a time: the windows' length does not matter.
TEST(Coherence, WindowsChangeNothingForWhoTakesTurns) {
    for (const std::string topology : {"ideal", "mesh", "bus"})
        expect_equal_in_windows(
            [&](integer window) {
                Config c = simple();
                c.core.window = 1;
                c.chip.tiles = 3;
                c.chip.cores = 2;
                c.network.topology = topology;
                c.sim.window = window;
                c = topology == "bus" ? snooping(c, 3) : coherent(c);
                return act(c, random_steps(7, 100, c, 4));
            },
            topology);
}

TEST(Coherence, LookUpsHaveTheirEnergy) {
    const auto part = [](const Report& r, const std::string& name) {
        for (const EnergyPart& p : energy_parts(r))
            if (p.part == name)
                return p;
        return EnergyPart{"none", 0, 0, ""};
    };
    const std::vector<Step> steps = {{0, 0, 0, true}, {1, 0, 0, false}, {0, 0, 0, true}, {2, 0, 1, false}};
    Config c = simple();
    c.chip.tiles = 3;
    EXPECT_EQ(part(act(c, steps), "directory").part, std::string("none"));
    c = coherent(c);
    c.energy.directory_pj = 20;
    c.energy.snoop_pj = 7;
    EXPECT_EQ(part(act(c, steps), "directory").events, 4U) << "two reads, a write, an upgrade";
    EXPECT_DOUBLE_EQ(part(act(c, steps), "directory").joules, 4 * 20e-12);
    EXPECT_EQ(part(act(c, steps), "snoops").part, std::string("none"));
    c.coherence.directory_entries = c.coherence.directory_ways = 1;
    EXPECT_EQ(part(act(c, steps), "directory").events, 5U) << "and a line recalled";
    c = snooping(c, 1);
    EXPECT_DOUBLE_EQ(part(act(c, steps), "snoops").joules, 4 * 2 * 7e-12);
    EXPECT_EQ(part(act(c, steps), "directory").part, std::string("none"));
}

TEST(Coherence, WhatItNeedsIsSaid) {
    const std::string on = "coherence.plain = \"directory\"\n";
    EXPECT_EQ(mistake(on + "l2.inclusion = \"inclusive\"\n"), "");
    EXPECT_NE(mistake(on).find("l2.inclusion must be inclusive, not none"), std::string::npos);
    EXPECT_NE(
        mistake(on + "l2.inclusion = \"inclusive\"\nl2.write_policy = \"through\"\n").find("l2.write_policy"),
        std::string::npos);
    EXPECT_NE(
        mistake(on + "l2.inclusion = \"inclusive\"\nsim.mode = \"reference\"\n").find("memory.controller"),
        std::string::npos);
    EXPECT_NE(mistake(on +
                      "l2.inclusion = \"inclusive\"\nchip.tiles = 4\nl3.size_bytes = 65536\nl3.ways = 8\n"
                      "l3.share = 8\n")
                  .find("l3.share"),
              std::string::npos);
    const std::string entries = on + "l2.inclusion = \"inclusive\"\ncoherence.directory_entries = ";
    EXPECT_EQ(mistake(entries + "24\n"), "");
    EXPECT_NE(mistake(entries + "20\n").find("no multiple of coherence.directory_ways, 8"),
              std::string::npos);
    const std::string snoops = "coherence.plain = \"snoop\"\nl2.inclusion = \"inclusive\"\n",
                      bus = "network.topology = \"bus\"\n";
    EXPECT_EQ(mistake(snoops + bus), "");
    EXPECT_NE(mistake(snoops).find("network.topology must be bus, not ideal"), std::string::npos);
    EXPECT_NE(mistake(snoops + bus + "chip.tiles = 4\nl3.size_bytes = 65536\nl3.ways = 8\n").find("l3.share"),
              std::string::npos);
    EXPECT_NE(mistake(bus + "chip.tiles = 4\nnetwork.buses = 3\n").find("make it a divisor"),
              std::string::npos);
}

TEST(Coherence, BrokenNumbersAreNoticed) {
    Config c = simple();
    c.chip.tiles = 2;
    const std::vector<Step> steps = {{0, 0, 0, true}, {1, 0, 0, false}, {0, 0, 0, true}};
    const Report snooped = act(snooping(c, 2), steps);
    EXPECT_NO_THROW(check_laws(snooped));
    for (const auto count : {&CoherenceCounters::snoops, &CoherenceCounters::passed_on,
                             &CoherenceCounters::acknowledgements, &CoherenceCounters::claims}) {
        Report r = snooped;
        ++(r.coherence.*count);
        EXPECT_THROW(check_laws(r), std::logic_error);
    }
    c = coherent(c);
    const Report good = act(c, steps);
    EXPECT_NO_THROW(check_laws(good));
    for (const auto& row : coherence_counters)
        if (row.count != &CoherenceCounters::wait_cycles && row.count != &CoherenceCounters::claims &&
            row.count != &CoherenceCounters::lost_upgrades) {
            Report r = good;
            ++(r.coherence.*row.count);
            EXPECT_THROW(check_laws(r), std::logic_error) << row.name;
        }
    Report r = good;
    ++r.incoherent_lines;
    EXPECT_THROW(check_laws(r), std::logic_error);
    r = good;
    ++r.l2[0].upgrades;
    EXPECT_THROW(check_laws(r), std::logic_error);
}

} // namespace
} // namespace sim::test
