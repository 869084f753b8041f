// A tree of nodes that move by curves: glTF 2.0, 3.5 (nodes) and 3.11 (animations).
#pragma once

#include "razor/scene/animation/curve.h"
#include "razor/scene/graph/affine.h"

#include <glm/gtc/quaternion.hpp>

#include <string>
#include <vector>

namespace razor {

/// p -> translation + rotation (scale p), relative to the parent; or a matrix instead of all three.
struct SkeletonNode {
    int parent = -1; // -1: none
    glm::dvec3 translation{0}, scale{1};
    glm::dquat rotation{1, 0, 0, 0};
    std::optional<Affine> matrix{};
    std::vector<double> weights{}; // of the morph targets of what is drawn here
};

struct Skeleton {
    std::vector<SkeletonNode> nodes;
    std::vector<int> order; // of evaluation: parents_first(nodes)
};

/// Node numbers, each after its parent's. Nodes in a circle of parents, and those below, are left out.
std::vector<int> parents_first(const std::vector<SkeletonNode>& nodes);

/// What moves one property of one node.
struct Channel {
    enum class Path : std::uint8_t { translation, rotation, scale, weights };

    int node = 0; // one without a matrix, unless `weights` move
    Path path = Path::translation;
    Curve curve; // of 3 components, 4 (rotation), or one each morph target
};

struct Clip {
    std::string name;
    std::vector<Channel> channels;

    /// Time of the last key, seconds; 0 without channels.
    double length() const;
};

struct SkeletonPose {
    std::vector<Affine> world; // of each node: from its coordinates to those of the scene
    std::vector<std::vector<double>> weights;
};

/// The nodes of a skeleton `seconds` after the clip's beginning; what has no channel stays.
std::vector<SkeletonNode> nodes_at(const Skeleton& skeleton, const Clip& clip, double seconds);
/// Of nodes that stand so; `order` as of a skeleton.
SkeletonPose pose_of(const std::vector<SkeletonNode>& nodes, const std::vector<int>& order);

/// The nodes as they stand.
SkeletonPose rest_pose(const Skeleton& skeleton);
/// ... and `seconds` after the clip's beginning.
SkeletonPose pose_at(const Skeleton& skeleton, const Clip& clip, double seconds);

/// When scales of a node, or of those above it, have keys: in order, each once. Seconds.
std::vector<double> scale_times(const Skeleton& skeleton, const Clip& clip, int node);

/// Nodes whose world matrices the clip changes: those of its channels and all below them.
std::vector<bool> moved_nodes(const Skeleton& skeleton, const Clip& clip);

} // namespace razor
