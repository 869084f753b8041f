// Messages link by link: by hand, and against plain lists of taken cycles.
#include "sim/network/flights.h"

#include "sim/validation/network_order.h"
#include "tests/sim/networks.h"

#include <map>

namespace sim::test {
namespace {

using Message = Network::Message;

// A bus, 3 cycles a hop, lines of 5 flits. What is known of it: how long before.
TEST(Flights, LinesThatComeBackGoFirstByHand) {
    for (const cycle ahead : {5U, 6U, 9U}) {
        Config c = network_machine("bus", 4);
        c.network.buses = 1;
        const cycle earliest = 0;
        Network n(c, earliest);
        Flights flights(n, ahead);
        const std::size_t hub = n.topology().channel(0);
        std::map<std::uint64_t, cycle> there;
        const auto fly = [&](cycle until) {
            for (; flights.next() < until;)
                if (const auto a = flights.step())
                    there[a->id] = a->at;
        };
        std::vector<std::tuple<cycle, std::uint64_t, Network::Leg, cycle>> sends = {
            {11, 0, {Message::write, 1, hub, 64}, 11},
            {12, 1, {Message::request, 2, hub, 0}, 12},
            {13 - ahead, 2, {Message::reply, hub, 3, 64}, 13},
            {40, 3, {Message::word, 0, 3, 0}, 40},
        };
        std::sort(sends.begin(), sends.end(),
                  [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
        for (const auto& [known, id, leg, sent] : sends) {
            fly(known);
            flights.send(id, leg, sent);
        }
        fly(Flights::never);
        // The line takes the bus in 13..17, and the link to tile 3 in 16..20; the write takes the bus in 11,
        // 12, 18, 19, 20, so that its last flit is at the hub in 23; the request, which came to the bus
        // behind it, takes that in 21 and the link to the hub in 24; nobody is in the word's way.
        EXPECT_EQ(there, (std::map<std::uint64_t, cycle>{{0, 24}, {1, 25}, {2, 21}, {3, 44}})) << ahead;
        EXPECT_EQ(n.counters().link_flits, 3 * (5 + 5 + 1 + 1U));
        EXPECT_EQ(n.counters().latency_cycles, 13 + 13 + 8 + 4U);
        EXPECT_EQ(n.counters().queue_cycles, 5 + 9U);
        EXPECT_EQ(n.counters().messages(), 4U);
        EXPECT_EQ(n.quiet(), 44U);
    }
}

// However long before lines are known, and however much waits.
TEST(Flights, EqualListsOfTakenCycles) {
    for (const char* topology : topologies)
        for (const auto& [hop, width] : {std::pair<integer, integer>{3, 16}, {0, 64}, {7, 2}})
            for (const double load : {0.5, 0.95, 1.4}) {
                Config c = network_machine(topology, 9);
                c.network.hop_cycles = hop;
                c.network.link_bytes = width;
                c.memory.channels = 2;
                const auto messages = network_traffic(c, load, 2000, 7);
                const std::vector<cycle> expected = arrivals_by_lists(c, messages);
                const auto line = flits(c, c.network.reply_bytes + 64);
                for (const cycle ahead : {line, line + 3, 150 + line, cycle{900}})
                    ASSERT_EQ(arrivals_of_flights(c, messages, ahead), expected)
                        << topology << ", " << hop << " cycles a hop, " << width << " bytes, load " << load
                        << ", ahead " << ahead;
            }
}

TEST(Flights, ALineThatIsKnownTooLateIsNoticed) {
    const Config c = network_machine("crossbar", 2);
    const cycle earliest = 0;
    Network n(c, earliest);
    Flights flights(n, 10);
    flights.send(0, {Message::request, 0, 1, 0}, 20);
    flights.step();
    EXPECT_DEATH(flights.send(1, {Message::reply, 1, 0, 64}, 29), "broken invariant");
    flights.send(1, {Message::reply, 1, 0, 64}, 30);
}

} // namespace
} // namespace sim::test
