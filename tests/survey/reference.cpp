#include "tests/survey/reference.h"

#include "razor/frame/view.h"
#include "razor/scene/graph/flatten.h"

#include <glm/geometric.hpp>

namespace razor::test {

LayerSet layers(std::initializer_list<LayerGroup> groups) {
    LayerSet set;
    for (const LayerGroup group : groups)
        set.add(group);
    return set;
}

RenderResult surveyed(const Scene& scene, const LayerSet& layers, RenderOptions options) {
    options.layers = layers;
    if (options.threads == 0)
        options.threads = 1;
    return render_native(scene, options);
}

double Pixels::operator()(std::string_view plane, int x, int y) const {
    return film_.find(plane)->at(static_cast<std::size_t>(y - part_.y) *
                                     static_cast<std::size_t>(part_.width) +
                                 static_cast<std::size_t>(x - part_.x));
}

namespace {

/// From the middle of the film to a pixel's.
glm::dvec3 on_film(const Scene& scene, int x, int y) {
    const View view = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, scene.settings);
    const double pixel = 2 * film.half_height / scene.settings.height;
    return view.right * ((x + 0.5) * pixel - film.half_width) +
           view.up * (film.half_height - (y + 0.5) * pixel);
}

} // namespace

glm::dvec3 start_of(const Scene& scene, int x, int y) {
    const bool parallel = scene.camera.projection == Projection::orthographic;
    return scene.camera.position + (parallel ? on_film(scene, x, y) : glm::dvec3(0));
}

glm::dvec3 way_through(const Scene& scene, int x, int y) {
    const glm::dvec3 forward = view_of(scene.camera).forward;
    if (scene.camera.projection == Projection::orthographic)
        return forward;
    return glm::normalize(forward + on_film(scene, x, y));
}

std::vector<Drawn> drawn(const Scene& scene) {
    std::vector<Box> boxes;
    for (const Mesh& mesh : scene.meshes)
        boxes.push_back(bounds_of_used_points(mesh.points, mesh.face_vertices));
    const FlatGraph flat = flatten(drawn_graph(scene.graph, scene.meshes.size()), boxes);
    std::vector<Drawn> all;
    for (const FlatInstance& i : flat.instances)
        all.push_back({i.mesh, flat.nodes[static_cast<std::size_t>(i.node)].world});
    return all;
}

} // namespace razor::test
