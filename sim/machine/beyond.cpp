#include "sim/machine/beyond.h"

#include "sim/machine/tile.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace sim {
namespace {

bool after(const Request& a, const Request& b) {
    return std::tie(a.at, a.tile, a.sequence, a.stage, a.to) >
           std::tie(b.at, b.tile, b.sequence, b.stage, b.to);
}

std::size_t wide(integer x) {
    return static_cast<std::size_t>(x);
}

constexpr std::uint64_t disorder = 4096; // memory clocks by which a request may be earlier than another
/// In core cycles, and with room for what else comes out of order.
std::uint64_t disorder_cycles(const Config& c) {
    return disorder / 2 * wide(c.memory.clock_ps) / wide(c.chip.clock_ps);
}

/// Requests of one exit that wait until it is known when an MSHR or a place in the buffer is free, in the
/// order in which they left.
void hold(std::vector<Request>& held, const Request& r) {
    auto later = std::upper_bound(held.begin(), held.end(), r,
                                  [](const Request& a, const Request& b) { return a.sequence < b.sequence; });
    held.insert(later, r);
}
/// The first that waits for a place in the buffer (or an MSHR) tries again at `free`, when one is.
std::optional<Request> release(std::vector<Request>& held, bool buffer, cycle free) {
    auto first = std::find_if(held.begin(), held.end(),
                              [&](const Request& r) { return (r.write != Request::nothing) == buffer; });
    if (first == held.end())
        return std::nullopt;
    Request r = *first;
    held.erase(first);
    r.at = std::max(r.at, free);
    return r;
}

} // namespace

Beyond::Beyond(const Config& config, Reply reply)
    : exits_(wide(config.chip.cores / config.cores_sharing(config.tile_levels() - 1))),
      tiles_sharing_(wide(config.cores_sharing(config.cache_levels() - 1) / config.chip.cores)),
      line_bytes_(static_cast<std::uint32_t>(config.cache(config.tile_levels() - 1).line_bytes)),
      memory_(config, disorder), ways_(config, served_, disorder_cycles(config)), config_(config),
      reply_(std::move(reply)) {
    const CacheConfig& last = config.cache(config.tile_levels() - 1);
    ports_.assign(wide(config.chip.tiles) * exits_,
                  Port{OrderedPool(wide(last.mshrs)), OrderedPool(wide(last.write_back_buffer)), {}});
}

