// The camera's axes, and how far apart its rays are.
#pragma once

#include "razor/image/image.h"
#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

namespace razor {

/// Unit vectors; any up will do where the camera's is no help.
struct View {
    glm::dvec3 right, up, forward;
};
View view_of(const Camera& camera);

/// Half the film's width and height, at distance 1 from a perspective camera.
struct FilmExtent {
    double half_width, half_height;
};
FilmExtent film_extent(const Camera& camera, const Settings& settings);
/// From the camera's position rays begin so far away at most, a lens left out.
double film_reach(const Camera& camera, const Settings& settings);

/// What files say of it.
PictureCamera picture_camera(const Camera& camera, const Settings& settings);

/// Footprint of a pixel (razor/kernels/differentials.h) at distance 1 from a pinhole, one for the whole film,
/// so that all rays of a frame see one surface: the film's solid angle is shared evenly among its pixels. A
/// pixel's own falls with cos^1.5 of the angle from the axis: for 35 degrees square it is 0.92 to 1.05 times
/// this, for 90 degrees 0.61 to 1.38 (tests/kernels/differentials.cpp). Of an orthographic camera: a pixel's
/// side, at any distance.
double pixel_footprint(const Camera& camera, const Settings& settings);

/// What camera rays ask for at depth z and distance d from the lens: edges of |base + slope z| + growth d.
struct CameraField {
    double base, slope, growth;
};
/// A pixel's footprint and, of its samples on the lens, that of one: the lens' area, seen from the plane in
/// focus as it narrows to a point there, over their number. Times edge_pixels; growth and slope together are
/// at most gradation_cap, which costs the slope first: what is out of focus is then finer than asked for. Of
/// an orthographic camera: a pixel's side everywhere, so that neither grows.
CameraField camera_field(const Camera& camera, const Settings& settings);

} // namespace razor
