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

float Pixels::operator()(std::string_view plane, int x, int y) const {
    return film_.find(plane)->values.at(static_cast<std::size_t>(y - part_.y) *
                                            static_cast<std::size_t>(part_.width) +
                                        static_cast<std::size_t>(x - part_.x));
}

glm::dvec3 way_through(const Scene& scene, int x, int y) {
    const View view = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, scene.settings);
    const double pixel = 2 * film.half_height / scene.settings.height;
    return glm::normalize(view.forward + view.right * ((x + 0.5) * pixel - film.half_width) +
                          view.up * (film.half_height - (y + 0.5) * pixel));
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
