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
            wake();
            continue;
        }
        // All that memory has decided before this cycle is known: what it will decide is answered later.
        tickets_.set_floors({served_ + shortest_, served_ + shortest_});
        if (event == next) {
            const Event e = events_.top();
            events_.pop();
            act(e);
        } else {
            act(pop());
        }
        take_answers();
        wake();
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
    come(kind == Event::reads ? ways_.ask(line.who, line.address, t)
                              : ways_.write(line.who, line.address, line.bytes, t),
         kind, line);
}

/// It comes there.
void QueuedBeyond::come(cycle there, Event::Kind kind, const Transfer& line) {
    std::uint64_t id = transfers_.size();
    if (free_.empty()) {
        transfers_.push_back(line);
    } else {
        id = free_.back();
        free_.pop_back();
        transfers_[id] = line;
    }
    foresee(there, kind, id);
}

/// A cache here asks for a line, or writes one. Returns its ticket.
cycle QueuedBeyond::send_for(Ways::Asker cache, const Access& a, Event::Kind kind) {
    const cycle ticket = tickets_.open();
    send(std::max(a.at, served_), kind, {cache, a.address, a.bytes, ticket});
    return ticket;
}

void QueuedBeyond::act(const Event& e) {
    switch (e.kind) {
    case Event::reads:
        transfers_[e.what].since = served_;
        return memory_.read(e.what, transfers_[e.what].address, served_);
    case Event::writes: {
        const Transfer& line = transfers_[e.what];
        if (coherence_ && line.who.kind == Ways::Asker::tile && line.request.mshr != Request::no_entry)
            coherence_->written(line.request);
        return memory_.write(e.what, line.address, served_);
    }
    case Event::frees_mshr:
    case Event::frees_buffer:
        return next_waiting(e.what, e.kind == Event::frees_mshr);
    }
}

/// An MSHR or a place in the buffer of an exit is free: for the first that waits for one.
void QueuedBeyond::next_waiting(std::size_t port, bool mshr) {
    std::deque<Request>& line = mshr ? ports_[port].reads : ports_[port].writes;
    while (!line.empty()) {
        const Request r = line.front();
        line.pop_front();
        if (!grants_silently(r))
            return mshr ? enter_mshr(r) : enter_buffer(r);
    }
    ++(mshr ? ports_[port].mshrs : ports_[port].buffers);
}

