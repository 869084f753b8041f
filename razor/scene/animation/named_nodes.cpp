#include "razor/scene/animation/named_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace razor {

NamedNodes::NamedNodes(std::vector<NamedNode> named, Skeleton skeleton,
                       std::shared_ptr<const SkeletonMotion> motion, double cycle)
    : named_(std::move(named)), skeleton_(std::move(skeleton)), motion_(std::move(motion)), cycle_(cycle),
      moved_(motion_ ? motion_->moved() : std::vector<bool>(skeleton_.nodes.size())) {}

Affine NamedNodes::at(std::size_t named, double seconds) const {
    const SkeletonPose pose = motion_ ? motion_->at(in_cycle(seconds, cycle_)) : rest_pose(skeleton_);
    return pose.world[static_cast<std::size_t>(named_[named].node)];
}

bool NamedNodes::moves(std::size_t named) const {
    return moved_[static_cast<std::size_t>(named_[named].node)];
}

std::optional<double> NamedNodes::flat_at(std::size_t named, std::optional<double> moment) const {
    std::vector<double> times;
    if (motion_ && !moment)
        times = motion_->scale_times(named_[named].node);
    if (times.empty())
        times.push_back(moment.value_or(0));
    const auto flat =
        std::find_if(times.begin(), times.end(), [&](double time) { return !can_carry(at(named, time)); });
    return flat == times.end() ? std::nullopt : std::optional(*flat);
}

bool can_carry(const Affine& place) {
    const auto is_finite = [](const glm::dvec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    const glm::dmat3& axes = place.linear;
    return is_finite(place.translation) && is_finite(axes[0]) && is_finite(axes[1]) && is_finite(axes[2]) &&
           !is_degenerate(axes);
}

} // namespace razor
