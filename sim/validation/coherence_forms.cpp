#include "sim/validation/coherence_forms.h"

#include "isa/address_space.h"
#include "sim/core/stalls.h"
#include "sim/machine/engine.h"
#include "sim/validation/network_forms.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

using namespace isa::timing;

constexpr site here{"coherence form", 1};
constexpr integer delay = 1000; // of an addition, four of which are the gap

integer words(const Config& c) {
    return flits_of(c.network, c.network.request_bytes);
}
integer lines(const Config& c) {
    return flits_of(c.network, c.network.reply_bytes + c.l2.line_bytes);
}
integer way(const Config& c, integer from, integer to) {
    return hops_between(c, from, to) * c.network.hop_cycles;
}
/// Until the directory, at tile 0, has looked up what a tile asks for; beside the tags of an L3, if there is
/// one.
integer known(const Config& c, integer tile) {
    return c.l1.latency + c.l2.latency + way(c, tile, 0) + words(c) + c.coherence.directory_cycles +
           (c.l3.size_bytes != 0 ? c.l3.latency : 0);
}
/// A line that another tile has, and brings.
cycle forwarded(const Config& c, integer from, integer to) {
    return static_cast<cycle>(known(c, to) + way(c, 0, from) + words(c) + c.l2.latency + way(c, from, to) +
                              lines(c));
}
/// A line that nobody has changed, from memory.
cycle fetched(const Config& c, integer tile) {
    return static_cast<cycle>(known(c, tile) + c.memory.controller_cycles + c.memory.tCL +
                              c.memory.burst_clocks() + way(c, 0, tile) + lines(c));
}

/// On `buses` buses of a machine whose tiles see each other's requests: until all of a request is on the bus
/// of tile `to`, and until `who`, of another bus perhaps, has said what it has of the line.
integer on_bus(const Config& c) {
    return c.l1.latency + c.l2.latency + c.network.hop_cycles + words(c);
}
integer bus_of(const Config& c, integer tile) {
    return tile * c.network.buses / c.chip.tiles;
}
/// The hub tells one bus after the other, each in a message of as many cycles as a word has.
integer said(const Config& c, integer to, integer who) {
    const integer own = bus_of(c, to), other = bus_of(c, who);
    const integer earlier = other - (own < other ? 1 : 0);
    return on_bus(c) + (own == other ? 0 : c.network.hop_cycles + words(c) * (earlier + 1)) +
           c.coherence.snoop_cycles;
}
/// Until all have.
integer all_said(const Config& c, integer to) {
    integer last = 0;
    for (integer bus = 0; bus < c.network.buses; ++bus)
        last = std::max(last, said(c, to, bus * c.chip.tiles / c.network.buses));
    return last;
}
cycle brought(const Config& c, integer from, integer to) {
    return static_cast<cycle>(said(c, to, from) + c.l2.latency + way(c, from, to) + lines(c));
}
cycle fetched_over_bus(const Config& c, integer tile) {
    const integer memory = c.memory.controller_cycles + c.memory.tCL + c.memory.burst_clocks();
    const integer below = on_bus(c) + (c.l3.size_bytes != 0 ? c.l3.latency : memory);
    return static_cast<cycle>(std::max(below, all_said(c, tile)) + c.network.hop_cycles + lines(c));
}
/// Through an L3 at the hub, as is memory, from a row that is not open.
cycle fetched_through_l3(const Config& c, integer tile) {
    const integer memory =
        c.memory.controller_cycles + c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks();
    const integer below = on_bus(c) + c.l3.latency + words(c) + memory + lines(c);
    return static_cast<cycle>(std::max(below, all_said(c, tile)) + c.network.hop_cycles + lines(c));
}

/// What machines whose tiles see each other's requests take, without a cache beyond these, or with an L3.
void add_snoops_of(const Config& c, const std::string& where, std::vector<CoherenceForm>& out) {
    const bool l3 = c.l3.size_bytes != 0;
    const auto add = [&](const char* name, const char* by, const std::vector<TimedAccess>& accesses,
                         const std::vector<cycle>& expected) {
        out.push_back({fmt::format("{}, {}", name, where), by, expected, {}});
        act_in_turn(c, accesses, &out.back().measured);
    };
    std::vector<TimedAccess> accesses = {{1, 0, true}};
    std::vector<cycle> expected;
    for (int turn = 0; turn < 10; ++turn)
        for (const auto& [from, to] : {std::pair(1, 10), std::pair(10, 1)}) {
            accesses.insert(accesses.end(), {{to, 0, false}, {to, 0, true}});
            expected.push_back(brought(c, from, to));
        }
    add("ping-pong", "request, what the owner says, line", accesses, expected);
    accesses.clear();
    expected.clear();
    for (int turn = 0; turn < 5; ++turn) {
        accesses.insert(accesses.end(), {{4, 0, true}, {9, 0, false}, {2, 0, false}, {11, 0, false}});
        expected.insert(expected.end(), {brought(c, 4, 9), fetched_over_bus(c, 2), fetched_over_bus(c, 11)});
    }
    add("a producer and three consumers",
        l3 ? "a line brought, the others from the L3" : "a line brought, the others from memory's open row",
        accesses, expected);
    // A line that nobody has, then one that its reader alone has.
    if (l3)
        add("a line that the L3 lacks", "request, L3, memory, line; then from who has it",
            {{4, 0, false}, {9, 0, false}}, {fetched_through_l3(c, 4), brought(c, 4, 9)});
    out.push_back({fmt::format("upgrade, {}", where),
                   "request, what all say",
                   {static_cast<cycle>(2 * access_gap + 1 + all_said(c, 5))},
                   {}});
    out.back().measured.push_back(0);
    const Report r = act_in_turn(c, {{7, 0, false}, {5, 0, false}, {5, 0, true}});
    for (const ThreadReport& t : r.threads)
        if (t.tile == 5)
            out.back().measured.front() = t.finish;
}

