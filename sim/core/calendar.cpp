#include "sim/core/calendar.h"

#include <fmt/core.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace sim {

void calendar_has_passed(const char* name, std::uint64_t slot, std::uint64_t earliest) {
    fmt::print(stderr,
               "razor-sim: broken invariant: the calendar of {} was asked for slot {}, and nobody should ask "
               "for any "
               "before {}\n",
               name, slot, earliest);
    std::abort();
}

/// Lets the ring begin with the earliest word that may be asked for, and makes it long enough for `number`.
void Calendar::move_on(std::uint64_t number) {
    std::uint64_t earliest = (*earliest_ << shift_) / 64;
    if (number < first_ || number < earliest)
        calendar_has_passed(name_, number * 64, earliest * 64);
    std::uint64_t next = std::max(first_ + words_.size(), earliest); // not in the ring yet
    if (number - earliest > mask_) {
        std::vector<std::uint64_t> longer(std::bit_ceil(number - earliest + 1), absent_);
        for (std::uint64_t n = earliest; n < next; ++n)
            longer[n & (longer.size() - 1)] = words_[n & mask_];
        words_ = std::move(longer);
        mask_ = words_.size() - 1;
    }
    for (; next <= earliest + mask_; ++next)
        words_[next & mask_] = absent_;
    first_ = earliest;
}

Calendar::Slot Calendar::last_taken_before(Slot end) const {
    if (end == 0)
        return 0;
    for (std::uint64_t number = std::min((end - 1) / 64, first_ + mask_) + 1; number-- > first_;) {
        std::uint64_t taken = words_[number & mask_] & ~absent_;
        if (number == (end - 1) / 64)
            taken &= ~std::uint64_t{0} >> (63 - (end - 1) % 64);
        if (taken != 0)
            return last_of(number, taken);
    }
    return 0;
}

bool Calendar::take_two_before(Slot from, Slot end) {
    std::array<Slot, 2> found{};
    std::size_t count = 0;
    for (Slot s = from; s < end && count < found.size(); ++s) {
        const std::uint64_t number = s / 64;
        if (number - first_ > mask_)
            return true;
        if ((words_[number & mask_] >> s % 64 & 1) == 0)
            found[count++] = s;
    }
    if (count < found.size())
        return false;
    for (const Slot s : found)
        mark(s);
    return true;
}

/// The first run from `from` on, when it is known that none begins before `next`. Where many wait for a unit,
/// each passes what those before it have found taken at once.
Calendar::Slot Calendar::find_run_after(Slot from, Slot next, std::uint32_t length) {
    constexpr std::size_t lengths = 4;
    barren_.resize(lengths);
    Barren& b = barren_[length % lengths];
    const bool known = b.length == length;
    Slot begin = next;
    for (;;) {
        if (known && b.has(begin))
            begin = b.to;
        const Slot end = begin + length, busy = last_busy(begin, end);
        if (busy == end)
            break;
        begin = busy + 1;
    }
    if (known && from <= b.to && b.from <= begin) // they touch
        b = {std::min(from, b.from), std::max(begin, b.to), length};
    else
        b = {from, begin, length};
    return begin;
}

/// Of several words, the first of which, `number`, has `free` slots to take.
Calendar::Span Calendar::take_across(std::uint64_t number, std::uint64_t free, std::uint32_t count) {
    if (free != 0) { // mostly the next one has the rest
        const auto here = static_cast<std::uint32_t>(std::popcount(free));
        const std::uint64_t next = ~word(number + 1);
        if (static_cast<std::uint32_t>(std::popcount(next)) >= count - here) {
            const std::uint64_t taken = lowest(next, count - here);
            word(number) |= free;
            word(number + 1) |= taken;
            return {number * 64 + static_cast<unsigned>(std::countr_zero(free)), last_of(number + 1, taken)};
        }
    }
    Slot first = no_slot;
    for (;; free = ~word(++number)) {
        note_full(number, word(number));
        if (free == 0)
            continue;
        first = first == no_slot ? number * 64 + static_cast<unsigned>(std::countr_zero(free)) : first;
        const std::uint64_t taken = lowest(free, count);
        word(number) |= taken;
        count -= static_cast<std::uint32_t>(std::popcount(taken));
        if (count == 0)
            return {first, last_of(number, taken)};
    }
}

} // namespace sim
