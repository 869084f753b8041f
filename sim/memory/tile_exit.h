// The way out of a tile: what a last cache of it asks for becomes requests, which are served when the window
// has ended (sim/machine/beyond.h holds that cache's MSHRs and write-back buffer, for that is where their
// times are known).
#pragma once

#include "sim/memory/attribution.h"
#include "sim/memory/below.h"
#include "sim/memory/tickets.h"
#include "sim/memory/under_way.h"

#include <utility>

namespace sim {

/// What left a tile since it was last emptied, through any of its exits.
struct Leaving {
    std::vector<Request> requests;
    std::uint64_t sequence = 0;
    std::uint64_t reads_at_once = 0, writes_at_once = 0; // lines, where memory's part takes no time
};

class TileExit final : public Below {
public:
    /// The tile's `exit`th; `to_memory`: no cache lies beyond. `coherent`: who reads memory is found there.
    TileExit(std::uint32_t tile, std::uint32_t exit, bool to_memory, bool coherent, Leaving& leaving,
             Tickets& tickets, Attribution& attribution)
        : tile_(tile), exit_(exit), to_memory_(to_memory), coherent_(coherent), leaving_(leaving),
          tickets_(tickets), attribution_(attribution) {}

    Answer read(const Access& a) override {
        if (to_memory_ && !coherent_)
            attribution_.count_memory_read(a.address, a.column);
        if (tickets_.at_once()) [[unlikely]] {
            ++leaving_.reads_at_once;
            return {a.at, Cause::memory};
        }
        Request r = request(a);
        r.write = std::exchange(followed_.write, Request::nothing);
        r.bytes = followed_.bytes;
        r.whole = followed_.whole;
        r.read = a.address;
        r.ticket = tickets_.open();
        r.exclusive = a.exclusive;
        leave(r);
        return {.ready = r.ticket, .from = Cause::memory, .shared = !a.exclusive};
    }
    Answer own(const Access& a) override {
        Request r = request(a);
        r.read = a.address;
        r.ticket = tickets_.open();
        r.kind = Request::upgrade;
        r.exclusive = true;
        leave(r);
        return {.ready = r.ticket, .from = Cause::coherence, .shared = true};
    }
    Answer write(const Access& a) override {
        if (to_memory_)
            attribution_.count_memory_write(a.address, a.column);
        if (tickets_.at_once()) [[unlikely]] {
            ++leaving_.writes_at_once;
            return {a.at, Cause::memory};
        }
        Request r = request(a);
        r.write = a.address;
        r.bytes = a.bytes;
        r.whole = a.whole;
        r.stays = a.stays;
        if (a.followed)
            followed_ = r;
        else
            leave(r);
        return {a.at, Cause::memory};
    }
    /// Word to the caches beyond.
    void tell(Request::Kind kind, std::uint64_t address, cycle at, std::size_t column) {
        Request r = request({address, 0, at, column});
        r.write = address;
        r.kind = kind;
        leave(r);
    }

    UnderWay under_way; // of a coherent machine: lines, by address

private:
    Request request(const Access& a) const {
        Request r{};
        r.at = a.at;
        r.tile = tile_;
        r.exit = exit_;
        r.column = a.column;
        return r;
    }
    void leave(Request r) {
        r.sequence = ++leaving_.sequence;
        if (coherent_ && (r.kind == Request::lines || r.kind == Request::upgrade)) {
            if (r.write != Request::nothing)
                under_way.writes(r.write);
            if (r.read != Request::nothing)
                under_way.asks(r.read, r.kind == Request::upgrade, r.sequence);
        }
        leaving_.requests.push_back(r);
    }

    std::uint32_t tile_, exit_;
    bool to_memory_, coherent_;
    Request followed_{}; // a write whose read has not come yet
    Leaving& leaving_;
    Tickets& tickets_;
    Attribution& attribution_;
};

} // namespace sim
