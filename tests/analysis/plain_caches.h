// Caches as plainly as they can be written, for tests: slow, and obviously right.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace analysis::test {

/// Lines in the order of touches; `skew`: some far more often than others.
inline std::vector<std::uint64_t> random_lines(std::size_t count, std::uint64_t lines, std::uint32_t seed,
                                               bool skew) {
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t line = random() % lines;
        if (skew)
            line = line * (random() % lines) / lines * (random() % lines) / lines;
        if (random() % 11 == 0 && i > 8) // runs
            line = out[i - 1 - random() % 8] + 1;
        out.push_back(line);
    }
    return out;
}

/// The place of each touch in the LRU stack, from 1 on; 0: first touch.
inline std::vector<std::uint64_t> plain_distances(const std::vector<std::uint64_t>& touches) {
    std::vector<std::uint64_t> stack, out;
    for (const std::uint64_t line : touches) {
        const auto found = std::find(stack.rbegin(), stack.rend(), line);
        out.push_back(found == stack.rend() ? 0 : static_cast<std::uint64_t>(found - stack.rbegin()) + 1);
        if (found != stack.rend())
            stack.erase(std::next(found).base());
        stack.push_back(line);
    }
    return out;
}

/// Misses of a set-associative cache; `recent`: hits make a line young again (LRU), else they do not (FIFO).
inline std::uint64_t plain_misses(const std::vector<std::uint64_t>& touches, std::uint64_t sets,
                                  std::uint64_t ways, bool recent) {
    std::vector<std::vector<std::uint64_t>> cache(sets);
    std::uint64_t misses = 0;
    for (const std::uint64_t line : touches) {
        std::vector<std::uint64_t>& set = cache[line % sets];
        const auto found = std::find(set.begin(), set.end(), line);
        const bool hit = found != set.end();
        misses += hit ? 0 : 1;
        if (hit && !recent)
            continue;
        if (hit)
            set.erase(found);
        else if (set.size() == ways)
            set.erase(set.begin());
        set.push_back(line);
    }
    return misses;
}

/// The least misses of a cache of so many lines, by trying every choice: of few touches only.
inline std::uint64_t least_misses(const std::vector<std::uint64_t>& touches, std::size_t lines) {
    std::map<std::vector<std::uint64_t>, std::uint64_t> states = {{{}, 0}}; // contents, sorted, by misses
    for (const std::uint64_t line : touches) {
        std::map<std::vector<std::uint64_t>, std::uint64_t> next;
        const auto reach = [&](std::vector<std::uint64_t> contents, std::uint64_t misses) {
            std::sort(contents.begin(), contents.end());
            const auto [at, fresh] = next.try_emplace(contents, misses);
            at->second = std::min(at->second, misses);
        };
        for (const auto& [contents, misses] : states) {
            if (std::find(contents.begin(), contents.end(), line) != contents.end()) {
                reach(contents, misses);
                continue;
            }
            if (contents.size() < lines) {
                std::vector<std::uint64_t> more = contents;
                more.push_back(line);
                reach(more, misses + 1);
                continue;
            }
            for (std::size_t out = 0; out < contents.size(); ++out) {
                std::vector<std::uint64_t> other = contents;
                other[out] = line;
                reach(other, misses + 1);
            }
        }
        states = std::move(next);
    }
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [contents, misses] : states)
        least = std::min(least, misses);
    return least;
}

} // namespace analysis::test
