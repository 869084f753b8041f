// What lies beyond the tiles: the MSHRs and write-back buffers of the tiles' last caches, a level of caches
// that tiles share, if there is one, and memory. Requests are served between windows, in the order (cycle,
// tile, sequence). Requests go over the network (sim/network/ways.h), as do answers; an MSHR is held until
// the answer is back, a place in the buffer until what is written has arrived and been taken. Where tiles
// share a cache, a request that arrives takes its bank, in this order, and acts when the bank begins with it.
// What an inclusive cache drops there leaves the tiles at the end of the window, in which they may still have
// used it. Not modelled: that a bank stands still while a miss waits for an MSHR.
#pragma once

#include "sim/memory/below.h"
#include "sim/memory/cache.h"
#include "sim/memory/memory.h"
#include "sim/memory/pool.h"
#include "sim/network/ways.h"

#include <deque>
#include <functional>
#include <vector>

namespace sim {

struct Tile;

/// The memory as a cache beyond the tiles sees it.
class MemoryPort final : public Below {
public:
    MemoryPort(Memory& memory, Ways& ways, std::uint32_t cache)
        : memory_(memory), ways_(ways), cache_{Ways::Asker::cache, cache} {}
    /// Whose traffic follows.
    void charge(Attribution& attribution) { attribution_ = &attribution; }

    Answer read(const Access& a) override {
        ++attribution_->cell(a.address, a.column).memory_reads;
        const cycle ready = memory_.read(a.address, ways_.ask(cache_, a.address, a.at));
        return {ways_.answer(cache_, a.address, a.bytes, ready), Cause::memory};
    }
    Answer write(const Access& a) override {
        ++attribution_->cell(a.address, a.column).memory_writes;
        return {memory_.write(a.address, ways_.write(cache_, a.address, a.bytes, a.at)), Cause::memory};
    }

private:
    Memory& memory_;
    Ways& ways_;
    Ways::Asker cache_;
    Attribution* attribution_ = nullptr;
};

/// A cache of several tiles.
struct SharedCache {
    SharedCache(const Config& config, unsigned level, std::uint32_t number, const cycle& earliest,
                const SiteAtHand& site, Memory& memory, Ways& ways, Tickets& tickets,
                Attribution& attribution)
        : port(memory, ways, number),
          cache(config, level, false, earliest, site, port, tickets, attribution) {
        port.charge(attribution);
    }
    void charge(Attribution& attribution) {
        port.charge(attribution);
        cache.charge(attribution);
    }
    MemoryPort port;
    Cache cache;
};

class Beyond {
public:
    /// Answers a request's ticket: (tile, ticket, when and from where).
    using Reply = std::function<void(std::uint32_t, cycle, const Answer&)>;

    Beyond(const Config& config, Reply reply);
    /// The tiles that requests come from; once, before any.
    void connect(std::deque<Tile>& tiles);

    /// Takes what a tile sends; empties the list.
    void accept(std::vector<Request>& leaving);
    /// Serves everything that arrives before cycle `end`. What arrives after this is later.
    void serve(cycle end);
    static constexpr cycle everything = ~cycle{0};
    /// Memory writes what it has queued; returns the cycle from which on it and all requests are at rest.
    cycle drain() { return std::max({served_, ways_.network().quiet(), memory_.drain()}); }
    /// What follows counts by itself from this memory clock on.
    void count_from(std::uint64_t clock) { memory_.count_refreshes(clock); }
    /// The frame is over: dirty lines that `keep` says so of are written back.
    template <class Keep> void write_back(cycle t, std::size_t column, Keep keep) {
        for (SharedCache& shared : caches_)
            shared.cache.finish(std::max(t, served_ + shared.cache.latency()), column, keep);
    }
    /// Nothing follows: memory writes what it has queued.
    void finish() { memory_.finish(); }
    /// When the earliest request waits to be served; ~0: none does.
    cycle next() const { return waiting_.empty() ? ~cycle{0} : waiting_.front().at; }
    const Memory& memory() const { return memory_; }
    const Network& network() const { return ways_.network(); }
    const std::deque<SharedCache>& caches() const { return caches_; }
    std::uint64_t misplaced() const;

private:
    struct Port {
        OrderedPool mshrs, write_backs;
        std::vector<Request> held; // until it is known when an MSHR is free
    };
    void push(const Request& r);
    Request pop();
    Port& port_of(const Request& r) { return ports_[r.tile * exits_ + r.exit]; }
    SharedCache& cache_of(const Request& r) { return caches_[r.tile / tiles_sharing_]; }
    void serve_from_memory(Request r);
    void serve_from_cache(Request r);
    void arrive(Request r);
    void tell(Request r);
    Ways::Asker asker(const Request& r) const { return {Ways::Asker::tile, r.tile}; }
    void write(Request r);
    void read(Request r);

    std::size_t exits_, tiles_sharing_; // of a tile; of a cache
    std::uint32_t line_bytes_;          // of the tiles' last caches
    std::vector<Port> ports_;           // by tile and exit
    std::vector<Request> waiting_;      // a heap, earliest first
    cycle served_ = 0;
    Memory memory_;
    Ways ways_;
    Config config_;
    Tickets tickets_; // none is ever open
    SiteAtHand site_;
    std::deque<SharedCache> caches_;
    std::deque<Tile>* tiles_ = nullptr;
    Reply reply_;
};

} // namespace sim
