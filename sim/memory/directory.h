// The directory: which caches may have a line, and which of them may write it: an entry for every line, a bit
// in it for every cache (here a list, which is shorter). Caches drop clean lines without a word, so that it
// knows of more than there is, never of less. With room for all that anybody has (a full map), or for so many
// entries a set: then the one that was asked for least recently has to leave for another's, by who can
// recall it from the caches that have it. Knows nothing of time but when an owner has its line.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

namespace sim {

class Directory {
public:
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};

    /// Caches by number: an owner, modified or exclusive, or sharers, or nobody.
    struct Line {
        std::uint32_t owner = nobody;
        cycle since = 0;     // when the owner has it ...
        bool coming = false; // ... which is not known yet
        std::vector<std::uint32_t> sharers;

        bool shared_by(std::uint32_t cache) const {
            return std::find(sharers.begin(), sharers.end(), cache) != sharers.end();
        }
        bool has(std::uint32_t cache) const { return owner == cache || shared_by(cache); }
    };

    /// The set of a line, by its number, among those of its home: spread, as a home's lines may be any.
    static std::uint64_t set_of(std::uint64_t line, std::uint64_t sets) {
        return (line * 0x9E3779B97F4A7C15U >> 32) % sets;
    }

    /// `ways` entries a set, of which set_of(address) is a line's number; 0: a full map.
    Directory(std::size_t ways, std::function<std::uint64_t(std::uint64_t)> set_of)
        : ways_(ways), set_of_(std::move(set_of)) {}

    /// The entry of a line that is asked for, new if there is none.
    Line& line(std::uint64_t address) {
        if (ways_ != 0) {
            std::vector<std::uint64_t>& set = sets_[set_of_(address)];
            std::erase(set, address);
            set.push_back(address);
        }
        return lines_[address];
    }
    const Line* find(std::uint64_t address) const {
        const auto found = lines_.find(address);
        return found == lines_.end() ? nullptr : &found->second;
    }
    Line* find(std::uint64_t address) {
        const auto found = lines_.find(address);
        return found == lines_.end() ? nullptr : &found->second;
    }
    /// Whether a line has no entry and its set has no room.
    bool is_crowded_for(std::uint64_t address) const {
        if (ways_ == 0 || find(address) != nullptr)
            return false;
        const auto set = sets_.find(set_of_(address));
        return set != sets_.end() && set->second.size() >= ways_;
    }
    /// The line that leaves that set first, of those that may.
    template <class May> std::optional<std::uint64_t> leaving(std::uint64_t address, May may) const {
        const std::vector<std::uint64_t>& set = sets_.at(set_of_(address));
        const auto found = std::find_if(set.begin(), set.end(), may);
        return found == set.end() ? std::nullopt : std::optional(*found);
    }
    void forget(std::uint64_t address) {
        lines_.erase(address);
        if (ways_ != 0)
            std::erase(sets_.at(set_of_(address)), address);
    }
    /// The cache has it no more.
    void remove(std::uint64_t address, std::uint32_t cache) {
        Line* l = find(address);
        if (l == nullptr)
            return;
        if (l->owner == cache)
            l->owner = nobody;
        std::erase(l->sharers, cache);
        if (l->owner == nobody && l->sharers.empty())
            forget(address);
    }

private:
    std::size_t ways_;
    std::function<std::uint64_t(std::uint64_t)> set_of_;
    std::unordered_map<std::uint64_t, Line> lines_;
    std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> sets_; // least recently asked for first
};

} // namespace sim
