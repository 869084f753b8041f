// How the nodes of a skeleton move.
#pragma once

#include "razor/scene/animation/skeleton.h"

#include <cmath>
#include <memory>
#include <vector>

namespace razor {

/// Immutable.
class SkeletonMotion {
public:
    SkeletonMotion() = default;
    SkeletonMotion(const SkeletonMotion&) = delete;
    SkeletonMotion& operator=(const SkeletonMotion&) = delete;
    virtual ~SkeletonMotion() = default;

    /// So many seconds after its beginning.
    virtual SkeletonPose at(double seconds) const = 0;
    /// Time of the last key, seconds.
    virtual double length() const = 0;
    /// Of each node, whether its world matrix is another one at other moments.
    virtual std::vector<bool> moved() const = 0;
    /// When scales of a node, or of those above it, have keys: in order. Seconds.
    virtual std::vector<double> scale_times(int node) const = 0;
};

/// Seconds into a motion that begins again after `cycle` seconds, or never where that is 0.
inline double in_cycle(double seconds, double cycle) {
    return cycle > 0 ? seconds - cycle * std::floor(seconds / cycle) : seconds;
}

/// By a clip of its own.
class ClipMotion final : public SkeletonMotion {
public:
    ClipMotion(Skeleton skeleton, Clip clip) : skeleton_(std::move(skeleton)), clip_(std::move(clip)) {}
    SkeletonPose at(double seconds) const override { return pose_at(skeleton_, clip_, seconds); }
    double length() const override { return clip_.length(); }
    std::vector<bool> moved() const override { return moved_nodes(skeleton_, clip_); }
    std::vector<double> scale_times(int node) const override {
        return razor::scale_times(skeleton_, clip_, node);
    }

private:
    Skeleton skeleton_;
    Clip clip_;
};

} // namespace razor
