#include "sim/network/network.h"

#include <algorithm>

namespace sim {

Network::Network(const Config& c, const cycle& earliest)
    : topology_(c), link_bytes_(static_cast<std::uint32_t>(c.network.link_bytes)),
      hop_cycles_(static_cast<cycle>(c.network.hop_cycles)),
      through_port_(c.network.topology == "crossbar" ? hop_cycles_ : 0),
      header_{static_cast<std::uint32_t>(c.network.request_bytes),
              static_cast<std::uint32_t>(c.network.reply_bytes),
              static_cast<std::uint32_t>(c.network.write_bytes),
              static_cast<std::uint32_t>(c.network.request_bytes)},
      links_(c.network.ideal() ? 0 : topology_.links(), Link{Calendar("network link", earliest)}) {}

std::uint32_t Network::flits(const Leg& leg) const {
    const std::uint32_t bytes = header_[static_cast<std::size_t>(leg.kind)] + leg.data;
    return std::max(1U, (bytes + link_bytes_ - 1) / link_bytes_);
}

void Network::route(const Leg& leg, std::vector<std::uint32_t>& links) const {
    links.assign(1, static_cast<std::uint32_t>(topology_.link_from(leg.from)));
    topology_.walk(leg.from, leg.to,
                   [&](std::size_t link) { links.push_back(static_cast<std::uint32_t>(link)); });
    links.push_back(static_cast<std::uint32_t>(topology_.link_to(leg.to)));
}

Calendar::Span Network::book(std::size_t number, cycle t, std::uint32_t flits) {
    Link& link = links_[number];
    const bool within = t >= link.full_from && t <= link.full_to;
    const cycle from = within ? link.full_to : t; // a backlog in one step
    constexpr std::uint32_t at_once = 64;
    Calendar::Span s = link.calendar.take(from, std::min(flits, at_once));
    for (std::uint32_t taken = at_once; taken < flits; taken += at_once)
        s.last = link.calendar.take(s.last + 1, std::min(flits - taken, at_once)).last;
    if (!within && s.last >= link.full_to)
        link.full_from = t;
    link.full_to = std::max(link.full_to, s.last + 1);
    link.flits += flits;
    quiet_ = std::max(quiet_, s.last + 1);
    return s;
}

std::uint32_t Network::book_before(std::size_t number, cycle t, std::uint32_t flits, cycle end,
                                   Calendar::Span& span) {
    Link& link = links_[number];
    std::uint32_t taken = 0;
    for (; taken < flits; ++taken) {
        const cycle slot = link.calendar.find(t);
        if (slot >= end)
            break;
        link.calendar.mark(slot);
        span = {taken == 0 ? slot : span.first, slot};
        t = slot + 1;
        quiet_ = std::max(quiet_, t);
    }
    link.flits += taken;
    return taken;
}

cycle Network::next(Calendar::Span taken, std::uint32_t flits, std::size_t hop, std::size_t links) const {
    // No flit goes on before it has come: as the last one does not, none does.
    const cycle head = std::max(taken.first, taken.last - (flits - 1));
    return head + (hop == 0 ? through_port_ : hop + 1 < links ? hop_cycles_ : 0);
}

void Network::count(const Leg& leg, std::size_t links, cycle sent, cycle there) {
    const std::uint32_t bytes = header_[static_cast<std::size_t>(leg.kind)] + leg.data;
    const std::uint64_t hops = topology_.hops(leg.from, leg.to), flits = this->flits(leg);
    ++(counters_.*network_counters[static_cast<std::size_t>(leg.kind)].count);
    counters_.bytes += bytes;
    counters_.data_bytes += leg.data;
    counters_.flits += flits;
    counters_.hops += hops;
    counters_.byte_hops += bytes * hops;
    counters_.link_flits += flits * links;
    counters_.latency_cycles += there - sent;
    counters_.queue_cycles += there - sent - hops * hop_cycles_ - flits;
}

cycle Network::send(const Leg& leg, cycle t) {
    const std::uint32_t flits = this->flits(leg);
    route(leg, route_);
    cycle head = t;
    Calendar::Span taken{};
    for (std::size_t hop = 0; hop < route_.size(); ++hop) {
        taken = book(route_[hop], head, flits);
        head = next(taken, flits, hop, route_.size());
    }
    count(leg, route_.size(), t, taken.last + 1);
    if (sent_ != nullptr)
        sent_->push_back({leg, t, taken.last + 1});
    return taken.last + 1;
}

NetworkReport Network::report() const {
    NetworkReport out{counters_, {}};
    for (std::size_t i = 0; i < links_.size(); ++i)
        out.links.push_back({topology_.link_name(i), links_[i].flits});
    return out;
}

const LinkUse& NetworkReport::busiest() const {
    return *std::max_element(links.begin(), links.end(),
                             [](const LinkUse& a, const LinkUse& b) { return a.flits < b.flits; });
}

} // namespace sim
