// Coherence between the last caches of tiles (coherence.plain): a directory of their lines, at the line's
// bank of the cache that all tiles share, or at its memory channel. MESI: a line that nobody else has comes
// exclusive; one that another may write is asked of that one, which brings it directly, and writes it back if
// it had changed it and has it read from it; a write invalidates all sharers, which tell the writer. What
// happens to a line is decided when the directory has looked it up, in the order in which requests are
// served; messages take their ways over the network, and act on the tiles' caches at once, that is after the
// window: whether one has a line is what its tags say then. Not modelled: ports of caches that bring lines;
// that a line which is asked for again while it is taken away cannot be read meanwhile; places in the
// directory for lines whose messages are on their way.
#pragma once

#include "sim/machine/tile.h"
#include "sim/memory/directory.h"
#include "sim/memory/directory_counters.h"
#include "sim/network/ways.h"

#include <deque>
#include <functional>

namespace sim {

class Coherence {
public:
    /// A changed line that a tile's cache writes back from this cycle on.
    using WriteBack = std::function<void(const Request&)>;

    Coherence(const Config& config, Ways& ways, std::deque<Tile>& tiles, WriteBack write_back);

    /// What becomes of a request that the directory has looked up.
    struct Outcome {
        enum From : std::uint8_t { below, owner, nobody } from = below; // that brings the line
        cycle at = 0;       // when it is asked for below; of others, when all is there
        cycle finished = 0; // when all others have said that they dropped it
    };
    /// A line is asked for, or the right to write it, at `t`.
    Outcome ask(const Request& r, cycle t);
    /// Whether a cache that asks for the right to write a line has it; then it is asked for no more.
    bool grants_silently(const Request& r);
    /// It comes from below at `ready`.
    void arrives(const Request& r, cycle ready);
    /// It is written back.
    void written(const Request& r);
    /// A shared word in it is written.
    void claim(const Request& r, cycle t);

    std::uint64_t look_up() const { return look_up_; }
    const DirectoryCounters& counters() const { return counters_; }
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
    void forward(const Request& r, Directory::Line& l, cycle t, Outcome& out);
    cycle invalidate(const Request& r, const Directory::Line& l, cycle t);
    void give(const Request& r, Directory::Line& l);
    void write_back(std::uint32_t from, const Request& r, cycle t);

    std::size_t exits_;
    unsigned level_; // of the tiles' last caches
    std::uint32_t line_bytes_;
    std::uint64_t look_up_;
    Ways& ways_;
    std::deque<Tile>& tiles_;
    WriteBack write_back_;
    Directory directory_;
    DirectoryCounters counters_;
};

} // namespace sim
