// As Frame::Impl::fill_view() (razor/frame/frame_memory.cpp), without what levels of detail need.
#include "tests/benchmarks/embree/view.h"

#include "razor/frame/view.h"
#include "razor/scene/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace razor::baseline {
namespace {

constexpr double pi = 3.14159265358979323846;

void put(float (&to)[3], const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        to[i] = static_cast<float>(v[i]);
}

bool shines(const glm::vec3& radiance) {
    return std::max({radiance.x, radiance.y, radiance.z}) > 0;
}

} // namespace

FrameView view_of_scene(const Scene& scene, const glm::dvec3& origin) {
    const Settings& s = scene.settings;
    if (s.seed != 0)
        throw UserError("--seed: the baseline takes the samples of seed 0 only; leave it out");
    if (scene.camera.projection != Projection::perspective || !is_pixel(s.filter))
        throw UserError(
            "the baseline knows perspective cameras and the box filter only; render this scene without "
            "it");
    FrameView v{};
    v.width = s.width;
    v.height = s.height;
    v.samples = s.samples;
    v.light_samples = s.light_samples;
    v.sky_samples = shines(scene.sky) ? s.sky_samples : 0;
    const razor::View axes = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, s);
    const double pixel = 2 * film.half_height / s.height;
    put(v.camera, scene.camera.position - origin);
    put(v.film_corner, axes.forward - axes.right * film.half_width + axes.up * film.half_height);
    put(v.film_x, axes.right * pixel);
    put(v.film_y, -axes.up * pixel);
    if (scene.camera.aperture_radius > 0) {
        v.focus = static_cast<float>(focus_distance(scene.camera));
        put(v.lens_x, axes.right * scene.camera.aperture_radius);
        put(v.lens_y, axes.up * scene.camera.aperture_radius);
    }
    put(v.background, glm::dvec3(scene.sky));
    put(v.sky, glm::dvec3(scene.sky) / static_cast<double>(std::max(s.sky_samples, 1)));
    return v;
}

std::vector<LightSource> lights_of_scene(const Scene& scene, const glm::dvec3& origin) {
    std::vector<LightSource> lights;
    for (std::size_t n = 0; n < scene.lights.size(); ++n) {
        const Light& light = scene.lights[n];
        if (light.kind != LightKind::rectangle)
            throw UserError("the baseline knows rectangle lights only; render this scene without it");
        const glm::dvec3 normal = glm::cross(light.edge_u, light.edge_v);
        const double area = glm::length(normal);
        if (!(area > 0) || !shines(light.radiance))
            continue;
        LightSource& l = lights.emplace_back();
        put(l.corner, light.corner - origin);
        put(l.edge_u, light.edge_u);
        put(l.edge_v, light.edge_v);
        put(l.normal, normal / area);
        put(l.radiance,
            glm::dvec3(light.radiance) * (area / (pi * std::max(scene.settings.light_samples, 1))));
        // Of the first light 2, of the others those after the lens'.
        l.dimension = n == 0 ? 2 : 4 + static_cast<int>(n);
    }
    return lights;
}

} // namespace razor::baseline
