// The ways of requests: from a tile to the bank that answers for a line, of the cache beyond the tiles that
// it shares, or to the line's memory channel; from such a cache to the channel; and back. With
// network.topology = "ideal" they take no time and nothing is counted. A line in several channels goes by
// the one of its first burst. Who books a whole way at once (ask, write, answer, ...) has requests reach a
// channel or a bank in the order in which they were sent, at the cycles at which they come; who goes link by
// link (asking, writing, answering, ..., for flights.h) in that in which they come.
// Not modelled: acknowledgements of writes; what an inclusive cache beyond the tiles recalls from them; words
// that workers share, whose way is coherence.remote_cycles.
#pragma once

#include "sim/memory/dram_mapping.h"
#include "sim/network/network.h"

#include <algorithm>

namespace sim {

class Ways {
public:
    using Leg = Network::Leg;
    /// Who asks: a tile, or a cache beyond the tiles, by number.
    struct Asker {
        enum Kind : std::uint8_t { tile, cache } kind;
        std::uint32_t number;
    };
    /// Core cycles that no way between a tile and what it asks is shorter than: there, and back with a line;
    /// and those of a line on its last link.
    struct Shortest {
        std::uint64_t there = 0, back = 0, last_link = 0;
    };

    /// Nobody sends before `earliest`. Nothing reaches memory more than `disorder` core cycles before what
    /// reached it earlier: it waits until then.
    Ways(const Config& config, const cycle& earliest, std::uint64_t disorder);

    bool ideal() const { return ideal_; }
    /// A message to what answers the asker. Of a read:
    Leg asking(Asker who, std::uint64_t address) const {
        return ideal_ ? Leg{} : Leg{Network::Message::request, source(who, address), target(who, address), 0};
    }
    /// Of a write of so many bytes.
    Leg writing(Asker who, std::uint64_t address, std::uint32_t bytes) const {
        return ideal_ ? Leg{}
                      : Leg{Network::Message::write, source(who, address), target(who, address), bytes};
    }
    /// The line that was read comes back.
    Leg answering(Asker who, std::uint64_t address, std::uint32_t bytes) const {
        return ideal_ ? Leg{}
                      : Leg{Network::Message::reply, target(who, address), source(who, address), bytes};
    }
    /// A tile's word about a line to a cache beyond the tiles.
    Leg telling(std::uint32_t tile, std::uint32_t cache, std::uint64_t address) const {
        return ideal_ ? Leg{} : Leg{Network::Message::word, tile, bank(cache, address), 0};
    }
    /// ... and to a directory.
    Leg telling_directory(std::uint32_t tile, std::uint64_t address) const {
        return ideal_ ? Leg{} : Leg{Network::Message::word, tile, target({Asker::tile, tile}, address), 0};
    }
    // Of a directory, at the bank or channel of the line; all but lines are words.
    /// From it to a tile.
    Leg telling_tile(std::uint64_t address, std::uint32_t tile) const {
        return ideal_ ? Leg{} : Leg{Network::Message::word, target({Asker::tile, tile}, address), tile, 0};
    }
    /// Of a hub where buses meet: to all tiles of a bus, in one message.
    Leg telling_bus(std::uint64_t address, std::size_t bus) const {
        return telling_tile(address, static_cast<std::uint32_t>(network_.topology().tile_of_bus(bus)));
    }
    /// From a tile to it, that it has done as it was told.
    Leg answering_directory(std::uint32_t tile, std::uint64_t address) const {
        Leg leg = telling_directory(tile, address);
        leg.answers = true;
        return leg;
    }
    /// A line from a tile to another, or another cache of the tile, and word that one was dropped.
    Leg passing(std::uint32_t from, std::uint32_t to, std::uint32_t bytes) const {
        return ideal_ ? Leg{} : Leg{Network::Message::reply, from, to, bytes};
    }
    Leg telling_writer(std::uint32_t from, std::uint32_t to) const {
        return ideal_ ? Leg{} : Leg{Network::Message::word, from, to, 0, true};
    }

    /// It leaves at `t` and takes all its links at once; returns when it is there.
    cycle send(const Leg& leg, cycle t) { return ideal_ ? t : network_.send(leg, t); }
    cycle ask(Asker who, std::uint64_t address, cycle t) { return reach(asking(who, address), t); }
    cycle write(Asker who, std::uint64_t address, std::uint32_t bytes, cycle t) {
        return reach(writing(who, address, bytes), t);
    }
    cycle answer(Asker who, std::uint64_t address, std::uint32_t bytes, cycle t) {
        return send(answering(who, address, bytes), t);
    }
    /// What reaches memory at `t`: no earlier than so much before what reached it earlier.
    cycle in_order(cycle t) {
        t = std::max(t, latest_ > disorder_ ? latest_ - disorder_ : 0);
        latest_ = std::max(latest_, t);
        return t;
    }
    const Network& network() const { return network_; }
    Network& network() { return network_; }
    /// Number of the bank of the cache that all tiles share, or else of the memory channel, that answers for
    /// a line.
    std::size_t home(std::uint64_t address) const;
    std::size_t homes() const { return homes_; }

    static Shortest shortest(const Config& config);

private:
    cycle reach(const Leg& leg, cycle t);
    std::size_t bank(std::size_t cache, std::uint64_t address) const;
    std::size_t source(Asker who, std::uint64_t address) const;
    std::size_t target(Asker who, std::uint64_t address) const;

    bool ideal_;
    Network network_;
    DramMapping mapping_;
    unsigned line_shift_; // of the last cache
    std::size_t homes_;
    bool banks_; // are homes, not channels
    std::uint64_t line_mask_;
    cycle disorder_, latest_ = 0;
};

} // namespace sim
