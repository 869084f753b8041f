// Tags of a set-associative cache with least-recently-used replacement. Knows nothing of time or data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

class CacheArray {
public:
    static constexpr std::size_t none = ~std::size_t{0};
    static constexpr std::uint64_t no_line = ~std::uint64_t{0};

    /// `sets` is a power of two.
    CacheArray(std::size_t sets, std::size_t ways)
        : tags_(sets * ways, no_line), used_(sets * ways, 0), mask_(sets - 1), ways_(ways) {}

    std::size_t entries() const { return tags_.size(); }
    /// Where a line (number, not address) is, or none.
    std::size_t find(std::uint64_t line) const {
        std::size_t base = (line & mask_) * ways_;
        for (std::size_t i = base; i < base + ways_; ++i)
            if (tags_[i] == line)
                return i;
        return none;
    }
    void touch(std::size_t entry) { used_[entry] = ++now_; }
    /// The entry that a line would take: an empty one, or the least recently used of its set.
    std::size_t victim(std::uint64_t line) const {
        std::size_t base = (line & mask_) * ways_;
        std::size_t oldest = base;
        for (std::size_t i = base; i < base + ways_; ++i)
            if (used_[i] < used_[oldest])
                oldest = i;
        return oldest;
    }
    std::uint64_t line(std::size_t entry) const { return tags_[entry]; }
    void fill(std::size_t entry, std::uint64_t line) {
        tags_[entry] = line;
        touch(entry);
    }
    void drop(std::size_t entry) {
        tags_[entry] = no_line;
        used_[entry] = 0;
    }

private:
    std::vector<std::uint64_t> tags_, used_;
    std::uint64_t mask_, now_ = 0;
    std::size_t ways_;
};

} // namespace sim