void add_snoops(const std::string& mode, std::vector<CoherenceForm>& out) {
    for (const integer buses : {1, 2, 3})
        for (const integer snoop_cycles : {4, 90}) { // sooner and later than memory, and an L3
            Config c = coherent_machine("bus", 12, mode);
            c.coherence.plain = "snoop";
            c.network.buses = buses;
            c.coherence.snoop_cycles = snoop_cycles;
            const std::string where = fmt::format("{} of 12 tiles, snooped in {}",
                                                  buses == 1   ? "a bus"
                                                  : buses == 2 ? "two buses"
                                                               : "three buses",
                                                  snoop_cycles);
            add_snoops_of(c, where, out);
            c.l3.size_bytes = 1 << 20;
            c.l3.share = "chip";
            add_snoops_of(c, where + " above an L3", out);
        }
}

} // namespace

Config coherent_machine(const std::string& topology, integer tiles, const std::string& mode) {
    Config c = network_machine(topology, tiles);
    c.sim.mode = mode;
    if (mode == "reference") {
        c.memory.controller = "queued";
        c.sim.quantum = c.sim.window = 0;
    }
    c.coherence.plain = "directory";
    c.coherence.directory_cycles = 5;
    c.l2.inclusion = "inclusive";
    c.memory.tREFI = 0;
    c.memory.controller_cycles = 0;
    return c;
}

Report act_in_turn(const Config& config, const std::vector<TimedAccess>& accesses,
                   std::vector<cycle>* latencies) {
    Config c = config;
    c.latency[static_cast<std::size_t>(operation::add)] = delay;
    const int threads = static_cast<int>(c.chip.threads), cores = static_cast<int>(c.chip.cores);
    c.chip.placement = "pack";
    isa::address_space space{std::uint64_t{1} << 20};
    std::byte* data = space.add("data", -1, std::uint64_t{1} << 16, true);
    std::vector<cycle> taken(accesses.size());
    const Report r = Machine(c).run(space, static_cast<int>(c.all_threads()), {{"work"}}, [&](int worker) {
        stamp clock;
        for (std::size_t i = 0; i < accesses.size(); ++i) {
            const TimedAccess& a = accesses[i];
            std::byte* p = data + a.word * 4;
            const bool acts = (a.tile * cores + a.core) * threads == worker;
            if (acts && a.write)
                store(here, p, 4, clock, stamp{});
            if (acts && !a.write) {
                const cycle since = clock.last;
                const stamp s = load(here, p, 4, clock);
                const cycle there =
                    is_ticket(s.last) ? running_engine->await(*running_hart, s.last).last : s.last;
                taken[i] = there - since;
            }
            if (i + 1 == accesses.size())
                break;
            for (integer t = 0; t < access_gap; t += delay)
                clock = scalar_op(operation::add, clock);
        }
    });
    if (latencies != nullptr) {
        latencies->clear();
        for (std::size_t i = 0; i < accesses.size(); ++i)
            if (!accesses[i].write)
                latencies->push_back(taken[i]);
    }
    return r;
}

