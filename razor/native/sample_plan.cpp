#include "razor/native/sample_plan.h"

#include <algorithm>

namespace razor {

int next_step(int samples) {
    int whole = pilot_samples / 2;
    while (2 * whole <= samples)
        whole *= 2;
    if (samples < pilot_samples)
        return samples + pilot_samples / 2;
    return samples == whole ? whole + whole / 2 : 2 * whole;
}

TileNeighbours::TileNeighbours(std::span<const TilePlace> places) {
    for (std::size_t t = 0; t < places.size(); ++t)
        numbers_[{places[t].column, places[t].row}] = t;
}

double TileNeighbours::mean(const TilePlace& middle, std::span<const double> values) const {
    double sum = 0;
    int known = 0;
    for (int row = -1; row <= 1; ++row)
        for (int column = -1; column <= 1; ++column)
            if (const auto found = numbers_.find({middle.column + column, middle.row + row});
                found != numbers_.end()) {
                sum += values[found->second];
                ++known;
            }
    return known > 0 ? sum / known : 0;
}

void SamplePlan::tell_progress(double after, double in_all) {
    // It may turn out to be more than it seemed: what was shown is not taken back.
    done_before_ = done_after_;
    done_after_ = std::max(done_before_, after / std::max(in_all, 1.0));
}

} // namespace razor
