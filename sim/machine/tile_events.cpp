#include "sim/machine/tile_events.h"

#include <algorithm>
#include <utility>

namespace sim {

// --- what comes to a cache

cycle Arrivals::enter(const Access& a, Kind kind) {
    std::uint32_t slot = 0;
    if (free_.empty()) {
        slot = static_cast<std::uint32_t>(requests_.size());
        requests_.emplace_back();
        lines_.push_back(nothing);
    } else {
        slot = free_.back();
        free_.pop_back();
    }
    const cycle at = after_others(a, kind, std::max(a.at, events_.now_)); // a thread that was behind
    const cycle ticket = kind == Kind::discard ? 0 : events_.tickets_.open();
    requests_[slot] = {a, ticket, events_.site_, ++events_.sequence_, at, kind};
    requests_[slot].access.at = at;
    lines_[slot] = cache_.line_of(a.address);
    cache_.bring_set(lines_[slot]);
    events_.foresee(at, a.asker + 1, events_.sequence_, number_, slot);
    return ticket;
}

/// No earlier than what its cache has asked for of the same line before. (Banks keep the order; word that a
/// line is dead takes none.)
cycle Arrivals::after_others(const Access& a, Kind kind, cycle at) const {
    const std::uint64_t line = cache_.line_of(a.address);
    for (auto l = std::find(lines_.begin(), lines_.end(), line); l != lines_.end();
         l = std::find(l + 1, lines_.end(), line)) {
        const Request& other = requests_[static_cast<std::size_t>(l - lines_.begin())];
        if (other.access.asker == a.asker)
            at = std::max(at, kind == Kind::discard ? other.access.at : other.comes);
    }
    return at;
}

bool Arrivals::waits(std::uint64_t line) const {
    return std::any_of(waiting_.begin(), waiting_.end(),
                       [&](std::uint32_t slot) { return lines_[slot] == line; });
}

/// The request comes, or its bank begins with it.
void Arrivals::happen(std::uint32_t slot, cycle now) {
    Request& r = requests_[slot];
    if (!r.booked && r.kind != Kind::discard && !r.recalled) {
        r.booked = true;
        Access taken = r.access;
        if (r.kind == Kind::own) // no data move
            taken.bytes = 1;
        const cycle begins = cache_.book(taken);
        if (begins != now) {
            r.access.at = begins;
            return events_.foresee(begins, r.access.asker + 1, r.sequence, number_, slot);
        }
    }
    r.access.at = now;
    if (waits(lines_[slot]))
        waiting_.push_back(slot);
    else if (!act(slot, now))
        waiting_.push_back(slot);
}

/// False: refused.
bool Arrivals::act(std::uint32_t slot, cycle now) {
    Request& r = requests_[slot];
    r.access.at = now;
    if (r.kind == Kind::discard) {
        cache_.discard(r.access.address);
        lines_[slot] = nothing;
        free_.push_back(slot);
        return true;
    }
    events_.site_ = r.site;
    const Access access = r.access; // what it asks for may move the requests
    const Answer answer = serve(r, access);
    if (answer.refused) {
        note_refusal(answer.ready);
        return false;
    }
    finish(slot, answer, now);
    return true;
}

Answer Arrivals::serve(const Request& r, const Access& a) {
    if (r.recalled)
        return cache_.pass(a);
    return r.kind == Kind::own ? cache_.own_booked(a) : cache_.serve_booked(a, r.kind == Kind::write);
}

void Arrivals::finish(std::uint32_t slot, const Answer& answer, cycle now) {
    const Request r = requests_[slot];
    lines_[slot] = nothing;
    free_.push_back(slot);
    if (r.kind != Kind::write && r.access.by != nullptr && cache_.coherent())
        r.access.by->settle_right(r.access.address, r.access.bytes, answer.shared);
    if (r.kind == Kind::read && answer.dirty)
        deliver_dirty(r.access, now);
    if (is_ticket(answer.ready))
        return events_.tickets_.answer_like(r.ticket, answer.ready);
    events_.tickets_.answer(r.ticket, answer.ready, answer.from);
    events_.answered(now, r.access.by);
}

/// An exclusive cache gives up a line that it had not written back: that is up to who asked, to what this one
/// has sent back already, or comes back.
void Arrivals::deliver_dirty(const Access& a, cycle now) {
    if (a.by == nullptr || a.by->came_dirty(a.address))
        return;
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (lines_[i] == cache_.line_of(a.address) && requests_[i].kind == Kind::write &&
            requests_[i].access.by == a.by && !requests_[i].recalled) {
            requests_[i].access.clean = false;
            return;
        }
    a.by->send_back(a.address, now, a.column);
}

bool Arrivals::is_asked(std::uint64_t address, const Cache& by) const {
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (const Request& r = requests_[i]; lines_[i] == cache_.line_of(address) && r.access.by == &by &&
                                             by.line_of(r.access.address) == by.line_of(address) &&
                                             (r.kind == Kind::read || r.kind == Kind::own))
            return true;
    return false;
}

/// Whole lines among these bytes that are on their way to be written.
template <class Visit> void Arrivals::each_write(std::uint64_t address, std::uint64_t bytes, Visit visit) {
    for (std::size_t i = 0; i < lines_.size(); ++i)
        if (Request& r = requests_[i]; lines_[i] != nothing && r.kind == Kind::write && r.access.whole &&
                                       !r.recalled &&
                                       r.access.address - address < bytes) // not what lies before
            visit(r);
}

bool Arrivals::recall(std::uint64_t address, std::uint64_t bytes) {
    bool dirty = false;
    each_write(address, bytes, [&](Request& r) {
        r.recalled = true;
        dirty |= !r.access.clean;
    });
    return dirty;
}

bool Arrivals::clean(std::uint64_t address, std::uint64_t bytes) {
    bool dirty = false;
    each_write(address, bytes, [&](Request& r) { dirty |= !std::exchange(r.access.clean, true); });
    return dirty;
}

// --- what waits for room

void Arrivals::note_refusal(cycle again) {
    until_answer_ |= again == Answer::unknown || maybe_sooner(again);
    if (again != Answer::unknown && latest(again) < again_) {
        again_ = latest(again);
        events_.foresee(again_, 0, number_, number_, TileEvents::no_slot);
    }
}

/// Those that find room act, each line's in order of arrival.
void Arrivals::retry(cycle now) {
    again_ = ~cycle{0};
    until_answer_ = false;
    const std::vector<std::uint32_t> all = std::exchange(waiting_, {});
    for (const std::uint32_t slot : all)
        if (waits(lines_[slot]) || !act(slot, now))
            waiting_.push_back(slot);
}

// --- the tile

void TileEvents::step() {
    const Event e = events_.top();
    events_.pop();
    now_ = std::max(now_, e.at);
    update();
    if (e.where == nobody)
        return heard_(now_, nullptr);
    ++count_;
    Arrivals& a = arrivals_[e.where];
    if (e.slot != no_slot)
        a.happen(e.slot, now_);
    else if (e.at == a.again_)
        a.retry(now_);
}

void TileEvents::try_again() {
    for (Arrivals& a : arrivals_)
        if (a.until_answer_) {
            a.until_answer_ = false;
            a.note_refusal(now_);
        }
}

void TileEvents::answered(cycle now, const Cache* by) {
    try_again();
    heard_(now, by);
}

} // namespace sim
