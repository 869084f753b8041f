// Places on a model that move with it, and that other models can be attached to.
#pragma once

#include "razor/scene/animation/track.h"
#include "razor/scene/graph/affine.h"

#include <glm/gtc/quaternion.hpp>

#include <optional>
#include <string>
#include <vector>

namespace razor {

/// One tag as a file states it: in each frame a map from the coordinates of what is attached to those of the
/// model. Its axes may be anything, also not finite.
struct TagFrames {
    std::string name;
    std::vector<Affine> frames;
};

/// Immutable. n / rate seconds after the beginning a tag is where it is in frame n. In between, and as time
/// says beyond, its origin is blended as points of the model are; so are its axes as unit quaternions, each
/// on the side of the earlier frame's, and the sum made a unit again: the way from one to the other is the
/// shortest arc.
class Tags {
public:
    /// Each tag has as many frames, of which there must be one. Axes need not be of unit length or at right
    /// angles: the first keeps its direction, the second the plane of both.
    Tags(std::vector<TagFrames> tags, double rate, const Timing& timing);

    std::size_t count() const { return tags_.size(); }
    const std::string& name(std::size_t tag) const { return tags_[tag].name; }
    /// The first frame in which the axes are flat, mirrored or not finite, or the origin is not, if there is
    /// one: then the tag is of no use.
    std::optional<std::size_t> bad_frame(std::size_t tag) const { return tags_[tag].bad_frame; }
    /// A turn and a shift.
    Affine at(std::size_t tag, double seconds) const;

private:
    struct Tag {
        std::string name;
        std::vector<glm::dvec3> origins;
        std::vector<glm::dquat> turns;
        std::optional<std::size_t> bad_frame;
    };

    std::vector<Tag> tags_;
    std::vector<double> times_;
    Timing timing_;
};

} // namespace razor
