// How many caches have the same lines at once, in the mean over a trace.
#pragma once

#include "analysis/traces/coherent_caches.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

/// Of caches of one shape; means are over touches, of all caches together.
class Replication {
public:
    explicit Replication(CacheShape shape) : caches_(shape, {}) {}

    void touch(const Touch& touch, std::uint32_t cache) {
        caches_.touch(touch, cache);
        ++caches_.observer().now;
    }
    /// Of lines, by the group that touched them first.
    struct Group {
        double copies = 0; // in any cache, in the mean
        double lines = 0;  // different ones of these
    };
    std::vector<Group> groups() const {
        const Watch& watch = caches_.observer();
        std::vector<Group> out;
        for (const Held& h : watch.held) {
            const auto mean = [&](std::uint64_t sum, std::uint64_t held) {
                const std::uint64_t all = sum + held * (watch.now - h.since);
                return watch.now == 0 ? 0 : static_cast<double>(all) / static_cast<double>(watch.now);
            };
            out.push_back({mean(h.copy_sum, h.copies), mean(h.line_sum, h.lines)});
        }
        return out;
    }
    std::uint64_t caches() const { return caches_.caches(); }

private:
    struct Held {                                       // of a group
        std::uint64_t copies = 0, lines = 0, since = 0; // for so long
        std::uint64_t copy_sum = 0, line_sum = 0;       // of all touches before
    };
    struct Watch {
        std::uint64_t now = 0; // touches
        std::vector<Held> held;
        Held& of(const HeldLine& line) {
            if (line.group >= held.size())
                held.resize(std::size_t{line.group} + 1);
            Held& h = held[line.group];
            h.copy_sum += h.copies * (now - h.since);
            h.line_sum += h.lines * (now - h.since);
            h.since = now;
            return h;
        }
        void filled(const HeldLine& line, const Copy&, const Touch&) {
            Held& h = of(line);
            ++h.copies;
            h.lines += line.caches == 1 ? 1 : 0;
        }
        void used(const Copy&, std::uint64_t) {}
        void left(const HeldLine& line, const Copy&) {
            Held& h = of(line);
            --h.copies;
            h.lines -= line.caches == 0 ? 1 : 0;
        }
    };
    CoherentCaches<Watch> caches_;
};

} // namespace analysis
