// How the nodes of a skeleton move.
#pragma once

#include "razor/scene/animation/skeleton.h"

#include <memory>

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
};

/// By a clip of its own.
class ClipMotion final : public SkeletonMotion {
public:
    ClipMotion(Skeleton skeleton, Clip clip) : skeleton_(std::move(skeleton)), clip_(std::move(clip)) {}
    SkeletonPose at(double seconds) const override { return pose_at(skeleton_, clip_, seconds); }
    double length() const override { return clip_.length(); }

private:
    Skeleton skeleton_;
    Clip clip_;
};

} // namespace razor
