// What each level counts, with one line of meaning each.
#pragma once

#include <array>
#include <cstdint>

namespace sim {

template <class Counters> struct CounterRow {
    const char* name;
    std::uint64_t Counters::*count;
    const char* meaning;
};

struct CacheCounters {
    std::uint64_t reads = 0, writes = 0, hits = 0, hits_in_flight = 0, misses = 0, fills = 0, write_backs = 0;
    std::uint64_t invalidations = 0, discarded = 0, prefetches = 0, prefetches_dropped = 0, busy_cycles = 0;
};
inline constexpr std::array<CounterRow<CacheCounters>, 12> cache_counters = {{
    {"reads", &CacheCounters::reads, "read accesses"},
    {"writes", &CacheCounters::writes, "write accesses"},
    {"hits", &CacheCounters::hits, "accesses that found their line, on its way or there"},
    {"hits_in_flight", &CacheCounters::hits_in_flight,
     "of the hits, those that waited for a fill begun earlier"},
    {"misses", &CacheCounters::misses, "accesses that did not find their line"},
    {"fills", &CacheCounters::fills, "lines read from the level below"},
    {"write_backs", &CacheCounters::write_backs, "dirty lines sent to the level below"},
    {"invalidations", &CacheCounters::invalidations,
     "lines dropped because a shared word in them was written"},
    {"discarded", &CacheCounters::discarded, "dirty lines made clean because their contents were dead"},
    {"prefetches", &CacheCounters::prefetches, "fills begun by prefetch operations"},
    {"prefetches_dropped", &CacheCounters::prefetches_dropped,
     "prefetches dropped because every MSHR was busy"},
    {"busy_cycles", &CacheCounters::busy_cycles, "port or bank cycles taken"},
}};

struct MemoryCounters {
    std::uint64_t reads = 0, writes = 0, bursts = 0, row_hits = 0, row_empties = 0, row_conflicts = 0;
    std::uint64_t busy_clocks = 0, last_clock = 0;
};
inline constexpr std::array<CounterRow<MemoryCounters>, 8> memory_counters = {{
    {"reads", &MemoryCounters::reads, "lines read"},
    {"writes", &MemoryCounters::writes, "lines written"},
    {"bursts", &MemoryCounters::bursts, "bus bursts, of bus_bytes x burst_length bytes"},
    {"row_hits", &MemoryCounters::row_hits, "bursts whose row was open"},
    {"row_empties", &MemoryCounters::row_empties, "bursts whose bank had no open row"},
    {"row_conflicts", &MemoryCounters::row_conflicts, "bursts whose bank had another row open"},
    {"busy_clocks", &MemoryCounters::busy_clocks,
     "memory clocks in which a data bus moved data, all channels"},
    {"last_clock", &MemoryCounters::last_clock, "the clock in which the last burst ended"},
}};

} // namespace sim
