// Height maps, scenes that are displaced by them, and what they say in double precision.
#pragma once

#include "razor/scene/scene.h"

#include <functional>

namespace razor::test {

/// Texel (x, y), row 0 at the top.
Texture height_texture(int width, int height, const std::function<float(int x, int y)>& value);
Texture smooth_heights();  // waves, in [0, 1]
Texture random_heights();  // nothing to do with their neighbours, in [0, 1]
Texture stepped_heights(); // a chequerboard of 0 and 1
Texture constant_heights(float value);
/// Of texture coordinates, from -0.5 to 1.5, features of a size of about a face.
Texture pattern_heights(PatternKind kind);

/// By what razor/scene/texture.h and razor/kernels/heights.h say: trilinear at this level; patterns as
/// nothing but points sees them.
double lookup(const Texture& texture, const glm::dvec2& at, double level);

/// Coordinates by where points are: no seams.
Mesh with_smooth_texcoords(Mesh mesh);
/// Every face has coordinates of its own: seams at all edges.
Mesh with_seams(Mesh mesh);

/// One mesh, rays asking for all levels.
Scene displaced_scene(const Mesh& mesh, double edges_across, const Texture& heights, double scale,
                      double midlevel);

} // namespace razor::test
