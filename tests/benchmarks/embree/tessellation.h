// Vertices of grid meshes, by all threads.
#pragma once

#include "tests/benchmarks/embree/grid_mesh.h"

#include <string>
#include <vector>

namespace razor::baseline {

/// The best of this build and processor for "auto". Throws UserError where there are no such kernels.
const Kernels& choose_kernels(const std::string& isa);

struct Tessellation {
    const GridMesh* grid;
    const float* points;        // x, y, z of its mesh's points
    float *positions, *normals; // x, y, z of its vertices; normals of flat patches are zero
};

void tessellate(const std::vector<Tessellation>& tessellations, const Kernels& kernels, int threads);

} // namespace razor::baseline
