// Cages given frame by frame.
#pragma once

#include "razor/scene/animation/moving_cage.h"
#include "razor/scene/animation/track.h"

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace razor {

class TextureCache;

/// One cage whose points are known in each frame, of which there must be one: n / rate seconds after the
/// beginning they are those of frame n.
class PointFrames : public MovingCage {
public:
    /// `cage`: at rest; each frame has as many points.
    PointFrames(std::shared_ptr<const Mesh> cage, std::vector<std::vector<glm::dvec3>> frames, double rate,
                const Timing& timing);
    std::shared_ptr<const Mesh> at(double seconds) const override;
    double length() const override { return times_.back(); }

private:
    std::shared_ptr<const Mesh> cage_;
    std::vector<std::vector<glm::dvec3>> frames_;
    std::vector<double> times_;
    Timing timing_;
};

/// OBJ or PLY files, one a frame: the numbers first to last in place of %d or %0Nd in their name. Only the
/// first one and the last few are kept; they are read when a moment needs them. The first frame is at rest.
/// Where others have other faces, each is at rest as it is, and nothing can be in between: interpolation must
/// be `step`.
class CageSequence : public MovingCage {
public:
    /// With `textures`, also the materials of the first frame, which others name. Throws UserError where a
    /// file is missing or the first cannot be read.
    CageSequence(std::string name, int first, int last, double rate, const Timing& timing,
                 TextureCache* textures = nullptr);
    /// Throws UserError where a file cannot be read or has other faces.
    std::shared_ptr<const Mesh> at(double seconds) const override;
    double length() const override { return times_.back(); }

private:
    std::shared_ptr<const Mesh> frame(std::size_t key) const;
    std::shared_ptr<const Mesh> read(std::size_t key) const;

    std::string name_;
    int first_;
    std::shared_ptr<const Mesh> rest_;
    mutable std::mutex mutex_;
    mutable std::vector<std::pair<std::size_t, std::shared_ptr<const Mesh>>> kept_; // latest last
    std::vector<double> times_;
    Timing timing_;
};

} // namespace razor
