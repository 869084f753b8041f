// Which slots of a resource are taken: one bit a slot, in a ring. Requests may come out of time order
// (threads run ahead of each other, and what lies downstream is booked for the future), so that a free gap
// before a later booking stays usable. The ring must span everything booked at one time; a request for a slot
// that the ring has passed is a broken invariant.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace sim {

[[noreturn]] void calendar_too_short(const char* name, std::uint64_t slot, std::uint64_t ring);

class Calendar {
public:
    using Slot = std::uint64_t;
    struct Span {
        Slot first, last;
    };

    /// `per_cycle` slots a cycle exist; the slots of a cycle are numbered from cycle <<
    /// log2_group(per_cycle).
    Calendar(const char* name, std::uint64_t ring_cycles, unsigned per_cycle = 1)
        : words_(std::bit_ceil((ring_cycles << log2_group(per_cycle)) / 64 + 2)), mask_(words_.size() - 1),
          name_(name) {
        unsigned group = 1U << log2_group(per_cycle);
        for (unsigned bit = 0; bit < 64; ++bit)
            if (bit % group >= per_cycle)
                absent_ |= std::uint64_t{1} << bit;
        for (Word& w : words_)
            w.bits = absent_;
    }
    static unsigned log2_group(unsigned per_cycle) {
        return static_cast<unsigned>(std::bit_width(per_cycle - 1));
    }

    /// Takes the first free slot from `from` on.
    Slot take(Slot from) {
        for (std::uint64_t number = from / 64, open = ~std::uint64_t{0} << (from % 64);;
             ++number, open = ~std::uint64_t{0}) {
            Word& w = word(number);
            std::uint64_t free = ~w.bits & open;
            if (free != 0) {
                w.bits |= free & (~free + 1);
                return number * 64 + static_cast<unsigned>(std::countr_zero(free));
            }
        }
    }
    /// Takes the first `count` free slots from `from` on, adjacent or not.
    Span take(Slot from, std::uint32_t count) {
        std::uint64_t number = from / 64;
        std::uint64_t open = ~std::uint64_t{0} << (from % 64);
        for (Slot first = no_slot;; ++number, open = ~std::uint64_t{0}) {
            Word& w = word(number);
            std::uint64_t free = ~w.bits & open;
            if (free == 0)
                continue;
            auto low = static_cast<unsigned>(std::countr_zero(free));
            first = first == no_slot ? number * 64 + low : first;
            std::uint64_t wanted = count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
            if ((free >> low & wanted) == wanted) { // all in one piece
                w.bits |= wanted << low;
                return {first, number * 64 + low + count - 1};
            }
            std::uint64_t rest = free; // what stays free
            for (; count != 0 && rest != 0; --count)
                rest &= rest - 1;
            std::uint64_t taken = free ^ rest;
            w.bits |= taken;
            if (count == 0)
                return {first, number * 64 + 63 - static_cast<unsigned>(std::countl_zero(taken))};
        }
    }
    /// Frees a slot that was taken, unless the ring has passed it.
    void release(Slot slot) {
        Word& w = words_[slot / 64 & mask_];
        if (w.number == slot / 64)
            w.bits &= ~(std::uint64_t{1} << (slot % 64));
    }
    /// The first of `length` adjacent free slots from `from` on; takes none.
    Slot find_run(Slot from, std::uint32_t length) {
        for (Slot end = from + length;;) {
            Slot busy = last_busy(from, end);
            if (busy == end)
                return from;
            from = busy + 1;
            end = from + length;
        }
    }
    void mark_run(Slot from, std::uint32_t length) {
        for (Slot s = from; s < from + length;) {
            unsigned bit = s % 64;
            auto n = static_cast<unsigned>(std::min<std::uint64_t>(64 - bit, from + length - s));
            word(s / 64).bits |= (~std::uint64_t{0} >> (64 - n)) << bit;
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
    struct Word {
        std::uint64_t number = 0; // which word of unbounded time it stands for
        std::uint64_t bits = 0;
    };

    Word& word(std::uint64_t number) {
        Word& w = words_[number & mask_];
        if (w.number != number) [[unlikely]] {
            if (w.number > number)
                calendar_too_short(name_, number * 64, words_.size() * 64);
            w = {number, absent_};
        }
        return w;
    }
    /// The last taken slot in [from, end), or `end`.
    Slot last_busy(Slot from, Slot end) {
        for (std::uint64_t number = (end - 1) / 64;; --number) {
            std::uint64_t seen = word(number).bits;
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

    std::vector<Word> words_;
    std::uint64_t mask_, absent_ = 0;
    const char* name_;
};

} // namespace sim
