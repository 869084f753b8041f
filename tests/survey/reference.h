// What a survey should find, worked out from the scene alone in double precision.
#pragma once

#include "razor/native/render.h"
#include "razor/scene/graph/affine.h"
#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <string_view>
#include <vector>

namespace razor::test {

LayerSet layers(std::initializer_list<LayerGroup> groups);

/// The scene's film with layers, and what rendering it counted.
RenderResult surveyed(const Scene& scene, const LayerSet& layers, RenderOptions options = {});

/// The value of a pixel, counted in the whole picture.
class Pixels {
public:
    Pixels(const Film& film, const Settings& settings) : film_(film), part_(shown_part(settings)) {}
    double operator()(std::string_view plane, int x, int y) const;

private:
    const Film& film_;
    Crop part_;
};

/// Of the ray through the middle of a pixel: where it begins, with a lens in its middle, and its unit
/// direction.
glm::dvec3 start_of(const Scene& scene, int x, int y);
glm::dvec3 way_through(const Scene& scene, int x, int y);

/// From mesh to world, of each drawing of a mesh in the graph's order.
struct Drawn {
    int mesh = 0;
    Affine world;
};
std::vector<Drawn> drawn(const Scene& scene);

} // namespace razor::test