void QueuedBeyond::act(const Request& r) {
    if (r.kind == Request::claim) {
        claim(r);
    } else if (r.kind == Request::invalidate || r.kind == Request::discard) {
        tell(r);
    } else if (r.stage != Request::arrives && !caches_.empty()) {
        look_up(r);
    } else if (r.stage == Request::writes) {
        write_owners(r);
    } else if (r.stage != Request::arrives) {
        ask_others(r);
    } else if (grants_silently(r)) {
        return;
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
    Request w = r;
    w.read = Request::nothing;
    w.stage = Request::writes;
    if (caches_.empty()) {
        send(served_, Event::writes, {asker(r), r.write, r.bytes, 0, w});
    } else {
        w.at = cache_of(r).cache.book(
            {r.write, r.bytes, ways_.write(asker(r), r.write, r.bytes, served_), r.column});
        push(w);
    }
    r.write = Request::nothing;
    if (r.read != Request::nothing)
        want_mshr(r);
}

void QueuedBeyond::enter_mshr(Request r) {
    if (caches_.empty() && !coherence_)
        return send(served_, Event::reads, {asker(r), r.read, line_bytes_, 0, r});
    r.stage = Request::reads;
    r.at = ways_.ask(asker(r), r.read, served_);
    if (!caches_.empty())
        r.at = cache_of(r).cache.book({r.read, r.kind == Request::upgrade ? 1 : line_bytes_, r.at, r.column});
    push(r);
}

// --- coherence

/// A shared word was written: the directory, or who else is on the bus, hears of it.
void QueuedBeyond::claim(Request r) {
    if (r.stage != Request::arrives)
        return coherence_->claim(r, r.at + coherence_->look_up());
    r.at = ways_.answer_directory(r.tile, r.write, r.at);
    r.stage = Request::writes;
    push(r);
}

/// An upgrade of who has the right by now needs no MSHR, nor anybody else.
bool QueuedBeyond::grants_silently(const Request& r) {
    if (r.kind != Request::upgrade || !coherence_->grants_silently(r))
        return false;
    reply_(r.tile, r.ticket, {served_, Cause::coherence});
    return true;
}

/// It waits until wake().
bool QueuedBeyond::is_blocked(const Request& r) {
    if (!coherence_->is_coming(r.read))
        return false;
    blocked_[r.read].push_back(r);
    return true;
}

/// Without caches beyond the tiles: the directory beside the line's channel has the request, or the bus.
void QueuedBeyond::ask_others(const Request& r) {
    if (is_blocked(r))
        return;
    const Coherence::Outcome out = coherence_->ask(r, r.at + coherence_->look_up());
    if (out.from != Coherence::Outcome::below)
        return reply(r, {std::max(out.at, out.finished), Cause::coherence});
    ++attribution_of(r).cell(r.read, r.column).memory_reads;
    Transfer line{asker(r), r.read, line_bytes_, 0, r, out.known};
    line.request.finished = out.finished;
    come(out.at, Event::reads, line);
}

/// What an owner had changed comes to memory, as others read it.
void QueuedBeyond::write_owners(const Request& r) {
    ++attribution_of(r).cell(r.write, r.column).memory_writes;
    come(r.at, Event::writes, {asker(r), r.write, r.bytes, 0, r});
}

/// Those go on that waited for lines of which it is known now when their owners have them.
void QueuedBeyond::wake() {
    while (!known_.empty()) {
        const auto waiting = blocked_.find(known_.back());
        known_.pop_back();
        if (waiting == blocked_.end())
            continue;
        const std::vector<Request> all = std::move(waiting->second);
        blocked_.erase(waiting);
        for (Request r : all) {
            r.at = served_;
            act(r);
        }
    }
}

// --- answers

/// A cache's bank begins with the request.
void QueuedBeyond::look_up(Request r) {
    charge(r);
    Cache& cache = cache_of(r).cache;
    const bool write = r.stage == Request::writes;
    if (coherence_ && !write && !r.found) { // the directory lies beside the cache's tags
        if (is_blocked(r))
            return;
        const cycle known = r.at + cache.latency() + coherence_->look_up();
        const Coherence::Outcome out = coherence_->ask(r, known);
        if (out.from != Coherence::Outcome::below)
            return reply(r, {std::max(out.at, out.finished), Cause::coherence});
        r.found = true;
        r.finished = out.finished;
        r.at =
            out.at > known ? out.at : r.at + coherence_->look_up(); // if who was thought to have it has not
        return push(r);
    }
    const Answer a = write ? cache.serve_booked({r.write, r.bytes, r.at, r.column, r.whole}, true)
                           : cache.serve_booked({r.read, line_bytes_, r.at, r.column}, false);
    if (coherence_ && write && !a.refused && r.mshr != Request::no_entry)
        coherence_->written(r);
    if (a.refused) { // no MSHR that memory has yet to answer is free before the floor
        r.at = a.ready == Answer::unknown ? tickets_.floors().lines : a.ready;
        push(r);
    } else if (is_ticket(a.ready)) {
        unanswered_.push_back({r, a.ready});
    } else {
        answer(r, a);
    }
}

void QueuedBeyond::answer(const Request& r, Answer a) {
    if (r.stage == Request::writes) {
        if (r.mshr != Request::no_entry)
            foresee(std::max(a.ready, served_), Event::frees_buffer, port_of(r));
        return;
    }
    a.ready = ways_.answer(asker(r), r.read, line_bytes_, a.ready);
    if (r.finished > a.ready)
        a = {r.finished, Cause::coherence};
    if (coherence_) {
        coherence_->arrives(r, a.ready);
        known_.push_back(r.read);
    }
    reply(r, a);
}

/// The tile has what it asked for.
void QueuedBeyond::reply(const Request& r, Answer a) {
    reply_(r.tile, r.ticket, a);
    foresee(std::max(a.ready, served_), Event::frees_mshr, port_of(r));
}

/// What memory has decided since.
void QueuedBeyond::take_answers() {
    if (memory_.reads().empty() && memory_.writes().empty())
        return;
    for (const WaitingMemory::Done& d : memory_.reads()) {
        const Transfer& t = transfers_[d.id];
        const cycle sent = std::max({d.at, t.since + shortest_, t.known}); // the write queue answers at once
        if (t.who.kind == Ways::Asker::tile)
            answer(t.request, {sent, Cause::memory});
        else
            tickets_.answer(t.ticket, ways_.answer(t.who, t.address, t.bytes, sent), Cause::memory);
        free_.push_back(d.id);
    }
    for (const WaitingMemory::Done& d : memory_.writes()) {
        const Transfer& t = transfers_[d.id];
        if (t.who.kind == Ways::Asker::tile)
            answer(t.request, {d.at, Cause::memory});
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
