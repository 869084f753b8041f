// Who is connected with whom, and which links a message takes. Units send and receive: every tile, every
// bank of a cache beyond the tiles, every memory channel. Each has a link into the network and one out of it.
// * crossbar: each unit is a port; from any to any other is one hop, and no links lie between.
// * ring: a node for each tile, a link each way between neighbours. The shorter way; where both are as long,
//   nodes with even numbers send upwards, others downwards.
// * mesh: a node for each tile, row by row, a link each way between neighbours. Along the row first, then
//   along the column (dimension-order routing, so that no cycle of links can wait for itself).
// * bus: tiles have a port to one of network.buses, which all of its tiles take in turn. These buses meet in
// a
//   hub, where banks and channels are: from a tile to another of its bus, or to the hub, is one hop, to a
//   tile of another bus two. Addresses and data take turns on the same lines; who is told something by a
//   message that others see pass as well is coherence.plain.
// On rings and meshes banks and channels stand at the tiles' nodes, spread evenly and in order: channel c of
// C at node floor(c N / C) of N, bank b of B at tile floor(b S / B) of the S tiles that share its cache.
#pragma once

#include "sim/config/config.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace sim {

class Topology {
public:
    explicit Topology(const Config& config);

    /// Numbers of units.
    std::size_t tile(std::size_t number) const { return number; }
    std::size_t bank(std::size_t cache, std::size_t bank) const { return nodes_ + cache * banks_ + bank; }
    std::size_t channel(std::size_t number) const { return nodes_ + caches_ * banks_ + number; }
    std::size_t tiles() const { return nodes_; }
    std::size_t caches() const { return caches_; } // beyond the tiles
    std::size_t banks() const { return banks_; }   // of one of them
    std::size_t channels() const { return channels_; }
    std::size_t units() const { return node_.size(); }
    /// Which cache answers a tile, where there are any.
    std::size_t cache_of(std::size_t tile) const { return tile / sharing_; }
    /// Of a ring or mesh.
    std::size_t node(std::size_t unit) const { return node_[unit]; }
    std::size_t columns() const { return columns_; }
    /// Of a tile; what is at the hub has none: buses().
    std::size_t bus_of(std::size_t unit) const { return unit < nodes_ ? unit * buses_ / nodes_ : buses_; }
    std::size_t buses() const { return buses_; }
    /// A tile of that bus.
    std::size_t tile_of_bus(std::size_t bus) const { return bus * nodes_ / buses_; }
    std::size_t rows() const { return nodes_ / columns_; }

    /// Routers that a message passes on to another; the crossbar, once.
    std::size_t hops(std::size_t from, std::size_t to) const;
    /// Links by number: those of units, from and to, then those between routers.
    std::size_t links() const { return 2 * units() + between_; }
    std::size_t link_from(std::size_t unit) const { return unit; }
    std::size_t link_to(std::size_t unit) const { return units() + unit; }
    std::string link_name(std::size_t link) const;
    /// Of a ring or mesh: the routers that a link between such joins, from the first to the second.
    std::pair<std::size_t, std::size_t> ends(std::size_t link) const { return ends_[link - 2 * units()]; }
    /// visit(link) of each link between routers, in order.
    template <class Visit> void walk(std::size_t from, std::size_t to, Visit visit) const {
        if (kind_ == Kind::crossbar)
            return;
        if (kind_ == Kind::bus) {
            const std::size_t first = bus_of(from), second = bus_of(to);
            if (first < buses_)
                visit(2 * units() + first);
            if (second < buses_ && second != first)
                visit(2 * units() + second);
            return;
        }
        for (std::size_t at = node_[from], end = node_[to]; at != end;) {
            const Step s = kind_ == Kind::ring ? ring_step(at, end) : mesh_step(at, end);
            visit(s.link);
            at = s.to;
        }
    }
    /// Links, one way, across the cut of a ring or mesh into halves, the smallest there is (where rows and
    /// columns are odd: the nearest to halves); half of a crossbar's ports; half of several buses, or the
    /// one.
    std::size_t bisection() const;

private:
    enum class Kind { ideal, crossbar, ring, mesh, bus };
    struct Step {
        std::size_t link, to;
    };
    Step ring_step(std::size_t at, std::size_t end) const;
    Step mesh_step(std::size_t at, std::size_t end) const;
    std::string unit_name(std::size_t unit) const;

    Kind kind_;
    std::size_t nodes_, columns_ = 1, buses_ = 0, caches_ = 0, banks_ = 0, sharing_ = 1, channels_,
                        between_ = 0;
    unsigned level_ = 0;                                    // of the caches beyond, for their names
    std::vector<std::size_t> node_;                         // by unit
    std::vector<std::string> name_;                         // by link between routers, as what follows
    std::vector<std::pair<std::size_t, std::size_t>> ends_; // of rings and meshes
};

/// Cycles that a message of so many bytes takes on a link.
inline integer flits_of(const NetworkConfig& c, integer bytes) {
    return bytes <= c.link_bytes ? 1 : (bytes + c.link_bytes - 1) / c.link_bytes;
}

} // namespace sim
