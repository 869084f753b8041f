// What coherence between tiles counts (coherence.plain), with one line of meaning each.
#pragma once

#include "sim/memory/counters.h"

namespace sim {

struct CoherenceCounters {
    std::uint64_t reads = 0, writes = 0, upgrades = 0, silent_upgrades = 0, lost_upgrades = 0, claims = 0;
    std::uint64_t exclusive = 0, shared = 0;
    std::uint64_t forwards = 0, forwards_dirty = 0, forwards_clean = 0, forwards_stale = 0, written_back = 0;
    std::uint64_t invalidations = 0, invalidations_received = 0, invalidations_stale = 0,
                  acknowledgements = 0;
    std::uint64_t recalled_lines = 0, recalls = 0, recalls_received = 0, recalls_stale = 0, crowded = 0;
    std::uint64_t snoops = 0, passed_on = 0;
    std::uint64_t wait_cycles = 0;

    /// Lines that another tile's cache brought.
    std::uint64_t supplied() const { return forwards_dirty + forwards_clean; }
};
inline constexpr std::array<CounterRow<CoherenceCounters>, 25> coherence_counters = {{
    {"reads", &CoherenceCounters::reads, "lines that last caches of tiles asked for"},
    {"writes", &CoherenceCounters::writes, "lines that they asked for to write them"},
    {"upgrades", &CoherenceCounters::upgrades, "rights to write lines that they shared, asked for"},
    {"silent_upgrades", &CoherenceCounters::silent_upgrades,
     "such rights that a cache had got with the line meanwhile: no message"},
    {"lost_upgrades", &CoherenceCounters::lost_upgrades,
     "of the upgrades, those whose line another had written meanwhile: it came again"},
    {"claims", &CoherenceCounters::claims,
     "messages of who writes a shared word that others may have its line"},
    {"exclusive", &CoherenceCounters::exclusive, "reads of lines that nobody else had: they may be written"},
    {"shared", &CoherenceCounters::shared, "reads of lines that others have too"},
    {"forwards", &CoherenceCounters::forwards,
     "requests that the one cache that might write the line was told of"},
    {"forwards_dirty", &CoherenceCounters::forwards_dirty,
     "of these, lines that it brought, and had changed"},
    {"forwards_clean", &CoherenceCounters::forwards_clean, "of these, lines that it brought unchanged"},
    {"forwards_stale", &CoherenceCounters::forwards_stale,
     "of these, lines that it had dropped without a word"},
    {"written_back", &CoherenceCounters::written_back,
     "changed lines that were written back as others read them, or as they were recalled"},
    {"invalidations", &CoherenceCounters::invalidations,
     "sharers that were told that another writes the line"},
    {"invalidations_received", &CoherenceCounters::invalidations_received, "of these, to caches that had it"},
    {"invalidations_stale", &CoherenceCounters::invalidations_stale,
     "of these, to caches that had dropped it without a word, or were asking for it again"},
    {"acknowledgements", &CoherenceCounters::acknowledgements, "messages that a sharer has dropped the line"},
    {"recalled_lines", &CoherenceCounters::recalled_lines,
     "lines that left a directory with room for some (coherence.directory_entries) for others"},
    {"recalls", &CoherenceCounters::recalls, "caches that were told to drop such a line, and answered"},
    {"recalls_received", &CoherenceCounters::recalls_received, "of these, caches that had it"},
    {"recalls_stale", &CoherenceCounters::recalls_stale,
     "of these, caches that had dropped it without a word"},
    {"crowded", &CoherenceCounters::crowded,
     "requests that got an entry beyond its set, all lines of which were just being asked for"},
    {"snoops", &CoherenceCounters::snoops,
     "times that a last cache of a tile looked up what another one asked for (coherence.plain = snoop)"},
    {"passed_on", &CoherenceCounters::passed_on, "messages of the hub that tell another bus of a request"},
    {"wait_cycles", &CoherenceCounters::wait_cycles,
     "cycles that forwarded requests waited until the owner itself had the line, summed"},
}};

} // namespace sim
