#include "sim/machine/immediate_beyond.h"

#include "sim/machine/windows.h"

#include <algorithm>
#include <optional>

namespace sim {
namespace {

bool later(const Request& a, const Request& b) {
    return a.sequence > b.sequence;
}

void put(std::vector<Request>& heap, const Request& r) {
    heap.push_back(r);
    std::push_heap(heap.begin(), heap.end(), later);
}
Request take_first(std::vector<Request>& heap) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const Request first = heap.back();
    heap.pop_back();
    return first;
}

} // namespace

ImmediateBeyond::ImmediateBeyond(const Config& config, Reply reply)
    : Beyond(config, std::move(reply)), memory_(config, disorder) {
    const CacheConfig& last = config.cache(config.tile_levels() - 1);
    ports_.assign(wide(config.chip.tiles) * exits_,
                  Port{OrderedPool(wide(last.mshrs)), OrderedPool(wide(last.write_back_buffer))});
}

void ImmediateBeyond::count_from(cycle t) {
    memory_.count_refreshes(to_memory_clocks(config_, t));
}

void ImmediateBeyond::serve(cycle end) {
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

void ImmediateBeyond::send_on(const Request& r, const Ways::Leg& leg, cycle t) {
    Request later = r;
    later.at = ways_.send(leg, t);
    push(later);
}

void ImmediateBeyond::serve_from_memory(Request r) {
    if (coherence_ && serves_alone(r))
        return;
    Port& port = ports_[port_of(r)];
    if (r.write != Request::nothing) {
        OrderedPool::Grant buffer = port.write_backs.take(r.at);
        if (buffer.at > r.at)
            return wait(port.for_buffer, r, buffer.at);
        port.write_backs.hold(buffer.entry,
                              write_memory(attribution_of(r), r.write, r.bytes,
                                           ways_.write(asker(r), r.write, r.bytes, r.at), r.column));
        leave(port.for_buffer, r, port.write_backs);
        if (coherence_)
            coherence_->written(r);
        r.write = Request::nothing;
    }
    if (r.read == Request::nothing)
        return;
    OrderedPool::Grant mshr = port.mshrs.take(r.at);
    if (mshr.at > r.at)
        return wait(port.for_mshr, r, mshr.at);
    Answer answer{0, Cause::memory};
    if (coherence_) {
        answer = read_coherently(r);
    } else {
        answer.ready =
            read_memory(attribution_of(r), r.read, line_bytes_, ways_.ask(asker(r), r.read, r.at), r.column);
        answer.ready = ways_.answer(asker(r), r.read, line_bytes_, answer.ready);
    }
    port.mshrs.hold(mshr.entry, answer.ready);
    leave(port.for_mshr, r, port.mshrs);
    reply_(r.tile, r.ticket, answer);
}

void ImmediateBeyond::wait(Queue& queue, Request r, cycle until) {
    r.at = until;
    if (r.sequence <= queue.first) { // one that was first before may be served with it
        queue.first = r.sequence;
        return push(r);
    }
    put(queue.behind, r);
}

/// It has its entry, or needs none: if it was first, another is.
void ImmediateBeyond::leave(Queue& queue, const Request& r, OrderedPool& pool) {
    if (queue.first != r.sequence)
        return;
    queue.first = no_sequence;
    if (queue.behind.empty())
        return;
    const Request next = take_first(queue.behind);
    wait(queue, next, std::max(next.at, pool.take(r.at).at));
}

/// Of a coherent machine: what needs no MSHR, and no place in the buffer.
bool ImmediateBeyond::serves_alone(const Request& r) {
    if (r.kind == Request::claim) {
        const cycle there = ways_.send(ways_.telling_directory(r.tile, r.write), r.at);
        coherence_->claim(r, there + coherence_->look_up(), {});
        return true;
    }
    if (r.kind == Request::upgrade && r.stage == Request::arrives && coherence_->grants_silently(r)) {
        reply_(r.tile, r.ticket, {r.at, Cause::coherence});
        // It may have been the one that an MSHR was free for.
        leave(ports_[port_of(r)].for_mshr, r, ports_[port_of(r)].mshrs);
        let_next_try(ports_[port_of(r)].until_mshr, r.at);
        return true;
    }
    if (r.stage != Request::writes || !caches_.empty())
        return false;
    attribution_of(r).count_memory_write(r.write, r.column); // an owner's, on its way since
    write_memory(attribution_of(r), r.write, r.bytes, ways_.in_order(r.at), r.column);
    return true;
}

/// All messages are there at once, as far as it goes here.
Coherence::Outcome ImmediateBeyond::ask_others(const Request& r, cycle t) {
    Coherence::Outcome out;
    coherence_->ask(
        r, t, {[&out](cycle at) { out.at = at; }, [&out](const Coherence::Outcome& all) { out = all; }});
    return out;
}

/// A line, or the right to write it, from memory or another tile.
Answer ImmediateBeyond::read_coherently(const Request& r) {
    const cycle there = ways_.ask(asker(r), r.read, r.at) + coherence_->look_up();
    const Coherence::Outcome out = ask_others(r, there);
    cycle ready = out.at;
    if (out.from == Coherence::Outcome::below) {
        attribution_of(r).count_memory_read(r.read, r.column);
        ready = read_memory(attribution_of(r), r.read, line_bytes_, ways_.in_order(out.at), r.column);
        ready = ways_.answer(asker(r), r.read, line_bytes_, std::max(ready, out.known));
        coherence_->arrives(r, std::max(ready, out.finished));
        if (out.finished <= ready)
            return {ready, Cause::memory};
    }
    return {std::max(ready, out.finished), Cause::coherence};
}

void ImmediateBeyond::serve_from_cache(Request r) {
    charge(r);
    if (coherence_ && serves_alone(r))
        return;
    if (r.kind == Request::invalidate || r.kind == Request::discard)
        tell(r);
    else if (r.stage == Request::arrives)
        arrive(r);
    else if (r.stage == Request::writes)
        write(r);
    else
        read(r);
}

std::optional<std::size_t> ImmediateBeyond::take(OrderedPool& pool, const Request& request) {
    const OrderedPool::Grant grant = pool.take(request.at);
    if (grant.at <= request.at) {
        pool.hold_open(grant.entry);
        return grant.entry;
    }
    if (pool.open()) {
        Port& port = ports_[port_of(request)];
        put(request.write != Request::nothing ? port.until_buffer : port.until_mshr, request);
    } else {
        Request later = request;
        later.at = grant.at;
        push(later);
    }
    return std::nullopt;
}

/// The first of those that wait, at `free`, when there is something free.
void ImmediateBeyond::let_next_try(std::vector<Request>& waiting, cycle free) {
    if (waiting.empty())
        return;
    Request next = take_first(waiting);
    next.at = std::max(next.at, free);
    push(next);
}

void ImmediateBeyond::arrive(Request r) {
    Port& port = ports_[port_of(r)];
    if (r.write != Request::nothing) {
        const auto buffer = take(port.write_backs, r);
        if (!buffer)
            return;
        if (coherence_)
            coherence_->written(r);
        Request w = r;
        w.read = Request::nothing;
        w.mshr = *buffer;
        w.stage = Request::writes;
        send_to_bank(w, ways_.writing(asker(r), r.write, r.bytes), r.at);
        r.write = Request::nothing;
    }
    if (r.read == Request::nothing)
        return;
    const auto mshr = take(port.mshrs, r);
    if (!mshr)
        return;
    r.mshr = *mshr;
    r.stage = Request::reads;
    send_read(r, r.at);
}

void ImmediateBeyond::write(Request r) {
    Access a{r.write, r.bytes, r.at, r.column, r.whole};
    Answer answer = cache_of(r).cache.serve_booked(a, true);
    if (answer.refused) {
        r.at = answer.ready;
        return push(r);
    }
    if (r.mshr == Request::no_entry) // an owner's, as others read the line
        return;
    Port& port = ports_[port_of(r)];
    port.write_backs.close(r.mshr, answer.ready);
    let_next_try(port.until_buffer, answer.ready);
}

void ImmediateBeyond::read(Request r) {
    if (coherence_ && !r.found)
        return look_for_owner(r);
    Answer a = cache_of(r).cache.serve_booked({r.read, line_bytes_, r.at, r.column}, false);
    if (a.refused) {
        r.at = a.ready;
        return push(r);
    }
    a.ready = ways_.answer(asker(r), r.read, line_bytes_, std::max(a.ready, r.known));
    if (r.finished > a.ready)
        a = {r.finished, Cause::coherence};
    if (coherence_)
        coherence_->arrives(r, a.ready);
    answer(r, a);
    line_is_known(r);
}

/// The request is on the buses; or at a directory, which lies beside the cache's tags.
void ImmediateBeyond::look_for_owner(Request r) {
    if (snoops_ && coherence_->is_coming(r.read)) { // its owner's request waits for its bank
        blocked_[r.read].push_back(r);
        return;
    }
    const cycle known = snoops_ ? r.at : r.at + cache_of(r).cache.latency() + coherence_->look_up();
    const Coherence::Outcome out = ask_others(r, known);
    if (out.from != Coherence::Outcome::below)
        return answer(r, {std::max(out.at, out.finished), Cause::coherence});
    r.found = true;
    r.finished = out.finished;
    if (snoops_) {
        r.known = out.known;
        return take_bank(r, out.at);
    }
    // Later if who was thought to have it has not.
    r.at = out.at > known ? out.at : r.at + coherence_->look_up();
    push(r);
}

/// It is known when the one who asked has the line: those go on that wait for that.
void ImmediateBeyond::line_is_known(const Request& r) {
    const auto waiting = blocked_.find(r.read);
    if (waiting == blocked_.end())
        return;
    for (Request& next : waiting->second) {
        next.at = r.at;
        push(next);
    }
    blocked_.erase(waiting);
}

/// The tile has what it asked for.
void ImmediateBeyond::answer(const Request& r, const Answer& a) {
    Port& port = ports_[port_of(r)];
    port.mshrs.close(r.mshr, a.ready);
    reply_(r.tile, r.ticket, a);
    let_next_try(port.until_mshr, a.ready);
}

} // namespace sim
