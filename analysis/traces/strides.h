// How far apart the references are that a thread makes one after the other to the same: at a site, to a
// structure.
#pragma once

#include "analysis/traces/touches.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace analysis {

/// Counts of many values in bounded memory: those that are more than one in `room` of all are there (Misra
/// and Gries, Science of Computer Programming 1982). Counts are at most error() too small.
class FrequentValues {
public:
    explicit FrequentValues(std::size_t room) : room_(room) {}
    void add(std::int64_t value) {
        if (const auto found = counts_.find(value); found != counts_.end())
            ++found->second;
        else if (counts_.size() < room_)
            counts_.emplace(value, 1);
        else
            cut();
    }
    struct Counted {
        std::int64_t value;
        std::uint64_t count;
    };
    /// The most frequent ones, of equals the smaller in size, at most so many.
    std::vector<Counted> most(std::size_t count) const;
    std::uint64_t error() const { return cuts_; }

private:
    void cut();

    std::size_t room_;
    std::unordered_map<std::int64_t, std::uint64_t> counts_;
    std::uint64_t cuts_ = 0;
};

class Strides {
public:
    /// What a reference is beside the one before it of its thread and group.
    enum Pattern : std::uint8_t {
        first,      // there is none before
        same,       // the same address
        sequential, // it begins where that ended
        strided,    // as far from it as that from the one before
        irregular,  // all else
        patterns
    };
    static constexpr std::array<const char*, patterns> pattern_names = {"first", "same", "sequential",
                                                                        "strided", "irregular"};
    /// Powers of two of bytes: bucket b of strides in [2^(b-1), 2^b), 0 of none; backwards and forwards.
    static constexpr std::size_t buckets = 65;

    /// Differences wrap around at 64 bits.
    void add(const Access& access);

    struct Group {
        std::array<std::uint64_t, patterns> counts{};
        std::array<std::uint64_t, buckets> forwards{}, backwards{};
        FrequentValues values{512};
        std::uint64_t references() const;
    };
    const std::vector<Group>& groups() const { return groups_; }

private:
    struct Last { // of a thread and group
        std::uint64_t address = 0, more = 0;
        std::int64_t stride = 0;
    };
    std::vector<Group> groups_;
    std::unordered_map<std::uint64_t, Last> last_;
};

} // namespace analysis
