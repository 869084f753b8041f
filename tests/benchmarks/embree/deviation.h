// How far grids are from the surface.
#pragma once

#include "tests/benchmarks/embree/grid_mesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace razor::baseline {

/// For each level how far vertices that the next one has lie from the triangles' edges that they halve: the
/// root of the mean square, in the units of `points`, the mesh's. Measured up to the fifth level; from there
/// on a quarter each.
std::array<double, finest_level + 1> deviations(const Topology& topology, const PageMaker* pages,
                                                const std::vector<glm::dvec3>& points);

} // namespace razor::baseline
