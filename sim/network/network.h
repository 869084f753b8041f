// Messages over links. A message is as many flits as it has link_bytes, of which each link takes one a cycle.
// Behind the first flit, hop_cycles from link to link, the others follow; without anybody in the way all of
// it is there after hops x hop_cycles + flits. Links are calendars: whoever is served first takes the first
// free cycles, also before and between what others have booked, as if every message had a virtual channel of
// its own. Not modelled: buffers of routers, which have room for all that waits, and so back pressure and the
// number of virtual channels; that a message waits behind another one at the head of its queue; arbitration
// other than by order of time at the sender; messages of a sender to one receiver may overtake each other.
#pragma once

#include "sim/core/calendar.h"
#include "sim/network/counters.h"
#include "sim/network/topology.h"

#include <vector>

namespace sim {

class Network {
public:
    enum class Message { request, reply, write, word }; // as the first of network_counters

    /// Nobody sends before `earliest`, which its owner moves on.
    Network(const Config& config, const cycle& earliest);

    /// A message of `data` bytes and its header; returns the cycle at which all of it is there.
    cycle send(Message kind, std::size_t from, std::size_t to, std::uint32_t data, cycle t);

    const Topology& topology() const { return topology_; }
    const NetworkCounters& counters() const { return counters_; }
    NetworkReport report() const; // links by number
    /// From this cycle on no link is busy.
    cycle quiet() const { return quiet_; }

private:
    struct Link {
        Calendar calendar;
        std::uint64_t flits = 0;
        cycle full_from = 0, full_to = 0; // no slot between is free
    };
    Calendar::Span book(Link& link, cycle t, std::uint32_t flits);

    Topology topology_;
    std::uint32_t link_bytes_;
    cycle hop_cycles_, through_port_; // from a unit's own link to the next
    std::array<std::uint32_t, 4> header_;
    std::vector<Link> links_;
    NetworkCounters counters_;
    cycle quiet_ = 0;
};

} // namespace sim
