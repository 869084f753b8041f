// Messages over links. A message is as many flits as it has link_bytes, of which each link takes one a cycle.
// Behind the first flit, hop_cycles from link to link, the others follow; without anybody in the way all of
// it is there after hops x hop_cycles + flits. Links are calendars. By send() a message takes all of its
// links at once: whoever is served first takes the first free cycles, also before and between what others
// have booked, as if every message had a virtual channel of its own. flights.h has messages take link by
// link, in order of time. Not modelled: buffers of routers, which have room for all that waits, and so back
// pressure and the number of virtual channels; that a message waits behind another one at the head of its
// queue, for another link; messages of a sender to one receiver may overtake each other.
#pragma once

#include "sim/core/calendar.h"
#include "sim/network/counters.h"
#include "sim/network/topology.h"

#include <vector>

namespace sim {

class Network {
public:
    enum class Message { request, reply, write, word }; // as the first of network_counters
    /// From a unit to another, with so many bytes besides the header.
    struct Leg {
        Message kind;
        std::size_t from, to;
        std::uint32_t data;
        bool answers = false; // word that answers another
        /// What somebody waits for who has asked.
        bool comes_back() const { return kind == Message::reply || answers; }
    };

    /// For who compares: a message that left at `sent` and was all there at `there`.
    struct Sent {
        Leg leg;
        cycle sent, there;
        bool comes_back() const { return leg.comes_back(); }
    };

    /// Nobody sends before `earliest`, which its owner moves on.
    Network(const Config& config, const cycle& earliest);

    /// From now on all messages are noted, in the order in which they are sent.
    void note_in(std::vector<Sent>* messages) { sent_ = messages; }
    std::vector<Sent>* noted_in() const { return sent_; }

    /// A message leaves at `t`; returns the cycle at which all of it is there.
    cycle send(const Leg& leg, cycle t);

    // For who books link by link.
    std::uint32_t flits(const Leg& leg) const;
    /// Its links, in order.
    void route(const Leg& leg, std::vector<std::uint32_t>& links) const;
    /// Takes the first free cycles of a link from `t` on, one a flit.
    Calendar::Span book(std::size_t link, cycle t, std::uint32_t flits);
    /// ... or those of them before `end`; returns how many. `span` is the first and last.
    std::uint32_t book_before(std::size_t link, cycle t, std::uint32_t flits, cycle end,
                              Calendar::Span& span);
    /// The first free cycle of a link from `t` on.
    cycle free_from(std::size_t link, cycle t) { return links_[link].calendar.find(t); }
    /// When a message that has taken these cycles of its link number `hop`, of so many, comes to the next
    /// one.
    cycle next(Calendar::Span taken, std::uint32_t flits, std::size_t hop, std::size_t links) const;
    /// It was sent at `sent`, and is there, over so many links.
    void count(const Leg& leg, std::size_t links, cycle sent, cycle there);

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

    Topology topology_;
    std::uint32_t link_bytes_;
    cycle hop_cycles_, through_port_; // from a unit's own link to the next
    std::array<std::uint32_t, 4> header_;
    std::vector<Link> links_;
    std::vector<std::uint32_t> route_; // of the message that is sent
    NetworkCounters counters_;
    std::vector<Sent>* sent_ = nullptr;
    cycle quiet_ = 0;
};

} // namespace sim
