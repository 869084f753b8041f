#include "sim/machine/queued_beyond.h"

#include <algorithm>

namespace sim {

QueuedBeyond::QueuedBeyond(const Config& config, Reply reply)
    : Beyond(config, std::move(reply)), shortest_(MemoryLines::shortest_read(config)), memory_(config) {
    const CacheConfig& last = config.cache(config.tile_levels() - 1);
    ports_.assign(
        static_cast<std::size_t>(config.chip.tiles) * exits_,
        Port{static_cast<std::size_t>(last.mshrs), static_cast<std::size_t>(last.write_back_buffer), {}, {}});
}

/// What memory decides at a cycle depends on nothing that comes at this cycle or later.
cycle QueuedBeyond::next() {
    cycle next = waiting_.empty() ? never : waiting_.front().at;
    if (!events_.empty())
        next = std::min(next, events_.top().at);
    if (memory_.busy())
        next = std::min(next, std::max(served_, memory_.next_event() - 1));
    return next;
}

void QueuedBeyond::serve(cycle end) {
    for (;;) {
        const cycle decision = memory_.busy() ? memory_.next_event() : never;
        const cycle event = events_.empty() ? never : events_.top().at;
        const cycle request = waiting_.empty() ? never : waiting_.front().at;
        const cycle next = std::min({decision, event, request});
        if (next == never || next > end || (next == end && decision != end))
            break;
        served_ = std::max(served_, next);
        if (decision == next) {
            memory_.advance_to(next);
            take_answers();
            continue;
        }
        // All that memory has decided before this cycle is known: what it will decide is answered later.
        tickets_.set_floor(served_ + shortest_);
        if (event == next) {
            const Event e = events_.top();
            events_.pop();
            act(e);
        } else {
            act(pop());
        }
        take_answers();
    }
    if (end != everything)
        served_ = std::max(served_, end);
    if (tickets_.size() >= 4096)
        tickets_.forget(served_);
}

cycle QueuedBeyond::drain() {
    serve(everything);
    served_ = std::max({served_, ways_.network().quiet(), memory_.drain()});
    return served_;
}

/// A line is on its way to memory from `t` on.
void QueuedBeyond::send(cycle t, Event::Kind kind, const Transfer& line) {
    std::uint64_t id = transfers_.size();
    if (free_.empty()) {
        transfers_.push_back(line);
    } else {
        id = free_.back();
        free_.pop_back();
        transfers_[id] = line;
    }
    const cycle there = kind == Event::reads ? ways_.ask(line.who, line.address, t)
                                             : ways_.write(line.who, line.address, line.bytes, t);
    foresee(there, kind, id);
}

/// A cache here asks for a line, or writes one. Returns its ticket.
cycle QueuedBeyond::send_for(Ways::Asker cache, const Access& a, Event::Kind kind) {
    const cycle ticket = tickets_.open();
    send(std::max(a.at, served_), kind, {cache, a.address, ticket, a.bytes});
    return ticket;
}

void QueuedBeyond::act(const Event& e) {
    switch (e.kind) {
    case Event::reads:
        transfers_[e.what].since = served_;
        return memory_.read(e.what, transfers_[e.what].address, served_);
    case Event::writes:
        return memory_.write(e.what, transfers_[e.what].address, served_);
    case Event::frees_mshr:
    case Event::frees_buffer: {
        const bool mshr = e.kind == Event::frees_mshr;
        Port& port = ports_[e.what];
        std::deque<Request>& line = mshr ? port.reads : port.writes;
        if (line.empty()) {
            ++(mshr ? port.mshrs : port.buffers);
            return;
        }
        const Request r = line.front();
        line.pop_front();
        return mshr ? enter_mshr(r) : enter_buffer(r);
    }
    }
}

void QueuedBeyond::act(const Request& r) {
    if (r.kind != Request::lines) {
        tell(r);
    } else if (r.stage != Request::arrives) {
        look_up(r);
    } else if (r.write != Request::nothing) {
        want_buffer(r);
    } else {
        want_mshr(r);
    }
}

void QueuedBeyond::want_buffer(const Request& r) {
    Port& port = ports_[port_of(r)];
    if (port.buffers == 0)
        return port.writes.push_back(r);
    --port.buffers;
    enter_buffer(r);
}

void QueuedBeyond::want_mshr(const Request& r) {
    Port& port = ports_[port_of(r)];
    if (port.mshrs == 0)
        return port.reads.push_back(r);
    --port.mshrs;
    enter_mshr(r);
}

void QueuedBeyond::enter_buffer(Request r) {
    r.at = served_;
    if (caches_.empty()) {
        send(served_, Event::writes, {asker(r), r.write, 0, r.bytes, port_of(r)});
    } else {
        Request w = r;
        w.read = Request::nothing;
        w.stage = Request::writes;
        w.at = cache_of(r).cache.book(
            {r.write, r.bytes, ways_.write(asker(r), r.write, r.bytes, served_), r.column});
        push(w);
    }
    r.write = Request::nothing;
    if (r.read != Request::nothing)
        want_mshr(r);
}

void QueuedBeyond::enter_mshr(Request r) {
    if (caches_.empty())
        return send(served_, Event::reads, {asker(r), r.read, r.ticket, line_bytes_, port_of(r)});
    r.stage = Request::reads;
    r.at = cache_of(r).cache.book({r.read, line_bytes_, ways_.ask(asker(r), r.read, served_), r.column});
    push(r);
}

/// A cache's bank begins with the request.
void QueuedBeyond::look_up(Request r) {
    charge(r);
    Cache& cache = cache_of(r).cache;
    const bool write = r.stage == Request::writes;
    const Answer a = write ? cache.serve_booked({r.write, r.bytes, r.at, r.column, r.whole}, true)
                           : cache.serve_booked({r.read, line_bytes_, r.at, r.column}, false);
    if (a.refused) { // no MSHR that memory has yet to answer is free before the floor
        r.at = a.ready == Answer::unknown ? tickets_.floor() : a.ready;
        push(r);
    } else if (is_ticket(a.ready)) {
        unanswered_.push_back({r, a.ready});
    } else {
        answer(r, a);
    }
}

void QueuedBeyond::answer(const Request& r, Answer a) {
    const bool read = r.stage == Request::reads;
    if (read) {
        a.ready = ways_.answer(asker(r), r.read, line_bytes_, a.ready);
        reply_(r.tile, r.ticket, a);
    }
    foresee(std::max(a.ready, served_), read ? Event::frees_mshr : Event::frees_buffer, port_of(r));
}

/// What memory has decided since.
void QueuedBeyond::take_answers() {
    if (memory_.reads().empty() && memory_.writes().empty())
        return;
    for (const WaitingMemory::Done& d : memory_.reads()) {
        const Transfer& t = transfers_[d.id];
        const cycle sent = std::max(d.at, t.since + shortest_); // later where the write queue answered
        const cycle ready = ways_.answer(t.who, t.address, t.bytes, sent);
        if (t.who.kind == Ways::Asker::tile) {
            reply_(t.who.number, t.ticket, {ready, Cause::memory});
            foresee(ready, Event::frees_mshr, t.port);
        } else {
            tickets_.answer(t.ticket, ready, Cause::memory);
        }
        free_.push_back(d.id);
    }
    for (const WaitingMemory::Done& d : memory_.writes()) {
        const Transfer& t = transfers_[d.id];
        if (t.who.kind == Ways::Asker::tile)
            foresee(d.at, Event::frees_buffer, t.port);
        else
            tickets_.answer(t.ticket, d.at, Cause::memory);
        free_.push_back(d.id);
    }
    memory_.reads().clear();
    memory_.writes().clear();
    std::erase_if(unanswered_, [this](const Unanswered& u) {
        Answered a{};
        if (!tickets_.find(u.ticket, a))
            return false;
        answer(u.request, {a.last, a.from});
        return true;
    });
}

} // namespace sim
