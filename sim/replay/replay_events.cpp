// The reference mode, in which caches within tiles act in order of time.
#include "sim/replay/replay_machine.h"

#include <algorithm>

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

/// A tile comes to the end of the window at hand.
void ReplayMachine::finish_tile(Tile& tile) {
    finish_events(tile, window_end_);
    tile.events->come_to(window_end_);
}

/// The earliest cycle at which something happens by itself; ~0: never.
cycle ReplayMachine::next_event() const {
    cycle next = beyond_->next();
    for (const Tile& tile : tiles_)
        next = std::min(next, tile.events->next);
    return next;
}

/// Of the next window, which begins no later than with that.
cycle ReplayMachine::end_of_window_with(cycle next) const {
    return std::max(window_end_ + window_cycles_, (next / window_cycles_ + 1) * window_cycles_);
}

void ReplayMachine::let_events_happen(std::uint32_t stream, const TileProgress& progress) {
    // What is done when a window has ended all over the chip, to words that tiles share, others see as well.
    if (progress.now() >= window_end_) {
        for (Tile& tile : tiles_)
            finish_tile(tile);
        return;
    }
    TileEvents& events = *seats_[stream].tile->events;
    for (std::uint32_t n = 0; n < progress.events() && events.next < window_end_; ++n)
        events.step();
    events.come_to(progress.now());
}

/// All tiles come to the end of the window at hand, and what left them is answered, as far as it can be.
void ReplayMachine::finish_window() {
    for (Tile& tile : tiles_)
        finish_tile(tile);
    serve(window_end_);
    set_floors(window_end_);
    for (Tile& tile : tiles_)
        tile.events->try_again();
}

/// The window at hand ends, and so do those that follow in which no thread did anything, as far as cycle
/// `served`.
void ReplayMachine::finish_windows(cycle served) {
    while (window_end_ <= served) {
        finish_window();
        const cycle next = next_event();
        const cycle end = end_of_window_with(next);
        if (next == ~cycle{0} || end > served)
            return;
        window_end_ = end;
        for (Tile& tile : tiles_)
            tile.earliest = end - window_cycles_ > reach_ ? end - window_cycles_ - reach_ : 0;
    }
}

/// No thread does anything any more: windows go on until nothing is on its way within the tiles.
void ReplayMachine::settle_tiles() {
    const auto busy = [this] {
        return std::any_of(tiles_.begin(), tiles_.end(), [](const Tile& t) { return t.events->busy(); });
    };
    while (busy()) {
        const cycle next = next_event();
        if (next == ~cycle{0})
            return; // on another machine: what waits does so for something that never comes
        window_end_ = end_of_window_with(next);
        set_floors(next);
        finish_window();
    }
}

} // namespace sim
