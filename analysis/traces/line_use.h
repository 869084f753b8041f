// What becomes of lines: how many of their bytes are used, who touches them, whether threads write beside
// each other.
#pragma once

#include "analysis/traces/line_map.h"
#include "analysis/traces/touches.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

class LineUse {
public:
    /// Lines of a power of two of bytes. Bytes are told apart by 64ths of a line, where lines are longer
    /// than 64.
    explicit LineUse(std::uint64_t line_bytes);

    void touch(const Touch& touch);

    /// Of lines by the group that touched them first.
    struct Group {
        std::uint64_t lines = 0, touches = 0;
        std::uint64_t bytes = 0;         // touched at least once
        std::uint64_t shared = 0;        // lines that several threads touch
        std::uint64_t copies = 0;        // threads of each line, summed: lines of private caches without end
        std::uint64_t written = 0;       // shared lines that at least one thread writes
        std::uint64_t falsely = 0;       // of these, those where none touches a byte that another one writes
        std::uint64_t false_touches = 0; // of lines that are falsely shared
    };
    std::vector<Group> groups() const;
    /// Of lines that so many threads touch, by the group that touched them first.
    struct Shared {
        std::uint32_t group = 0;
        std::uint64_t threads = 0, lines = 0, touches = 0;
        std::uint64_t written = 0; // lines that at least one thread writes
    };
    /// Ascending by group and number of threads; those that there are.
    std::vector<Shared> shared() const;
    /// What a thread touches.
    struct Footprint {
        std::uint32_t stream = 0;
        std::uint64_t lines = 0, alone = 0; // nobody else touches these
        std::uint64_t bytes = 0;            // touched at least once
        std::uint64_t written = 0;          // lines that it writes
    };
    /// Ascending by stream.
    std::vector<Footprint> footprints() const;
    struct Line {
        std::uint64_t line, touches;
        std::uint32_t group;
        std::uint64_t threads;
    };
    /// Those touched most, at most so many.
    std::vector<Line> hottest(std::size_t count) const;

private:
    struct User { // of a line: a thread; 64 bits, one a part of the line
        std::uint32_t stream = 0, next = LineMap::none;
        std::uint64_t touched = 0, written = 0;
    };
    struct Known {
        std::uint64_t line = 0, touches = 0;
        std::uint32_t group = 0, users = LineMap::none; // the first of its users
    };
    std::uint64_t parts(const Touch& touch) const;

    unsigned part_shift_; // of bytes of a line, to its part
    LineMap numbers_;
    std::vector<Known> known_;
    std::vector<User> users_;
    std::size_t groups_ = 0;
};

} // namespace analysis
