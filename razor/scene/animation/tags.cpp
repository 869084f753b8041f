#include "razor/scene/animation/tags.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace razor {
namespace {

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Gram-Schmidt. Nothing where no turn is near.
std::optional<glm::dquat> turn_of(const glm::dmat3& axes) {
    // What files state is near 1: where it is far from that, or two axes nearly agree, it means nothing.
    constexpr double least_length = 1e-6, most_length = 1e6, least_sine = 1e-3;
    glm::dmat3 unit = axes;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(axes[axis]);
        if (!(length >= least_length && length <= most_length))
            return std::nullopt;
        unit[axis] /= length;
    }
    const glm::dvec3 across = unit[1] - glm::dot(unit[0], unit[1]) * unit[0];
    const double sine = glm::length(across);
    if (!(sine >= least_sine))
        return std::nullopt;
    const glm::dvec3 up = unit[2];
    unit[1] = across / sine;
    unit[2] = glm::cross(unit[0], unit[1]);
    if (!(glm::dot(unit[2], up) >= least_sine))
        return std::nullopt;
    return glm::normalize(glm::quat_cast(unit));
}

} // namespace

Tags::Tags(std::vector<TagFrames> tags, double rate, const Timing& timing) : timing_(timing) {
    for (TagFrames& from : tags) {
        Tag& tag = tags_.emplace_back();
        tag.name = std::move(from.name);
        for (std::size_t f = 0; f < from.frames.size(); ++f) {
            const std::optional<glm::dquat> turn = turn_of(from.frames[f].linear);
            tag.origins.push_back(from.frames[f].translation);
            tag.turns.push_back(turn.value_or(glm::dquat(1, 0, 0, 0)));
            if (!tag.bad_frame && (!turn || !is_finite(tag.origins.back())))
                tag.bad_frame = f;
        }
    }
    for (std::size_t f = 0; !tags_.empty() && f < tags_.front().origins.size(); ++f)
        times_.push_back(static_cast<double>(f) / rate);
}

Affine Tags::at(std::size_t tag, double seconds) const {
    const Tag& t = tags_[tag];
    const Blend blend = blend_at(times_, timing_, seconds);
    glm::dvec3 origin = t.origins[blend.base];
    const glm::dquat base = t.turns[blend.base];
    glm::dquat turn = base;
    for (std::size_t i = 0; i < blend.count; ++i) {
        const auto& [key, factor] = blend.parts[i];
        const glm::dquat other = glm::dot(base, t.turns[key]) < 0 ? -t.turns[key] : t.turns[key];
        origin += (t.origins[key] - t.origins[blend.base]) * factor;
        turn = turn + (other - base) * factor;
    }
    return {glm::mat3_cast(glm::normalize(turn)), origin};
}

} // namespace razor
