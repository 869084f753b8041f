#include "razor/scene/graph/records.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

float below(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) <= x
               ? nearest
               : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

float above(double x) {
    return -below(-x);
}

void put_rows(float (&rows)[9], const glm::dmat3& m) {
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rows[3 * row + column] = static_cast<float>(m[column][row]);
        }
    }
}

GraphNodeRecord pack_node(const FlatNode& node, const glm::dvec3& origin) {
    GraphNodeRecord record{};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = node.bounds.low[axis] - origin[axis];
        const double high = node.bounds.high[axis] - origin[axis];
        // More than control points, patches' boxes and grids can be off in single precision.
        const double slack = 1e-6 * std::max(std::abs(low), std::abs(high));
        record.low[axis] = below(low - slack);
        record.high[axis] = above(high + slack);
    }
    record.first_child = node.first_child;
    record.child_count = node.child_count;
    record.instance = node.instance;
    record.parent = node.parent;
    return record;
}

} // namespace

GraphRecords pack(const FlatGraph& flat, std::span<const glm::dvec3> mesh_origins, const glm::dvec3& origin) {
    GraphRecords records;
    records.origin = origin;
    records.nodes.reserve(flat.nodes.size());
    for (const FlatNode& node : flat.nodes) {
        records.nodes.push_back(pack_node(node, origin));
    }
    records.instances.reserve(flat.instances.size());
    for (const FlatInstance& instance : flat.instances) {
        const Affine& world = flat.nodes[static_cast<std::size_t>(instance.node)].world;
        InstanceRecord record{};
        put_rows(record.to_scene, world.linear);
        put_rows(record.to_object, inverse(world).linear);
        const glm::dvec3 at = world.linear * mesh_origins[static_cast<std::size_t>(instance.mesh)] +
                              (world.translation - origin);
        for (int axis = 0; axis < 3; ++axis) {
            record.origin[axis] = static_cast<float>(at[axis]);
        }
        record.mesh = instance.mesh;
        record.level_offset = instance.level_offset;
        record.material = instance.material;
        record.mirrored = is_mirrored(world.linear) ? 1 : 0;
        record.node = instance.node;
        records.instances.push_back(record);
    }
    return records;
}

} // namespace razor
