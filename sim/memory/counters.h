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
    std::uint64_t invalidations = 0, back_invalidations = 0, clean_victims = 0, moved_up = 0, discarded = 0,
                  prefetches = 0, prefetches_dropped = 0, busy_cycles = 0, dropped = 0;
    std::uint64_t written_through = 0, written_around = 0;
    std::uint64_t hardware_prefetches = 0, prefetches_useful = 0, prefetches_late = 0, prefetches_useless = 0;
    std::uint64_t compulsory = 0, capacity = 0, conflict = 0, coherence = 0;
    std::uint64_t upgrades = 0, lost_upgrades = 0, downgrades = 0;
};
inline constexpr std::array<CounterRow<CacheCounters>, 29> cache_counters = {{
    {"reads", &CacheCounters::reads, "read accesses"},
    {"writes", &CacheCounters::writes, "write accesses"},
    {"hits", &CacheCounters::hits, "accesses that found their line, on its way or there"},
    {"hits_in_flight", &CacheCounters::hits_in_flight,
     "of the hits, those that waited for a fill begun earlier"},
    {"misses", &CacheCounters::misses, "accesses that did not find their line"},
    {"fills", &CacheCounters::fills, "lines read from the level below"},
    {"write_backs", &CacheCounters::write_backs, "dirty lines sent to the level below"},
    {"invalidations", &CacheCounters::invalidations,
     "lines dropped because others wrote them, or a shared word in them"},
    {"back_invalidations", &CacheCounters::back_invalidations,
     "lines dropped because an inclusive level below dropped theirs"},
    {"clean_victims", &CacheCounters::clean_victims, "clean lines sent to the exclusive level below"},
    {"moved_up", &CacheCounters::moved_up, "lines read from this exclusive level, and no longer in it"},
    {"discarded", &CacheCounters::discarded, "dirty lines made clean because their contents were dead"},
    {"prefetches", &CacheCounters::prefetches, "fills begun by prefetch operations"},
    {"prefetches_dropped", &CacheCounters::prefetches_dropped,
     "prefetches, also of hardware, dropped because every MSHR was busy or no other line could make room"},
    {"busy_cycles", &CacheCounters::busy_cycles, "port or bank cycles taken"},
    {"dropped", &CacheCounters::dropped, "dirty lines of data that died with the frame, never written back"},
    {"written_through", &CacheCounters::written_through,
     "writes sent to the level below, those around included"},
    {"written_around", &CacheCounters::written_around, "of these, writes that missed and brought no line"},
    {"hardware_prefetches", &CacheCounters::hardware_prefetches, "fills begun by the cache's prefetcher"},
    {"prefetches_useful", &CacheCounters::prefetches_useful, "of these, lines that were accessed"},
    {"prefetches_late", &CacheCounters::prefetches_late,
     "of these, on their way when they were first accessed"},
    {"prefetches_useless", &CacheCounters::prefetches_useless,
     "hardware prefetches of lines that left, or the frame ended, before they were accessed"},
    {"compulsory", &CacheCounters::compulsory, "misses of lines never asked for before (sim.miss_causes)"},
    {"capacity", &CacheCounters::capacity, "misses that a fully associative cache has too"},
    {"conflict", &CacheCounters::conflict, "misses that a fully associative cache does not have"},
    {"coherence", &CacheCounters::coherence, "misses of lines invalidated since they were last used"},
    {"upgrades", &CacheCounters::upgrades,
     "times that the level below was asked for the right to write a line that was here (coherence.plain)"},
    {"lost_upgrades", &CacheCounters::lost_upgrades,
     "times that caches above asked for the right to write a line that had left this one meanwhile, and came "
     "again (reference mode)"},
    {"downgrades", &CacheCounters::downgrades,
     "changed lines that were sent down because others read them (coherence.plain)"},
}};

