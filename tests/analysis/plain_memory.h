// Caches that keep each other coherent, and what is said of them, as plainly as it can be written: for tests.
#pragma once

#include "analysis/traces/touches.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace analysis::test {

/// Touches of some threads, some of them of lines that are written by several.
inline std::vector<Touch> random_touches(std::size_t count, std::uint64_t lines, std::uint32_t threads,
                                         std::uint64_t line_bytes, std::uint32_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Touch> out;
    for (std::size_t i = 0; i < count; ++i) {
        Touch t{};
        t.stream = static_cast<std::uint32_t>(random() % threads);
        t.line = random() % lines;
        if (random() % 3 != 0) // of its own, mostly
            t.line = t.line / threads * threads + t.stream;
        t.low = random() % line_bytes;
        t.high = std::min(line_bytes - 1, t.low + random() % 8);
        t.writes = random() % 4 == 0;
        t.group = static_cast<std::uint32_t>(random() % 3);
        t.time = i;
        out.push_back(t);
    }
    return out;
}

/// What happens to a line in a cache.
struct Stay {
    std::uint64_t line, begin, end; // numbers of touches; the one that ends it is after it
    std::uint32_t cache;
    bool dropped; // ended by a write elsewhere
};

/// All stays of lines in caches of so many sets and ways, in order of their begins; those at the end of all
/// end at the number of touches.
inline std::vector<Stay> plain_stays(const std::vector<Touch>& touches, std::uint64_t sets,
                                     std::uint64_t ways, std::uint32_t threads_of_cache) {
    std::vector<Stay> out;
    std::map<std::pair<std::uint32_t, std::uint64_t>, std::vector<std::size_t>>
        cache_sets; // stays, oldest first
    for (std::size_t i = 0; i < touches.size(); ++i) {
        const Touch& t = touches[i];
        const std::uint32_t cache = t.stream / threads_of_cache;
        std::vector<std::size_t>& set = cache_sets[{cache, t.line % sets}];
        const auto found =
            std::find_if(set.begin(), set.end(), [&](std::size_t s) { return out[s].line == t.line; });
        if (found != set.end()) {
            std::rotate(found, found + 1, set.end());
        } else {
            if (set.size() == ways) {
                out[set.front()].end = i;
                set.erase(set.begin());
            }
            set.push_back(out.size());
            out.push_back({t.line, i, touches.size(), cache, false});
        }
        if (!t.writes)
            continue;
        for (auto& [key, other] : cache_sets)
            if (key.first != cache && key.second == t.line % sets)
                std::erase_if(other, [&](std::size_t s) {
                    if (out[s].line != t.line)
                        return false;
                    out[s].end = i;
                    out[s].dropped = true;
                    return true;
                });
    }
    return out;
}

} // namespace analysis::test
