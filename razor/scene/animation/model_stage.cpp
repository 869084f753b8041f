#include "razor/scene/animation/model_stage.h"

#include "razor/scene/animation/skeleton_motion.h"

#include <utility>

namespace razor {
namespace {

std::string name_of(const auto& carried, const char* kind) {
    return !carried.node_name.empty() ? carried.node_name
           : !carried.name.empty()    ? carried.name
                                      : kind + (" of node " + std::to_string(carried.node));
}

} // namespace

std::string CarriedCamera::called() const {
    return name_of(*this, "camera");
}

std::string CarriedLight::called() const {
    return name_of(*this, "light");
}

ModelStage::ModelStage(Skeleton skeleton, std::optional<Clip> clip, double cycle,
                       std::vector<CarriedCamera> cameras, std::vector<CarriedLight> lights)
    : skeleton_(std::move(skeleton)), clip_(std::move(clip)), cycle_(cycle), cameras_(std::move(cameras)),
      lights_(std::move(lights)),
      moved_(clip_ ? moved_nodes(skeleton_, *clip_) : std::vector<bool>(skeleton_.nodes.size())) {}

std::vector<Affine> ModelStage::nodes_at(double seconds) const {
    if (!clip_)
        return rest_pose(skeleton_).world;
    return pose_at(skeleton_, *clip_, in_cycle(seconds, cycle_)).world;
}

bool ModelStage::moves(int node) const {
    return moved_[static_cast<std::size_t>(node)];
}

} // namespace razor
