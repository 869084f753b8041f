// What a worker counts: instrumentation of the host, not part of the machine.
#pragma once

#include "razor/frame/ray_kinds.h"

#include <cstdint>

namespace razor {

struct Counters {
    std::int64_t rays = 0;
    std::int64_t camera_hits = 0;
    std::int64_t bounce_hits = 0; // these and the camera's are shaded, once each
    std::int64_t packets = 0;     // rays / (packets x width) is their utilisation
    std::int64_t groups = 0;      // of rays alike in direction, traversed one after the other
    std::int64_t node_visits = 0, box_tests = 0, block_tests = 0, cell_tests = 0, quad_tests = 0;
    std::int64_t graph_openings = 0, cluster_openings = 0; // once a kd node that needs it
    std::int64_t patches_opened = 0, blocks_made = 0, vertices_made = 0, triangles_made = 0;
    std::int64_t plain_tests = 0;    // of the block tests, those of some ray at the block's anchors ...
    std::int64_t blended_tests = 0;  // ... and those of one field's rays with the block blended for them
    std::int64_t blended_blocks = 0; // blendings, for tests and for shading
    std::int64_t finest_blocks = 0;  // of the blocks made, those of level 0
    std::int64_t normal_blocks = 0;  // blocks whose normals were asked for
    std::int64_t textured_hits = 0;  // that are shaded, where textures make something of the surface
    std::int64_t shading_evaluations =
        0;                             // of all of a surface's textures, at hits or at vertices (phase one)
    std::int64_t grid_evaluations = 0; // of these, at vertices ...
    std::int64_t grid_lanes = 0;       // ... in so many lanes
    std::int64_t pages_requested = 0;
    std::int64_t waits = 0;          // for what another worker was building
    std::int64_t steals = 0;         // of other workers' stretches of the screen ...
    std::int64_t stolen_strides = 0; // ... so much together
    std::int64_t meanwhile_runs = 0; // of tiles rendered in place of a wait
    std::int64_t lost_races = 0;     // takes and steals tried again, as another worker was faster

    Counters& operator+=(const Counters& o);
    Counters& operator-=(const Counters& o);
};

/// Of each kind of ray what tracing its packets took and built, and of kind_none all else.
struct CountersByKind {
    Counters kind[kind_count];

    Counters sum() const;
    CountersByKind& operator+=(const CountersByKind& o);
    CountersByKind& operator-=(const CountersByKind& o);
};

/// Name and value of each counter, in order.
template <class Visit> void for_each_counter(const Counters& c, Visit visit) {
    visit("rays", c.rays);
    visit("camera_hits", c.camera_hits);
    visit("bounce_hits", c.bounce_hits);
    visit("packets", c.packets);
    visit("groups", c.groups);
    visit("node_visits", c.node_visits);
    visit("box_tests", c.box_tests);
    visit("block_tests", c.block_tests);
    visit("cell_tests", c.cell_tests);
    visit("quad_tests", c.quad_tests);
    visit("graph_openings", c.graph_openings);
    visit("cluster_openings", c.cluster_openings);
    visit("patches_opened", c.patches_opened);
    visit("blocks_made", c.blocks_made);
    visit("vertices_made", c.vertices_made);
    visit("triangles_made", c.triangles_made);
    visit("plain_tests", c.plain_tests);
    visit("blended_tests", c.blended_tests);
    visit("blended_blocks", c.blended_blocks);
    visit("finest_blocks", c.finest_blocks);
    visit("normal_blocks", c.normal_blocks);
    visit("textured_hits", c.textured_hits);
    visit("shading_evaluations", c.shading_evaluations);
    visit("grid_evaluations", c.grid_evaluations);
    visit("grid_lanes", c.grid_lanes);
    visit("pages_requested", c.pages_requested);
    visit("waits", c.waits);
    visit("steals", c.steals);
    visit("stolen_strides", c.stolen_strides);
    visit("meanwhile_runs", c.meanwhile_runs);
    visit("lost_races", c.lost_races);
}

} // namespace razor
