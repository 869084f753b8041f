// The unit that a frame reckons in. Kernels work in single precision, whose range ends at 2^-126 and 2^128:
// of scenes stated in very small or very large units, squares of lengths and their products would leave it.
// So what enters a frame is in a unit of the frame's, and what leaves it is in world units again. Both are a
// power of two apart, so that nothing is rounded.
#pragma once

#include "razor/scene/graph/box.h"
#include "razor/scene/scene.h"

namespace razor {

/// Extents, as powers of two of world units, that a frame keeps the world's unit for. Parts of about 1e-12
/// are the smallest whose squares stay: at worst 1e-9 of the whole.
inline constexpr int least_log2_extent = -10, most_log2_extent = 20;

/// How many world units one unit of the frame is: a power of two; 1 where the longest side of the bounds of
/// all that the graph places is 2^-10 to 2^20 world units, else such that it is 2^9 to 2^10 of the frame's:
/// rather long, as what is lost first are squares of small parts. Cameras and lights are not what is cut
/// into small parts, and may be far from it: they count only where they are more than 2^50 units away, whose
/// squares would overflow; the scene is then made smaller. The meshes must be valid. Throws UserError where
/// the graph cannot be laid out (see flatten()).
double frame_unit(const Scene& scene);
/// The same, where the box of all instances (as of FlatNode::bounds) is known.
double frame_unit(const Scene& scene, const Box& all);

/// The scene with every length times `factor`.
Camera scaled(Camera camera, double factor);
Scene scaled(Scene scene, double factor);

} // namespace razor
