// LRU stack distances where most touches are of the last few lines, as those of samples are.
#pragma once

#include "analysis/traces/stack_distance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace analysis {

/// As StackDistance, but the top of the stack is a list, where a line moves to the front. Only lines that
/// fell out of it are marked.
class RecentStack : private StackDistance {
public:
    static constexpr std::size_t most = 8; // lines of the list
    using StackDistance::first;
    using StackDistance::lines;
    using StackDistance::StackDistance;

    std::uint64_t touch(std::uint64_t line) {
        for (std::size_t i = 0; i < count_; ++i)
            if (top_[i] == line) {
                to_front(line, i);
                return i + 1;
            }
        return touch_below(line);
    }
    void forget(std::uint64_t line) {
        const auto end = top_.begin() + static_cast<std::ptrdiff_t>(count_);
        const auto found = std::find(top_.begin(), end, line);
        if (found == end) {
            StackDistance::forget(line);
            return;
        }
        std::copy(found + 1, end, found);
        --count_;
        forget_unmarked(line);
    }

private:
    /// From that place, or over what is there.
    void to_front(std::uint64_t line, std::size_t place) {
        for (; place != 0; --place)
            top_[place] = top_[place - 1];
        top_[0] = line;
    }
    std::uint64_t touch_below(std::uint64_t line) {
        const std::uint64_t distance = take(line);
        if (count_ == most)
            put(top_[most - 1]);
        else
            ++count_;
        to_front(line, count_ - 1);
        return distance;
    }

    std::array<std::uint64_t, most> top_{}; // the last touched first
    std::size_t count_ = 0;
};

} // namespace analysis
