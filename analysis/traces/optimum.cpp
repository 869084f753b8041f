#include "analysis/traces/optimum.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>

namespace analysis {

void Optimum::touch(std::uint64_t line, std::uint32_t group) {
    if (touched_.size() >= std::numeric_limits<std::uint32_t>::max())
        throw std::length_error("Belady's optimum is for less than 2^32 references");
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    std::uint32_t& number = numbers_[line];
    if (number == LineMap::none)
        number = next;
    touched_.push_back({number, group});
}

std::vector<std::uint64_t> Optimum::misses(std::uint64_t lines, std::size_t groups,
                                           const std::function<void()>& look) const {
    constexpr std::size_t touches_a_look = std::size_t{1} << 16;
    constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();
    const std::size_t n = touched_.size();
    std::vector<std::uint32_t> next(n), last(numbers_.size(), never); // of each touch and line: its next one
    for (std::size_t i = n; i-- > 0;) {
        next[i] = last[touched_[i].line];
        last[touched_[i].line] = static_cast<std::uint32_t>(i);
    }
    // What is in the cache, that which is needed last on top. Entries of lines that were touched since lie
    // deeper than all that hold, and go when they are as many.
    struct Entry {
        std::uint32_t next, line;
        bool operator<(const Entry& e) const { return next < e.next; }
    };
    std::vector<Entry> heap;
    std::vector<std::uint32_t> due(numbers_.size(), 0); // of a line in the cache: its next touch
    std::vector<bool> in(numbers_.size(), false);
    std::vector<std::uint64_t> out(groups, 0);
    std::uint64_t held = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (i % touches_a_look == 0)
            look();
        const auto [line, group] = touched_[i];
        if (!in[line]) {
            ++out[group];
            if (held == lines) {
                while (!in[heap.front().line] || due[heap.front().line] != heap.front().next) {
                    std::pop_heap(heap.begin(), heap.end());
                    heap.pop_back();
                }
                in[heap.front().line] = false;
                std::pop_heap(heap.begin(), heap.end());
                heap.pop_back();
            } else {
                ++held;
            }
            in[line] = true;
        }
        due[line] = next[i];
        heap.push_back({next[i], line});
        std::push_heap(heap.begin(), heap.end());
        if (heap.size() > 2 * lines + 1024) {
            std::erase_if(heap, [&](const Entry& e) { return !in[e.line] || due[e.line] != e.next; });
            std::make_heap(heap.begin(), heap.end());
        }
    }
    return out;
}

} // namespace analysis
