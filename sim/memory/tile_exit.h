// The way out of a tile: what its last cache asks for becomes requests, which are served when the window has
// ended (sim/machine/beyond.h holds that cache's MSHRs and write-back buffer, for that is where their times
// are known).
#pragma once

#include "sim/memory/attribution.h"
#include "sim/memory/below.h"
#include "sim/memory/tickets.h"

#include <utility>

namespace sim {

class TileExit final : public Below {
public:
    TileExit(std::uint32_t tile, Tickets& tickets, Attribution& attribution)
        : tile_(tile), tickets_(tickets), attribution_(attribution) {}

    Answer read(const Access& a) override {
        ++attribution_.cell(a.address, a.column).memory_reads;
        Request r{a.at, tile_, 0, std::exchange(followed_, Request::nothing), a.address, tickets_.open()};
        leave(r);
        return {r.ticket, Cause::memory};
    }
    Answer write(const Access& a) override {
        ++attribution_.cell(a.address, a.column).memory_writes;
        if (a.followed)
            followed_ = a.address;
        else
            leave({a.at, tile_, 0, a.address});
        return {a.at, Cause::memory};
    }
    /// What left the tile since the caller last emptied it.
    std::vector<Request>& leaving() { return leaving_; }

private:
    void leave(Request r) {
        r.sequence = ++sequence_;
        leaving_.push_back(r);
    }

    std::uint32_t tile_;
    std::uint64_t followed_ = Request::nothing; // a write whose read has not come yet
    std::vector<Request> leaving_;
    std::uint64_t sequence_ = 0;
    Tickets& tickets_;
    Attribution& attribution_;
};

} // namespace sim
