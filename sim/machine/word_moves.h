// The lines of words that several tiles write: which tile has one, and when it gets there. A tile that asks
// has it `move` cycles after it can see what the one before it wrote, and keeps it for all of its own who ask
// before the next tile's request takes it away. So tiles that fight for a word pay for its way once a turn,
// however many threads they have; in a machine this is their L2's doing, which merges requests for a line.
#pragma once

#include "sim/core/calendar.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace sim {

class WordMoves {
public:
    struct Write {
        std::uint64_t word;
        std::uint32_t tile;
        cycle asked;   // for the line
        cycle at;      // could act, if that were here
        cycle service; // for which it has the line
    };
    /// Cycles from one tile to another, and from a write until others of its tile see it.
    WordMoves(cycle move, cycle visibility) : move_(move), visibility_(visibility) {}

    /// When it acts. Calls come in order of `at`, but for threads that a quantum lets run behind.
    /// `oldest`: nobody asks before this cycle from now on.
    cycle write(const Write& w, cycle oldest) {
        Stay& s = stay(w, oldest);
        const cycle acts = std::max(s.free, w.at);
        s.free = acts + w.service + visibility_;
        return acts;
    }

private:
    static constexpr cycle open = ~cycle{0};
    struct Stay {
        std::uint32_t tile;
        cycle free;        // what has been written is seen, or the line gets there
        cycle left = open; // when the next tile's request took it away
    };

    Stay& stay(const Write& w, cycle oldest) {
        std::vector<Stay>& stays = words_[w.word];
        std::erase_if(stays, [oldest](const Stay& s) { return s.left < oldest; });
        for (Stay& s : stays)
            if (s.tile == w.tile && w.asked <= s.left)
                return s;
        cycle from = w.at;
        if (!stays.empty())
            from = stays.back().left = std::max(w.at, stays.back().free);
        return stays.emplace_back(Stay{w.tile, from + move_});
    }

    const cycle move_, visibility_;
    std::unordered_map<std::uint64_t, std::vector<Stay>> words_; // the last one is where the line is or goes
};

} // namespace sim
