#include "sim/validation/network_forms.h"

#include "isa/address_space.h"
#include "sim/machine/machine.h"
#include "sim/network/network.h"
#include "sim/validation/core_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace sim {
namespace {

constexpr integer line = 64, header = 8, width = 16, hop = 3;
constexpr integer request_flits = 1, line_flits = (line + header + width - 1) / width;

/// Each pair of `pairs` sends so many lines, in turn.
cycle last_arrival(const Config& c, const std::vector<std::pair<std::size_t, std::size_t>>& pairs, int each) {
    const cycle begin = 0;
    Network network(c, begin);
    cycle last = 0;
    for (int i = 0; i < each; ++i)
        for (const auto& [from, to] : pairs)
            last = std::max(
                last, network.send({Network::Message::write, from, to, static_cast<std::uint32_t>(line)}, 0));
    return last;
}

class Loads {
public:
    /// `messages`: that the busiest link takes of each of `pairs`, together.
    template <class Pair>
    void add(const std::string& topology, integer tiles, const char* name, const char* by, integer messages,
             Pair pair) {
        const Config c = network_machine(topology, tiles);
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (integer distance = 1; distance < tiles; ++distance) // everybody's first, then everybody's second
            for (integer from = 0; from < tiles; ++from)
                if (const integer to = (from + distance) % tiles; pair(from, to))
                    pairs.emplace_back(from, to);
        constexpr int each = 400;
        all_.push_back({fmt::format("{}, {} of {} tiles", name, topology, tiles), by,
                        static_cast<cycle>(messages * each * line_flits),
                        [c, pairs] { return last_arrival(c, pairs, each); }});
    }
    std::vector<NetworkLoad> take() { return std::move(all_); }

private:
    std::vector<NetworkLoad> all_;
};

} // namespace

Config network_machine(const std::string& topology, integer tiles) {
    Config c = plain_core();
    c.chip.tiles = tiles;
    c.chip.cores = c.chip.threads = 1;
    c.memory.clock_ps = c.chip.clock_ps;
    c.network.topology = topology;
    c.network.link_bytes = width;
    c.network.hop_cycles = hop;
    c.network.request_bytes = c.network.reply_bytes = c.network.write_bytes = header;
    return c;
}

integer hops_between(const Config& c, integer from, integer to) {
    const integer tiles = c.chip.tiles, apart = std::abs(from - to);
    if (c.network.topology == "crossbar")
        return 1;
    if (c.network.bus())
        return from * c.network.buses / tiles == to * c.network.buses / tiles ? 1 : 2;
    if (c.network.topology == "ring")
        return std::min(apart, tiles - apart);
    integer columns = 1;
    while (columns * columns < tiles || tiles % columns != 0)
        ++columns;
    return std::abs(from % columns - to % columns) + std::abs(from / columns - to / columns);
}

std::vector<NetworkPing> network_pings() {
    std::vector<NetworkPing> out;
    for (const char* topology : {"crossbar", "ring", "mesh", "bus"}) {
        const Config c = network_machine(topology, 12);
        out.push_back({fmt::format("{} of {} tiles", topology, c.chip.tiles), {}, {}});
        for (integer tile = 0; tile < c.chip.tiles; ++tile) {
            const integer way = hops_between(c, tile, 0) * hop;
            out.back().expected.push_back(static_cast<cycle>(
                c.l1.latency + c.l2.latency + way + request_flits + c.memory.controller_cycles +
                c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks() + way + line_flits));
            isa::address_space space{std::uint64_t{1} << 20};
            std::byte* data = space.add("data", -1, std::uint64_t{1} << 16, true);
            out.back().measured.push_back(Machine(c)
                                              .run(space, static_cast<int>(c.chip.tiles), {{"work"}},
                                                   [&](int worker) {
                                                       if (worker == tile)
                                                           isa::timing::load({"ping", 1}, data, 4, {});
                                                   })
                                              .cycles);
        }
    }
    return out;
}

std::vector<NetworkLoad> network_loads() {
    Loads loads;
    for (const char* topology : {"crossbar", "ring", "mesh", "bus"}) // 15 lines for each of tile 5
        loads.add(topology, 16, "all to one", "the link to it", 15,
                  [](integer, integer to) { return to == 5; });
    const auto all = [](integer, integer) { return true; };
    loads.add("crossbar", 16, "all to all", "each port", 15, all);
    // A link of a ring: n/2 - d sources at each distance d on either side of it, and half of those n/2 away.
    loads.add("ring", 16, "all to all", "each link, n^2 / 8", 32, all);
    loads.add("ring", 15, "all to all", "each link, (n^2 - 1) / 8", 28, all);
    // A row's middle link: its half of the row sends to all in the columns beyond.
    loads.add("mesh", 16, "all to all", "the middle links, 2 x 8", 16, all);
    loads.add("mesh", 64, "all to all", "the middle links, 4 x 32", 128, all);
    loads.add("mesh", 32, "all to all", "the middle links of 4 rows of 8, 4 x 16", 64, all);
    loads.add("bus", 16, "all to all", "the bus, n (n - 1)", 240, all);
    // Everybody sends across the middle.
    loads.add("ring", 16, "bisection", "each link, n / 4", 4,
              [](integer from, integer to) { return to == (from + 8) % 16; });
    loads.add("mesh", 64, "bisection", "a row's middle link, 4 each way", 4,
              [](integer from, integer to) { return from / 8 == to / 8 && from % 8 + to % 8 == 7; });
    return loads.take();
}

} // namespace sim
