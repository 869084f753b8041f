// Coherent machines, and steps of chance on them beside a table of states (coherence_oracle.h).
#pragma once

#include "tests/sim/coherence_oracle.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <random>
#include <string>
#include <vector>

namespace sim::test {

inline Config coherent(Config c) {
    c.coherence.plain = "directory";
    for (CacheConfig* level : {&c.l2, &c.l3, &c.l4, &c.l5})
        if (level->size_bytes != 0 && level->share != "chip")
            level->inclusion = "inclusive";
    return c;
}

/// The same in the reference mode.
inline Config in_order_of_time(Config c) {
    c.sim.mode = "reference";
    c.sim.quantum = c.sim.window = 0;
    c.memory.controller = "queued";
    return c;
}

struct Step {
    int tile, core, line;
    bool write;
};

/// Each step's core acts when its turn comes, 4,000 cycles after the last.
inline Report act(Config c, const std::vector<Step>& steps, int lines_apart = 1) {
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

inline std::vector<Step> random_steps(std::uint32_t seed, int count, const Config& c, int lines) {
    std::mt19937 random(seed);
    std::vector<Step> out;
    for (int i = 0; i < count; ++i)
        out.push_back({static_cast<int>(random() % u(c.chip.tiles)),
                       static_cast<int>(random() % u(c.chip.cores)),
                       static_cast<int>(random() % static_cast<std::uint32_t>(lines)), random() % 3 == 0});
    return out;
}

inline OracleCounts counts_of(const Report& r) {
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

inline void expect_equal(const OracleCounts& a, const OracleCounts& b, const std::string& what) {
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

/// Tiles that see each other's requests.
inline Config snooping(Config c, integer buses) {
    c = coherent(c);
    c.coherence.plain = "snoop";
    c.network.topology = "bus";
    c.network.buses = buses;
    return c;
}

} // namespace sim::test
