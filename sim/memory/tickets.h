// Times that are not known yet. What lies beyond a tile is answered at the end of a window, and what a cache
// in it does in order of time when that has acted; until then a request is a ticket: a number with the top
// bit set, in place of a cycle. Whoever needs the cycle asks again then. A tile has tickets of its own.
#pragma once

#include "sim/core/stalls.h"

#include <cstddef>
#include <cstdint>
#include <deque>

namespace sim {

inline constexpr cycle ticket_bit = cycle{1} << 63U;
inline bool is_ticket(cycle c) {
    return c >= ticket_bit;
}

/// A cycle to try again at, or sooner, when something is answered.
inline constexpr cycle sooner_bit = cycle{1} << 62U;
inline cycle at_most(cycle c) {
    return c | sooner_bit;
}
inline bool maybe_sooner(cycle c) {
    return !is_ticket(c) && (c & sooner_bit) != 0;
}
inline cycle latest(cycle c) {
    return c & ~sooner_bit;
}

/// When the first and the last part of what a ticket stands for are there, and what brought the last.
struct Answered {
    cycle first = 0, last = 0;
    Cause from = Cause::memory;
};

/// No open ticket will be answered with an earlier cycle; none for a line, which takes longer than the right
/// to write one.
struct Floors {
    cycle any = 0, lines = 0;
};

class Tickets {
public:
    /// A new one, unanswered.
    cycle open() {
        entries_.push_back({});
        return ticket_bit | (begin_ + entries_.size() - 1);
    }
    void answer(cycle ticket, cycle ready, Cause from) {
        Entry& e = entries_[(ticket ^ ticket_bit) - begin_];
        e.time = {ready, ready, from};
        e.answered = true;
    }
    /// With whatever `other`, a younger one, is answered with.
    void answer_like(cycle ticket, cycle other) {
        Entry& e = entries_[(ticket ^ ticket_bit) - begin_];
        e.parts = other;
        e.part_count = like_other;
    }
    /// One for several accesses together: what is known of them, and the tickets of the rest.
    cycle join(const Answered& known, const cycle* tickets, std::uint32_t count) {
        Entry e;
        e.time = known;
        e.parts = parts_begin_ + parts_.size();
        e.part_count = count;
        parts_.insert(parts_.end(), tickets, tickets + count);
        entries_.push_back(e);
        return ticket_bit | (begin_ + entries_.size() - 1);
    }
    /// One for the same as `ticket`, but for what is there at `least` at the earliest. Without need if no
    /// open ticket will be answered that early.
    cycle no_earlier(cycle ticket, cycle least, Cause from) {
        if (least <= floors_.any)
            return ticket;
        cycle bounded = join({least, least, from}, &ticket, 1);
        entries_.back().bounded = true;
        return bounded;
    }
    /// Whether the ticket is answered, and with what. One that was forgotten lies in the past: cycle 0.
    bool find(cycle ticket, Answered& out) {
        std::uint64_t number = ticket ^ ticket_bit;
        if (number < begin_) {
            out = {};
            return true;
        }
        Entry& e = entries_[number - begin_];
        if (!e.answered && (e.part_count == 0 || !gather(e)))
            return false;
        out = e.time;
        return true;
    }
    const Floors& floors() const { return floors_; }
    void set_floors(const Floors& floors) { floors_ = floors; }
    std::size_t size() const { return entries_.size(); }
    /// Whether nobody asks for any now: what is asked for is there at once, however busy things are.
    bool at_once() const { return at_once_; }
    void set_at_once(bool on) { at_once_ = on; }
    /// Forgets the oldest answered tickets whose time has come by then: nobody's next operation is earlier.
    void forget(cycle by) {
        while (!entries_.empty() && known(entries_.front()) && entries_.front().time.last <= by) {
            entries_.pop_front();
            ++begin_;
        }
        std::uint64_t parts = parts_begin_ + parts_.size();
        for (const Entry& e : entries_)
            if (e.part_count != 0 && e.part_count != like_other) {
                parts = e.parts;
                break;
            }
        parts_.erase(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(parts - parts_begin_));
        parts_begin_ = parts;
    }

private:
    struct Entry {
        Answered time;
        std::uint64_t parts = 0; // the first one's place, or the other ticket
        std::uint32_t part_count = 0;
        bool bounded = false; // its part counts from `time` on
        bool answered = false;
    };
    static constexpr std::uint32_t like_other = ~std::uint32_t{0};

    bool known(Entry& e) { return e.answered || (e.part_count == like_other && gather(e)); }
    bool gather(Entry& e) {
        if (e.part_count == like_other) {
            e.answered = find(e.parts, e.time);
            return e.answered;
        }
        Answered all = e.time;
        for (std::uint64_t i = e.parts; i < e.parts + e.part_count; ++i) {
            Answered part;
            if (!find(parts_[i - parts_begin_], part))
                return false;
            if (e.bounded ? part.first > all.first : part.first < all.first)
                all.first = part.first;
            if (part.last > all.last || (part.last == all.last && part.from > all.from && !e.bounded)) {
                all.last = part.last;
                all.from = part.from;
            }
        }
        e.time = all;
        e.answered = true;
        return true;
    }

    std::deque<Entry> entries_;
    std::deque<cycle> parts_;
    std::uint64_t begin_ = 0, parts_begin_ = 0;
    Floors floors_;
    bool at_once_ = false;
};

} // namespace sim
