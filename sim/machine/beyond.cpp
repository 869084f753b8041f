#include "sim/machine/beyond.h"

#include "sim/machine/immediate_beyond.h"
#include "sim/machine/queued_beyond.h"
#include "sim/machine/tile.h"

#include <algorithm>
#include <tuple>

namespace sim {
namespace {

bool after(const Request& a, const Request& b) {
    return std::tie(a.at, a.tile, a.sequence, a.stage, a.to) >
           std::tie(b.at, b.tile, b.sequence, b.stage, b.to);
}

} // namespace

std::unique_ptr<Beyond> Beyond::make(const Config& config, Reply reply) {
    if (config.memory.controller == "queued")
        return std::make_unique<QueuedBeyond>(config, std::move(reply));
    return std::make_unique<ImmediateBeyond>(config, std::move(reply));
}

Beyond::Beyond(const Config& config, Reply reply)
    : exits_(wide(config.chip.cores / config.cores_sharing(config.tile_levels() - 1))),
      tiles_sharing_(wide(config.cores_sharing(config.cache_levels() - 1) / config.chip.cores)),
      line_bytes_(static_cast<std::uint32_t>(config.cache(config.tile_levels() - 1).line_bytes)),
      // In core cycles, and with room for what else comes out of order.
      ways_(config, served_, disorder / 2 * wide(config.memory.clock_ps) / wide(config.chip.clock_ps)),
      config_(config), snoops_(config.coherence.snoops()), reply_(std::move(reply)) {}

void Beyond::connect(std::deque<Tile>& tiles) {
    tiles_ = &tiles;
    if (config_.coherence.kept())
        coherence_ = std::make_unique<Coherence>(
            config_, ways_, tiles,
            [this](Request w) {
                w.at = std::max(w.at, served_);
                if (snoops_) // memory, or the cache here, has it as it passes
                    return caches_.empty() ? push(w) : come_to_bank(w, w.at);
                const Ways::Leg leg = ways_.writing(asker(w), w.write, w.bytes);
                return caches_.empty() ? send_on(w, leg, w.at) : send_to_bank(w, leg, w.at);
            },
            [this](const Ways::Leg& leg, cycle t, const Coherence::Arrives& arrives) {
                send_word(leg, t, arrives);
            });
    const unsigned level = config_.tile_levels();
    if (level == config_.cache_levels())
        return;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (t % tiles_sharing_ == 0)
            caches_.emplace_back(config_, level, served_, site_,
                                 memory_below(static_cast<std::uint32_t>(caches_.size())), tickets_,
                                 tiles[t].attribution);
        for (Cache& upper : tiles[t].caches[level - 1])
            caches_.back().cache.add_above(upper);
    }
}

void Beyond::push(const Request& r) {
    waiting_.push_back(r);
    std::push_heap(waiting_.begin(), waiting_.end(), after);
}

Request Beyond::pop() {
    std::pop_heap(waiting_.begin(), waiting_.end(), after);
    Request r = waiting_.back();
    waiting_.pop_back();
    return r;
}

void Beyond::accept(std::vector<Request>& leaving) {
    for (Request& r : leaving) {
        r.at = std::max(r.at, served_); // a thread that was behind: what is served stays served
        push(r);
    }
    leaving.clear();
}

void Beyond::send_read(const Request& r, cycle t) {
    const Ways::Leg leg = ways_.asking(asker(r), r.read);
    return caches_.empty() || snoops_ ? send_on(r, leg, t) : send_to_bank(r, leg, t);
}

/// A request is at its bank of a cache here.
void Beyond::take_bank(Request r, cycle there) {
    const bool write = r.stage == Request::writes;
    const bool right_alone = r.kind == Request::upgrade && !r.found;
    const std::uint32_t bytes = write ? r.bytes : right_alone ? 1 : line_bytes_;
    r.at = cache_of(r).cache.book({write ? r.write : r.read, bytes, there, r.column});
    push(r);
}

/// What follows is the traffic of the request's tile.
void Beyond::charge(const Request& r) {
    cache_of(r).charge((*tiles_)[r.tile].attribution);
}

Attribution& Beyond::attribution_of(const Request& r) {
    return (*tiles_)[r.tile].attribution;
}

MemoryPort& Beyond::way_to_memory(std::uint32_t tile) {
    MemoryPort& port = caches_[tile / tiles_sharing_].port;
    port.charge((*tiles_)[tile].attribution);
    return port;
}

/// A line is written elsewhere, or dead: word of it goes to each cache that may have it, and acts there.
void Beyond::tell(Request r) {
    const std::size_t own = r.tile / tiles_sharing_;
    if (r.stage == Request::arrives) {
        r.stage = Request::writes;
        for (r.to = 0; r.to < caches_.size(); ++r.to)
            if ((r.to == own) == (r.kind == Request::discard))
                send_on(r, ways_.telling(r.tile, r.to, r.write), r.at);
        return;
    }
    SharedCache& shared = caches_[r.to];
    shared.charge((*tiles_)[r.tile].attribution);
    if (r.kind == Request::discard)
        shared.cache.discard(r.write);
    else
        shared.cache.invalidate(r.write, r.at + shared.cache.latency(), r.column);
}

std::uint64_t Beyond::misplaced() const {
    std::uint64_t lines = 0;
    for (const SharedCache& shared : caches_)
        lines += shared.cache.misplaced();
    return lines;
}

} // namespace sim
