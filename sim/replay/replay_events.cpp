// The reference mode, in which caches within tiles act in order of time.
#include "sim/replay/replay_machine.h"

namespace sim {

bool ReplayMachine::let_one_event_happen(std::uint32_t stream) {
    Tile& tile = *seats_[stream].tile;
    if (tile.events->next >= window_end_)
        return false;
    tile.events->step();
    return true;
}

/// All events of a tile before this cycle.
void ReplayMachine::finish_events(Tile& tile, cycle end) {
    while (tile.events->next < end)
        tile.events->step();
}

/// The window at hand ends, and so do those that follow in which no thread did anything, as far as cycle
/// `served`.
void ReplayMachine::finish_windows(cycle served) {
    while (window_end_ <= served) {
        bool busy = false;
        cycle next = beyond_->next();
        for (Tile& tile : tiles_) {
            finish_events(tile, window_end_);
            tile.events->come_to(window_end_);
            busy = busy || tile.events->busy() || !tile.leaving.requests.empty();
        }
        if (served == Beyond::everything && !busy)
            return;
        serve(window_end_);
        set_floors(window_end_);
        next = beyond_->next();
        for (Tile& tile : tiles_) {
            tile.events->try_again();
            next = std::min(next, tile.events->next);
        }
        if (next == ~cycle{0})
            return;
        const cycle end =
            std::max(window_end_ + window_cycles_, (next / window_cycles_ + 1) * window_cycles_);
        if (end > served)
            return;
        window_end_ = end;
        for (Tile& tile : tiles_)
            tile.earliest = end - window_cycles_ > reach_ ? end - window_cycles_ - reach_ : 0;
    }
}

} // namespace sim
