// What writing and reading of blocks have in common: the layout, and what is guessed from what came before.
#pragma once

#include "traces/evictions.h"
#include "traces/reference.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

namespace traces {

inline constexpr std::size_t columns = 6;     // table, classes, addresses, times, order, tiles
inline constexpr unsigned part_shift = 4;     // above the kind
inline constexpr unsigned set_bits_shift = 8; // above the addresses' shift

/// Above those: how references are coded, and whether a predicted block's order is known, and its tiles.
inline constexpr unsigned coding_shift = 16;
inline constexpr std::uint32_t is_predicted = 1, is_ordered = 2, has_tiles = 4;

inline std::size_t header_bytes(std::size_t columns) {
    return 16 + 8 + columns * 8;
}

inline std::size_t most_turns(std::size_t references) {
    return 2 * references + 2 * most_idle_windows;
}

/// Whether addresses of a class, and the bytes of a class's number, lie side by side: a tenth less of what
/// caches pass on. What cores ask for is read half as fast again without.
inline bool side_by_side(std::uint32_t version, unsigned set_bits) {
    return version >= 6 && set_bits != 0;
}

/// Bytes that numbers below `n` take.
inline std::uint32_t bytes_for(std::size_t n) {
    return n <= 1U << 8U ? 1 : n <= 1U << 16U ? 2 : 3;
}

/// Of each class, the first that differs in its part alone: their addresses follow each other.
template <class ClassOf> std::vector<std::uint32_t> without_parts(std::size_t classes, ClassOf class_of) {
    const auto key = [&](std::uint32_t number) {
        const Class& c = class_of(number);
        return std::tuple(c.site, c.size, c.structure, c.phase, c.work, c.kind, c.detail);
    };
    std::vector<std::uint32_t> sorted(classes), first(classes);
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple_cat(key(a), std::tuple(a)) < std::tuple_cat(key(b), std::tuple(b));
    });
    for (std::size_t i = 0; i < classes; ++i)
        first[sorted[i]] = i != 0 && key(sorted[i]) == key(sorted[i - 1]) ? first[sorted[i - 1]] : sorted[i];
    return first;
}

/// References one class after the other, those of a class in their order; `first_of`: what counts as a class
/// (without_parts()), `nowhere` for classes that are left out.
class ByClass {
public:
    static constexpr std::uint32_t nowhere = ~std::uint32_t{0};

    void sort(const std::vector<std::uint32_t>& classes, const std::vector<std::uint32_t>& first_of) {
        begins_.assign(first_of.size() + 1, 0);
        for (const std::uint32_t c : classes)
            if (first_of[c] != nowhere)
                ++begins_[first_of[c] + 1];
        std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
        next_.assign(begins_.begin(), begins_.end());
        all_.resize(begins_.back());
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (const std::uint32_t first = first_of[classes[i]]; first != nowhere)
                all_[next_[first]++] = static_cast<std::uint32_t>(i);
    }
    std::size_t classes() const { return begins_.size() - 1; }
    std::span<const std::uint32_t> of(std::size_t c) const {
        return {all_.data() + begins_[c], all_.data() + begins_[c + 1]};
    }

private:
    std::vector<std::uint32_t> begins_, next_, all_; // by class; numbers of references
};

/// Those that count as no lines that leave a cache; of all others without_parts().
template <class ClassOf>
std::vector<std::uint32_t> without_leaving(std::vector<std::uint32_t> first_of, ClassOf class_of) {
    for (std::uint32_t c = 0; c < first_of.size(); ++c)
        if (Evictions::leaves(class_of(c)))
            first_of[c] = ByClass::nowhere;
    return first_of;
}

/// Windows mostly follow each other, and are as long.
struct WindowGuess {
    std::uint64_t last, length = 0;
    void see(const Turn& t) {
        last = t.until;
        length = t.until - t.begin;
    }
};

} // namespace traces
