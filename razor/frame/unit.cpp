#include "razor/frame/unit.h"

#include "razor/frame/displacement.h"
#include "razor/frame/scene_geometry.h"
#include "razor/frame/view.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor {
namespace {

constexpr int usual_log2_extent = 9, most_log2_reach = 50;

/// No squares here: lengths are of any size.
double largest(const glm::dvec3& p) {
    const glm::dvec3 a = glm::abs(p);
    return std::max({a.x, a.y, a.z});
}

void scale(Camera& camera, double factor) {
    camera.position *= factor;
    camera.target *= factor;
    camera.aperture_radius *= factor;
    camera.focus_distance *= factor;
    camera.height *= factor;
}

/// As conjugated by the scaling: linear parts stay.
void scale(Placement& placement, double factor) {
    placement.local.translate *= factor;
    if (placement.local.matrix)
        placement.local.matrix->translation *= factor;
    placement.spacing *= factor;
}

/// The square alone may be no float where the product is one.
glm::vec3 times_square(const glm::vec3& intensity, double factor) {
    constexpr double most = std::numeric_limits<float>::max();
    return {glm::min(glm::dvec3(intensity) * factor * factor, most)};
}

} // namespace

double frame_unit(const Scene& scene) {
    std::vector<Box> of_meshes;
    const std::vector<double> most = displacement_bounds(scene);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        of_meshes.push_back(displaced_bounds(scene.meshes[m], most[m]));
    return frame_unit(scene, lay_out(scene, of_meshes).nodes.front().bounds);
}

double frame_unit(const Scene& scene, const Box& all) {
    const double extent = largest(all.high - all.low);
    if (!(extent > 0)) // a point: there is nothing to see
        return 1;
    double reach = extent;
    const auto reaches = [&](const glm::dvec3& p) { reach = std::max(reach, largest(p - all.centre())); };
    for (const Camera& camera : {scene.camera, dicing_camera(scene)}) {
        reaches(camera.position);
        reach += film_reach(camera, scene.settings);
        reach = std::max({reach, camera.aperture_radius, camera.focus_distance});
    }
    for (const Light& light : scene.lights) {
        if (light.kind == LightKind::rectangle) {
            for (const glm::dvec3& p :
                 {light.corner, light.corner + light.edge_u, light.corner + light.edge_v})
                reaches(p);
        } else if (light.kind != LightKind::directional) {
            const bool wide = light.kind == LightKind::disk || light.kind == LightKind::sphere;
            reaches(light.position);
            reaches(light.position + (wide ? light.radius : 0));
        }
    }
    if (extent >= std::ldexp(1.0, least_log2_extent) && extent <= std::ldexp(1.0, most_log2_extent) &&
        reach <= std::ldexp(1.0, most_log2_reach))
        return 1;
    const int exponent =
        std::max(std::ilogb(extent) - usual_log2_extent, std::ilogb(reach) - most_log2_reach);
    return std::ldexp(1.0, std::max(exponent, -1000)); // its inverse must be finite
}

Camera scaled(Camera camera, double factor) {
    scale(camera, factor);
    return camera;
}

Scene scaled(Scene scene, double factor) {
    for (Mesh& mesh : scene.meshes) {
        for (glm::dvec3& p : mesh.points)
            p *= factor;
        for (glm::dvec3& p : mesh.rest)
            p *= factor;
        mesh.edge_length *= factor;
    }
    for (Group& group : scene.graph.groups)
        for (Placement& placement : group.placements)
            scale(placement, factor);
    for (Light& light : scene.lights) {
        light.corner *= factor;
        light.edge_u *= factor;
        light.edge_v *= factor;
        light.position *= factor;
        light.radius *= factor;
        if (light.kind == LightKind::point || light.kind == LightKind::spot) // W / sr, over distances squared
            light.radiance = times_square(light.radiance, factor);
    }
    for (Material& material : scene.materials) {
        material.bump *= static_cast<float>(factor);
        material.displacement_scale *= static_cast<float>(factor);
    }
    for (Texture& texture : scene.textures)
        if (texture.pattern && texture.pattern->space == PatternSpace::object)
            texture.pattern->size *= factor;
    scale(scene.camera, factor);
    if (scene.dicing_camera)
        scale(*scene.dicing_camera, factor);
    return scene;
}

} // namespace razor
