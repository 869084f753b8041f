#include "sim/core/calendar.h"

#include <fmt/core.h>

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

/// Of several words, the first of which, `number`, has `free` slots to take.
Calendar::Span Calendar::take_across(std::uint64_t number, std::uint64_t free, std::uint32_t count) {
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
