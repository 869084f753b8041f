#include "sim/validation/network_order.h"

#include "isa/address_space.h"
#include "sim/machine/machine.h"
#include "sim/network/flights.h"
#include "sim/validation/coherence_forms.h"
#include "sim/validation/network_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <queue>
#include <random>
#include <set>
#include <tuple>

namespace sim {
namespace {

struct Hop {
    std::size_t link;
    cycle later; // from its first flit here to that on the next link
};

std::vector<Hop> way(const Config& c, const Topology& topology, const Network::Leg& leg) {
    const auto hop = static_cast<cycle>(c.network.hop_cycles);
    std::vector<Hop> out{{topology.link_from(leg.from), c.network.topology == "crossbar" ? hop : 0}};
    topology.walk(leg.from, leg.to, [&](std::size_t link) { out.push_back({link, hop}); });
    out.push_back({topology.link_to(leg.to), 0});
    return out;
}

/// Cycles of a link that are taken.
using List = std::set<cycle>;

/// Takes the first free ones from `t` on; returns the first and last of them.
std::pair<cycle, cycle> take(List& taken, cycle t, cycle count) {
    cycle first = 0;
    for (cycle had = 0;; ++t)
        if (taken.insert(t).second) {
            first = had == 0 ? t : first;
            if (++had == count)
                return {first, t};
        }
}

/// Knows from which cycle on a known line of messages may be sent: `ahead` before it leaves.
cycle known(const NetworkMessage& m, cycle ahead) {
    return m.comes_back() ? m.sent - ahead : m.sent;
}

std::vector<std::size_t> in_order(const std::vector<NetworkMessage>& messages, cycle ahead) {
    std::vector<std::size_t> order(messages.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return known(messages[a], ahead) < known(messages[b], ahead);
    });
    return order;
}

} // namespace

std::vector<NetworkMessage> network_traffic(const Config& c, double load, std::size_t count,
                                            std::uint32_t seed) {
    using Message = Network::Message;
    const Topology topology(c);
    cycle earliest = 0;
    const Network network(c, earliest);
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return std::size_t{random()} % n; };
    const auto line = static_cast<std::uint32_t>(c.last_cache().line_bytes);
    std::vector<NetworkMessage> messages(count);
    std::vector<double> use(topology.links());
    for (NetworkMessage& m : messages) {
        const std::size_t tile = topology.tile(below(topology.tiles())),
                          channel = topology.channel(below(topology.channels()));
        switch (below(7)) {
        case 5:
            m.leg = {Message::word, channel, tile, 0};
            break;
        case 6:
            m.leg = {Message::word, tile, (tile + 1) % topology.tiles(), 0, true};
            break;
        case 0:
            m.leg = {Message::write, tile, channel, line};
            break;
        case 1:
        case 2:
            m.leg = {Message::request, tile, channel, 0};
            break;
        default:
            m.leg = {Message::reply, channel, tile, line};
        }
        for (const Hop& h : way(c, topology, m.leg))
            use[h.link] += network.flits(m.leg);
    }
    const auto cycles = static_cast<std::size_t>(*std::max_element(use.begin(), use.end()) / load);
    constexpr cycle begin = 1000;
    for (NetworkMessage& m : messages)
        m.sent = begin + below(cycles);
    std::stable_sort(messages.begin(), messages.end(),
                     [](const NetworkMessage& a, const NetworkMessage& b) { return a.sent < b.sent; });
    return messages;
}

std::vector<cycle> arrivals_by_lists(const Config& c, const std::vector<NetworkMessage>& messages) {
    struct Event {
        cycle at;
        std::size_t hop, number;
        bool operator>(const Event& e) const {
            return std::tie(at, hop, number) > std::tie(e.at, e.hop, e.number);
        }
    };
    const Topology topology(c);
    cycle earliest = 0;
    const Network network(c, earliest);
    std::vector<List> links(topology.links());
    std::vector<cycle> there(messages.size());
    for (const bool back : {true, false}) {
        std::priority_queue<Event, std::vector<Event>, std::greater<>> events;
        for (std::size_t i = 0; i < messages.size(); ++i)
            if (messages[i].comes_back() == back)
                events.push({messages[i].sent, 0, i});
        while (!events.empty()) {
            const Event e = events.top();
            events.pop();
            const Network::Leg& leg = messages[e.number].leg;
            const std::vector<Hop> hops = way(c, topology, leg);
            const cycle flits = network.flits(leg);
            const auto [first, last] = take(links[hops[e.hop].link], e.at, flits);
            // No flit goes on before it has come.
            const cycle head = std::max(first, last + 1 - flits) + hops[e.hop].later;
            if (e.hop + 1 < hops.size())
                events.push({head, e.hop + 1, e.number});
            else
                there[e.number] = last + 1;
        }
    }
    return there;
}

