// The phases of a frame, as reports name them.
#pragma once

namespace razor {

enum Phase : int {
    phase_animate,    // moving what is animated, refitting bounds
    phase_build,      // kd-tree nodes and item lists
    phase_tessellate, // patches to blocks
    phase_shade,      // the tile loop, camera rays, normals, materials
    phase_traverse,   // kd-tree descent
    phase_intersect,  // blocks
    phase_morph,      // blocks between two levels, as one ray's footprint blends them
    phase_light,      // light samples, shadow rays' contributions
    phase_resolve,    // the film
    phase_count
};
inline constexpr const char* phase_names[phase_count] = {
    "animate", "build", "tessellate", "shade", "traverse", "intersect", "morph", "light", "resolve"};

/// What is timed on the host, each when it first happens in a frame.
enum Moment : int { moment_refitted, moment_first_packet, moment_count };

} // namespace razor