void Beyond::connect(std::deque<Tile>& tiles) {
    tiles_ = &tiles;
    const unsigned level = config_.tile_levels();
    if (level == config_.cache_levels())
        return;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        if (t % tiles_sharing_ == 0)
            caches_.emplace_back(config_, level, static_cast<std::uint32_t>(caches_.size()), served_, site_,
                                 memory_, ways_, tickets_, tiles[t].attribution);
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

void Beyond::serve(cycle end) {
    while (!waiting_.empty() && waiting_.front().at < end) {
        Request r = pop();
        served_ = r.at;
        if (caches_.empty())
            serve_from_memory(r);
        else
            serve_from_cache(r);
    }
    if (end != everything)
        served_ = std::max(served_, end);
}

void Beyond::serve_from_memory(Request r) {
    Port& port = port_of(r);
    if (r.write != Request::nothing) {
        OrderedPool::Grant buffer = port.write_backs.take(r.at);
        if (buffer.at > r.at) {
            r.at = buffer.at;
            return push(r);
        }
        port.write_backs.hold(buffer.entry,
                              memory_.write(r.write, ways_.write(asker(r), r.write, r.bytes, r.at)));
        r.write = Request::nothing;
    }
    if (r.read == Request::nothing)
        return;
    OrderedPool::Grant mshr = port.mshrs.take(r.at);
    if (mshr.at > r.at) {
        r.at = mshr.at;
        return push(r);
    }
    cycle ready = memory_.read(r.read, ways_.ask(asker(r), r.read, r.at));
    ready = ways_.answer(asker(r), r.read, line_bytes_, ready);
    port.mshrs.hold(mshr.entry, ready);
    reply_(r.tile, r.ticket, {ready, Cause::memory});
}

void Beyond::serve_from_cache(Request r) {
    cache_of(r).charge((*tiles_)[r.tile].attribution);
    if (r.kind != Request::lines)
        tell(r);
    else if (r.stage == Request::arrives)
        arrive(r);
    else if (r.stage == Request::writes)
        write(r);
    else
        read(r);
}

/// A line is written elsewhere, or dead: word of it goes to each cache that may have it, and acts there.
void Beyond::tell(Request r) {
    const std::size_t own = r.tile / tiles_sharing_;
    if (r.stage == Request::arrives) {
        r.stage = Request::writes;
        const cycle sent = r.at;
        for (r.to = 0; r.to < caches_.size(); ++r.to)
            if ((r.to == own) == (r.kind == Request::discard)) {
                r.at = ways_.tell(r.tile, r.to, r.write, sent);
                push(r);
            }
        return;
    }
    SharedCache& shared = caches_[r.to];
    shared.charge((*tiles_)[r.tile].attribution);
    if (r.kind == Request::discard)
        shared.cache.discard(r.write);
    else
        shared.cache.invalidate(r.write, r.at + shared.cache.latency(), r.column);
}

void Beyond::arrive(Request r) {
    Port& port = port_of(r);
    Cache& cache = cache_of(r).cache;
    if (r.write != Request::nothing) {
        OrderedPool::Grant buffer = port.write_backs.take(r.at);
        if (buffer.at > r.at) {
            if (port.write_backs.open())
                return hold(port.held, r);
            r.at = buffer.at;
            return push(r);
        }
        port.write_backs.hold_open(buffer.entry);
        Request w = r;
        w.read = Request::nothing;
        w.mshr = buffer.entry;
        w.stage = Request::writes;
        w.at = cache.book({r.write, r.bytes, ways_.write(asker(r), r.write, r.bytes, r.at), r.column});
        push(w);
        r.write = Request::nothing;
    }
    if (r.read == Request::nothing)
        return;
    OrderedPool::Grant mshr = port.mshrs.take(r.at);
    if (mshr.at > r.at) {
        if (port.mshrs.open())
            return hold(port.held, r);
        r.at = mshr.at;
        return push(r);
    }
    port.mshrs.hold_open(mshr.entry);
    r.mshr = mshr.entry;
    r.stage = Request::reads;
    r.at = cache.book({r.read, line_bytes_, ways_.ask(asker(r), r.read, r.at), r.column});
    push(r);
}

void Beyond::write(Request r) {
    Access a{r.write, r.bytes, r.at, r.column, r.whole};
    Answer answer = cache_of(r).cache.serve_booked(a, true);
    if (answer.refused) {
        r.at = answer.ready;
        return push(r);
    }
    Port& port = port_of(r);
    port.write_backs.close(r.mshr, answer.ready);
    if (std::optional<Request> next = release(port.held, true, answer.ready))
        push(*next);
}

void Beyond::read(Request r) {
    Answer answer = cache_of(r).cache.serve_booked({r.read, line_bytes_, r.at, r.column}, false);
    if (answer.refused) {
        r.at = answer.ready;
        return push(r);
    }
    answer.ready = ways_.answer(asker(r), r.read, line_bytes_, answer.ready);
    Port& port = port_of(r);
    port.mshrs.close(r.mshr, answer.ready);
    reply_(r.tile, r.ticket, answer);
    if (std::optional<Request> next = release(port.held, false, answer.ready))
        push(*next);
}

std::uint64_t Beyond::misplaced() const {
    std::uint64_t lines = 0;
    for (const SharedCache& shared : caches_)
        lines += shared.cache.misplaced();
    return lines;
}

} // namespace sim
