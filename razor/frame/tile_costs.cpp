#include "razor/frame/tile_costs.h"

namespace razor {

void TileLog::clear() {
    last_ = {};
    open_.clear();
    costs_.clear();
}

void TileLog::settle() {
    if (!open_.empty()) {
        CountersByKind counted = counters_;
        counted -= last_;
        open_.back() += counted;
    }
    last_ = counters_;
}

void TileLog::begun() {
    settle();
    open_.emplace_back();
}

void TileLog::ended(std::int64_t tile, double seconds) {
    settle();
    Cost& cost = costs_[tile];
    cost.counters += open_.back();
    cost.seconds += seconds;
    open_.pop_back();
}

} // namespace razor
