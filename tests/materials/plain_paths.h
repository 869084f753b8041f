// Pictures again, in double and by definition: every polygon is asked by every ray, lights are sampled by
// area, lobes one at a time. Of what settings say it keeps to bounces and diffuse_bounces. Patterns and bumps
// are evaluated at points, displaced faces are many small triangles, fixed, with the normals of the heights'
// slopes. Nothing here is shared with the kernels.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace razor::test {

/// Sums over the samples of a block of pixels.
struct BlockSums {
    glm::dvec3 sum{0}, squares{0};
    int samples = 0;

    glm::dvec3 mean() const { return sum / double(samples); }
    /// Of the mean, squared.
    glm::dvec3 variance() const {
        return (squares / double(samples) - mean() * mean()) / double(samples - 1);
    }
};

/// What a scene of bilinear meshes with planar convex faces, each drawn where its points lie, and rectangles
/// as lights looks like: blocks of `side` x `side` pixels, row by row from the top. Materials are metals or
/// not, by no half; what lets light through is smooth. Of maps it knows patterns of the object as albedo,
/// roughness and bump, and heights that displace quads, which then have texture coordinates.
std::vector<BlockSums> plain_picture(const Scene& scene, int side, int samples_a_pixel);

} // namespace razor::test
