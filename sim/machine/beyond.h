// What lies beyond the tiles: the MSHRs and write-back buffers of the tiles' last caches, a level of caches
// that tiles share, if there is one, and memory. Requests are served between windows, in the order (cycle,
// tile, sequence). Requests go over the network (sim/network/ways.h), as do answers; an MSHR is held until
// the answer is back, a place in the buffer until what is written has arrived and been taken. Where tiles
// share a cache, a request that arrives takes its bank, in this order, and acts when the bank begins with it.
// On buses whose tiles see each other's requests it is first known who has the line, and only what comes from
// the cache takes a bank. What an inclusive cache drops there leaves the tiles at the end of the window, in
// which they may still have used it. Not modelled: that a bank stands still while a miss waits for an MSHR.
//
// By memory's controller (memory.controller) it is one of two: immediate_beyond.h, queued_beyond.h.
#pragma once

#include "sim/machine/coherence.h"
#include "sim/memory/below.h"
#include "sim/memory/cache.h"
#include "sim/network/ways.h"

#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace sim {

struct Tile;

/// The way from a cache beyond the tiles to memory, where its traffic is counted.
class MemoryPort : public Below {
public:
    explicit MemoryPort(std::uint32_t cache) : who_{Ways::Asker::cache, cache} {}
    /// Whose traffic follows.
    void charge(Attribution& attribution) { attribution_ = &attribution; }

    Answer read(const Access& a) final {
        attribution_->count_memory_read(a.address, a.column);
        return read(a, *attribution_);
    }
    Answer write(const Access& a) final {
        attribution_->count_memory_write(a.address, a.column);
        return write(a, *attribution_);
    }

protected:
    virtual Answer read(const Access& a, Attribution& attribution) = 0;
    virtual Answer write(const Access& a, Attribution& attribution) = 0;

    Ways::Asker who_;

private:
    Attribution* attribution_ = nullptr;
};

/// A cache of several tiles.
struct SharedCache {
    SharedCache(const Config& config, unsigned level, const cycle& earliest, const SiteAtHand& site,
                MemoryPort& memory, Tickets& tickets, Attribution& attribution)
        : port(memory), cache(config, level, false, earliest, site, port, tickets, attribution) {
        port.charge(attribution);
    }
    void charge(Attribution& attribution) {
        port.charge(attribution);
        cache.charge(attribution);
    }
    MemoryPort& port;
    Cache cache;
};

class Beyond {
public:
    /// Answers a request's ticket: (tile, ticket, when and from where).
    using Reply = std::function<void(std::uint32_t, cycle, const Answer&)>;

    /// The one that the machine's memory.controller wants.
    static std::unique_ptr<Beyond> make(const Config& config, Reply reply);
    Beyond(const Beyond&) = delete;
    Beyond& operator=(const Beyond&) = delete;
    virtual ~Beyond() = default;

    /// The tiles that requests come from; once, before any.
    void connect(std::deque<Tile>& tiles);
    /// Takes what a tile sends; empties the list.
    void accept(std::vector<Request>& leaving);
    /// Serves everything that arrives before cycle `end`. What arrives after this is later.
    virtual void serve(cycle end) = 0;
    static constexpr cycle everything = ~cycle{0};
    /// Memory writes what it has queued; returns the cycle from which on it and all requests are at rest.
    virtual cycle drain() = 0;
    /// What follows counts by itself from this cycle on.
    virtual void count_from(cycle t) = 0;
    void judge_prefetches() {
        for (SharedCache& shared : caches_)
            shared.cache.judge_prefetches();
    }
    /// A line that is at memory at cycle `t`, or when those before it are, if that is (much) later: it is
    /// read or written, and nobody waits for the answer.
    virtual void ask_memory(bool write, std::uint64_t address, cycle t) = 0;
    /// How the cache here that a tile shares asks memory for the tile's sake.
    MemoryPort& way_to_memory(std::uint32_t tile);
    /// The frame is over: dirty lines that `keep` says so of are written back.
    template <class Keep> void write_back(cycle t, std::size_t column, Keep keep) {
        for (SharedCache& shared : caches_)
            shared.cache.finish(std::max(t, served_ + shared.cache.latency()), column, keep);
    }
    /// Nothing follows: memory writes what it has queued.
    virtual void finish() = 0;
    /// No request is answered by what happens before this cycle; ~0: none waits for an answer.
    virtual cycle next() = 0;
    /// Of memory: sums over all ranks, and each: rank r of channel c at c x ranks + r.
    virtual MemoryCounters counters() const = 0;
    virtual std::vector<MemoryCounters> rank_counters() const = 0;
    const Network& network() const { return ways_.network(); }
    void note_messages(std::vector<Network::Sent>* messages) { ways_.network().note_in(messages); }
    const std::deque<SharedCache>& caches() const { return caches_; }
    std::uint64_t misplaced() const;
    /// Null where plain data are not kept coherent.
    const Coherence* coherence() const { return coherence_.get(); }

protected:
    Beyond(const Config& config, Reply reply);
    /// Memory, as a cache here sees it, and the way there.
    virtual MemoryPort& memory_below(std::uint32_t cache) = 0;
    void push(const Request& r);
    Request pop();
    std::size_t port_of(const Request& r) const { return r.tile * exits_ + r.exit; }
    Ways::Asker asker(const Request& r) const { return {Ways::Asker::tile, r.tile}; }
    SharedCache& cache_of(const Request& r) { return caches_[r.tile / tiles_sharing_]; }
    /// A request leaves at `t` for where it is served next.
    virtual void send_on(const Request& r, const Ways::Leg& leg, cycle t) = 0;
    /// ... for the bank of a cache here, which it takes.
    virtual void send_to_bank(const Request& r, const Ways::Leg& leg, cycle t) = 0;
    /// It is there at `t` without a message.
    virtual void come_to_bank(const Request& r, cycle t) = 0;
    /// A line, or the right to write it, is asked for at `t`: at a bank of a cache here, or on the buses.
    void send_read(const Request& r, cycle t);
    /// A message of the directory's, or to it.
    virtual void send_word(const Ways::Leg& leg, cycle t, const Coherence::Arrives& arrives) = 0;
    void take_bank(Request r, cycle there);
    void charge(const Request& r);
    Attribution& attribution_of(const Request& r);
    void tell(Request r);

    static constexpr std::uint64_t disorder =
        4096; // memory clocks by which a request may be earlier than another

    std::size_t exits_, tiles_sharing_; // of a tile; of a cache
    std::uint32_t line_bytes_;          // of the tiles' last caches
    std::vector<Request> waiting_;      // a heap, earliest first
    cycle served_ = 0;
    Ways ways_;
    Config config_;
    bool snoops_;     // tiles see each other's requests
    Tickets tickets_; // of what caches here ask memory for
    std::deque<SharedCache> caches_;
    Reply reply_;
    std::unique_ptr<Coherence> coherence_; // if wanted

private:
    SiteAtHand site_;
    std::deque<Tile>* tiles_ = nullptr;
};

} // namespace sim
