// Which slots of a resource are taken: one bit a slot, in a ring. Requests may come out of time order
// (threads run ahead of each other, and what lies downstream is booked for the future), so that a free gap
// before a later booking stays usable. The ring grows with the time between the earliest cycle that anybody
// may still ask for and the latest that somebody did; a request before the earliest is a broken invariant.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>
#ifdef __BMI2__
#include <immintrin.h>
#endif

namespace sim {

[[noreturn]] void calendar_has_passed(const char* name, std::uint64_t slot, std::uint64_t earliest);

class Calendar {
public:
    using Slot = std::uint64_t;
    struct Span {
        Slot first, last;
    };

    /// `per_cycle` slots a cycle exist; the slots of a cycle are numbered from cycle <<
    /// log2_group(per_cycle). Nobody asks for cycles before `earliest`, which its owner moves on.
    Calendar(const char* name, const cycle& earliest, unsigned per_cycle = 1)
        : earliest_(&earliest), shift_(log2_group(per_cycle)), name_(name) {
        unsigned group = 1U << shift_;
        for (unsigned bit = 0; bit < 64; ++bit)
            if (bit % group >= per_cycle)
                absent_ |= std::uint64_t{1} << bit;
        words_.assign(16, absent_);
        mask_ = words_.size() - 1;
    }
    static unsigned log2_group(unsigned per_cycle) {
        return static_cast<unsigned>(std::bit_width(per_cycle - 1));
    }

    /// Takes the first free slot from `from` on.
    Slot take(Slot from) {
        for (Start s = start(from);; ++s.number, s.open = ~std::uint64_t{0}) {
            std::uint64_t& w = word(s.number);
            const std::uint64_t free = ~w & s.open;
            if (free != 0) [[likely]] {
                w |= free & (~free + 1);
                return s.number * 64 + static_cast<unsigned>(std::countr_zero(free));
            }
            note_full(s.number, w);
        }
    }
    /// The first free slot from `from` on; takes none.
    Slot find(Slot from) {
        for (std::uint64_t number = from / 64, open = ~std::uint64_t{0} << (from % 64);;
             ++number, open = ~std::uint64_t{0})
            if (std::uint64_t free = ~word(number) & open; free != 0)
                return number * 64 + static_cast<unsigned>(std::countr_zero(free));
    }
    /// Where a cycle is one slot: which of the 64 around `t`, from a multiple of 64 on, are `t` or later and
    /// free.
    std::uint64_t free_around(Slot t) { return ~word(t / 64) & ~std::uint64_t{0} << (t % 64); }
    /// Takes the first `count` free slots from `from` on, adjacent or not.
    Span take(Slot from, std::uint32_t count) {
        const Start s = start(from);
        std::uint64_t& w = word(s.number);
        const std::uint64_t free = ~w & s.open;
        if (static_cast<std::uint32_t>(std::popcount(free)) < count) [[unlikely]]
            return take_across(s.number, free, count);
        const std::uint64_t taken = lowest(free, count);
        w |= taken;
        return {s.number * 64 + static_cast<unsigned>(std::countr_zero(free)), last_of(s.number, taken)};
    }
    /// Takes the first `count` free slots, up to 64, from `from` on, where 64 slots from a multiple of 64 on
    /// hold all of them and none is later than `latest`; if not, false, and none is taken.
    [[gnu::always_inline]] bool take_near(Slot from, std::uint32_t count, Slot latest, Span& taken) {
        const Start s = start(from);
        std::uint64_t& w = word(s.number);
        const std::uint64_t free = ~w & s.open;
        if (static_cast<std::uint32_t>(std::popcount(free)) < count || s.number * 64 + 63 > latest)
            [[unlikely]]
            return false;
        const std::uint64_t bits = lowest(free, count);
        w |= bits;
        taken = {s.number * 64 + static_cast<unsigned>(std::countr_zero(free)), last_of(s.number, bits)};
        return true;
    }
    /// Its bits from cycle `t` on come to the host's caches.
    void prefetch(cycle t) const { __builtin_prefetch(&words_[((t << shift_) / 64) & mask_]); }
    /// The last slot before `end` that is taken, of those that are still remembered; 0: none is.
    Slot last_taken_before(Slot end) const;
    /// Takes the first two free slots from `from` on and before `end`, which may be earlier than anybody asks
    /// for; false: there are not two (of what is forgotten, there are).
    bool take_two_before(Slot from, Slot end);
    /// Frees a slot that was taken.
    void release(Slot slot) {
        word(slot / 64) &= ~(std::uint64_t{1} << (slot % 64));
        full_count_ = 0;
        barren_.clear();
    }
    /// The first of `length` adjacent free slots from `from` on; takes none.
    Slot find_run(Slot from, std::uint32_t length) {
        const Slot end = from + length, busy = last_busy(from, end);
        return busy == end ? from : find_run_after(from, busy + 1, length);
    }
    /// Takes a slot that is free.
    void mark(Slot slot) { word(slot / 64) |= std::uint64_t{1} << (slot % 64); }
    void mark_run(Slot from, std::uint32_t length) {
        for (Slot s = from; s < from + length;) {
            unsigned bit = s % 64;
            auto n = static_cast<unsigned>(std::min<std::uint64_t>(64 - bit, from + length - s));
            word(s / 64) |= (~std::uint64_t{0} >> (64 - n)) << bit;
            s += n;
        }
    }
    Slot take_run(Slot from, std::uint32_t length) {
        if (length == 1)
            return take(from);
        Slot s = find_run(from, length);
        mark_run(s, length);
        return s;
    }

private:
    static constexpr Slot no_slot = ~Slot{0};