/// Of a core's TLB, the second one behind it, and its walks.
struct TlbCounters {
    std::uint64_t lookups = 0, hits = 0, misses = 0, second_hits = 0, merged = 0, walks = 0;
    std::uint64_t walk_reads = 0, walk_spared = 0, walk_cycles = 0, walker_cycles = 0, wait_cycles = 0,
                  prefetches_dropped = 0;
};
inline constexpr std::array<CounterRow<TlbCounters>, 12> tlb_counters = {{
    {"lookups", &TlbCounters::lookups, "pages looked up: of an operation, each that it touches once"},
    {"hits", &TlbCounters::hits, "of these, pages that the core's TLB had"},
    {"misses", &TlbCounters::misses, "of these, pages that it did not have"},
    {"second_hits", &TlbCounters::second_hits, "misses that the second TLB answered"},
    {"merged", &TlbCounters::merged, "misses that waited for a walk that had begun for another"},
    {"walks", &TlbCounters::walks, "misses that walked through the page tables"},
    {"walk_reads", &TlbCounters::walk_reads, "entries of page tables read through the L1"},
    {"walk_spared", &TlbCounters::walk_spared, "levels of page tables that the walk cache spared"},
    {"walk_cycles", &TlbCounters::walk_cycles, "cycles of all walks, summed"},
    {"walker_cycles", &TlbCounters::walker_cycles, "cycles that misses waited for others' walks to end"},
    {"wait_cycles", &TlbCounters::wait_cycles, "cycles from a miss to its translation, summed"},
    {"prefetches_dropped", &TlbCounters::prefetches_dropped,
     "prefetch operations dropped because the core's TLB did not have their page"},
}};

struct MemoryCounters {
    std::uint64_t reads = 0, writes = 0, read_bursts = 0, write_bursts = 0, forwarded = 0, merged = 0;
    std::uint64_t row_hits = 0, row_empties = 0, row_conflicts = 0, activates = 0, reopened = 0,
                  precharges = 0, refreshes = 0;
    std::uint64_t batches = 0, turnarounds = 0, rank_switches = 0;
    std::uint64_t busy_clocks = 0, read_clocks = 0, queue_clocks = 0, read_wait_clocks = 0,
                  write_wait_clocks = 0;
    std::uint64_t last_clock = 0; // in which the last burst ended; of a sum, the latest
};
inline constexpr std::array<CounterRow<MemoryCounters>, 21> memory_counters = {{
    {"reads", &MemoryCounters::reads, "lines read"},
    {"writes", &MemoryCounters::writes, "lines written"},
    {"read_bursts", &MemoryCounters::read_bursts, "bursts read, of bus_bytes x burst_length bytes"},
    {"write_bursts", &MemoryCounters::write_bursts, "bursts written"},
    {"forwarded", &MemoryCounters::forwarded, "bursts read from the write queue instead"},
    {"merged", &MemoryCounters::merged, "bursts written into one that was still queued"},
    {"row_hits", &MemoryCounters::row_hits, "bursts whose row was open"},
    {"row_empties", &MemoryCounters::row_empties, "bursts whose bank had no open row"},
    {"row_conflicts", &MemoryCounters::row_conflicts, "bursts whose bank had another row open"},
    {"activates", &MemoryCounters::activates, "rows opened"},
    {"reopened", &MemoryCounters::reopened,
     "of these, once more for a burst whose row was closed before it was served"},
    {"precharges", &MemoryCounters::precharges, "rows closed, those closed by a refresh not counted"},
    {"refreshes", &MemoryCounters::refreshes,
     "refreshes of a rank, or of single banks, until the last burst; in order of time: while memory is used"},
    {"batches", &MemoryCounters::batches, "times that queued writes were sent (with a channel's first rank)"},
    {"turnarounds", &MemoryCounters::turnarounds,
     "neighbouring bursts of different direction (with a channel's first rank)"},
    {"rank_switches", &MemoryCounters::rank_switches,
     "neighbouring bursts of different ranks (with a channel's first rank)"},
    {"busy_clocks", &MemoryCounters::busy_clocks,
     "memory clocks in which a data bus moved data, all channels"},
    {"read_clocks", &MemoryCounters::read_clocks,
     "memory clocks from a read burst's arrival to its last data, summed"},
    {"queue_clocks", &MemoryCounters::queue_clocks,
     "of these, beyond what its own commands take in an idle memory"},
    {"read_wait_clocks", &MemoryCounters::read_wait_clocks,
     "memory clocks that read bursts waited for a place in the queue before, summed (queued controller)"},
    {"write_wait_clocks", &MemoryCounters::write_wait_clocks,
     "memory clocks that written bursts waited for a place in the queue, summed"},
}};
inline MemoryCounters& operator+=(MemoryCounters& sum, const MemoryCounters& c) {
    for (const auto& row : memory_counters)
        sum.*row.count += c.*row.count;
    sum.last_clock = sum.last_clock > c.last_clock ? sum.last_clock : c.last_clock;
    return sum;
}

} // namespace sim