std::vector<cycle> arrivals_of_flights(const Config& c, const std::vector<NetworkMessage>& messages,
                                       cycle ahead) {
    cycle earliest = 0;
    Network network(c, earliest);
    Flights flights(network, ahead);
    std::vector<cycle> there(messages.size());
    const auto fly = [&](cycle until) {
        while (flights.next() < until) {
            earliest = flights.next();
            if (const auto a = flights.step())
                there[a->id] = a->at;
        }
    };
    for (const std::size_t i : in_order(messages, ahead)) {
        fly(known(messages[i], ahead));
        flights.send(i, messages[i].leg, messages[i].sent);
    }
    fly(Flights::never);
    return there;
}

std::vector<cycle> arrivals_at_once(const Config& c, const std::vector<NetworkMessage>& messages,
                                    cycle ahead) {
    cycle earliest = 0;
    Network network(c, earliest);
    std::vector<cycle> there(messages.size());
    for (const std::size_t i : in_order(messages, ahead)) {
        earliest = known(messages[i], ahead);
        there[i] = network.send(messages[i].leg, messages[i].sent);
    }
    return there;
}

std::vector<NetworkOrder> network_orders() {
    std::vector<NetworkOrder> out;
    for (const char* topology : {"crossbar", "ring", "mesh", "bus"})
        for (const double load : {0.3, 0.6, 0.9}) {
            Config c = network_machine(topology, 16);
            c.memory.channels = 4;
            out.push_back({fmt::format("{} of {} tiles, {:.0f} % busy", topology, c.chip.tiles, 100 * load),
                           c, network_traffic(c, load, 20000, 1)});
        }
    return out;
}

namespace {

/// Loads and stores of few lines, and loads of many, by all threads, as chance wants it.
CoherentOrder fight(const std::string& name, const Config& c) {
    using namespace isa::timing;
    static constexpr site here{"network order", 1};
    constexpr int accesses = 300;
    isa::address_space space{std::uint64_t{1} << 26};
    std::byte* few = space.add("data", -1, std::uint64_t{1} << 16, true);
    std::byte* many = space.add("data", -1, std::uint64_t{1} << 20, true);
    CoherentOrder out{{name, c, {}}, 0};
    RunOptions options;
    options.messages = &out.order.messages;
    const Report r = Machine(c).run(
        space, static_cast<int>(c.all_threads()), {{"work"}},
        [&](int worker) {
            std::mt19937 random(static_cast<std::uint32_t>(worker));
            stamp last;
            for (int i = 0; i < accesses; ++i) {
                std::byte* line = few + random() % 48 * 64;
                switch (random() % 4) {
                case 0:
                    store(here, line, 4, last, stamp{});
                    break;
                case 1:
                    load(here, many + random() % 8192 * 64, 4, last);
                    break;
                default:
                    last = load(here, line, 4, last);
                }
            }
        },
        1, options);
    out.counted = r.network.counters.messages();
    return out;
}

} // namespace

std::vector<CoherentOrder> coherent_orders() {
    std::vector<CoherentOrder> out;
    for (const std::string topology : {"crossbar", "ring", "mesh", "bus"}) {
        Config c = coherent_machine(topology, 9, "reference");
        c.network.link_bytes = 8; // so that messages meet
        c.memory.channels = 2;
        const auto add = [&](const std::string& what, const Config& machine) {
            out.push_back(fight(fmt::format("{} of {} tiles, {}", topology, c.chip.tiles, what), machine));
        };
        if (topology == "bus") {
            c.coherence.plain = "snoop";
            c.network.buses = 3;
            add("snooped", c);
            c.l3.size_bytes = 1 << 20;
            c.l3.share = "chip";
            c.l3.banks = 2;
            add("snooped above an L3", c);
            continue;
        }
        add("directories", c);
        Config few = c;
        few.coherence.directory_ways = 2;
        few.coherence.directory_entries = 8;
        add("directories of 8 lines", few);
        c.l3.size_bytes = 1 << 20;
        c.l3.share = "chip";
        c.l3.banks = 2;
        add("directories at an L3", c);
    }
    return out;
}

} // namespace sim
