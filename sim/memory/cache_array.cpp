#include "sim/memory/cache_array.h"

#include "sim/config/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

constexpr std::uint32_t distant = 3; // srrip: the farthest next use

std::size_t state_bytes(Replacement replacement, std::size_t ways) {
    switch (replacement) {
    case Replacement::lru:
        return ways;
    case Replacement::plru:
        return 16;
    case Replacement::srrip:
        return 8 + ways;
    case Replacement::random:
        break;
    }
    return 8;
}

} // namespace

Replacement replacement_of(std::string_view name) {
    return name == "plru"     ? Replacement::plru
           : name == "srrip"  ? Replacement::srrip
           : name == "random" ? Replacement::random
                              : Replacement::lru;
}

void CacheArray::too_far(std::uint64_t line) const {
    throw ConfigError(fmt::format(
        "a cache of {} set{} has no tag for line {}: frames have that many addresses; give it more sets (its "
        "size_bytes, ways) or longer lines (line_bytes)",
        mask_ + 1, mask_ == 0 ? "" : "s", line));
}

/// srrip has a tag more, which is never anybody's: where the first byte points after a fill, for a line that
/// was filled is not one that was used.
CacheArray::CacheArray(std::size_t sets, std::size_t ways, Replacement replacement, bool coherent)
    : mask_(sets - 1), ways_(static_cast<std::uint32_t>(ways)), replacement_(replacement),
      order_at_((ways + (replacement == Replacement::srrip ? 1 : 0) + 3) / 4 * 16),
      flags_at_((order_at_ + state_bytes(replacement, ways) + 7) / 8 * 8),
      stride_((flags_at_ + (coherent ? 32 : 24) + 15) / 16 * 16), bytes_(sets * stride_ + 64) {
    while ((std::size_t{1} << set_bits_) < sets)
        ++set_bits_;
    std::size_t misaligned = reinterpret_cast<std::uintptr_t>(bytes_.data()) % 64;
    base_ = bytes_.data() + (misaligned == 0 ? 0 : 64 - misaligned);
    for (std::size_t s = 0; s <= mask_; ++s) {
        std::byte* set = base_ + s * stride_;
        std::memset(set, 0xFF, order_at_);
        if (replacement == Replacement::lru)
            for (std::size_t w = 0; w < ways; ++w)
                set[order_at_ + w] = static_cast<std::byte>(ways - 1 - w); // way 0 is taken first
        else if (replacement == Replacement::srrip)
            set[order_at_] = static_cast<std::byte>(ways);
    }
}

/// A way other than the one used last was used.
void CacheArray::touch_other(std::byte* order, std::uint32_t way) {
    order[0] = static_cast<std::byte>(way);
    if (replacement_ == Replacement::srrip) {
        order[state_at + way] = std::byte{0};
    } else if (replacement_ == Replacement::plru) {
        std::uint64_t tree;
        std::memcpy(&tree, order + state_at, 8);
        for (std::uint32_t node = ways_ + way; node > 1; node /= 2) { // children of n: 2n and 2n + 1
            std::uint64_t bit = std::uint64_t{1} << (node / 2);
            tree = node % 2 == 0 ? tree | bit : tree & ~bit; // away from the way: set is the second half
        }
        std::memcpy(order + state_at, &tree, 8);
    }
}

CacheArray::Entry CacheArray::other_victim(std::uint64_t line) const {
    const std::byte* set = set_of(line);
    const std::byte* order = set + order_at_;
    for (std::uint32_t w = 0; w < ways_; ++w)
        if (tag_at(set, w) == empty)
            return entry(line, w);
    if (replacement_ == Replacement::srrip) {
        const std::byte* first = order + state_at;
        return entry(line, static_cast<std::uint32_t>(std::max_element(first, first + ways_) - first));
    }
    if (replacement_ == Replacement::random)
        return entry(line, static_cast<std::uint32_t>((random_ >> 32U) * ways_ >> 32U));
    std::uint64_t tree;
    std::memcpy(&tree, order + state_at, 8);
    std::uint32_t node = 1;
    while (node < ways_)
        node = 2 * node + static_cast<std::uint32_t>(tree >> node & 1U);
    return entry(line, node - ways_);
}

/// Before a line takes the entry that other_victim() chose.
void CacheArray::note_fill(Entry e) {
    std::byte* set = base_ + (e >> 6U) * stride_;
    std::byte* order = set + order_at_;
    std::uint32_t way = e & 63U;
    bool evicts = tag_at(set, way) != empty;
    if (replacement_ == Replacement::srrip) {
        std::byte* next_use = order + state_at;
        auto wait = evicts ? distant - static_cast<std::uint32_t>(next_use[way]) : 0;
        for (std::uint32_t w = 0; w < ways_ && wait != 0; ++w)
            next_use[w] = static_cast<std::byte>(static_cast<std::uint32_t>(next_use[w]) + wait);
        next_use[way] = static_cast<std::byte>(distant - 1);
        order[0] = static_cast<std::byte>(ways_);
        return;
    }
    if (replacement_ == Replacement::random && evicts) { // xorshift (Marsaglia 2003)
        random_ ^= random_ << 13U;
        random_ ^= random_ >> 7U;
        random_ ^= random_ << 17U;
    }
    touch_other(order, way);
}

} // namespace sim
