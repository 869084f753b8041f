// The network between tiles and what lies beyond them: routes, hand-derived cycles, what machines send over
// it, and what must not depend on it.
#include "sim/network/network.h"

#include "sim/machine/describe.h"
#include "sim/machine/energy.h"
#include "sim/machine/limits.h"
#include "sim/machine/windows.h"
#include "sim/network/figures.h"
#include "sim/network/ways.h"
#include "sim/validation/network_forms.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <map>
#include <random>

namespace sim::test {
namespace {

using Message = Network::Message;

constexpr std::array topologies = {"crossbar", "ring", "mesh"};
constexpr cycle none = 0;
constexpr integer kib = 1024;

/// An L3 of all tiles.
Config with_l3(Config c, integer banks) {
    c.l3.size_bytes = 1024 * kib;
    c.l3.share = "chip";
    c.l3.banks = banks;
    return c;
}
std::uint64_t flits(const Config& c, integer bytes) {
    return u((bytes + c.network.link_bytes - 1) / c.network.link_bytes);
}

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
    c.l3.share = "4";
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
                            n.send(Message::write, u(from), u(to), static_cast<std::uint32_t>(data), 100),
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
    EXPECT_EQ(n.send(Message::write, 0, 2, 64, 0), 11U);
    // 1 to 2 in 1, 2, 8, 9, 10, so that its last flit is at 2 in 13; the link to 2 in 11..15, in order of
    // call.
    EXPECT_EQ(n.send(Message::write, 1, 2, 64, 1), 16U);
    EXPECT_EQ(n.counters().queue_cycles, 16U - 1 - 3 - 5);
    // One flit from 3: nobody was on 3 to 2, the link to 2 is taken in 6..15.
    EXPECT_EQ(n.send(Message::request, 3, 2, 0, 4), 17U);
    EXPECT_EQ(n.send(Message::request, 3, 2, 0, 1), 5U); // before all of them
    EXPECT_EQ(n.counters().link_flits, 4 * 5U + 3 * 5U + 3 + 3);
    EXPECT_EQ(n.counters().hops, 2 + 1 + 1 + 1U);
    EXPECT_EQ(n.report().busiest().link, "to tile 2");
    EXPECT_EQ(n.report().busiest().flits, 12U);
    EXPECT_EQ(n.quiet(), 17U);
}

// A tile's own link takes a flit a cycle, in order.
TEST(Network, ASenderWaitsForItsOwnMessages) {
    for (const char* topology : topologies) {
        Network n(network_machine(topology, 4), none);
        for (cycle i = 0; i < 10; ++i)
            EXPECT_EQ(n.send(Message::write, 0, 1, 64, 0), 3 + 5 * (i + 1)) << topology;
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
        ASSERT_EQ(n.send(Message::write, 0, 1, data, t), there.second + 1) << i;
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

// --- machines

Report read_lines(const Config& c, int lines, integer reader, std::int64_t apart = 64,
                  std::int64_t first = 0) {
    return run_on(
        c,
        [=](std::byte* base, int w) {
            stamp s;
            for (int i = 0; w == reader && i < lines; ++i)
                s = load(here, base + (first + i) * apart, 4, s);
        },
        static_cast<int>(c.chip.tiles));
}

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
                const integer hops = hops_between(c, reader, 3 * bank) + hops_between(c, 3 * bank, 0);
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
            const std::uint64_t line = flits(c, 64 + c.network.reply_bytes);
            const std::uint64_t most = writes ? r.network.counters.data_bytes / 64 * line : 8 * lines * line;
            EXPECT_EQ(r.network.counters.writes != 0, writes);
            EXPECT_GE(r.drained, most);
            EXPECT_LE(r.drained, most * 102 / 100) << topology << (writes ? " writes" : " reads");
            EXPECT_STREQ(binding(limits(r)).resource, "network");
            EXPECT_EQ(limiter(r).find("network"), 0U);
            EXPECT_EQ(r.network.busiest().link, writes ? "to channel 0" : "from channel 0");
        }
}

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
        const Report dead = run_on(c, [=](std::byte* base, int) {
            for (int i = 0; i < 512; ++i)
                isa::timing::store(here, base + i * 64, 4, stamp{}, stamp{});
            stamp s;
            for (int i = 512; i < 2048; ++i) // all of them are in the L3 now
                s = load(here, base + i * 64, 4, s);
            if (discarded)
                for (int i = 0; i < 512; ++i)
                    isa::timing::discard(here, base + i * 64, 64, s);
            for (int i = 2048; i < 40000; ++i)
                s = load(here, base + i * 64, 4, s);
        });
        EXPECT_EQ(dead.memory.writes, discarded ? 0U : 512U);
        EXPECT_EQ(dead.network.counters.words, discarded ? 512U : 0U);
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

std::string without_window(Report r) {
    r.window = 0;
    r.config.sim.window = 0;
    for (CacheCounters& l2 : r.l2)
        l2.hits_in_flight = 0; // a line that comes while its bank is busy may count or not
    return print_json(r, false);
}

// As for a machine without a network (tests/sim/tiles.cpp), though the window is longer.
TEST(Network, WindowsUpToTheShortestWayChangeNothing) {
    for (const char* topology : topologies) {
        std::map<integer, std::string> reports;
        for (const integer window : {1, 7, 20, 0}) {
            Config c;
            c.chip.tiles = 1;
            c.chip.cores = 4;
            c.chip.threads = 2;
            c.core.window = 1;
            c.network.topology = topology;
            c.network.hop_cycles = 25;
            c.sim.window = window;
            c.l1.mshrs = c.l1.write_back_buffer = c.l2.mshrs = c.l2.write_back_buffer = 256;
            Memory memory;
            auto* words = reinterpret_cast<word*>(memory.data);
            auto* data = reinterpret_cast<std::int32_t*>(memory.more);
            reports[window] = without_window(Machine(c).run(
                memory.space, 8, {{"work"}}, [&](int w) { mixed_work(data, words + 16 * w, w, 60); }));
        }
        for (const auto& [window, text] : reports)
            EXPECT_EQ(text, reports[0]) << topology << ", window " << window;
    }
}

TEST(Network, ReportsDoNotDependOnHostThreads) {
    for (const char* topology : topologies)
        for (const char* l3 : {"none", "chip", "4"}) {
            std::map<int, std::string> reports;
            for (const int host_threads : {1, 2, 3, 8}) {
                Config c;
                c.chip.tiles = 6;
                c.chip.cores = 2;
                c.core.window = 8;
                c.sim.quantum = 1000;
                c.sim.window = 200;
                c.l2.share = "core";
                c.l2.size_bytes = 4 * kib;
                c.network.topology = topology;
                c.network.link_bytes = 2;
                c.memory.channels = 2;
                if (l3 != std::string("none")) {
                    c.l3.size_bytes = 8 * kib;
                    c.l3.share = l3;
                }
                Memory memory;
                auto* words = reinterpret_cast<word*>(memory.data);
                auto* data = reinterpret_cast<std::int32_t*>(memory.more);
                const Report r = Machine(c).run(
                    memory.space, 24, {{"work"}},
                    [&](int w) { mixed_work(data + 4096 * (w / 3), words + w % 3 * 16, w, 10); },
                    host_threads);
                EXPECT_GT(r.network.counters.queue_cycles, 0U);
                reports[host_threads] = print_json(r, false);
            }
            for (const int host_threads : {2, 3, 8})
                EXPECT_EQ(reports[host_threads], reports[1])
                    << topology << ", L3 " << l3 << ", " << host_threads << " host threads";
        }
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
    const auto mistake = [](const std::string& text) -> std::string {
        try {
            parse_machine(text, "m.toml");
        } catch (const ConfigError& e) {
            return e.what();
        }
        return "";
    };
    const std::string mesh = "[chip]\ntiles = 6\n[network]\ntopology = \"mesh\"\n";
    EXPECT_EQ(mistake(mesh + "columns = 3\n"), "");
    EXPECT_NE(mistake(mesh + "columns = 4\n").find("which does not divide chip.tiles, 6"), std::string::npos);
    EXPECT_NE(mistake("[network]\ntopology = \"torus\"\n").find("must be one of"), std::string::npos);
    EXPECT_NE(mistake("[network]\nlink_bytes = 0\n"), "");
}

} // namespace
} // namespace sim::test