std::vector<CoherenceForm> coherence_forms(const std::string& mode) {
    std::vector<CoherenceForm> out;
    const auto add = [&out](const char* name, const std::string& topology, const char* by, const Config& c,
                            const std::vector<TimedAccess>& accesses, const std::vector<cycle>& expected) {
        out.push_back({fmt::format("{}, {} of {} tiles", name, topology, c.chip.tiles), by, expected, {}});
        act_in_turn(c, accesses, &out.back().measured);
    };
    for (const std::string topology : {"crossbar", "ring", "mesh"}) {
        const Config c = coherent_machine(topology, 12, mode);
        // Each reads the word that the other wrote, and writes it.
        std::vector<TimedAccess> accesses = {{1, 0, true}};
        std::vector<cycle> expected;
        for (int turn = 0; turn < 10; ++turn)
            for (const auto& [from, to] : {std::pair(1, 6), std::pair(6, 1)}) {
                accesses.insert(accesses.end(), {{to, 0, false}, {to, 0, true}});
                expected.push_back(forwarded(c, from, to));
            }
        add("ping-pong", topology, "request, look-up, forward, line", c, accesses, expected);
        // With the directory at the only bank of an L3, where others read what is written back.
        Config l3 = c;
        l3.l3.size_bytes = 1 << 20;
        l3.l3.share = "chip";
        l3.l3.banks = 1;
        const cycle from_l3 = static_cast<cycle>(known(l3, 10) + way(l3, 0, 10) + lines(l3));
        std::vector<TimedAccess> more = accesses;
        std::vector<cycle> longer;
        for (const cycle t : expected)
            longer.push_back(t + static_cast<cycle>(l3.l3.latency));
        more.insert(more.end(), {{6, 0, false}, {10, 0, false}});
        longer.insert(longer.end(), {forwarded(l3, 1, 6), from_l3});
        add("ping-pong above an L3", topology, "request, L3 and look-up, forward, line", l3, more, longer);
        // Cores of a tile: what one has changed comes from its L1, what both have from the L2.
        Config cores = c;
        cores.chip.cores = 3;
        const auto l2 = static_cast<cycle>(c.l1.latency + c.l2.latency),
                   l1 = static_cast<cycle>(c.l1.latency);
        add("a neighbour core's line", topology, "L1 and L2, and the other L1", cores,
            {{2, 0, true, 0},
             {2, 0, false, 1},
             {2, 0, false, 2},
             {2, 0, false, 1},
             {2, 0, true, 1},
             {2, 0, false, 0}},
            {l2 + l1, l2, l1, l2 + l1});
        // The first to read gets it from who wrote it, the others from memory.
        accesses.clear();
        expected.clear();
        for (int turn = 0; turn < 5; ++turn) {
            accesses.insert(accesses.end(), {{4, 0, true}, {9, 0, false}, {2, 0, false}, {11, 0, false}});
            expected.insert(expected.end(), {forwarded(c, 4, 9), fetched(c, 2), fetched(c, 11)});
        }
        add("a producer and three consumers", topology, "a line brought, the others from memory's open row",
            c, accesses, expected);
        // Words of two tiles, which neither the other reads, in a line; and in one of their own.
        for (const int apart : {1, 16}) {
            accesses = {{3, 0, true}, {8, apart, true}};
            expected.clear();
            for (int turn = 0; turn < 10; ++turn) {
                accesses.insert(accesses.end(),
                                {{3, 0, false}, {3, 0, true}, {8, apart, false}, {8, apart, true}});
                if (apart == 1)
                    expected.insert(expected.end(), {forwarded(c, 8, 3), forwarded(c, 3, 8)});
                else
                    expected.insert(expected.end(), 2, static_cast<cycle>(c.l1.latency));
            }
            add(apart == 1 ? "false sharing" : "no sharing", topology,
                apart == 1 ? "as a ping-pong" : "hits of the L1", c, accesses, expected);
        }
        // A directory with room for one line recalls it from who has it before another one is read.
        Config small = c;
        small.coherence.directory_entries = small.coherence.directory_ways = 1;
        const auto recalled = [&](integer from, integer to) {
            return fetched(c, to) + static_cast<cycle>(2 * way(c, 0, from) + 2 * words(c) + c.l2.latency);
        };
        add("two lines and a directory with room for one", topology,
            "request, look-up, recall, answer, memory's open row", small,
            {{4, 0, false}, {9, 16, false}, {2, 0, false}, {11, 16, false}, {9, 0, false}},
            {fetched(c, 4) + static_cast<cycle>(c.memory.tRCD), recalled(4, 9), recalled(9, 2),
             recalled(2, 11), recalled(11, 9)});
        // A write of what another has: it is done when that one has said that it dropped it.
        const std::vector<TimedAccess> shared = {{7, 0, false}, {5, 0, false}, {5, 0, true}};
        const integer grant = words(c); // to the writer, goes first from the directory
        const integer told =
            known(c, 5) + grant + way(c, 0, 7) + words(c) + c.l2.latency + way(c, 7, 5) + words(c);
        out.push_back({fmt::format("upgrade, {} of {} tiles", topology, c.chip.tiles),
                       "request, look-up, invalidation, acknowledgement",
                       {static_cast<cycle>(2 * access_gap + 1 + told)},
                       {}});
        out.back().measured.push_back(0);
        const Report r = act_in_turn(c, shared);
        for (const ThreadReport& t : r.threads)
            if (t.tile == 5)
                out.back().measured.front() = t.finish;
    }
    add_snoops(mode, out);
    return out;
}

} // namespace sim
