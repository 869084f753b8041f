// What displacement along the normal makes of a scene's bounds, and what kernels need to know of it besides
// materials: how far it goes, and how densely textures lie on faces.
#pragma once

#include "razor/frame/scene_geometry.h"
#include "razor/scene/scene.h"

#include <span>
#include <vector>

namespace razor {

/// How far surfaces of a material are from where their cage has them, at most, in the mesh's units: by the
/// heights that the texture has, of whatever means. Throws UserError if that is no length: a displaced
/// material whose texture has no heights, or heights times scale beyond single precision.
double displacement_bound(const Scene& scene, int material);

/// Of the materials that an instance's faces have, and of each mesh those of all its instances, the largest.
double displacement_bound(const Scene& scene, int mesh, int material);
std::vector<double> displacement_bounds(const Scene& scene);

/// Of a mesh's points that faces use, and so much about them.
Box displaced_bounds(const Mesh& mesh, double bound);

/// Of each face the area that it takes of texture coordinates over that of its polygon: what a target edge
/// length is in texture coordinates, squared, per square of the length. 0 for faces without area.
void measure_texture_density(const Mesh& mesh, std::span<float> of_faces);

/// Of the heights that a texture has: a picture's, or a pattern's, which are its red.
struct HeightRange {
    float least = 0, most = 0;
};
HeightRange height_range(const Texture& texture);

/// How fast the heights of each level of a pyramid change along u and v, at most, bilinear as they are: per
/// unit of texture coordinates. Of a pattern those of its one level.
struct HeightSlopes {
    float u = 0, v = 0;
};
std::vector<HeightSlopes> height_slopes(const Texture& texture);

} // namespace razor
