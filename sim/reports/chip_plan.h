// Where the parts of a chip stand in its drawing: nested boxes of tiles, cores and caches, and lines of
// links. Nothing here says where parts lie on silicon; what is drawn beside each other is what shares
// something.
#pragma once

#include "sim/config/config.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace sim {

struct ChipPart {
    enum Kind {
        tile,
        core,
        cache,    // of `level`; an L1's is 0
        bank,     // of a cache beyond the tiles, of `level`
        router,   // of a ring or mesh
        backbone, // what all units of a crossbar or ideal network meet in, or the hub of buses
        channel   // of memory
    } kind = tile;
    unsigned level = 0;
    std::string name{};                         // with its number: what a pointer shows
    double x = 0, y = 0, width = 0, height = 0; // of its box, in pixels, from the upper left
    std::string label{};                        // shown where it fits
};

struct ChipLink {
    std::string name;                              // as in reports (Topology::link_name)
    std::vector<std::pair<double, double>> points; // right-angled, or the straight way to a router
    double width = 1;
};

/// Of one configuration. `links` are those of a network that has any (Topology::links()); an ideal one's ways
/// are `ways`, which take no time.
struct ChipPlan {
    std::vector<ChipPart> parts; // those that hold others come first
    std::vector<ChipLink> links, ways;
    double width = 0, height = 0;
};
ChipPlan plan_chip(const Config& config);

} // namespace sim
