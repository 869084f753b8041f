// What a cache asks of what lies below it: another cache, or the way out of its tile.
#pragma once

#include "sim/core/stalls.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

/// When an access is served (a cycle or a ticket), and what serves it. Or, refused: it has not happened, for
/// an MSHR or buffer is not free; ask again at that cycle, or (unknown) when something was answered, or
/// (maybe_sooner) at the first of both. Small enough for two registers.
struct Answer {
    static constexpr cycle unknown = ~cycle{0};
    cycle ready;
    Cause from;
    bool refused = false;
    bool dirty = false;  // the line has left an exclusive cache, which had not written it back
    bool shared = false; // of a coherent machine: the line is not to be written without asking
    bool moved = false;  // it was refused, but lines have gone to make room for what it wanted

    static Answer later(cycle when, bool moved = false) {
        return {.ready = when, .from = Cause::mshrs, .refused = true, .moved = moved};
    }
};

class Cache;

/// A request for some bytes of one line, at any address in it.
struct Access {
    std::uint64_t address;
    std::uint32_t bytes; // that move
    cycle at;
    std::size_t column;
    bool whole =
        false; // of a write: all bytes that move are written, so that a line of them need not be read
    bool followed = false; // of a write: the read of what takes its place follows at once
    bool modify = false;   // a read that changes what it reads
    bool forced = false;   // happens at once, whatever is busy
    bool clean = false;    // of a write: what lies below has the same
    // Of a coherent machine:
    bool exclusive = false; // a read of a line that will be written
    bool owned = false;     // of a write: the right to it is there, or asked for by itself
    bool stays = false;     // of a write back: the line stays in the cache, clean
    Cache* by = nullptr;    // the cache above that asks
    // For caches that answer in order of time:
    std::uint32_t asker = 0; // the number of the cache above that asks, or of the core's L1
};

/// What is on its way to a cache from those above it.
class Coming {
public:
    Coming() = default;
    Coming(const Coming&) = delete;
    Coming& operator=(const Coming&) = delete;
    virtual ~Coming() = default;

    /// A cache below drops its line of these bytes: whole lines among them that are on their way to be
    /// written go there instead. Returns whether any was dirty.
    virtual bool recall(std::uint64_t address, std::uint64_t bytes) = 0;
    /// Somebody else reads these bytes: what of them is on its way to be written goes there too, and what
    /// comes is clean. Returns whether any was dirty.
    virtual bool clean(std::uint64_t address, std::uint64_t bytes) = 0;
};

class Below {
public:
    Below() = default;
    Below(const Below&) = delete;
    Below& operator=(const Below&) = delete;
    virtual ~Below() = default;

    virtual Answer read(const Access& a) = 0;
    /// Ready when it is accepted.
    virtual Answer write(const Access& a) = 0;
    /// Of a coherent machine: the line is above, and will be written. Ready when nobody else has it; with
    /// `shared` that is not decided yet.
    virtual Answer own(const Access& a) { return {a.at, Cause::memory}; }
    /// Whether that cache above has asked for the line of this address, or the right to write it, and nothing
    /// here has acted on that yet: then it stays where others' requests, which come first, would take it.
    virtual bool is_asked(std::uint64_t /*address*/, const Cache& /*by*/) const { return false; }
};

/// What leaves a tile: a dirty line to be written, a line to be read, or the one and then the other; or word
/// that a line is to be dropped elsewhere, or is dead.
struct Request {
    static constexpr std::uint64_t nothing = ~std::uint64_t{0};
    cycle at;
    std::uint32_t tile, exit;                      // of the tile, by number
    std::uint64_t sequence;                        // within its tile
    std::uint64_t write = nothing, read = nothing; // addresses
    cycle ticket = 0;                              // of the read
    std::size_t column = 0;
    std::uint32_t bytes = 0; // of the write
    bool whole = false;      // likewise
    /// Word is of the line at `write`. Of a coherent machine: an upgrade asks for the right to write the line
    /// at `read`, which is there; a claim says that a shared word at `write` has been written.
    enum Kind : std::uint8_t { lines, invalidate, discard, upgrade, claim } kind = lines;
    bool exclusive = false; // of a read: to write it
    bool stays = false;     // of a write: its line stays where it was
    bool found = false;     // the directory, or who else is on the buses, has been asked for it
    /// Where it stands: on its way, then on the buses or at a bank of a cache beyond the tiles, with an entry
    /// of its exit's MSHRs.
    enum Stage : std::uint8_t { arrives, writes, reads } stage = arrives;
    static constexpr std::size_t no_entry = ~std::size_t{0};
    std::size_t mshr = 0;
    cycle finished = 0;         // when all other caches have dropped the line
    cycle known = 0;            // when they have said what they have: no answer leaves earlier
    std::uint32_t decision = 0; // a number, of what they say
    std::uint32_t to = 0;       // cache beyond the tiles that word of a line goes to
};

} // namespace sim
