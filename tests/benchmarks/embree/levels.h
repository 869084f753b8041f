// How finely the baseline tessellates what.
#pragma once

#include "razor/frame/scene_geometry.h"
#include "razor/scene/scene.h"
#include "tests/benchmarks/embree/grid_mesh.h"

#include <array>
#include <vector>

namespace razor::baseline {

/// Root mean square of the lengths of the edges of its faces, in the mesh's units.
double mean_edge(const Mesh& mesh);

/// For each instance the n of GridMesh: the mean edge, cut into 2^n, comes nearest in the logarithm to the
/// length that the frame asks for of the instance (Lod::object), or of all of its mesh (Lod::fixed). `finer`:
/// steps beyond that.
std::vector<int> levels_of(const Scene& scene, const SceneGeometry& geometry, int finer);

/// For each instance the lowest n that deviates (deviation.h) from the surface by a sixteenth of that length
/// at most; by a quarter of that for each step finer.
std::vector<int> levels_by_deviation(const SceneGeometry& geometry,
                                     const std::vector<std::array<double, finest_level + 1>>& deviations,
                                     int finer);

} // namespace razor::baseline