    /// The first word that may have a free slot from `from` on, and which of its slots count.
    struct Start {
        std::uint64_t number, open;
    };
    Start start(Slot from) const {
        const std::uint64_t number = from / 64;
        if (number - full_from_ < full_count_)
            return {full_from_ + full_count_, ~std::uint64_t{0}};
        return {number, ~std::uint64_t{0} << (from % 64)};
    }
    void note_full(std::uint64_t number, std::uint64_t w) {
        if (~w != 0)
            return;
        if (number != full_from_ + full_count_) {
            full_from_ = number;
            full_count_ = 0;
        }
        ++full_count_;
    }

    /// The lowest `count` bits, 1 or more, that are set in `free`, or all.
    static std::uint64_t lowest(std::uint64_t free, std::uint32_t count) {
#ifdef __BMI2__
        return _pdep_u64(~std::uint64_t{0} >> (64 - std::min(count, 64U)), free);
#else
        std::uint64_t rest = free; // what stays free
        for (; count != 0 && rest != 0; --count)
            rest &= rest - 1;
        return free ^ rest;
#endif
    }

    static Slot last_of(std::uint64_t number, std::uint64_t taken) {
        return number * 64 + 63 - static_cast<unsigned>(std::countl_zero(taken));
    }
    Span take_across(std::uint64_t number, std::uint64_t free, std::uint32_t count);
    std::uint64_t& word(std::uint64_t number) {
        if (number - first_ > mask_) [[unlikely]] // also what is earlier than the first
            move_on(number);
        return words_[number & mask_];
    }
    void move_on(std::uint64_t number);
    Slot find_run_after(Slot from, Slot next, std::uint32_t length);
    /// The last taken slot in [from, end), or `end`.
    Slot last_busy(Slot from, Slot end) {
        for (std::uint64_t number = (end - 1) / 64;; --number) {
            std::uint64_t seen = word(number);
            if (number == (end - 1) / 64)
                seen &= ~std::uint64_t{0} >> (63 - (end - 1) % 64);
            if (number == from / 64)
                seen &= ~std::uint64_t{0} << (from % 64);
            if (seen != 0)
                return number * 64 + 63 - static_cast<unsigned>(std::countl_zero(seen));
            if (number == from / 64)
                return end;
        }
    }

    std::vector<std::uint64_t> words_; // a power of two
    std::uint64_t mask_;
    std::uint64_t first_ = 0; // the number, in unbounded time, of the ring's earliest word
    std::uint64_t full_from_ = 0,
                  full_count_ = 0; // some words in which no slot is free, to be passed at once
    /// From `from` on until `to` no run of this length begins.
    struct Barren {
        Slot from = 0, to = 0;
        std::uint32_t length = 0;
        bool has(Slot s) const { return s - from < to - from; }
    };
    std::vector<Barren> barren_; // of some lengths, by their last bits; empty: nothing is known
    std::uint64_t absent_ = 0;
    const cycle* earliest_;
    unsigned shift_;
    const char* name_;
};

} // namespace sim
