// What each screen tile of a frame cost the worker that rendered it.
#pragma once

#include "isa/services.h"
#include "razor/frame/counters.h"

#include <map>
#include <vector>

namespace razor {

struct TileCost {
    int column = 0, row = 0; // of the tile in the whole picture, counted in tiles
    CountersByKind counters; // also of what was begun again for want of memory
    double seconds = 0;      // the host's
};

/// One worker's tiles, told of by the laps that it is timed by. What is counted while a tile is rendered in
/// place of another's wait is that one's alone.
class TileLog final : public isa::lap_listener {
public:
    struct Cost {
        CountersByKind counters;
        double seconds = 0;
    };

    /// Reads the worker's counters as they grow; they must outlive the log.
    explicit TileLog(const CountersByKind& counters) : counters_(counters) {}
    void clear();
    void begun() override;
    void ended(std::int64_t tile, double seconds) override;
    /// By the tile's number.
    const std::map<std::int64_t, Cost>& costs() const { return costs_; }

private:
    /// What was counted since the last event is the innermost open tile's.
    void settle();

    const CountersByKind& counters_;
    CountersByKind last_;
    std::vector<CountersByKind> open_;
    std::map<std::int64_t, Cost> costs_;
};

} // namespace razor
