// Points that follow the nodes of a skeleton: morph targets, then linear-blend skinning (Magnenat-Thalmann et
// al., "Joint-dependent local deformations", Graphics Interface 1988), as in glTF 2.0, 3.7.3. Not modelled:
// dual quaternions, normals.
#pragma once

#include "razor/scene/animation/skeleton.h"

#include <span>
#include <vector>

namespace razor {

struct Influence {
    int joint = 0; // index into Skin::joints
    double weight = 0;

    bool operator==(const Influence&) const = default;
};

struct Skin {
    std::vector<glm::dvec3> points; // of the mesh, in its own coordinates
    /// For each morph target, how far it takes each point.
    std::vector<std::vector<glm::dvec3>> targets;
    int node = 0; // whose weights the targets have, and which all points follow if there are no joints
    std::vector<int> joints;
    std::vector<Affine> inverse_bind; // for each joint: from the mesh's coordinates to the joint's
    /// Of point i: influences [first[i], first[i + 1]), their weights add up to 1. Empty without joints.
    std::vector<std::size_t> first;
    std::vector<Influence> influences;

    /// The influences of the next point: those with weight, divided by their sum, which need not be 1 before,
    /// in order of joints. Weights must not be negative; if all are 0, the first joint alone counts.
    void append_influences(std::span<const Influence> of_point);
    std::span<const Influence> influences_of(std::size_t point) const {
        return first.empty() ? std::span<const Influence>{}
                             : std::span(influences).subspan(first[point], first[point + 1] - first[point]);
    }
};

/// Where the points are, in the scene's coordinates; off by some units of rounding of double precision. The
/// transform of the node itself counts only without joints. `result`: one each point.
void pose(const Skin& skin, const SkeletonPose& skeleton, std::span<glm::dvec3> result);

/// For each point the first one that is at the same place and follows the same nodes and targets in the same
/// way, exactly.
std::vector<int> first_alike(const Skin& skin);

/// These points of `skin`, in this order.
Skin gather(const Skin& skin, std::span<const int> points);

} // namespace razor
