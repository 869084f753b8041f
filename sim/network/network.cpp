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

/// Takes the first free cycles from `t` on, one a flit.
Calendar::Span Network::book(Link& link, cycle t, std::uint32_t flits) {
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

cycle Network::send(Message kind, std::size_t from, std::size_t to, std::uint32_t data, cycle t) {
    const std::uint32_t bytes = header_[static_cast<std::size_t>(kind)] + data;
    const std::uint32_t flits = std::max(1U, (bytes + link_bytes_ - 1) / link_bytes_);
    const std::uint64_t hops = topology_.hops(from, to);
    std::uint64_t links = 2;
    // No flit goes on before it has come: as the last one does not, none does.
    const auto next = [flits](Calendar::Span s, cycle later) {
        return std::max(s.first, s.last - (flits - 1)) + later;
    };
    cycle head = next(book(links_[topology_.link_from(from)], t, flits), through_port_);
    topology_.walk(from, to, [&](std::size_t link) {
        head = next(book(links_[link], head, flits), hop_cycles_);
        ++links;
    });
    const cycle there = book(links_[topology_.link_to(to)], head, flits).last + 1;
    ++(counters_.*network_counters[static_cast<std::size_t>(kind)].count);
    counters_.bytes += bytes;
    counters_.data_bytes += data;
    counters_.flits += flits;
    counters_.hops += hops;
    counters_.byte_hops += bytes * hops;
    counters_.link_flits += flits * links;
    counters_.latency_cycles += there - t;
    counters_.queue_cycles += there - t - hops * hop_cycles_ - flits;
    return there;
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
