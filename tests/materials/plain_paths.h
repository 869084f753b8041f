// Pictures again, in double and by definition: every polygon is asked by every ray, lights are sampled by
// area, lobes one at a time, pixels by all filters. Of what settings say it keeps to bounces and
// diffuse_bounces. Textures, patterns and bumps are evaluated at points, unfiltered; displaced faces and
// subdivided cages are many small triangles, fixed, with the normals of the surfaces that they stand for.
// Nothing here is shared with the kernels.
#pragma once

#include "razor/scene/scene.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace razor::test {

/// Of a block of pixels, or of several of its pictures: the mean of its radiance, and its variance.
struct BlockMean {
    glm::dvec3 mean{0}, variance{0};
};

/// Sums over samples of one thing.
struct SampleSums {
    glm::dvec3 sum{0}, squares{0};
    int samples = 0;

    void add(const glm::dvec3& x) {
        sum += x;
        squares += x * x;
        ++samples;
    }
    glm::dvec3 mean() const { return sum / double(samples); }
    /// Of the mean.
    glm::dvec3 variance() const {
        return glm::max(squares / double(samples) - mean() * mean(), 0.0) / double(samples - 1);
    }
};

/// What a scene looks like: blocks of `side` x `side` pixels, row by row from the top. It knows all cameras,
/// lights, materials and maps. Meshes are bilinear ones of planar convex faces, each face where its points
/// lie, or closed cages as plain_cage.h takes them; of the former, quads with texture coordinates may be
/// displaced.
std::vector<BlockMean> plain_picture(const Scene& scene, int side, int samples_a_pixel);

} // namespace razor::test
