// What a cache does for coherence within a tile: MESI, with two marks a line. One that is not shared may be
// written at once (exclusive, or modified if dirty); to write a shared one, a cache asks below, up to the
// tile's last cache, and that beyond the tile. Every level below the L1s is inclusive, so that a cache knows
// which of those above have a line, as by duplicate tags: a write takes it from all but the writer's, a read
// leaves it shared with them, and what one of them has changed comes down first, one access of that cache
// later. Of lines whose answer is not known yet, nobody has the right; who asks for it twice waits once.
// Copies within the tile go when the right is asked for (reference mode: when the level below acts on that,
// which then says who has it), and those elsewhere when the window has ended. Not
// modelled: ports and banks of what others ask for; that the right takes longer where other caches of the
// tile have to give the line up.
#include "sim/memory/cache.h"
#include "sim/trace/passing.h"

#include <algorithm>
#include <array>

namespace sim {

/// When both are there.
Answer Cache::later_of(Answer a, Answer b) const {
    if (is_ticket(a.ready) && is_ticket(b.ready)) {
        const std::array<cycle, 2> parts = {a.ready, b.ready};
        a.ready = parts[0] == parts[1]
                      ? parts[0]
                      : tickets_.join({~cycle{0}, 0, Cause::busy}, parts.data(), parts.size());
        return a;
    }
    if (is_ticket(b.ready))
        std::swap(a, b);
    if (is_ticket(a.ready))
        a.ready = tickets_.no_earlier(a.ready, b.ready, b.from);
    else if (b.ready > a.ready)
        a = b;
    return a;
}

/// The right to write a line that is here, from below; or refused.
Answer Cache::ask_right(const Access& a, CacheArray::Entry entry, std::uint64_t line, cycle done) {
    if (const Pool::Hold* asked = mshrs_.find_right(line); asked != nullptr)
        return {tickets_.no_earlier(asked->until, done, cause_), asked->cause};
    if (!last_ && !a.forced)
        if (const cycle room = mshrs_.take(a.at); room != a.at)
            return Answer::later(room);
    Access right{line << line_shift_, std::uint32_t{1} << line_shift_, done, a.column};
    right.forced = a.forced;
    right.by = this;
    right.asker = number_;
    const Answer answer = below_.own(right);
    if (answer.refused) {
        note_refused(Passing::own, right, answer);
        return answer;
    }
    note_passed(traces::Kind::upgrade, right);
    ++counters_.upgrades;
    mshrs_.hold({line, a.at, answer.ready, answer.from, Pool::What::right});
    if (!answer.shared)
        array_.set_shared(entry, false);
    return answer;
}

Answer Cache::own(const Access& a) {
    Calendar& bank = banks_[(a.address >> line_shift_) & bank_mask_];
    const cycle start = bank.find_run(a.at, 1);
    const Answer answer = give_right(a, start);
    if (answer.refused)
        return answer;
    bank.mark_run(start, 1);
    quiet_ = std::max(quiet_, start + 1);
    ++counters_.busy_cycles;
    return answer;
}

/// The right to write a line, to the cache above that asks; its bank begins with that at `start`.
Answer Cache::give_right(const Access& a, cycle start) {
    const std::uint64_t line = a.address >> line_shift_;
    const CacheArray::Entry entry = array_.find(line);
    if (entry == CacheArray::none) { // it was taken meanwhile: the line has to come again
        Access again = a;
        again.exclusive = true;
        const Answer answer = act(again, false, start);
        counters_.lost_upgrades += answer.refused ? 0 : 1;
        return answer;
    }
    Answer answer{start + latency_, cause_};
    if (array_.shared(entry)) {
        const Answer right = ask_right(a, entry, line, start + latency_);
        if (right.refused)
            return right;
        answer = later_of(answer, right);
    }
    drop_others(a, entry);
    answer.shared = !owns(a.address);
    return answer;
}

/// The caches above but the one that asks lose what it writes.
void Cache::drop_others(const Access& a, CacheArray::Entry entry) {
    for (Cache* c : above_)
        if (c != a.by && c->lose(a.address, std::max(a.bytes, 1U)))
            array_.set_dirty(entry, true);
}

/// The caches above but the one that asks share what it reads.
Answer Cache::share_others(const Access& a, CacheArray::Entry entry, Answer answer) {
    for (Cache* c : above_)
        if (c != a.by && c->share(a.address, std::max(a.bytes, 1U), a.at, a.column)) {
            array_.set_dirty(entry, true);
            if (!is_ticket(answer.ready)) {
                answer.ready += c->latency_;
                answer.from = Cause::coherence;
            }
        }
    return answer;
}

bool Cache::above_hold(std::uint64_t address, const Cache* but) const {
    return std::any_of(above_.begin(), above_.end(),
                       [&](const Cache* c) { return c != but && c->holds(address); });
}

void Cache::settle_right(std::uint64_t address, std::uint64_t bytes, bool shared) {
    if (!shared)
        return grant(address, bytes);
    const std::uint64_t size = line_bytes();
    for (std::uint64_t at = begin_of(address); at < address + bytes; at += size) {
        for (Cache* c : above_)
            c->settle_right(at, size, true);
        if (const CacheArray::Entry entry = array_.find(at >> line_shift_); entry != CacheArray::none)
            array_.set_shared(entry, true);
    }
}

void Cache::grant(std::uint64_t address, std::uint64_t bytes) {
    const std::uint64_t size = line_bytes();
    for (std::uint64_t at = begin_of(address); at < address + bytes; at += size) {
        const CacheArray::Entry entry = array_.find(at >> line_shift_);
        if (entry == CacheArray::none)
            continue;
        array_.set_shared(entry, false);
        if (above_.empty())
            continue;
        const std::uint64_t step = std::uint64_t{1} << above_.front()->line_shift_;
        for (std::uint64_t part = at; part < at + size; part += step) {
            const auto has = [part](const Cache* c) { return c->holds(part); };
            const auto first = std::find_if(above_.begin(), above_.end(), has);
            if (first != above_.end() && std::none_of(first + 1, above_.end(), has))
                (*first)->grant(part, step);
        }
    }
}

bool Cache::lose(std::uint64_t address, std::uint64_t bytes) {
    bool dirty = false;
    const std::uint64_t size = line_bytes();
    for (std::uint64_t at = begin_of(address); at < address + bytes; at += size) {
        if (below_.is_asked(at, *this))
            continue;
        dirty |= coming_ != nullptr && coming_->recall(at, size);
        for (Cache* c : above_) // all of a line goes, whatever part of it is written
            dirty |= c->lose(at, size);
        const CacheArray::Entry entry = array_.find(at >> line_shift_);
        if (causes_)
            causes_->invalidate(at >> line_shift_, entry != CacheArray::none);
        if (entry == CacheArray::none)
            continue;
        dirty |= array_.dirty(entry);
        ++counters_.invalidations;
        count_useless(entry);
        array_.drop(entry);
    }
    if (dirty)
        note_held(address, bytes, 0, Passing::held | Passing::changed);
    return dirty;
}

bool Cache::share(std::uint64_t address, std::uint64_t bytes, cycle t, std::size_t column) {
    bool dirty = false;
    const std::uint64_t size = line_bytes();
    for (std::uint64_t at = begin_of(address); at < address + bytes; at += size) {
        if (below_.is_asked(at, *this))
            continue;
        bool changed = coming_ != nullptr && coming_->clean(at, size);
        for (Cache* c : above_)
            changed |= c->share(at, size, t, column);
        const CacheArray::Entry entry = array_.find(at >> line_shift_);
        if (entry == CacheArray::none)
            continue;
        array_.set_shared(entry, true);
        changed |= array_.dirty(entry);
        array_.set_dirty(entry, false);
        if (changed && last_) {
            ++counters_.write_backs;
            ++(attribution_->cell(at, column).*traffic_.write_backs);
            note(traces::Kind::write_back, at, t, column);
        }
        counters_.downgrades += changed ? 1 : 0;
        dirty |= changed;
    }
    if (dirty)
        note_held(address, bytes, t, Passing::held | Passing::changed);
    return dirty;
}

std::uint64_t Cache::incoherent() const {
    std::uint64_t lines = 0;
    for (const Cache* c : above_) {
        lines += c->incoherent();
        c->each_address([&](std::uint64_t address) {
            if (c->owns(address))
                lines += owns(address) && !above_hold(address, c) ? 0 : 1;
        });
    }
    return lines;
}

} // namespace sim
