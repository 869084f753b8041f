// Which references bring lines to the cache that passes them on, and which say that one leaves.
#pragma once

#include "traces/evictions.h"

#include <bit>

namespace traces {

/// By the classes of a block's table, which must outlive this.
class LineMoves {
public:
    /// `predicted`: of a predicted block. Memory is told of reads and writes alone: where no class is of a
    /// line that leaves, writes there are such lines.
    LineMoves(const std::vector<Class>& table, bool predicted)
        : table_(&table),
          writes_leave_(predicted && std::none_of(table.begin(), table.end(), Evictions::leaves)) {}

    bool leaves(std::uint32_t c) const {
        const Class& what = (*table_)[c];
        return writes_leave_ ? what.kind == Kind::write : Evictions::leaves(what);
    }
    bool comes(std::uint32_t c) const { return Evictions::comes((*table_)[c]) && !leaves(c); }

    /// How many low bits of a line that leaves and of the one that comes next are mostly the same; 0: hardly
    /// any line makes room for another, which is then coded like all else.
    unsigned set_bits(const Block& block, unsigned shift) const {
        std::array<std::size_t, Evictions::most_set_bits + 1> pairs{}; // by how many bits are
        std::size_t all = 0, leaving = 0;
        for (const Segment& s : block.segments)
            for (std::size_t i = s.begin; i < s.end; ++i) {
                if (!leaves(block.classes[i]))
                    continue;
                ++leaving;
                if (i + 1 == s.end || !comes(block.classes[i + 1]))
                    continue;
                const std::uint64_t differ = (block.addresses[i] ^ block.addresses[i + 1]) >> shift;
                ++pairs[std::min<std::size_t>(Evictions::most_set_bits,
                                              static_cast<std::size_t>(std::countr_zero(differ)))];
                ++all;
            }
        if (leaving < 64 || all * 2 < leaving)
            return 0;
        unsigned bits = Evictions::most_set_bits;
        for (std::size_t as_many = pairs[bits]; bits > 0 && as_many * 10 < all * 9;)
            as_many += pairs[--bits];
        return bits;
    }

private:
    const std::vector<Class>* table_;
    bool writes_leave_;
};

} // namespace traces
