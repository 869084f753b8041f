// A few equal entries, each held for a time: MSHRs, write-back buffers.
#pragma once

#include "sim/memory/tickets.h"

#include <algorithm>
#include <vector>

namespace sim {

/// For requests that come in any order of time, held until cycles that may not be known yet. Notes whose each
/// hold is. Remembers twice as many holds as it has entries, and some: a request that far behind finds it
/// emptier.
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
        for (;;) {
            std::size_t held = 0;
            cycle next = ~cycle{0};
            cycle floor = unknown; // of those that are open
            for (Hold& h : holds_) {
                if (h.from > t)
                    continue;
                if (is_ticket(h.until) && !resolve(h)) {
                    ++held;
                    const Floors& floors = tickets_.floors();
                    floor = std::min(floor, h.what == What::right ? floors.any : floors.lines);
                } else if (h.until > t) {
                    ++held;
                    next = std::min(next, h.until);
                }
            }
            if (held < entries_)
                return t;
            if (floor != unknown && next > floor)
                return heard_ && next != unknown ? at_most(next) : unknown;
            t = next;
        }
    }
    void hold(const Hold& h) {
        if (holds_.size() >= limit_)
            unlimited_ ? drop_ended(h.from) : drop_oldest();
        holds_.push_back(h);
    }
    /// The hold of a line, or nullptr: it has ended.
    Hold* find(std::uint64_t line) {
        return find_latest([line](const Hold& h) { return h.line == line && h.what != What::right; });
    }
    /// ... of the right to write it.
    Hold* find_right(std::uint64_t line) {
        return find_latest([line](const Hold& h) { return h.line == line && h.what != What::line; });
    }
    /// From now on as many are held as there may be; take() is not asked.
    void lift_limit() {
        unlimited_ = true;
        limit_ = entries_ * 4 + 64;
    }
    static constexpr cycle unknown = ~cycle{0};

private:
    template <class Wanted> Hold* find_latest(Wanted wanted) {
        for (std::size_t i = holds_.size(); i-- > 0;)
            if (wanted(holds_[i])) {
                Hold& h = holds_[i];
                if (is_ticket(h.until))
                    resolve(h);
                return &h;
            }
        return nullptr;
    }
    bool resolve(Hold& h) {
        Answered a;
        if (!tickets_.find(h.until, a))
            return false;
        h.until = a.last;
        h.cause = a.from;
        return true;
    }
    void drop_ended(cycle by) {
        std::erase_if(holds_, [&](Hold& h) { return (!is_ticket(h.until) || resolve(h)) && h.until <= by; });
    }
    void drop_oldest() {
        std::size_t oldest = holds_.size();
        for (std::size_t i = 0; i < holds_.size(); ++i) {
            if (is_ticket(holds_[i].until) && !resolve(holds_[i]))
                continue;
            if (oldest == holds_.size() || holds_[i].until < holds_[oldest].until)
                oldest = i;
        }
        if (oldest != holds_.size())
            holds_.erase(holds_.begin() + static_cast<std::ptrdiff_t>(oldest));
    }

    std::size_t entries_, limit_;
    bool unlimited_ = false, heard_;
    std::vector<Hold> holds_;
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
