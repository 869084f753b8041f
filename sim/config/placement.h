// Where workers run: which hardware thread each takes, and which of them share a kd-tree.
#pragma once

#include "sim/config/config.h"

#include <string>
#include <vector>

namespace sim {

/// A hardware thread: tile of the chip, core of the tile, thread of the core.
struct Place {
    integer tile = 0, core = 0, thread = 0;
    bool operator==(const Place&) const = default;
};

class Placement {
public:
    explicit Placement(const ChipConfig& chip);
    Placement(integer tiles, integer cores, integer threads, bool packed)
        : tiles_(tiles), cores_(cores), threads_(threads), packed_(packed) {}

    integer threads() const { return tiles_ * cores_ * threads_; }
    /// Spread: worker w+1 is on the next tile; tiles fill a core's first threads, core by core, then the
    /// second ones. Pack: worker w is on hardware thread w.
    Place of(integer worker) const;
    /// The chip's number of a hardware thread: (tile * cores + core) * threads + thread.
    integer number(const Place& p) const { return (p.tile * cores_ + p.core) * threads_ + p.thread; }

    /// The tree of each worker, numbered from 0 in the order of hardware threads, none without a worker.
    /// `share` is "chip" (all workers share one), "tile", "core", "worker" (nobody shares), or a number n:
    /// the workers in the order of their hardware threads, n by n. Throws std::invalid_argument for anything
    /// else.
    std::vector<int> trees(int workers, const std::string& share) const;
    /// The number of each worker's hardware thread: near ones share caches.
    std::vector<int> places(int workers) const;

private:
    integer tiles_, cores_, threads_;
    bool packed_;
};

} // namespace sim
