// Machines with a network between their tiles and what lies beyond: exact cycles of what they send over it,
// and what must not depend on it.
#include "sim/machine/limits.h"
#include "sim/machine/windows.h"
#include "tests/sim/coherent.h"
#include "tests/sim/networks.h"
#include "tests/sim/unchanging.h"

namespace sim::test {
namespace {

// Chases through the L3 that lies in banks at all tiles: every way to it adds up, to the cycle.
TEST(Network, HitsBeyondTheTilePayTheWayToTheirBank) {
    for (const char* topology : topologies) {
        Config c = with_l3(network_machine(topology, 8), 8);
        c.l2.size_bytes = 4 * kib;
        const int lines = static_cast<int>(4 * c.l2.size_bytes / 64);
        const auto chase = [&](integer reader, int turns) {
            return run_on(
                       c,
                       [=](std::byte* base, int w) {
                           stamp s;
                           for (int t = 0; w == reader && t < turns; ++t)
                               for (int i = 0; i < lines; ++i)
                                   s = load(here, base + i * 64, 4, s);
                       },
                       8)
                .cycles;
        };
        for (const integer reader : {0, 3, 5}) {
            cycle all = 0; // lines take turns in all eight banks
            for (integer bank = 0; bank < 8; ++bank)
                all += u(c.l1.latency + c.l2.latency + c.l3.latency +
                         2 * hops_between(c, reader, bank) * c.network.hop_cycles) +
                       flits(c, c.network.request_bytes) + flits(c, c.network.reply_bytes + 64);
            EXPECT_EQ(chase(reader, 3) - chase(reader, 2), all * u(lines) / 8) << topology << " " << reader;
        }
    }
}

// What misses the L3 too goes on from its bank to the channel and back.
TEST(Network, MissesBeyondTheTilePayBothWays) {
    for (const char* topology : topologies) {
        Config c = with_l3(network_machine(topology, 6), 2); // banks at tiles 0 and 3, the channel at 0
        for (const integer reader : {0, 2, 5})
            for (const integer bank : {0, 1}) {
                const cycle cycles = run_on(
                                         c,
                                         [=](std::byte* base, int w) {
                                             if (w == reader)
                                                 load(here, base + bank * 64, 4, stamp{});
                                         },
                                         6)
                                         .cycles;
                const integer hops = hops_between(c, reader, 3 * bank) +
                                     (c.network.bus() ? 0 : hops_between(c, 3 * bank, 0)); // both at the hub
                EXPECT_EQ(cycles,
                          u(c.l1.latency + c.l2.latency + c.l3.latency + 2 * hops * c.network.hop_cycles +
                            c.memory.controller_cycles + c.memory.tRCD + c.memory.tCL +
                            c.memory.burst_clocks()) +
                              2 * (flits(c, c.network.request_bytes) + flits(c, c.network.reply_bytes + 64)))
                    << topology << " reader " << reader << " bank " << bank;
            }
    }
}

TEST(Network, AnMshrIsHeldThereAndBack) {
    for (const char* topology : topologies) {
        Config c = network_machine(topology, 5);
        c.network.hop_cycles = 40;
        c.l1.mshrs = 64;
        c.l2.mshrs = 1;
        c.memory.tREFI = 0;
        constexpr int lines = 100;
        const auto cycles = [&](integer reader) {
            return run_on(
                       c,
                       [=](std::byte* base, int w) {
                           for (int i = 0; w == reader && i < lines; ++i)
                               load(here, base + i * 64, 4, stamp{}); // independent
                       },
                       5)
                .cycles;
        };
        const cycle near = cycles(0), far = cycles(2);
        const integer more = 2 * (hops_between(c, 2, 0) - hops_between(c, 0, 0)) * c.network.hop_cycles;
        EXPECT_EQ(far - near, u(lines * more)) << topology;
    }
}

/// Memory that is never in the way.
Config fast_memory(Config c) {
    c.memory.bus_bytes = 32;
    c.memory.burst_length = 2;
    c.memory.tCCD_S = c.memory.tCCD_L = 1;
    c.memory.tREFI = 0;
    return c;
}

// All tiles read from one channel, whose link takes 18 cycles a line; and write to it.
TEST(Network, TheChannelsLinkBindsWhereAllReadFromIt) {
    for (const char* topology : topologies)
        for (const bool writes : {false, true}) {
            Config c = fast_memory(network_machine(topology, 8));
            c.network.link_bytes = 4;
            c.l1.mshrs = c.l2.mshrs = 64;
            c.l2.write_back_buffer = c.l1.write_back_buffer = 64;
            c.l1.write_policy = c.l2.write_policy = writes ? "through" : "back";
            c.l1.write_miss = c.l2.write_miss = writes ? "around" : "allocate";
            c.l1.port_bytes = 64;
            constexpr int lines = 500;
            const Report r = run_on(
                c,
                [=](std::byte* base, int w) {
                    for (int i = 0; i < lines; ++i) {
                        std::byte* p = base + (i * 8 + w) * 128;
                        if (writes)
                            store_vector(here, p, all_lanes, stamp{}, stamp{}, stamp{});
                        else
                            load(here, p, 4, stamp{});
                    }
                },
                8);
            std::uint64_t line = flits(c, 64 + c.network.reply_bytes);
            if (c.network.bus() && !writes) // which the requests take as well
                line += flits(c, c.network.request_bytes);
            const std::uint64_t most = writes ? r.network.counters.data_bytes / 64 * line : 8 * lines * line;
            EXPECT_EQ(r.network.counters.writes != 0, writes);
            EXPECT_GE(r.drained, most);
            EXPECT_LE(r.drained, most * 102 / 100) << topology << (writes ? " writes" : " reads");
            EXPECT_STREQ(binding(limits(r)).resource, "network");
            EXPECT_EQ(limiter(r).find("network"), 0U);
            const std::string link = writes ? "to channel 0" : c.network.bus() ? "bus 0" : "from channel 0";
            EXPECT_EQ(r.network.busiest().link, link);
        }
}

// A word that tiles hand over, two of them with an L3 of their own: the writer's tile tells the others'
// cache.
TEST(Network, WordsOfInvalidationAndDeathAreMessages) {
    Config c = with_l3(network_machine("ring", 4), 2);
    c.l3.share = "2";
    Memory memory;
    auto* counter = reinterpret_cast<word*>(memory.data);
    const Report r = Machine(c).run(memory.space, 4, {{"work"}}, [&](int) { count_up(counter, 50); });
    EXPECT_EQ(counter->word, 200);
    EXPECT_GT(r.network.counters.words, 10U);
    EXPECT_GT(r.l3[0].invalidations + r.l3[1].invalidations, 10U);

    c.l3.share = "chip";
    c.l1.size_bytes = c.l2.size_bytes = 4 * kib;
    for (const bool discarded : {false, true}) {
        const Report dead = write_and_displace(c, discarded);
        EXPECT_EQ(dead.memory.writes, discarded ? 0U : 512U);
        EXPECT_EQ(dead.network.counters.words, discarded ? 512U : 0U);
    }
}

TEST(Network, TheWindowIsTheShortestWayThereAndBack) {
    Config c = simple();
    const std::uint64_t without = window_cycles(c);
    c.chip.tiles = 4;
    c.network.topology = "crossbar";
    c.network.link_bytes = 16;
    c.network.hop_cycles = 7;
    EXPECT_EQ(window_cycles(c), without + 2 * 7 + 1 + 5);
    c.network.topology = "mesh"; // the channel stands at a tile
    EXPECT_EQ(window_cycles(c), without + 1 + 5);
    c = with_l3(c, 4);
    EXPECT_EQ(window_cycles(c), u(c.l3.latency) + 5);
}

// As for a machine without a network (tests/sim/tiles.cpp), though the window is longer.
TEST(Network, WindowsUpToTheShortestWayChangeNothing) {
    for (const char* topology : topologies)
        expect_equal_in_windows(
            [&](integer window) {
                Config c;
                c.chip.tiles = 1;
                c.chip.cores = 4;
                c.chip.threads = 2;
                c.core.window = 1;
                c.network.topology = topology;
                c.network.hop_cycles = 25;
                c.sim.window = window;
                c.l1.mshrs = c.l1.write_back_buffer = c.l2.mshrs = c.l2.write_back_buffer = 256;
                const Shared s;
                return s.run(c, 8, [&](int w) { mixed_work(s.plain(), s.at(w), w, 60); });
            },
            topology);
}

// Words of the chip and plain data that tiles hand over, beyond whom lies a cache that they share.
TEST(Network, ReportsOfTilesThatSnoopAboveAnL3DoNotDependOnHostThreads) {
    for (const std::string mode : {"immediate", "queued", "reference"})
        expect_equal_on_host_threads(
            [&](int host_threads) {
                Config c = with_l3(busy_tiles(), 2);
                c.l3.size_bytes = 8 * kib;
                c.l3.latency = 100; // and with it windows of the reference mode
                c.coherence.snoop_cycles = 100;
                c.network.link_bytes = 2;
                c.memory.channels = 2;
                c.sim.jitter = 1;
                c = snooping(c, mode == "queued" ? 1 : 3);
                if (mode == "queued")
                    c.memory.controller = "queued";
                if (mode == "reference")
                    c = in_order_of_time(c);
                const Report r = run_busy_tiles(c, host_threads);
                EXPECT_GT(r.l3[0].hits, 100U);
                EXPECT_GT(r.coherence.supplied(), 100U);
                return r;
            },
            mode);
}

TEST(Network, ReportsDoNotDependOnHostThreads) {
    for (const char* topology : topologies)
        for (const std::string l3 : {"none", "chip", "4"})
            expect_equal_on_host_threads(
                [&](int host_threads) {
                    Config c = busy_tiles();
                    c.network.topology = topology;
                    c.network.link_bytes = 2;
                    c.memory.channels = 2;
                    if (l3 != "none") {
                        c.l3.size_bytes = 8 * kib;
                        c.l3.share = l3;
                    }
                    const Report r = run_busy_tiles(c, host_threads);
                    EXPECT_GT(r.network.counters.queue_cycles, 0U);
                    return r;
                },
                topology + (", L3 " + l3));
}

// So much is queued that requests would reach memory far out of order.
TEST(Network, HopelessNetworksStillEnd) {
    for (const char* topology : topologies) {
        Config c = with_l3(network_machine(topology, 6), 4);
        c.network.link_bytes = 1;
        c.network.request_bytes = c.network.reply_bytes = c.network.write_bytes = 256;
        c.l1.mshrs = c.l2.mshrs = c.l3.mshrs = 512;
        c.l2.write_back_buffer = 512;
        c.l1.size_bytes = c.l2.size_bytes = 4 * kib;
        c.l3.size_bytes = 64 * kib;
        const Report r = run_on(
            c,
            [](std::byte* base, int w) {
                for (int i = 0; i < 400; ++i)
                    isa::timing::store(here, base + (i * 6 + w) * 64, 4, stamp{}, stamp{});
            },
            6);
        EXPECT_GT(r.network.counters.queue_cycles / r.network.counters.messages(), 10000U) << topology;
        check_laws(r);
    }
}

// Nobody waits for what is prefetched last, but its reply is still on its way.
TEST(Network, AMachineIsNotQuietBeforeItsNetworkIs) {
    Config c = network_machine("mesh", 4);
    c.network.hop_cycles = 1000;
    const Report r = run_on(
        c,
        [](std::byte* base, int w) {
            if (w == 3)
                isa::timing::prefetch(here, base, stamp{});
        },
        4);
    EXPECT_LT(r.cycles, 100U);
    EXPECT_EQ(r.drained, u(c.l1.latency + c.l2.latency + 4 * 1000 + c.memory.controller_cycles +
                           c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks()) +
                             1 + 5);
}

} // namespace
} // namespace sim::test
