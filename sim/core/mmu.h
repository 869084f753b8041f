// What translates a core's addresses: its TLB, the second one that it may share with others, and its walks
// through the page tables (machine/translation.cpp).
#pragma once

#include "sim/config/config.h"
#include "sim/memory/counters.h"
#include "sim/memory/tlb.h"

#include <vector>

namespace sim {

struct Hart;

struct Mmu {
    Mmu(const TlbConfig& c, TlbArray& second)
        : first(static_cast<std::size_t>(c.entries), static_cast<std::size_t>(c.ways)), second(second),
          tables(static_cast<std::size_t>(c.walk_cache), 0), walkers(static_cast<std::size_t>(c.walkers)) {}

    /// A thread that waits for a walk to end; `t`: from when it goes on.
    struct Waiting {
        Hart* hart;
        cycle* t;
    };

    TlbArray first;
    TlbArray& second; // without entries: there is none
    TlbArray tables;  // the walk cache: entries of tables above the last
    Walkers walkers;
    std::vector<Waiting> waiting;
    TlbCounters counters;
};

} // namespace sim
