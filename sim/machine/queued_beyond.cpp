#include "sim/machine/queued_beyond.h"

#include "sim/machine/windows.h"

#include <algorithm>

namespace sim {

QueuedBeyond::QueuedBeyond(const Config& config, Reply reply)
    : Beyond(config, std::move(reply)),
      unknown_(known_ahead(config) +
               (config.network.ideal()
                    ? 0
                    : static_cast<std::uint64_t>(flits_of(
                          config.network, config.network.reply_bytes + config.last_cache().line_bytes)))),
      memory_(config), flights_(ways_.network(), known_ahead(config)) {
    const CacheConfig& last = config.cache(config.tile_levels() - 1);
    ports_.assign(
        static_cast<std::size_t>(config.chip.tiles) * exits_,
        Port{static_cast<std::size_t>(last.mshrs), static_cast<std::size_t>(last.write_back_buffer), {}, {}});
}

/// What memory decides at a cycle depends on nothing that comes at this cycle or later.
cycle QueuedBeyond::next() {
    cycle next = std::min(flights_.next(), waiting_.empty() ? never : waiting_.front().at);
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
        const cycle message = flights_.next();
        const cycle next = std::min({decision, message, event, request});
        if (next == never || next > end || (next == end && decision != end))
            break;
        served_ = std::max(served_, next);
        if (decision == next) {
            memory_.advance_to(next);
            take_answers();
            take_lines();
            wake();
            continue;
        }
        // All that memory has decided before this cycle is known: what it will decide is answered later.
        tickets_.set_floors({next + unknown_, next + unknown_});
        if (event == next) {
            const Event e = events_.top();
            events_.pop();
            act(e);
        } else if (request == next) {
            act(pop());
        } else if (const auto there = flights_.step()) { // all that are sent at this cycle have been
            arrive(there->id, there->at);
        }
        take_answers();
        take_lines();
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

// --- ways

std::uint64_t QueuedBeyond::keep(const Transfer& transfer) {
    if (free_.empty()) {
        transfers_.push_back(transfer);
        return transfers_.size() - 1;
    }
    const std::uint64_t id = free_.back();
    free_.pop_back();
    transfers_[id] = transfer;
    return id;
}

void QueuedBeyond::leave(std::uint64_t transfer, const Ways::Leg& leg, cycle t) {
    if (ways_.ideal())
        arrive(transfer, t);
    else
        flights_.send(transfer, leg, t);
}

/// It is known that it is there then.
void QueuedBeyond::arrive(std::uint64_t id, cycle there) {
    switch (transfers_[id].goes) {
    case Transfer::to_be_read:
        return foresee(there, Event::reads, id);
    case Transfer::to_be_written:
        return foresee(there, Event::writes, id);
    case Transfer::to_a_bank:
        return foresee(there, Event::takes_bank, id);
    case Transfer::on: {
        Request r = transfers_[id].request;
        free_.push_back(id);
        r.at = there;
        return push(r);
    }
    case Transfer::word: {
        const Coherence::Arrives arrives = std::move(arrives_[id]);
        free_.push_back(id);
        return arrives(there);
    }
    case Transfer::unasked:
        return;
    case Transfer::back:
        const Transfer t = transfers_[id];
        free_.push_back(id);
        if (t.who.kind == Ways::Asker::tile)
            return is_back(t.request, {there, t.from});
        if (there < tickets_.floors().lines) // caches have counted on it
            calendar_has_passed("lines", there, tickets_.floors().lines);
        answer_ticket(t.ticket, {there, t.from});
    }
}

/// A line is on its way to memory from `t` on.
void QueuedBeyond::send(const Transfer& line, cycle t) {
    const bool read = line.goes == Transfer::to_be_read;
    leave(keep(line),
          read ? ways_.asking(line.who, line.address) : ways_.writing(line.who, line.address, line.bytes), t);
}

/// ... or back to who asked for it.
void QueuedBeyond::send_back(std::uint64_t id, cycle t) {
    Transfer& line = transfers_[id];
    line.goes = Transfer::back;
    leave(id, ways_.answering(line.who, line.address, line.bytes), t);
}

/// A cache here asks for a line, or writes one. Returns its ticket.
cycle QueuedBeyond::send_for(Ways::Asker cache, const Access& a, Transfer::Goes goes,
                             Attribution& attribution) {
    const cycle ticket = tickets_.open();
    send({.goes = goes,
          .who = cache,
          .address = a.address,
          .bytes = a.bytes,
          .ticket = ticket,
          .attribution = &attribution,
          .column = a.column},
         std::max(a.at, served_));
    return ticket;
}

/// A line is there.
void QueuedBeyond::note_at_memory(const Transfer& line) {
    const bool of_tile = line.who.kind == Ways::Asker::tile;
    Attribution& of = of_tile ? attribution_of(line.request) : *line.attribution;
    of.note_memory(line.goes == Transfer::to_be_read ? traces::Kind::read : traces::Kind::write, line.address,
                   line.bytes, served_, of_tile ? line.request.column : line.column);
}

void QueuedBeyond::ask_memory(bool write, std::uint64_t address, cycle t) {
    served_ = std::max(served_, t);
    memory_.advance_to(served_);
    const std::uint64_t line = keep({.goes = Transfer::unasked});
    if (write)
        memory_.write(line, address, served_);
    else
        memory_.read(line, address, served_);
    take_answers();
}

// --- events

void QueuedBeyond::act(const Event& e) {
    switch (e.kind) {
    case Event::reads:
        note_at_memory(transfers_[e.what]);
        return memory_.read(e.what, transfers_[e.what].address, served_);
    case Event::writes: {
        note_at_memory(transfers_[e.what]);
        const Transfer& line = transfers_[e.what];
        if (coherence_ && line.who.kind == Ways::Asker::tile && line.request.mshr != Request::no_entry)
            coherence_->written(line.request);
        return memory_.write(e.what, line.address, served_);
    }
    case Event::takes_bank:
        free_.push_back(e.what);
        return take_bank(transfers_[e.what].request, served_);
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
    } else if (r.stage == Request::reads && !r.found && (caches_.empty() || snoops_)) {
        ask_others(r);
    } else if (r.stage != Request::arrives && !caches_.empty()) {
        look_up(r);
    } else if (r.stage == Request::writes) {
        write_owners(r);
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
        send({.goes = Transfer::to_be_written,
              .who = asker(r),
              .address = r.write,
              .bytes = r.bytes,
              .request = w},
             served_);
    } else {
        send_to_bank(w, ways_.writing(asker(r), r.write, r.bytes), served_);
    }
    r.write = Request::nothing;
    if (r.read != Request::nothing)
        want_mshr(r);
}

void QueuedBeyond::enter_mshr(Request r) {
    if (caches_.empty() && !coherence_)
        return send({.goes = Transfer::to_be_read,
                     .who = asker(r),
                     .address = r.read,
                     .bytes = line_bytes_,
                     .request = r},
                    served_);
    r.stage = Request::reads;
    send_read(r, served_);
}

// --- coherence

/// A shared word was written: the directory, or who else is on the bus, hears of it.
void QueuedBeyond::claim(Request r) {
    if (r.stage != Request::arrives)
        return coherence_->claim(r, r.at + coherence_->look_up(),
                                 [this, line = r.write / line_bytes_ * line_bytes_](
                                     const Coherence::Outcome&) { known_.push_back(line); });
    r.stage = Request::writes;
    send_on(r, ways_.telling_directory(r.tile, r.write), r.at);
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

/// The directory beside the line's channel has the request, or the bus.
void QueuedBeyond::ask_others(Request r) {
    if (is_blocked(r))
        return;
    r.decision = new_decision();
    coherence_->ask(r, r.at + coherence_->look_up(),
                    {[this, r](cycle at) { ask_below(r, at); },
                     [this, r](const Coherence::Outcome& out) { is_over(r, out); }});
}

/// No other tile is known to bring the line.
void QueuedBeyond::ask_below(const Request& r, cycle t) {
    if (!caches_.empty()) {
        Request found = r;
        found.found = true;
        return come_to_bank(found, t);
    }
    attribution_of(r).count_memory_read(r.read, r.column);
    arrive(keep({.goes = Transfer::to_be_read,
                 .who = asker(r),
                 .address = r.read,
                 .bytes = line_bytes_,
                 .request = r}),
           t);
}

/// A tile's answer would leave at `t`: on buses, no sooner than caches have said what they have.
void QueuedBeyond::send_when_known(std::uint64_t transfer, const Request& r, cycle t) {
    if (!snoops_)
        return send_back(transfer, t);
    Decision& d = decisions_[r.decision];
    if (d.over)
        return send_back(transfer, std::max(t, d.out.known));
    d.leaves = transfer;
    d.at = t;
}

std::uint32_t QueuedBeyond::new_decision() {
    if (free_decisions_.empty()) {
        free_decisions_.push_back(static_cast<std::uint32_t>(decisions_.size()));
        decisions_.emplace_back();
    }
    const std::uint32_t number = free_decisions_.back();
    free_decisions_.pop_back();
    decisions_[number] = {};
    return number;
}

/// All that others have to say of a request is known.
void QueuedBeyond::is_over(const Request& r, const Coherence::Outcome& out) {
    if (out.from != Coherence::Outcome::below) {
        free_decisions_.push_back(r.decision);
        known_.push_back(r.read);
        return reply(r, {std::max(out.at, out.finished), Cause::coherence});
    }
    Decision& d = decisions_[r.decision];
    d.over = true;
    d.out = out;
    if (d.leaves != nothing)
        send_back(d.leaves, std::max(d.at, out.known));
    else if (d.is_back)
        is_back(r, {d.at, d.from});
}

/// What an owner had changed comes to memory, as others read it.
void QueuedBeyond::write_owners(const Request& r) {
    attribution_of(r).count_memory_write(r.write, r.column);
    arrive(keep({.goes = Transfer::to_be_written,
                 .who = asker(r),
                 .address = r.write,
                 .bytes = r.bytes,
                 .request = r}),
           r.at);
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
        r.decision = new_decision();
        return coherence_->ask(r, known,
                               {[this, r, known](cycle at) {
                                    Request found = r;
                                    found.found = true;
                                    // Later if who was thought to have it has not.
                                    found.at = at > known ? at : r.at + coherence_->look_up();
                                    push(found);
                                },
                                [this, r](const Coherence::Outcome& out) { is_over(r, out); }});
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

void QueuedBeyond::answer(const Request& r, const Answer& a) {
    if (r.stage == Request::writes) {
        if (r.mshr != Request::no_entry)
            foresee(std::max(a.ready, served_), Event::frees_buffer, port_of(r));
        return;
    }
    if (ways_.ideal())
        return is_back(r, a);
    const std::uint64_t line = keep({.goes = Transfer::back,
                                     .who = asker(r),
                                     .address = r.read,
                                     .bytes = line_bytes_,
                                     .request = r,
                                     .from = a.from});
    send_when_known(line, r, a.ready);
}

void QueuedBeyond::is_back(const Request& r, const Answer& a) {
    if (!coherence_)
        return reply(r, a);
    Decision& d = decisions_[r.decision];
    if (!d.over) { // others have not yet dropped it
        d.is_back = true;
        d.at = a.ready;
        d.from = a.from;
        return;
    }
    free_decisions_.push_back(r.decision);
    const bool waits = d.out.finished > a.ready;
    const Answer all = waits ? Answer{d.out.finished, Cause::coherence} : a;
    coherence_->arrives(r, all.ready);
    known_.push_back(r.read);
    reply(r, all);
}

/// The tile has what it asked for.
void QueuedBeyond::reply(const Request& r, const Answer& a) {
    reply_(r.tile, r.ticket, a);
    foresee(std::max(a.ready, served_), Event::frees_mshr, port_of(r));
}

/// What memory has decided since.
void QueuedBeyond::take_answers() {
    if (memory_.reads().empty() && memory_.writes().empty())
        return;
    for (const WaitingMemory::Done& d : memory_.reads()) {
        const Transfer& t = transfers_[d.id];
        if (t.goes == Transfer::unasked) {
            free_.push_back(d.id);
            continue;
        }
        if (t.who.kind == Ways::Asker::tile)
            send_when_known(d.id, t.request, d.at);
        else
            send_back(d.id, d.at);
    }
    for (const WaitingMemory::Done& d : memory_.writes()) {
        const Transfer& t = transfers_[d.id];
        if (t.goes != Transfer::unasked && t.who.kind == Ways::Asker::tile)
            answer(t.request, {d.at, Cause::memory});
        else if (t.goes != Transfer::unasked)
            answer_ticket(t.ticket, {d.at, Cause::memory});
        free_.push_back(d.id);
    }
    memory_.reads().clear();
    memory_.writes().clear();
}

/// What caches here have waited for.
void QueuedBeyond::take_lines() {
    if (!lines_came_)
        return;
    lines_came_ = false;
    std::erase_if(unanswered_, [this](const Unanswered& u) {
        Answered a{};
        if (!tickets_.find(u.ticket, a))
            return false;
        answer(u.request, {a.last, a.from});
        return true;
    });
}

} // namespace sim
