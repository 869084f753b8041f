#include "razor/scene/animation/retarget.h"

#include "razor/scene/graph/box.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <utility>

namespace razor {
namespace {

std::size_t to_size(int index) {
    return static_cast<std::size_t>(index);
}

/// That of a node in its parent; of a matrix the one nearest to its x axis, then y (Gram-Schmidt).
glm::dquat rotation_of(const SkeletonNode& node) {
    if (!node.matrix)
        return node.rotation;
    const glm::dmat3& m = node.matrix->linear;
    const glm::dvec3 z = glm::cross(m[0], m[1]);
    if (!(glm::length(m[0]) > 0 && glm::length(z) > 0))
        return {1, 0, 0, 0};
    const glm::dvec3 x = glm::normalize(m[0]), n = glm::normalize(z);
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(n, x), n)));
}

std::vector<glm::dquat> rotations_of(const std::vector<SkeletonNode>& nodes, const std::vector<int>& order) {
    std::vector<glm::dquat> world(nodes.size(), {1, 0, 0, 0});
    for (const int n : order) {
        const glm::dquat local = rotation_of(nodes[to_size(n)]);
        const int parent = nodes[to_size(n)].parent;
        world[to_size(n)] = parent < 0 ? local : world[to_size(parent)] * local;
    }
    return world;
}

double size_of(const Box& box) {
    return box.empty() ? 0 : glm::length(box.high - box.low);
}

/// Turns a node, and all of it that is not rotation with it.
void turn(SkeletonNode& node, const glm::dquat& rotation) {
    if (node.matrix)
        node.matrix->linear =
            glm::mat3_cast(rotation * glm::inverse(rotation_of(node))) * node.matrix->linear;
    else
        node.rotation = rotation;
}

} // namespace

RetargetedMotion::RetargetedMotion(Skeleton source, Clip clip, Skeleton target, std::vector<int> follows)
    : source_(std::move(source)), clip_(std::move(clip)), target_(std::move(target)),
      follows_(std::move(follows)), source_rest_(rotations_of(source_.nodes, source_.order)),
      target_rest_(rotations_of(target_.nodes, target_.order)), source_pose_(rest_pose(source_)),
      target_pose_(rest_pose(target_)), root_(target_.nodes.size()) {
    Box source_box, target_box;
    std::vector<bool> below(target_.nodes.size()); // something above follows
    for (const int n : target_.order) {
        const int parent = target_.nodes[to_size(n)].parent;
        below[to_size(n)] = parent >= 0 && (below[to_size(parent)] || follows_[to_size(parent)] >= 0);
        if (follows_[to_size(n)] < 0)
            continue;
        root_[to_size(n)] = !below[to_size(n)];
        source_box.add(source_pose_.world[to_size(follows_[to_size(n)])].translation);
        target_box.add(target_pose_.world[to_size(n)].translation);
    }
    if (size_of(source_box) > 0 && size_of(target_box) > 0)
        size_ratio_ = size_of(target_box) / size_of(source_box);
}

SkeletonPose RetargetedMotion::at(double seconds) const {
    const std::vector<SkeletonNode> source = nodes_at(source_, clip_, seconds);
    const std::vector<glm::dquat> turned = rotations_of(source, source_.order);
    const SkeletonPose placed = pose_of(source, source_.order);
    std::vector<SkeletonNode> nodes = target_.nodes;
    std::vector<glm::dquat> world(nodes.size(), {1, 0, 0, 0});
    for (const int n : target_.order) {
        SkeletonNode& node = nodes[to_size(n)];
        const int parent = node.parent, followed = follows_[to_size(n)];
        const glm::dquat above = parent < 0 ? glm::dquat(1, 0, 0, 0) : world[to_size(parent)];
        if (followed < 0) {
            world[to_size(n)] = above * rotation_of(node);
            continue;
        }
        const std::size_t f = to_size(followed);
        world[to_size(n)] = turned[f] * glm::inverse(source_rest_[f]) * target_rest_[to_size(n)];
        turn(node, glm::normalize(glm::inverse(above) * world[to_size(n)]));
        if (!root_[to_size(n)])
            continue;
        const glm::dvec3 position =
            target_pose_.world[to_size(n)].translation +
            size_ratio_ * (placed.world[f].translation - source_pose_.world[f].translation);
        // Nothing above it moves.
        const Affine parent_world = parent < 0 ? Affine{} : target_pose_.world[to_size(parent)];
        if (!is_degenerate(parent_world.linear))
            (node.matrix ? node.matrix->translation : node.translation) = inverse(parent_world)(position);
    }
    return pose_of(nodes, target_.order);
}

std::vector<bool> RetargetedMotion::moved() const {
    const std::vector<bool> source = moved_nodes(source_, clip_);
    std::vector<bool> result(target_.nodes.size());
    for (const int n : target_.order) {
        const int parent = target_.nodes[to_size(n)].parent, followed = follows_[to_size(n)];
        result[to_size(n)] =
            (followed >= 0 && source[to_size(followed)]) || (parent >= 0 && result[to_size(parent)]);
    }
    return result;
}

} // namespace razor
