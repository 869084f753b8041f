// A tile: cores, the caches below their L1s that lie within it, and the fibres that run on them. Within a
// window of time it knows nothing of other tiles.
#pragma once

#include "sim/core/core.h"
#include "sim/core/hart.h"
#include "sim/core/sites.h"
#include "sim/machine/intervals.h"
#include "sim/machine/published.h"
#include "sim/machine/scheduler.h"
#include "sim/machine/tile_events.h"
#include "sim/machine/word_queues.h"
#include "sim/memory/jitter.h"
#include "sim/memory/tile_exit.h"

#include <atomic>
#include <deque>
#include <optional>
#include <vector>

namespace sim {

struct Tile {
    Tile(const Config& config, std::uint32_t number, std::uint64_t window, LineMap& lines,
         std::size_t columns)
        : number(number), attribution(lines, number, columns),
          scheduler(static_cast<std::uint64_t>(config.sim.quantum), window,
                    static_cast<std::size_t>(config.sim.stack_kib) * 1024) {
        if (config.sim.mode == "reference")
            events.emplace(scheduler, tickets, site);
        make_caches(config);
    }

    /// Waits until a ticket is answered, or (no ticket) for the end of the window.
    struct Parked {
        Hart* hart;
        cycle ticket;
    };
    /// Waits to act on a word, or to be given a page, that other tiles may reach too: done between windows.
    struct Deed {
        cycle at;
        Hart* hart;
        std::function<void()> request; // empty: the hart itself acts
    };

    std::uint32_t number;
    TraceTap* tap = nullptr;       // if a trace is recorded
    cycle earliest = 0;            // no operation from now on acts before
    std::atomic<cycle> claimed{0}; // the end of the window that a thread of the host has begun with, or done
    Attribution attribution;
    Tickets tickets;
    SiteAtHand site; // for prefetchers by stride
    Sites load_sites;
    Leaving leaving;
    std::deque<TileExit> exits;                        // one a cache of the last level here
    std::array<std::deque<Cache>, most_levels> caches; // by level, from 1 on
    std::array<std::size_t, most_levels> sharing{};    // cores of such a cache
    std::deque<Jitter> jitters;                        // between the L1s and each L2, if wanted
    std::deque<TlbArray> second_tlbs;
    std::deque<SharedUnit> shared_units;
    std::deque<Core> cores;
    std::vector<Hart*> harts;
    Sites sites;
    Scheduler scheduler;
    std::optional<TileEvents> events;                           // of the reference mode: ...
    std::array<std::vector<Arrivals*>, most_levels> arrivals{}; // ... what comes to each of the caches
    Published published;                                        // words that only this tile has touched
    WordQueues queues;
    std::vector<Hart*> sleepers;
    std::vector<Parked> parked;
    std::vector<Deed> deeds;
    TileIntervals intervals;

    /// The next core, with its L1.
    Core& add_core(const Config& config, std::size_t pairing_ports);
    /// The cache of a level that this core of the tile uses.
    Cache& cache_of(unsigned level, std::size_t core) { return caches[level][core / sharing[level]]; }
    /// The way there.
    Below& way_to(unsigned level, std::size_t core) {
        return events ? static_cast<Below&>(*arrivals[level][core / sharing[level]]) : cache_of(level, core);
    }

private:
    void make_caches(const Config& config);
};

} // namespace sim
