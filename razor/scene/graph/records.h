// The laid out graph as it will lie in frame memory: single precision relative to a double-precision origin,
// 32-bit indices. A ray in scene coordinates enters an instance as to_object (o - origin), to_object d: the
// subtraction comes first, so that far from the scene's origin no bits of the instance's own are lost.
#pragma once

#include "razor/scene/graph/flatten.h"

#include <cstdint>
#include <vector>

namespace razor {

/// Box in scene coordinates (world minus the scene's origin). It holds the double one, and whatever becomes
/// of what lies in it in single precision: patches' boxes as the frame refits them, and their grids.
struct GraphNodeRecord {
    float low[3], high[3];
    std::int32_t first_child; // children are consecutive
    std::int32_t child_count; // 0: a leaf, or an empty group
    std::int32_t instance;    // of a leaf; else -1
    std::int32_t parent;      // -1: the root
};
static_assert(sizeof(GraphNodeRecord) == 40);

/// Mesh coordinates are relative to the mesh's own double-precision origin (a mesh's points minus
/// mesh_origins[mesh]).
struct InstanceRecord {
    float to_scene[9];  // rows; scene = to_scene p + origin
    float to_object[9]; // rows; p = to_object (scene - origin)
    float origin[3];    // the mesh's origin in scene coordinates
    std::int32_t mesh;
    std::int32_t level_offset; // see FlatInstance
    std::int32_t material;     // -1: the mesh's own
    std::int32_t mirrored;     // 1: the outside is where the winding says inside
    std::int32_t node;
    std::int32_t padding[6];
};
static_assert(sizeof(InstanceRecord) == 128);

struct GraphRecords {
    glm::dvec3 origin; // of scene coordinates
    std::vector<GraphNodeRecord> nodes;
    std::vector<InstanceRecord> instances;
};

GraphRecords pack(const FlatGraph& flat, std::span<const glm::dvec3> mesh_origins, const glm::dvec3& origin);

} // namespace razor
