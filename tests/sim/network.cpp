// The network alone: routes, messages on links by hand and against slots, loads with closed forms.
#include "sim/network/network.h"

#include "tests/sim/networks.h"

#include <random>

namespace sim::test {
namespace {

using Message = Network::Message;

constexpr cycle none = 0;

TEST(Network, RoutesGoFromNeighbourToNeighbourTheShortestWay) {
    for (const char* topology : {"ring", "mesh"})
        for (const integer tiles : {1, 2, 3, 4, 7, 8, 12, 15, 16, 24}) {
            const Config c = network_machine(topology, tiles);
            const Topology t(c);
            for (integer from = 0; from < tiles; ++from)
                for (integer to = 0; to < tiles; ++to) {
                    std::string at = std::to_string(from);
                    integer links = 0;
                    bool in_column = false;
                    t.walk(u(from), u(to), [&](std::size_t link) {
                        ASSERT_GE(link, 2 * t.units());
                        ASSERT_LT(link, t.links());
                        const std::string name = t.link_name(link), begin = "router " + at + " to ";
                        ASSERT_EQ(name.find(begin), 0U) << name << " does not begin at " << at;
                        const std::string next = name.substr(begin.size());
                        const integer a = std::stoi(at), b = std::stoi(next);
                        EXPECT_EQ(hops_between(c, a, b), 1) << name;
                        if (c.network.topology == "mesh") {
                            const bool down = a % static_cast<integer>(t.columns()) ==
                                              b % static_cast<integer>(t.columns());
                            EXPECT_FALSE(in_column && !down) << "rows first";
                            in_column = down;
                        }
                        at = next;
                        ++links;
                    });
                    EXPECT_EQ(at, std::to_string(to));
                    EXPECT_EQ(links, hops_between(c, from, to)) << topology << " of " << tiles;
                }
        }
}

TEST(Network, UnitsAreSpreadEvenly) {
    Config c = with_l3(network_machine("mesh", 8), 4);
    c.memory.channels = 2;
    const Topology t(c);
    EXPECT_EQ(t.columns(), 4U);
    EXPECT_EQ(t.rows(), 2U);
    for (std::size_t bank = 0; bank < 4; ++bank)
        EXPECT_EQ(t.node(t.bank(0, bank)), 2 * bank);
    EXPECT_EQ(t.node(t.channel(0)), 0U);
    EXPECT_EQ(t.node(t.channel(1)), 4U);
    c.l3.share = std::string("4");
    c.l3.banks = 8;
    c.memory.channels = 16;
    const Topology groups(c);
    EXPECT_EQ(groups.caches(), 2U);
    for (std::size_t cache = 0; cache < 2; ++cache)
        for (std::size_t bank = 0; bank < 8; ++bank)
            EXPECT_EQ(groups.node(groups.bank(cache, bank)), 4 * cache + bank / 2);
    for (std::size_t channel = 0; channel < 16; ++channel)
        EXPECT_EQ(groups.node(groups.channel(channel)), channel / 2);
}

// Alone, every message takes hops x cycles a hop + flits, whatever it carries.
TEST(Network, WithoutOthersAMessageTakesItsHopsAndFlits) {
    for (const char* topology : topologies)
        for (const integer tiles : {1, 2, 5, 12, 16}) {
            const Config c = network_machine(topology, tiles);
            for (integer from = 0; from < tiles; ++from)
                for (integer to = 0; to < tiles; ++to)
                    for (const integer data : {0, 8, 9, 64, 128}) {
                        Network n(c, none);
                        EXPECT_EQ(
                            n.send({Message::write, u(from), u(to), static_cast<std::uint32_t>(data)}, 100),
                            100 + u(hops_between(c, from, to) * c.network.hop_cycles) +
                                flits(c, data + c.network.write_bytes));
                        EXPECT_EQ(n.counters().queue_cycles, 0U);
                    }
        }
}

// A ring of four, 3 cycles a hop, lines of 5 flits. The first message goes 0 -> 1 -> 2, the second 1 -> 2.
TEST(Network, MessagesShareLinksByHand) {
    const Config c = network_machine("ring", 4);
    Network n(c, none);
    // Link from 0 in 0..4, 0 to 1 in 0..4, 1 to 2 in 3..7, to 2 in 6..10.
    EXPECT_EQ(n.send({Message::write, 0, 2, 64}, 0), 11U);
    // 1 to 2 in 1, 2, 8, 9, 10, so that its last flit is at 2 in 13; the link to 2 in 11..15, in order of
    // call.
    EXPECT_EQ(n.send({Message::write, 1, 2, 64}, 1), 16U);
    EXPECT_EQ(n.counters().queue_cycles, 16U - 1 - 3 - 5);
    // One flit from 3: nobody was on 3 to 2, the link to 2 is taken in 6..15.
    EXPECT_EQ(n.send({Message::request, 3, 2, 0}, 4), 17U);
    EXPECT_EQ(n.send({Message::request, 3, 2, 0}, 1), 5U); // before all of them
    EXPECT_EQ(n.counters().link_flits, 4 * 5U + 3 * 5U + 3 + 3);
    EXPECT_EQ(n.counters().hops, 2 + 1 + 1 + 1U);
    EXPECT_EQ(n.report().busiest().link, "to tile 2");
    EXPECT_EQ(n.report().busiest().flits, 12U);
    EXPECT_EQ(n.quiet(), 17U);
}

// Four tiles on two buses that meet where the channel is, 3 cycles a hop, lines of 5 flits.
TEST(Network, BusesTakeTurnsByHand) {
    Config c = network_machine("bus", 4);
    c.network.buses = 2;
    Network n(c, none);
    const std::size_t hub = n.topology().channel(0);
    EXPECT_EQ(n.topology().hops(0, 1), 1U);
    EXPECT_EQ(n.topology().hops(0, 2), 2U);
    EXPECT_EQ(n.topology().hops(3, hub), 1U);
    EXPECT_EQ(n.topology().hops(hub, hub), 0U);
    EXPECT_EQ(n.send({Message::write, 0, hub, 64}, 0), 3 + 5U);  // bus 0 in 0..4
    EXPECT_EQ(n.send({Message::request, 1, hub, 0}, 0), 5 + 4U); // bus 0 in 5
    EXPECT_EQ(n.send({Message::request, 2, hub, 0}, 0), 9 + 1U); // bus 1 in 0, the hub's port in 3..8
    // Bus 0 in 6..10, bus 1 in 9..13.
    EXPECT_EQ(n.send({Message::write, 1, 3, 64}, 1), 12 + 5U);
    EXPECT_EQ(n.send({Message::write, 0, 1, 64}, 5), 11 + 3 + 5U); // bus 0 in 11..15
    const NetworkReport r = n.report();
    EXPECT_EQ(r.links[r.links.size() - 2].link, "bus 0");
    EXPECT_EQ(r.links[r.links.size() - 2].flits, 5 + 1 + 5 + 5U);
    EXPECT_EQ(r.links.back().flits, 1 + 5U);
}

// A tile's own link takes a flit a cycle, in order.
TEST(Network, ASenderWaitsForItsOwnMessages) {
    for (const char* topology : topologies) {
        Network n(network_machine(topology, 4), none);
        for (cycle i = 0; i < 10; ++i)
            EXPECT_EQ(n.send({Message::write, 0, 1, 64}, 0), 3 + 5 * (i + 1)) << topology;
    }
}

TEST(Network, BacklogsAreTheSameAsSlotBySlot) {
    // All from the same sender, at times out of order, against a plain list of cycles.
    Config c = network_machine("crossbar", 2);
    c.network.link_bytes = 1;
    Network n(c, none);
    std::vector<bool> port(400000), end(400000);
    std::mt19937 random(3);
    const auto take = [](std::vector<bool>& slots, cycle t, cycle count) {
        std::pair<cycle, cycle> span{~cycle{0}, 0};
        for (; count != 0; ++t)
            if (!slots[t]) {
                slots[t] = true;
                span = {std::min(span.first, t), t};
                --count;
            }
        return span;
    };
    for (int i = 0; i < 3000; ++i) {
        const cycle t = random() % 90000;
        const auto data = static_cast<std::uint32_t>(random() % 120);
        const cycle length = flits(c, data + c.network.write_bytes);
        const auto [first, last] = take(port, t, length);
        const auto there = take(end, std::max(first, last - (length - 1)) + u(c.network.hop_cycles), length);
        ASSERT_EQ(n.send({Message::write, 0, 1, data}, t), there.second + 1) << i;
    }
}

TEST(Network, PingPongsTakeExactCycles) {
    for (const NetworkPing& p : network_pings())
        EXPECT_EQ(p.measured, p.expected) << p.name;
}

TEST(Network, LoadsReachTheirClosedForms) {
    for (const NetworkLoad& l : network_loads()) {
        const cycle measured = l.run();
        EXPECT_GE(measured, l.expected) << l.name;
        EXPECT_LE(measured, l.expected * 102 / 100) << l.name;
    }
}

} // namespace
} // namespace sim::test
