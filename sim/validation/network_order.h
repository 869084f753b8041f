// The network once more, plainly: each message takes free cycles of a link, one by one, when it comes there;
// all lines that come back first, as if nothing else were there, then the rest. What flights.h does as time
// goes on must come to the same; how far from that lies what takes all its links at once is reported.
#pragma once

#include "sim/core/stalls.h"
#include "sim/network/network.h"

#include <string>
#include <vector>

namespace sim {

using NetworkMessage = Network::Sent;

/// Requests of tiles to memory channels, writes among them, and lines back; words of channels to tiles, and
/// of tiles to others that answer these; at random times, in the order of these; the busiest link is busy for
/// a part `load` of the time.
std::vector<NetworkMessage> network_traffic(const Config& config, double load, std::size_t count,
                                            std::uint32_t seed);

// When all of each message is there:
std::vector<cycle> arrivals_by_lists(const Config& config, const std::vector<NetworkMessage>& messages);
/// ... by Flights, with lines that come back known so long before; and by Network::send().
std::vector<cycle> arrivals_of_flights(const Config& config, const std::vector<NetworkMessage>& messages,
                                       cycle ahead);
std::vector<cycle> arrivals_at_once(const Config& config, const std::vector<NetworkMessage>& messages,
                                    cycle ahead);

/// Sixteen tiles and four channels.
struct NetworkOrder {
    std::string name;
    Config config;
    std::vector<NetworkMessage> messages;
};
std::vector<NetworkOrder> network_orders();

/// All that nine tiles say to each other, to directories or over buses, and to memory, while they fight for
/// lines in the reference mode, with when it was there.
struct CoherentOrder {
    NetworkOrder order;
    std::uint64_t counted; // messages, by the report
};
std::vector<CoherentOrder> coherent_orders();

} // namespace sim
