#include "razor/scene/animation/skeleton.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>

namespace razor {
namespace {

Affine local_transform(const SkeletonNode& node) {
    if (node.matrix)
        return *node.matrix;
    glm::dmat3 linear = glm::mat3_cast(node.rotation);
    for (int axis = 0; axis < 3; ++axis)
        linear[axis] *= node.scale[axis];
    return {linear, node.translation};
}

void apply(const Channel& channel, double seconds, SkeletonNode& node) {
    if (channel.path == Channel::Path::weights) {
        node.weights.resize(channel.curve.width);
        channel.curve.at(seconds, node.weights);
        return;
    }
    std::array<double, 4> v{};
    channel.curve.at(seconds, v);
    if (channel.path == Channel::Path::rotation)
        node.rotation = glm::dquat(v[3], v[0], v[1], v[2]);
    else
        (channel.path == Channel::Path::scale ? node.scale : node.translation) = {v[0], v[1], v[2]};
}

} // namespace

SkeletonPose pose_of(const std::vector<SkeletonNode>& nodes, const std::vector<int>& order) {
    SkeletonPose pose;
    pose.world.resize(nodes.size());
    pose.weights.reserve(nodes.size());
    for (const SkeletonNode& node : nodes)
        pose.weights.push_back(node.weights);
    for (const int i : order) {
        const auto n = static_cast<std::size_t>(i);
        const int parent = nodes[n].parent;
        const Affine local = local_transform(nodes[n]);
        pose.world[n] = parent < 0 ? local : pose.world[static_cast<std::size_t>(parent)] * local;
    }
    return pose;
}

std::vector<int> parents_first(const std::vector<SkeletonNode>& nodes) {
    std::vector<std::vector<int>> children(nodes.size());
    std::vector<int> order;
    order.reserve(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n].parent < 0)
            order.push_back(static_cast<int>(n));
        else
            children[static_cast<std::size_t>(nodes[n].parent)].push_back(static_cast<int>(n));
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::vector<int>& below = children[static_cast<std::size_t>(order[i])];
        order.insert(order.end(), below.begin(), below.end());
    }
    return order;
}

double Clip::length() const {
    double last = 0;
    for (const Channel& channel : channels)
        last = std::max(last, channel.curve.times.back());
    return last;
}

SkeletonPose rest_pose(const Skeleton& skeleton) {
    return pose_of(skeleton.nodes, skeleton.order);
}

std::vector<SkeletonNode> nodes_at(const Skeleton& skeleton, const Clip& clip, double seconds) {
    std::vector<SkeletonNode> nodes = skeleton.nodes;
    for (const Channel& channel : clip.channels)
        apply(channel, seconds, nodes[static_cast<std::size_t>(channel.node)]);
    return nodes;
}

SkeletonPose pose_at(const Skeleton& skeleton, const Clip& clip, double seconds) {
    return pose_of(nodes_at(skeleton, clip, seconds), skeleton.order);
}

std::vector<double> scale_times(const Skeleton& skeleton, const Clip& clip, int node) {
    std::vector<double> times;
    for (int n = node; n >= 0; n = skeleton.nodes[static_cast<std::size_t>(n)].parent)
        for (const Channel& channel : clip.channels)
            if (channel.node == n && channel.path == Channel::Path::scale)
                times.insert(times.end(), channel.curve.times.begin(), channel.curve.times.end());
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

std::vector<bool> moved_nodes(const Skeleton& skeleton, const Clip& clip) {
    std::vector<bool> moved(skeleton.nodes.size());
    for (const Channel& channel : clip.channels)
        if (channel.path != Channel::Path::weights)
            moved[static_cast<std::size_t>(channel.node)] = true;
    for (const int i : skeleton.order) {
        const auto n = static_cast<std::size_t>(i);
        const int parent = skeleton.nodes[n].parent;
        moved[n] = moved[n] || (parent >= 0 && moved[static_cast<std::size_t>(parent)]);
    }
    return moved;
}

} // namespace razor
