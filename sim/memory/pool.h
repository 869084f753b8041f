// A few equal entries, each held for a time: MSHRs, write-back buffers.
#pragma once

#include "sim/memory/tickets.h"

#include <algorithm>
#include <vector>

namespace sim {

/// For requests that come in any order of time, held until cycles that may not be known yet. Notes whose each
/// hold is. Remembers twice as many holds as it has entries, and some: a request that far behind finds it
/// emptier.
///
/// Holds whose end is known are kept in order of it: most requests come when all but a few have ended, and
/// look at these few alone.
class Pool {
public:
    /// What of the line is on its way: it, it with the right to write it, that right alone.
    enum class What : std::uint8_t { line, line_to_write, right };
    struct Hold {
        std::uint64_t line;
        cycle from, until; // until: a cycle or a ticket
        Cause cause;
        What what = What::line;
    };

    /// `heard`: who waits for an entry hears of every answer.
    Pool(std::size_t entries, Tickets& tickets, bool heard = false)
        : entries_(entries), limit_(2 * entries + 8), heard_(heard), tickets_(tickets) {}

    /// The first cycle from `t` on at which an entry is free; unknown if that depends on open tickets, or
    /// (who waits hears of their answers) at_most(the cycle).
    cycle take(cycle t) {
        if (tickets_.at_once()) [[unlikely]]
            return t;
        for (;;) {
            std::size_t held = 0;
            cycle floor = unknown; // of those that are open
            if (!open_.empty())
                resolve_begun(t);
            for (const Kept& h : open_) {
                if (h.from > t)
                    continue;
                ++held;
                const Floors& floors = tickets_.floors();
                floor = std::min(floor, h.what == What::right ? floors.any : floors.lines);
            }
            cycle next = ~cycle{0};
            for (std::size_t i = known_.size(); i-- > first_ && known_[i].until > t;)
                if (known_[i].from <= t) {
                    ++held;
                    next = known_[i].until;
                }
            if (held < entries_)
                return t;
            if (floor != unknown && next > floor)
                return heard_ && next != unknown ? at_most(next) : unknown;
            t = next;
        }
    }
    void hold(const Hold& h) {
        if (tickets_.at_once()) [[unlikely]]
            return;
        if (known_.size() - first_ + open_.size() >= limit_)
            unlimited_ ? drop_ended(h.from) : drop_oldest();
        const Kept kept{h, number_++};
        if (is_ticket(h.until))
            open_.push_back(kept);
        else
            keep(kept);
    }
    /// The latest hold of a line, if it lasts beyond this cycle, or who knows how long; or nullptr. Until the
    /// next call.
    const Hold* find(std::uint64_t line, cycle by) {
        return find_latest([line](const Hold& h) { return h.line == line && h.what != What::right; }, by);
    }
    /// ... of the right to write it, if nobody knows yet when that comes.
    const Hold* find_right(std::uint64_t line) {
        const Hold* const h = find_latest(
            [line](const Hold& one) { return one.line == line && one.what != What::line; }, unknown);
        return h != nullptr && is_ticket(h->until) ? h : nullptr;
    }
    /// From now on as many are held as there may be; take() is not asked.
    void lift_limit() {
        unlimited_ = true;
        limit_ = entries_ * 4 + 64;
    }
    static constexpr cycle unknown = ~cycle{0};

private:
    struct Kept : Hold {
        std::uint64_t number; // as they came
    };

    /// In its place among those whose end is known.
    const Kept& keep(const Kept& h) {
        if (first_ > limit_) {
            known_.erase(known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(first_));
            first_ = 0;
        }
        known_.push_back(h);
        std::size_t at = known_.size() - 1;
        for (; at > first_ && is_later(known_[at - 1], h); --at)
            known_[at] = known_[at - 1];
        known_[at] = h;
        return known_[at];
    }
    static bool is_later(const Kept& a, const Kept& b) {
        return a.until != b.until ? a.until > b.until : a.number > b.number;
    }
    template <class Wanted> const Hold* find_latest(Wanted wanted, cycle by) {
        for (std::size_t i = open_.size(); i-- > 0;)
            if (wanted(open_[i]) && !newer_is_known(wanted, open_[i].number)) {
                Kept h = open_[i];
                if (!resolve(h))
                    return &open_[i];
                open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
                const Kept& known = keep(h);
                return known.until > by ? &known : nullptr;
            }
        for (std::size_t i = known_.size(); i-- > first_ && known_[i].until > by;)
            if (wanted(known_[i])) // the latest that ends last is hardly ever not the latest
                return newer_is_known(wanted, known_[i].number) ? latest_known(wanted, by) : &known_[i];
        return nullptr;
    }
    template <class Wanted> bool newer_is_known(Wanted wanted, std::uint64_t number) const {
        return std::any_of(known_.begin() + static_cast<std::ptrdiff_t>(first_), known_.end(),
                           [&](const Kept& h) { return h.number > number && wanted(h); });
    }
    template <class Wanted> const Hold* latest_known(Wanted wanted, cycle by) const {
        const Kept* latest = nullptr;
        for (std::size_t i = first_; i < known_.size(); ++i)
            if (wanted(known_[i]) && (latest == nullptr || known_[i].number > latest->number))
                latest = &known_[i];
        return latest != nullptr && latest->until > by ? latest : nullptr;
    }
    bool resolve(Hold& h) {
        Answered a;
        if (!tickets_.find(h.until, a))
            return false;
        h.until = a.last;
        h.cause = a.from;
        return true;
    }
    /// Of those that began by then.
    void resolve_begun(cycle by) {
        std::size_t left = 0;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            Kept h = open_[i];
            if (h.from <= by && resolve(h))
                keep(h);
            else
                open_[left++] = h;
        }
        open_.resize(left);
    }
    void drop_ended(cycle by) {
        resolve_begun(unknown);
        while (first_ < known_.size() && known_[first_].until <= by)
            ++first_;
    }
    void drop_oldest() {
        resolve_begun(unknown);
        if (first_ < known_.size())
            ++first_;
    }

    std::size_t entries_, limit_;
    bool unlimited_ = false, heard_;
    std::vector<Kept> known_; // by their end, then as they came; from first_ on, those before were dropped
    std::size_t first_ = 0;
    std::vector<Kept> open_; // as they came
    std::uint64_t number_ = 0;
    Tickets& tickets_;
};

/// For requests that come in order of time.
class OrderedPool {
public:
    explicit OrderedPool(std::size_t entries) : free_at_(entries, 0) {}

    struct Grant {
        cycle at;
        std::size_t entry;
    };
    /// An entry at `t`, or when the first is released. The caller must then hold() it.
    Grant take(cycle t) {
        std::size_t first = 0;
        for (std::size_t i = 0; i < free_at_.size(); ++i) {
            if (free_at_[i] <= t)
                return {t, i};
            if (free_at_[i] < free_at_[first])
                first = i;
        }
        return {free_at_[first], first};
    }
    void hold(std::size_t entry, cycle until) { free_at_[entry] = until; }
    /// Until nobody knows when; close() says so.
    void hold_open(std::size_t entry) {
        free_at_[entry] = ~cycle{0};
        ++open_;
    }
    void close(std::size_t entry, cycle until) {
        free_at_[entry] = until;
        --open_;
    }
    bool open() const { return open_ != 0; }

private:
    std::vector<cycle> free_at_;
    std::size_t open_ = 0;
};

} // namespace sim
