// The cache that the cores of a tile share: banks interleaved by line, a bank busy while it moves a line,
// write-back, write-allocate, neither inclusive nor exclusive of the L1s. A line being filled counts as
// present; whoever hits it waits for the fill. A miss leaves the tile: it is a ticket, answered when the
// window has ended (sim/machine/beyond.h holds the L2's MSHRs and write-back buffer, for that is where their
// times are known). Not modelled: the network to the cores (its time is part of the latency), bank ports of
// fills. A written-back line is accepted when its bank has taken it, also where that evicts another dirty
// line.
#pragma once

#include "sim/config/config.h"
#include "sim/core/calendar.h"
#include "sim/memory/attribution.h"
#include "sim/memory/cache_array.h"
#include "sim/memory/counters.h"
#include "sim/memory/tickets.h"

#include <vector>

namespace sim {

/// When an access is served (a cycle or a ticket), and what serves it. Or, `retry` not 0: nothing has
/// happened, for an MSHR or buffer is not free; ask again at that cycle, or (unknown) when the window has
/// ended.
struct Answer {
    static constexpr cycle unknown = ~cycle{0};
    cycle ready;
    Cause from;
    cycle retry = 0;

    static Answer later(cycle when) { return {0, Cause::mshrs, when}; }
};

/// What leaves a tile: a dirty line to be written, a line to be read, or the one and then the other.
struct Request {
    static constexpr std::uint64_t nothing = ~std::uint64_t{0};
    cycle at;
    std::uint32_t tile;
    std::uint64_t sequence;                        // within its tile
    std::uint64_t write = nothing, read = nothing; // addresses
    cycle ticket = 0;                              // of the read
};

class L2 {
public:
    L2(const Config& config, std::uint32_t tile, const cycle& earliest, Tickets& tickets,
       Attribution& attribution);

    /// A line of the level above, at any byte address in it.
    Answer read(std::uint64_t address, cycle t, std::size_t column) {
        return access(address, t, column, false, true);
    }
    /// A line written back from above, or a released word; `whole` lines need no fill. Ready when it is
    /// accepted.
    Answer write(std::uint64_t address, cycle t, std::size_t column, bool whole) {
        return access(address, t, column, true, !whole);
    }
    /// A read-modify-write of a shared word: a read that leaves the line dirty.
    Answer modify(std::uint64_t address, cycle t, std::size_t column) {
        Answer a = access(address, t, column, false, true);
        array_.set_dirty(array_.find(address >> line_shift_), true);
        return a;
    }
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t address);
    /// A shared word in the line was written in another tile: drops the line, writing it back if it is dirty.
    void invalidate(std::uint64_t address, cycle t, std::size_t column);
    /// The frame is over: `keep(address)` says which dirty lines are written back; all others are dropped.
    template <class Keep> void finish(cycle t, std::size_t column, Keep keep) {
        array_.for_each([&](CacheArray::Entry e) {
            if (!array_.dirty(e))
                return;
            std::uint64_t address = array_.line(e) << line_shift_;
            if (keep(address)) {
                note_write_back(address, column);
                leave({t, tile_, 0, address});
            } else {
                ++counters_.dropped;
            }
            array_.set_dirty(e, false);
        });
    }
    const CacheCounters& counters() const { return counters_; }
    /// From this cycle on no bank is busy.
    cycle quiet() const { return quiet_; }
    /// What left the tile since the caller last emptied it.
    std::vector<Request>& leaving() { return leaving_; }

private:
    struct Flight {
        std::uint64_t line;
        cycle until; // a cycle or a ticket
    };
    Answer access(std::uint64_t address, cycle t, std::size_t column, bool write, bool needs_data);
    Answer in_flight(CacheArray::Entry entry, std::uint64_t line, cycle done);
    cycle arrival(std::uint64_t line);
    void note_write_back(std::uint64_t address, std::size_t column);
    void leave(Request r) {
        r.sequence = ++sequence_;
        leaving_.push_back(r);
    }

    std::uint32_t tile_;
    unsigned line_shift_;
    std::uint64_t latency_, bank_mask_;
    std::uint32_t occupancy_;
    bool whole_lines_;
    CacheArray array_;
    std::vector<Calendar> banks_;
    std::vector<Flight> flights_;
    std::size_t flight_limit_;
    std::vector<Request> leaving_;
    std::uint64_t sequence_ = 0;
    cycle quiet_ = 0;
    CacheCounters counters_;
    Tickets& tickets_;
    Attribution& attribution_;
};

} // namespace sim
