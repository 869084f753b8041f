// Plays a clip of one skeleton on another, joint by joint.
//
// With R the rotation of a joint from its own coordinates to those of its file's scene, at rest R0: a joint
// that follows another one, s, has
//     R(t) = (Rs(t) Rs0^-1) R0,
// it turns from how it rests as the other one does, in the directions of the scene. How its bone is rolled,
// how long it is and how many joints lie between does not matter; both models should rest in the same pose, y
// up, and face the same way. What follows nothing keeps its place in its parent. Bones keep their lengths: of
// places only that of joints without any above them that follow is taken over, how far it is from rest, times
// the ratio of the sizes (diagonals of the boxes about the joints at rest, of those that follow or are
// followed).
//
// Not handled: other rest poses, scales, morph weights, feet that slide because legs are in other
// proportions.
#pragma once

#include "razor/scene/animation/skeleton_motion.h"

#include <vector>

namespace razor {

class RetargetedMotion final : public SkeletonMotion {
public:
    /// `follows`: for each node of `target` one of `source`, or -1.
    RetargetedMotion(Skeleton source, Clip clip, Skeleton target, std::vector<int> follows);

    SkeletonPose at(double seconds) const override;
    double length() const override { return clip_.length(); }
    /// Of the target: those that follow what the clip moves, and all below them.
    std::vector<bool> moved() const override;
    std::vector<double> scale_times(int /*node*/) const override { return {}; } // scales are not played

private:
    Skeleton source_;
    Clip clip_;
    Skeleton target_;
    std::vector<int> follows_;
    std::vector<glm::dquat> source_rest_, target_rest_; // rotations to the scene
    SkeletonPose source_pose_, target_pose_;            // at rest
    std::vector<bool> root_;                            // of the target: follows, and nothing above it does
    double size_ratio_ = 1;
};

} // namespace razor
