// The tree of lights that are chosen from, as kernels read it.
#pragma once

#include "razor/frame/line.h"

namespace razor {

/// Depth first: the first child of a node follows it. Node 0 is the root.
struct alignas(line_bytes) LightNode {
    float low[3], high[3]; // of where the lights are, scene coordinates
    float axis[3];         // unit: emission is about it, ...
    float cos_normals;     // ... normals within this angle, ...
    float cos_emission;    // ... and from each of them within this; cosines
    float power;           // of all below, by how bright each is along its normal
    std::int32_t second;   // child; of a leaf -1 - its light
    std::int32_t next;     // node after all that is below
    std::int32_t parent;   // -1: the root
    std::int32_t padding;
};
static_assert(sizeof(LightNode) == line_bytes);

} // namespace razor
