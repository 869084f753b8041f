// A run as a series in time: what the chip did in each interval of so many cycles. Intervals are whole
// windows long. Threads' cycles count in the interval that they lie in, to the cycle. All else counts in the
// window in which it is simulated: operations when they enter the issue window, accesses when they begin,
// memory's requests when they reach it; looks at a word, which are known when the waiting ends, when they
// were made.
#pragma once

#include "sim/machine/report.h"

#include <cstdint>
#include <vector>

namespace sim {

/// What a tile's threads add to intervals, by number.
struct TileIntervals {
    std::vector<Stack> stacks;
    std::vector<std::int64_t> looks; // instructions of looks, moved here from a later interval
};

class Intervals {
public:
    /// `length` in cycles, rounded up to whole windows; 0: none are kept.
    Intervals(std::uint64_t length, std::uint64_t window);

    /// The first one begins at cycle `t`, the end of a window, when this has been counted.
    void begin(cycle t, const Interval& sums);
    bool wanted() const { return length_ != 0; }
    std::uint64_t length() const { return length_; }
    /// The interval that counters count for.
    std::size_t open() const { return rows_.size(); }
    /// The cycle at which the first one begins; rows count from here.
    cycle origin() const { return origin_; }
    /// Whether intervals end between the last time and cycle `t`.
    bool due(cycle t) const { return t >= next_; }
    /// They end: `sums` is what has been counted since the run began.
    void close(cycle t, const Interval& sums);
    /// The run ends `cycles` after the origin, and memory is quiet at `drained`, with these sums then and
    /// there.
    std::vector<Interval> finish(cycle cycles, const Interval& sums, cycle drained, const Interval& all,
                                 const std::vector<const TileIntervals*>& tiles);

private:
    void add(cycle end, const Interval& sums);

    std::uint64_t length_;
    cycle next_ = ~cycle{0}, origin_ = 0;
    Interval counted_; // in the rows so far
    std::vector<Interval> rows_;
};

/// As CSV, a line of names first.
std::string print_intervals(const Report& report);

} // namespace sim
