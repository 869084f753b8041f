// The directory: which caches may have a line, and which of them may write it. A full map: an entry for every
// line that anybody has, a bit in it for every cache (here a list, which is shorter). Caches drop clean lines
// without a word, so that it knows of more than there is, never of less. Knows nothing of time but when an
// owner has its line. Not modelled: a directory with room for some lines alone, and its recalls.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace sim {

class Directory {
public:
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};

    /// Caches by number: an owner, modified or exclusive, or sharers, or nobody.
    struct Line {
        std::uint32_t owner = nobody;
        cycle since = 0; // when the owner has it
        std::vector<std::uint32_t> sharers;

        bool shared_by(std::uint32_t cache) const {
            return std::find(sharers.begin(), sharers.end(), cache) != sharers.end();
        }
        bool has(std::uint32_t cache) const { return owner == cache || shared_by(cache); }
    };

    Line& line(std::uint64_t address) { return lines_[address]; }
    const Line* find(std::uint64_t address) const {
        const auto found = lines_.find(address);
        return found == lines_.end() ? nullptr : &found->second;
    }
    /// The cache has it no more.
    void remove(std::uint64_t address, std::uint32_t cache) {
        const auto found = lines_.find(address);
        if (found == lines_.end())
            return;
        Line& l = found->second;
        if (l.owner == cache)
            l.owner = nobody;
        std::erase(l.sharers, cache);
        if (l.owner == nobody && l.sharers.empty())
            lines_.erase(found);
    }

private:
    std::unordered_map<std::uint64_t, Line> lines_;
};

} // namespace sim
