// A trace over time: of each window, how much it touches, how much of that is new, and what LRU caches miss.
#pragma once

#include "analysis/traces/line_map.h"
#include "analysis/traces/stack_distance.h"
#include "analysis/traces/touches.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace analysis {

class Windows {
public:
    /// Windows of `length` units of the trace's time, from 0 on; `sizes`: caches' lines, ascending.
    Windows(std::uint64_t length, std::vector<std::uint64_t> sizes)
        : length_(length), sizes_(std::move(sizes)) {}

    struct Window {
        std::uint64_t touches = 0, writes = 0;
        std::uint64_t lines = 0;           // different ones
        std::uint64_t first = 0;           // never touched before
        std::vector<std::uint64_t> misses; // by size
    };
    void touch(const Touch& touch) {
        const std::uint64_t number = touch.time / length_;
        Window& w = windows_[number];
        w.misses.resize(sizes_.size(), 0);
        ++w.touches;
        w.writes += touch.writes ? 1 : 0;
        const std::uint64_t distance = stack_.touch(touch.line);
        w.first += distance == StackDistance::first ? 1 : 0;
        for (std::size_t size = 0; size < sizes_.size() && distance > sizes_[size]; ++size)
            ++w.misses[size];
        // A line that threads of a later window touched in between counts for both again.
        const auto mark = static_cast<std::uint32_t>(number % LineMap::none);
        std::uint32_t& last = last_window_[touch.line];
        w.lines += last != mark ? 1 : 0;
        last = mark;
    }
    /// By number: window n begins at n * length().
    const std::map<std::uint64_t, Window>& windows() const { return windows_; }
    std::uint64_t length() const { return length_; }

private:
    std::uint64_t length_;
    std::vector<std::uint64_t> sizes_;
    StackDistance stack_;
    LineMap last_window_;
    std::map<std::uint64_t, Window> windows_;
};

} // namespace analysis
