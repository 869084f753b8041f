#include "razor/native/visible.h"

#include "razor/frame/view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace razor {

VisibleSurface visible_surface(const Film& film, const Camera& camera, const Settings& settings) {
    const View view = view_of(camera);
    const FilmExtent extent = film_extent(camera, settings);
    const double pixel = 2 * extent.half_height / settings.height;
    const Crop part = shown_part(settings);
    const auto plane = [&film](const char* name) { return film.find(name)->values.data(); };
    const float *depth = plane("depth.Z"), *x = plane("normal.X"), *y = plane("normal.Y"),
                *z = plane("normal.Z");
    const bool parallel = camera.projection == Projection::orthographic;
    VisibleSurface out;
    for (int row = 0; row < film.height; ++row)
        for (int column = 0; column < film.width; ++column) {
            const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(row) * film.width + column;
            if (!std::isfinite(depth[i]))
                continue;
            const glm::dvec3 way = view.forward +
                                   view.right * (-extent.half_width + (part.x + column + 0.5) * pixel) +
                                   view.up * (extent.half_height - (part.y + row + 0.5) * pixel);
            const double cosine = std::abs(
                glm::dot(parallel ? view.forward : glm::normalize(way), glm::dvec3(x[i], y[i], z[i])));
            ++out.pixels;
            out.squares += cosine * most_squares > 1 ? 1 / cosine : most_squares;
        }
    return out;
}

} // namespace razor
