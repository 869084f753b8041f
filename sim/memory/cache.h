// A cache of a tile: a core's L1, whose ports the core books, or a level below it, with banks interleaved by
// line, each busy while it moves what is asked for. Neither inclusive nor exclusive of the caches
// above. A line being filled counts as present; whoever hits it waits for the fill.
// Misses are held in MSHRs, evicted dirty lines in a write-back buffer; those of the last cache of a tile
// stand where their times are known, beyond the tile. Not modelled: ports and banks of fills; the network to
// the cores (its time is part of the latency); that a line which must make room before it has come would
// still be on its way; banks and ports of prefetches. What one operation writes of a line is written through
// together, a port's width for each of its accesses. A line written back is accepted when its bank has taken
// it, also where that evicts another dirty line.
#pragma once

#include "sim/config/config.h"
#include "sim/core/calendar.h"
#include "sim/memory/attribution.h"
#include "sim/memory/below.h"
#include "sim/memory/cache_array.h"
#include "sim/memory/counters.h"
#include "sim/memory/miss_causes.h"
#include "sim/memory/pool.h"
#include "sim/memory/prefetcher.h"

#include <bit>
#include <memory>
#include <vector>

namespace sim {

class Cache final : public Below {
public:
    /// `level`: 0 for an L1. `last`: below it the tile ends.
    Cache(const Config& machine, unsigned level, bool last, const cycle& earliest, const SiteAtHand& site,
          Below& below, Tickets& tickets, Attribution& attribution);

    /// A core's `accesses` accesses to the line (number) at cycle `t`.
    Answer access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t, std::size_t column) {
        if (special_) [[unlikely]]
            return special_access(line, write, accesses, t, column);
        CacheArray::Entry entry = array_.find(line);
        if (entry == CacheArray::none || array_.in_flight(entry)) [[unlikely]]
            return waiting_access(entry, line, write, accesses, t, column);
        array_.touch(entry);
        if (write)
            array_.set_dirty(entry, true);
        counters_.hits += accesses;
        count_accesses(line, write, accesses, column);
        return {t + latency_, Cause::l1};
    }
    /// Begins a fill if the line is absent and an MSHR is free.
    void prefetch(std::uint64_t address, cycle t, std::size_t column);

    /// A line of the cache above, or a word.
    Answer read(const Access& a) override { return serve(a, false); }
    /// A line written back from above, or a released word.
    Answer write(const Access& a) override { return serve(a, true); }
    /// A read-modify-write of a shared word: a read that leaves the line dirty.
    Answer modify(const Access& a) {
        Access change = a;
        change.modify = true;
        return serve(change, false);
    }
    /// A shared word in the line was written elsewhere: drops the line, writing it back if it is dirty.
    void invalidate(std::uint64_t address, cycle t, std::size_t column);
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t address);
    /// The frame is over: `keep(address)` says which dirty lines are written back; all others are dropped.
    template <class Keep> void finish(cycle t, std::size_t column, Keep keep) {
        array_.for_each([&](CacheArray::Entry e) {
            count_useless(e);
            array_.set_prefetched(e, false);
            if (!array_.dirty(e))
                return;
            if (keep(array_.line(e) << line_shift_))
                write_back(e, t, t, column, false, true);
            else
                ++counters_.dropped;
            array_.set_dirty(e, false);
        });
    }
    CacheCounters& counters() { return counters_; }
    const CacheCounters& counters() const { return counters_; }
    /// From this cycle on no bank is busy.
    cycle quiet() const { return quiet_; }

private:
    Cache(const Config& machine, const CacheConfig& config, unsigned level, bool last, const cycle& earliest,
          const SiteAtHand& site, Below& below, Tickets& tickets, Attribution& attribution);
    void count_accesses(std::uint64_t line, bool write, std::uint32_t accesses, std::size_t column) {
        Traffic& cell = attribution_.touch(line << line_shift_, column);
        (write ? counters_.writes : counters_.reads) += accesses;
        (write ? cell.l1_writes : cell.l1_reads) += accesses;
    }
    Answer waiting_access(CacheArray::Entry entry, std::uint64_t line, bool write, std::uint32_t accesses,
                          cycle t, std::size_t column);
    Answer in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present);
    Answer fill(std::uint64_t line, cycle t, cycle down, std::size_t column);
    cycle write_back(CacheArray::Entry entry, cycle t, cycle down, std::size_t column, bool followed,
                     bool forced);
    Answer special_access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t,
                          std::size_t column);
    Answer serve(const Access& a, bool write);
    Answer perform(const Access& a, std::uint64_t line, bool write, cycle done, bool& hit);
    Answer allocate(const Access& a, std::uint64_t line, bool write, cycle done);
    Answer send_on(const Access& a, cycle down);
    void prefetch_after(const Access& a, std::uint64_t line, bool first, cycle down);
    void count_cause(std::uint64_t line);
    void count_useless(CacheArray::Entry leaving) {
        counters_.prefetches_useless += array_.prefetched(leaving) ? 1 : 0;
    }

    unsigned level_, line_shift_, bank_shift_;
    std::uint32_t port_bytes_; // of the L1
    std::uint64_t latency_, bank_mask_;
    bool last_, through_, around_;
    bool special_;                 // an L1 that does more than the least
    bool used_prefetched_ = false; // by the access at hand, for the first time
    Cause cause_;
    TrafficOfLevel traffic_;
    CacheArray array_;
    std::vector<Calendar> banks_;
    Pool mshrs_, write_backs_;
    Prefetcher prefetcher_;
    std::unique_ptr<MissCauses> causes_; // if wanted
    cycle quiet_ = 0;
    CacheCounters counters_;
    Tickets& tickets_;
    Below& below_;
    const SiteAtHand& site_;
    Attribution& attribution_;
};

} // namespace sim
