// Nodes of a model that other models can be attached to.
#pragma once

#include "razor/scene/animation/skeleton_motion.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace razor {

struct NamedNode {
    std::string name; // as the file has it: several nodes may be called so
    int node = 0;
    bool joint = false; // of a skin
};

/// Immutable. Coordinates are those of the file.
class NamedNodes {
public:
    /// `motion`: null where all stand still. `cycle`: seconds after which it begins again; 0: it holds its
    /// last keys.
    NamedNodes(std::vector<NamedNode> named, Skeleton skeleton, std::shared_ptr<const SkeletonMotion> motion,
               double cycle);

    const std::vector<NamedNode>& named() const { return named_; }
    /// From the coordinates of one of these, scales and all, so many seconds after the motion's beginning.
    Affine at(std::size_t named, double seconds) const;
    /// Whether it is elsewhere at other moments.
    bool moves(std::size_t named) const;
    /// The first key of scales, of its own or of nodes above it, at which nothing can hang on it: its axes
    /// are flat, or not finite. Where there are no such keys, or at a `moment` alone: seconds 0, or that.
    std::optional<double> flat_at(std::size_t named, std::optional<double> moment) const;

private:
    std::vector<NamedNode> named_;
    Skeleton skeleton_;
    std::shared_ptr<const SkeletonMotion> motion_;
    double cycle_;
    std::vector<bool> moved_; // of all nodes
};

/// Whether something can be placed so.
bool can_carry(const Affine& place);

} // namespace razor
