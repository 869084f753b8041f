// What reports and descriptions say of a network: counters, intervals, energy, figures, mistakes.
#include "sim/machine/describe.h"
#include "sim/machine/energy.h"
#include "sim/machine/limits.h"
#include "sim/network/figures.h"
#include "tests/sim/networks.h"

namespace sim::test {
namespace {

TEST(Network, CountsWhatLeavesATile) {
    Config c = network_machine("mesh", 4);
    c.l1.size_bytes = c.l2.size_bytes = 4 * kib;
    constexpr int lines =
        256; // written one after the other: all but 64 + 64 make room, the film's at the end
    for (const bool transient : {true, false}) {
        isa::address_space space(1 << 20);
        std::byte* data = space.add("data", -1, 1 << 18, transient);
        const Report r = Machine(c).run(space, 4, {{"work"}}, [&](int w) {
            for (int i = 0; w == 3 && i < lines; ++i)
                store(here, data + i * 64, 4, stamp{}, stamp{});
        });
        const NetworkCounters& n = r.network.counters;
        EXPECT_EQ(n.requests, u(lines));
        EXPECT_EQ(n.replies, u(lines));
        EXPECT_EQ(n.writes, r.memory.writes);
        EXPECT_EQ(n.writes == u(lines), !transient);
        EXPECT_EQ(n.words, 0U);
        EXPECT_EQ(n.bytes, lines * u(8 + 72) + 72 * n.writes);
        EXPECT_EQ(n.flits, lines * u(1 + 5) + 5 * n.writes);
        EXPECT_EQ(n.hops, 2 * n.messages()); // tile 3 and the channel at 0 are diagonal
        EXPECT_EQ(n.byte_hops, 2 * n.bytes);
        EXPECT_EQ(n.link_flits, 4 * n.flits);
        EXPECT_EQ(r.network.links.size(), 2 * (4 + 1) + 8U);
    }
}

TEST(Network, AnIdealOneIsInNoReport) {
    Config c = simple();
    c.network.hop_cycles = 100;
    const Report r = read_lines(c, 10, 0);
    EXPECT_TRUE(r.network.ideal());
    EXPECT_EQ(r.network.counters.messages(), 0U);
    EXPECT_EQ(print_json(r).find("\"hop_cycles\""), std::string::npos);
    EXPECT_EQ(print_json(r).find("\"network\": {\n    \"requests\""), std::string::npos);
    EXPECT_EQ(r.cycles, read_lines(simple(), 10, 0).cycles);
}

TEST(Network, FramesBeforeTheLastAreTakenAway) {
    Config c = network_machine("mesh", 4);
    c.l1.size_bytes = c.l2.size_bytes = 4 * kib;
    Memory memory;
    const auto messages = [&](int frames) {
        return Machine(c)
            .run(memory.space, 4, {{"work"}},
                 [&](int w) {
                     for (int i = 0; i < 300; ++i)
                         load(here, memory.data + (w * 300 + i) * 64, 4, stamp{});
                 },
                 1, {.frames = frames})
            .network.counters;
    };
    EXPECT_EQ(messages(3).requests, messages(1).requests); // caches are far too small to keep anything
    EXPECT_EQ(messages(3).link_flits, messages(1).link_flits);
}

// By the law that intervals sum to the run, and no two of them hold the same.
TEST(Network, IntervalsHaveTheirBytes) {
    Memory memory;
    const Report r = Machine(network_machine("ring", 4))
                         .run(memory.space, 4, {{"work"}},
                              [&](int w) {
                                  stamp s;
                                  for (int i = 0; w == 1 && i < 100; ++i)
                                      s = load(here, memory.data + i * 64, 4, s);
                              },
                              1, {.interval = 1000});
    EXPECT_GT(r.intervals.size(), 5U);
    std::uint64_t most = 0, sum = 0;
    for (const Interval& i : r.intervals) {
        most = std::max(most, i.network_bytes);
        sum += i.network_bytes;
    }
    EXPECT_EQ(sum, 100 * (8 + 72U));
    EXPECT_LT(most, sum / 3);
    EXPECT_GT(r.intervals[2].network_bytes, 0U);
}

TEST(Network, EnergyIsThatOfBytesTimesHops) {
    Config c = network_machine("ring", 5);
    c.energy.network_pj = 0.5;
    const Report r = read_lines(c, 100, 2);
    for (const EnergyPart& p : energy_parts(r))
        if (p.part == std::string("network")) {
            EXPECT_EQ(p.events, 100U * 2 * (8 + 72));
            EXPECT_DOUBLE_EQ(p.joules, 100 * 2 * (8 + 72) * 0.5e-12);
            return;
        }
    ADD_FAILURE() << "no energy of the network";
}

TEST(Network, FiguresOfAChip) {
    const auto bisection = [](const char* topology, integer tiles, integer columns = 0) {
        Config c = network_machine(topology, tiles);
        c.chip.clock_ps = 1000;
        c.network.columns = columns;
        const NetworkFigures f = network_figures(c);
        EXPECT_DOUBLE_EQ(f.link_bytes_per_second, 16e9);
        return f.bisection_bytes_per_second / 16e9;
    };
    EXPECT_EQ(bisection("crossbar", 15), 8); // with the channel
    EXPECT_EQ(bisection("ring", 16), 2);
    EXPECT_EQ(bisection("ring", 1), 0);
    EXPECT_EQ(bisection("bus", 16), 1);
    EXPECT_EQ(bisection("mesh", 16), 4);
    EXPECT_EQ(bisection("mesh", 8), 2);
    EXPECT_EQ(bisection("mesh", 6), 3); // three columns, two rows
    EXPECT_EQ(bisection("mesh", 9), 3);
    EXPECT_EQ(bisection("mesh", 16, 16), 1);
    EXPECT_EQ(bisection("mesh", 16, 1), 1);
    // On the mean, an idle load is as much later as the figures say.
    for (const bool l3 : {false, true})
        for (const char* topology : topologies) {
            const Config c = l3 ? with_l3(network_machine(topology, 6), 2) : network_machine(topology, 6);
            Config without = c;
            without.network.topology = "ideal";
            double sum = 0;
            for (integer tile = 0; tile < 6; ++tile)
                for (const std::int64_t bank : {0, 1})
                    sum += static_cast<double>(read_lines(c, 1, tile, 64, bank).cycles) -
                           static_cast<double>(read_lines(without, 1, tile, 64, bank).cycles);
            const NetworkFigures f = network_figures(c);
            EXPECT_NEAR(sum / 12, f.cycles + f.memory_cycles, 1e-9) << topology;
        }
    EXPECT_EQ(network_figures(simple()).cycles, 0);
}

TEST(Network, AChipsLatenciesHaveItsWays) {
    for (const bool l3 : {false, true}) {
        const Config c = l3 ? with_l3(network_machine("mesh", 6), 2) : network_machine("mesh", 6);
        double sum = 0;
        for (integer tile = 0; tile < 6; ++tile)
            for (const std::int64_t bank : {0, 1})
                sum += static_cast<double>(read_lines(c, 1, tile, 64, bank).cycles);
        EXPECT_NEAR(sum / 12 * static_cast<double>(c.chip.clock_ps) * 1e-3, chip_figures(c).memory_closed_ns,
                    1e-6);
        EXPECT_NE(chip_text(c).find("mesh, 3 x 2"), std::string::npos);
    }
    EXPECT_EQ(chip_text(simple()).find("network"), std::string::npos);
}

TEST(Network, BrokenNumbersAreNoticed) {
    const Report good = read_lines(network_machine("ring", 3), 20, 1);
    EXPECT_NO_THROW(check_laws(good));
    for (const auto& row : network_counters) {
        Report r = good;
        r.network.counters.*row.count += 1000;
        EXPECT_THROW(check_laws(r), std::logic_error) << row.name;
    }
    for (std::size_t link = 0; link < good.network.links.size(); ++link) {
        Report r = good;
        ++r.network.links[link].flits;
        EXPECT_THROW(check_laws(r), std::logic_error) << r.network.links[link].link;
    }
}

TEST(Network, BadNetworksAreOneClearLine) {
    const std::string mesh = "[chip]\ntiles = 6\n[network]\ntopology = \"mesh\"\n";
    EXPECT_EQ(mistake(mesh + "columns = 3\n"), "");
    EXPECT_NE(mistake(mesh + "columns = 4\n").find("which does not divide chip.tiles, 6"), std::string::npos);
    EXPECT_NE(mistake("[network]\ntopology = \"torus\"\n").find("must be one of"), std::string::npos);
    EXPECT_NE(mistake("[network]\nlink_bytes = 0\n"), "");
}

} // namespace
} // namespace sim::test
