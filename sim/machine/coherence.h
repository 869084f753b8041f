// Coherence between the last caches of tiles (coherence.plain). MESI: a line that nobody else has comes
// exclusive; one that another may write is brought by that one, which writes it back if it had changed it and
// has it read from it; a write takes it from all sharers.
// * directory: who has a line is known at its bank of the cache that all tiles share, or at its memory
//   channel. There a request is looked up, sent on to the owner, or told to the sharers, which tell the
//   writer. A directory with room for some lines alone (coherence.directory_entries) first recalls another
//   one for a line that it does not know: who has that drops it, what was changed is written back, and when
//   all have answered the request goes on. Lines that somebody is just asking for stay.
// * snoop: all caches see each other's requests. Those of the same bus as it passes; the hub passes it on to
//   all other buses. coherence.snoop_cycles later all have said what they have, and the owner begins to bring
//   the line, of which memory takes what it had changed as it passes; memory is asked at once, but its answer
//   waits for what the caches say, as does a writer. What they say goes on lines of its own.
// What happens to a line is decided when the directory has looked it up, or the hub has it, in the order in
// which requests are served; messages take their ways over the network, and act on the tiles' caches at once,
// that is after the window: whether one has a line is what its tags say then. Not modelled: ports of caches
// that look lines up or bring them; that a line which is asked for again while it is taken away cannot be
// read meanwhile, or, before a cache beyond the tiles, recalled; that a request waits where all lines of its
// set are being asked for; that a bus lets only so many requests be under way, or memory read in vain what an
// owner brings.
#pragma once

#include "sim/machine/tile.h"
#include "sim/memory/coherence_counters.h"
#include "sim/memory/directory.h"
#include "sim/network/ways.h"

#include <deque>
#include <functional>
#include <vector>

namespace sim {

class Coherence {
public:
    /// A changed line that a tile's cache writes back from this cycle on.
    using WriteBack = std::function<void(const Request&)>;

    Coherence(const Config& config, Ways& ways, std::deque<Tile>& tiles, WriteBack write_back);

    /// What becomes of a request.
    struct Outcome {
        enum From : std::uint8_t { below, owner, nobody } from = below; // that brings the line
        cycle at = 0;       // when it is asked for below; of others, when all is there
        cycle finished = 0; // when all others have said that they dropped it
        cycle known = 0;    // no answer from below leaves earlier
    };
    /// A line is asked for, or the right to write it, at `t`.
    Outcome ask(const Request& r, cycle t);
    /// Whether a cache that asks for the right to write a line has it; then it is asked for no more.
    bool grants_silently(const Request& r);
    /// Whether a request for this line has to wait: when its owner has it is not known until arrives() says
    /// so (memory with queues).
    bool is_coming(std::uint64_t line) const;
    /// It comes from below at `ready`.
    void arrives(const Request& r, cycle ready);
    /// It is written back.
    void written(const Request& r);
    /// A shared word in it is written.
    void claim(const Request& r, cycle t);

    /// Cycles of the directory, if there is one.
    std::uint64_t look_up() const { return look_up_; }
    const CoherenceCounters& counters() const { return counters_; }
    /// Lines that a cache may write or read but the directory does not know so: 0 when nothing is under way.
    std::uint64_t incoherent() const;

private:
    std::uint32_t number_of(const Request& r) const {
        return r.tile * static_cast<std::uint32_t>(exits_) + r.exit;
    }
    std::uint32_t tile_of(std::uint32_t cache) const { return cache / static_cast<std::uint32_t>(exits_); }
    Cache& cache(std::uint32_t number) const {
        return tiles_[tile_of(number)].caches[level_][number % exits_];
    }
    UnderWay& under_way(std::uint32_t number) const {
        return tiles_[tile_of(number)].exits[number % exits_].under_way;
    }
    void pass_on(const Request& r, cycle t);
    void forget_dropped(const Request& r, Directory::Line& l);
    cycle hears(const Request& r, std::uint32_t cache, cycle t);
    void forward(const Request& r, Directory::Line& l, cycle t, Outcome& out);
    cycle invalidate(const Request& r, const Directory::Line& l, cycle t);
    void give(const Request& r, Directory::Line& l);
    cycle make_room(const Request& r, cycle t);
    cycle recall(const Request& r, std::uint64_t line, cycle t);
    void write_back(std::uint32_t from, const Request& r, std::uint64_t line, cycle t);

    std::size_t exits_;
    unsigned level_; // of the tiles' last caches
    std::uint32_t line_bytes_;
    bool snoops_;
    std::uint64_t look_up_, snoop_;
    Ways& ways_;
    std::deque<Tile>& tiles_;
    WriteBack write_back_;
    Directory directory_;
    CoherenceCounters counters_;
    // Of the request at hand, where caches snoop:
    std::vector<cycle> heard_; // on each bus
    cycle said_ = 0;           // all have said what they have
};

} // namespace sim
