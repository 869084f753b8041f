#include "razor/scene/animation/cage_frames.h"

#include "razor/scene/error.h"
#include "razor/scene/models/still_cage.h"
#include "razor/scene/numbered_name.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace razor {
namespace {

std::vector<double> even_times(std::size_t frames, double rate) {
    std::vector<double> times;
    for (std::size_t n = 0; n < frames; ++n)
        times.push_back(static_cast<double>(n) / rate);
    return times;
}

using Points = std::vector<glm::dvec3>;

/// points_of(key): a pointer to the points of that frame, which are as many in all.
template <class PointsOf> Points blended(const Blend& blend, PointsOf points_of) {
    const auto base = points_of(blend.base);
    Points points = *base;
    for (std::size_t i = 0; i < blend.count; ++i) {
        const auto other = points_of(blend.parts[i].key);
        for (std::size_t p = 0; p < points.size(); ++p)
            points[p] += ((*other)[p] - (*base)[p]) * blend.parts[i].factor;
    }
    return points;
}

} // namespace

PointFrames::PointFrames(std::shared_ptr<const Mesh> cage, std::vector<Points> frames, double rate,
                         const Timing& timing)
    : cage_(std::move(cage)), frames_(std::move(frames)), times_(even_times(frames_.size(), rate)),
      timing_(timing) {}

std::shared_ptr<const Mesh> PointFrames::at(double seconds) const {
    return moved(*cage_,
                 blended(blend_at(times_, timing_, seconds), [&](std::size_t n) { return &frames_[n]; }));
}

CageSequence::CageSequence(std::string name, int first, int last, double rate, const Timing& timing,
                           TextureCache* textures)
    : name_(std::move(name)), first_(first),
      times_(even_times(static_cast<std::size_t>(last - first) + 1, rate)), timing_(timing) {
    for (int n = first; n <= last; ++n) {
        const std::string file = numbered(name_, n);
        std::error_code error;
        if (!std::filesystem::exists(file, error))
            throw UserError(fmt::format("{}: no such file, of frames {} to {}; give frames that are there",
                                        printable(file, 1000), first, last));
    }
    rest_ = std::make_shared<const Mesh>(textures == nullptr
                                             ? read_still_cage(numbered(name_, first), nullptr)
                                             : read_still_cage(numbered(name_, first), *textures));
}

std::shared_ptr<const Mesh> CageSequence::frame(std::size_t key) const {
    constexpr std::size_t most_kept = 4; // what a smooth moment needs
    if (key == 0)
        return rest_;
    const std::lock_guard guard(mutex_);
    auto at = std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.first == key; });
    if (at == kept_.end()) {
        kept_.emplace_back(key, read(key));
        at = std::prev(kept_.end());
    }
    std::rotate(at, std::next(at), kept_.end());
    if (kept_.size() > most_kept)
        kept_.erase(kept_.begin());
    return kept_.back().second;
}

std::shared_ptr<const Mesh> CageSequence::read(std::size_t key) const {
    const std::string file = numbered(name_, first_ + static_cast<int>(key));
    Mesh cage = read_still_cage(file, rest_->own_materials);
    if (cage.points.size() == rest_->points.size() && cage.face_sizes == rest_->face_sizes &&
        cage.face_vertices == rest_->face_vertices)
        return moved(*rest_, std::move(cage.points));
    if (timing_.interpolation != Interpolation::step)
        throw UserError(fmt::format("{}: its faces are not those of {}; write interpolation = \"step\"",
                                    printable(file, 1000),
                                    std::filesystem::path(numbered(name_, first_)).filename().string()));
    cage.rest = cage.points;
    return std::make_shared<const Mesh>(std::move(cage));
}

std::shared_ptr<const Mesh> CageSequence::at(double seconds) const {
    const Blend blend = blend_at(times_, timing_, seconds);
    const std::shared_ptr<const Mesh> base = frame(blend.base);
    if (blend.count == 0)
        return base->rest.empty() ? moved(*base, base->points) : base;
    return moved(*base, blended(blend, [&](std::size_t key) {
        const auto cage = key == blend.base ? base : frame(key);
        return std::shared_ptr<const Points>(cage, &cage->points);
    }));
}

} // namespace razor
