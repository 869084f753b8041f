// How much of a line is used from when it comes into a cache until it goes.
#pragma once

#include "analysis/traces/coherent_caches.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

/// Of caches of one shape. Bytes are told apart by 64ths of a line, where lines are longer than 64.
class LineResidency {
public:
    explicit LineResidency(CacheShape shape) : caches_(shape, Watch{shape, {}}) {}

    void touch(const Touch& touch, std::uint32_t cache) { caches_.touch(touch, cache); }
    /// After the last touch: lines still there go.
    void finish() { caches_.finish(); }

    /// Of stays of lines, by the group of the touch that brought them.
    struct Group {
        std::uint64_t stays = 0;
        std::uint64_t touches = 0;            // of any group
        std::uint64_t bytes = 0;              // touched at least once in a stay
        std::uint64_t once = 0;               // stays of one touch
        std::uint64_t dropped = 0;            // ended by a write elsewhere
        std::array<std::uint64_t, 4> parts{}; // stays in which up to a quarter was used, a half, ...
    };
    const std::vector<Group>& groups() const { return caches_.observer().groups; }

private:
    struct Watch {
        CacheShape shape;
        std::vector<Group> groups;
        void filled(const HeldLine&, const Copy& copy, const Touch&) {
            if (copy.group >= groups.size())
                groups.resize(std::size_t{copy.group} + 1);
        }
        void used(const Copy&, std::uint64_t) {}
        void left(const HeldLine&, const Copy& copy) {
            const std::uint64_t all = std::min<std::uint64_t>(shape.line_bytes, 64);
            const auto used = static_cast<std::uint64_t>(std::popcount(copy.used));
            Group& g = groups[copy.group];
            ++g.stays;
            g.touches += copy.touches;
            g.bytes += used * (shape.line_bytes / all);
            g.once += copy.touches == 1 ? 1 : 0;
            g.dropped += copy.dropped ? 1 : 0;
            ++g.parts[static_cast<std::size_t>((4 * used + all - 1) / all - 1)];
        }
    };
    CoherentCaches<Watch> caches_;
};

} // namespace analysis
