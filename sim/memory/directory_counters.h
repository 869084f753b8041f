// What a directory counts (coherence.plain), with one line of meaning each.
#pragma once

#include "sim/memory/counters.h"

namespace sim {

struct DirectoryCounters {
    std::uint64_t reads = 0, writes = 0, upgrades = 0, silent_upgrades = 0, lost_upgrades = 0, claims = 0;
    std::uint64_t exclusive = 0, shared = 0;
    std::uint64_t forwards = 0, forwards_dirty = 0, forwards_clean = 0, forwards_stale = 0, written_back = 0;
    std::uint64_t invalidations = 0, invalidations_received = 0, invalidations_stale = 0,
                  acknowledgements = 0;
    std::uint64_t wait_cycles = 0;

    /// Lines that another tile's cache brought.
    std::uint64_t supplied() const { return forwards_dirty + forwards_clean; }
};
inline constexpr std::array<CounterRow<DirectoryCounters>, 18> directory_counters = {{
    {"reads", &DirectoryCounters::reads, "lines that last caches of tiles asked for"},
    {"writes", &DirectoryCounters::writes, "lines that they asked for to write them"},
    {"upgrades", &DirectoryCounters::upgrades, "rights to write lines that they shared, asked for"},
    {"silent_upgrades", &DirectoryCounters::silent_upgrades,
     "such rights that a cache had got with the line meanwhile: no message"},
    {"lost_upgrades", &DirectoryCounters::lost_upgrades,
     "of the upgrades, those whose line another had written meanwhile: it came again"},
    {"claims", &DirectoryCounters::claims,
     "messages of who writes a shared word that others may have its line"},
    {"exclusive", &DirectoryCounters::exclusive, "reads of lines that nobody else had: they may be written"},
    {"shared", &DirectoryCounters::shared, "reads of lines that others have too"},
    {"forwards", &DirectoryCounters::forwards, "requests sent on to the one cache that might write the line"},
    {"forwards_dirty", &DirectoryCounters::forwards_dirty,
     "of these, lines that it brought, and had changed"},
    {"forwards_clean", &DirectoryCounters::forwards_clean, "of these, lines that it brought unchanged"},
    {"forwards_stale", &DirectoryCounters::forwards_stale,
     "of these, lines that it had dropped without a word"},
    {"written_back", &DirectoryCounters::written_back,
     "changed lines that were written back as others read them"},
    {"invalidations", &DirectoryCounters::invalidations, "messages to sharers that another writes the line"},
    {"invalidations_received", &DirectoryCounters::invalidations_received, "of these, to caches that had it"},
    {"invalidations_stale", &DirectoryCounters::invalidations_stale,
     "of these, to caches that had dropped it without a word, or were asking for it again"},
    {"acknowledgements", &DirectoryCounters::acknowledgements, "messages that a sharer has dropped the line"},
    {"wait_cycles", &DirectoryCounters::wait_cycles,
     "cycles that forwarded requests waited until the owner itself had the line, summed"},
}};

} // namespace sim
