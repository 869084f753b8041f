// A cage that changes its shape in time.
#pragma once

#include "razor/scene/scene.h"

#include <memory>

namespace razor {

/// Immutable, so that any number of moments may be asked for at once. Coordinates are those of the file.
class MovingCage {
public:
    MovingCage() = default;
    MovingCage(const MovingCage&) = delete;
    MovingCage& operator=(const MovingCage&) = delete;
    virtual ~MovingCage() = default;

    /// The cage `seconds` (any finite number) after the beginning of its motion, a function of that alone.
    /// Where nothing but points changes, Mesh::rest is the same at all moments.
    virtual std::shared_ptr<const Mesh> at(double seconds) const = 0;
    /// When the last key has been reached, seconds.
    virtual double length() const = 0;
};

/// `cage` with its points elsewhere; its own become Mesh::rest if it has none.
inline std::shared_ptr<const Mesh> moved(const Mesh& cage, std::vector<glm::dvec3> points) {
    auto m = std::make_shared<Mesh>(cage);
    if (m->rest.empty())
        m->rest = std::move(m->points);
    m->points = std::move(points);
    return m;
}

} // namespace razor
