// What the network counts, with one line of meaning each.
#pragma once

#include "sim/memory/counters.h"

#include <string>
#include <vector>

namespace sim {

struct NetworkCounters {
    std::uint64_t requests = 0, replies = 0, writes = 0, words = 0;
    std::uint64_t bytes = 0, data_bytes = 0, flits = 0, hops = 0, byte_hops = 0, link_flits = 0;
    std::uint64_t latency_cycles = 0, queue_cycles = 0;

    std::uint64_t messages() const { return requests + replies + writes + words; }
};
inline constexpr std::array<CounterRow<NetworkCounters>, 12> network_counters = {{
    {"requests", &NetworkCounters::requests,
     "messages that ask for a line: of a tile, or of a cache beyond the tiles"},
    {"replies", &NetworkCounters::replies, "messages that bring a line"},
    {"writes", &NetworkCounters::writes, "messages with written data"},
    {"words", &NetworkCounters::words,
     "messages about lines: to caches beyond the tiles that one is to be dropped or dead; of a directory and "
     "to it (coherence.plain)"},
    {"bytes", &NetworkCounters::bytes, "of all messages"},
    {"data_bytes", &NetworkCounters::data_bytes, "of these, lines and written data"},
    {"flits", &NetworkCounters::flits, "of all messages: cycles that one takes on each of its links"},
    {"hops", &NetworkCounters::hops, "of all messages: links between routers, or ways through the crossbar"},
    {"byte_hops", &NetworkCounters::byte_hops, "bytes times hops, summed over messages"},
    {"link_flits", &NetworkCounters::link_flits,
     "cycles of all links, those from and to units included, in which they moved a flit"},
    {"latency_cycles", &NetworkCounters::latency_cycles,
     "from the cycle at which a message may leave until all of it is there, summed"},
    {"queue_cycles", &NetworkCounters::queue_cycles, "of these, waiting for links"},
}};

/// What a link moved: a flit a cycle.
struct LinkUse {
    std::string link;
    std::uint64_t flits = 0;
};

/// Of a run; an ideal network has no links.
struct NetworkReport {
    NetworkCounters counters;
    std::vector<LinkUse> links;

    bool ideal() const { return links.empty(); }
    /// The link that moved most.
    const LinkUse& busiest() const;
};

} // namespace sim
