// How far a tile had gone on by itself when a thread of it made a reference, in the reference mode: a trace
// of what cores ask for says so in traces::Class::detail, so that a replay on the same machine lets as much
// happen before it.
#pragma once

#include "sim/core/stalls.h"

#include <cstdint>

namespace sim {

class TileProgress {
public:
    /// `events` happened since the tile's reference before, or since the window began; nothing that has
    /// happened is later than `now` (TileEvents). Of a reference at cycle `at`. 0, not told: it is too far.
    static std::uint32_t of(std::uint32_t events, cycle now, cycle at) {
        const cycle beyond = now < at ? 0 : now - at + 1;
        return events >= most_events || beyond > most_beyond
                   ? 0
                   : (events + 1) | static_cast<std::uint32_t>(beyond) << events_bits;
    }

    TileProgress(std::uint32_t detail, cycle at)
        : told_(detail != 0), events_((detail & most_events) - 1),
          now_((detail >> events_bits) == 0 ? 0 : at + (detail >> events_bits) - 1) {}
    bool told() const { return told_; }
    std::uint32_t events() const { return events_; }
    /// 0: no later than the reference.
    cycle now() const { return now_; }

private:
    static constexpr std::uint32_t events_bits = 12, most_events = (1U << events_bits) - 1;
    static constexpr cycle most_beyond = (cycle{1} << (32 - events_bits)) - 1;
    bool told_;
    std::uint32_t events_;
    cycle now_;
};

} // namespace sim
