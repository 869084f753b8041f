// Surfaces that are lights, as kernels read them.
#pragma once

#include "razor/frame/line.h"

namespace razor {

/// A triangle of a surface that emits, over which points are sampled evenly: its corners lie on the surface.
/// So often is each sampled, by its area and radiance, that the density by area is one for all of a material.
struct alignas(line_bytes) EmitterRecord {
    float corner[3]; // scene coordinates
    float edge_u[3]; // to the other two; counter-clockwise seen from the front
    float edge_v[3];
    float radiance[3];     // the mean of maps and all, / (pi x density by area)
    float domain;          // 1 / density by area
    float margin;          // by which its triangle may be off it, along a ray
    std::int32_t instance; // whose surface it is
    std::int32_t material; // and its material
};
static_assert(sizeof(EmitterRecord) == line_bytes);

/// Triangles of consecutive patches of an instance, which are chosen together: a leaf of the emitters' tree.
struct alignas(32) EmitterGroup {
    std::int32_t first_patch; // the number that names it; groups are in order of these
    std::int32_t first;       // of its triangles
    std::int32_t count;
    std::int32_t sums; // word of FrameHeader::emitter_sums
    std::int32_t leaf; // node of FrameHeader::emitter_nodes
    float chance;      // what it is of all emitters, by area and radiance
    std::int32_t padding[2];
};
static_assert(sizeof(EmitterGroup) == 32);

} // namespace razor
