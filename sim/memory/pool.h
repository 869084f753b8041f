// A few equal entries, each held for a time: MSHRs, write-back buffers.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <vector>

namespace sim {

class Pool {
public:
    explicit Pool(std::size_t entries) : free_at_(entries, 0) {}

    struct Grant {
        cycle at;
        std::size_t entry;
    };
    /// An entry at `t`, or when the first is released. The caller must then hold() it.
    Grant take(cycle t) {
        std::size_t first = 0;
        for (std::size_t i = 0; i < free_at_.size(); ++i) {
            if (free_at_[i] <= t)
                return {t, i};
            if (free_at_[i] < free_at_[first])
                first = i;
        }
        return {free_at_[first], first};
    }
    void hold(std::size_t entry, cycle until) { free_at_[entry] = until; }
    bool full(cycle t) const {
        return std::all_of(free_at_.begin(), free_at_.end(), [t](cycle free) { return free > t; });
    }

private:
    std::vector<cycle> free_at_;
};

} // namespace sim
