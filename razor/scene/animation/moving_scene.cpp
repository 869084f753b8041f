#include "razor/scene/animation/moving_scene.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/attachment.h"

#include <array>
#include <cstring>
#include <span>
#include <utility>

namespace razor {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

// To the last bit: zeros have signs.

bool same_vectors(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool same_cage(const Mesh& a, const Mesh& b) {
    return same_vectors(a.points, b.points) && same_vectors(a.rest, b.rest) && a.face_sizes == b.face_sizes &&
           a.face_vertices == b.face_vertices;
}

bool same_transform(const Transform& a, const Transform& b) {
    if (a.matrix || b.matrix) // then the vectors say nothing
        return a.matrix && b.matrix && std::memcmp(&*a.matrix, &*b.matrix, sizeof(Affine)) == 0;
    return same_vectors(std::array{a.scale, a.rotate, a.translate},
                        std::array{b.scale, b.rotate, b.translate});
}

// `Description`: a scene's, const or not.

template <class Description> auto& list_of(Description& scene, const PlacementName& name) {
    return name.group < 0 ? scene.objects : scene.groups[at(name.group)].objects;
}
template <class Description> auto& object_of(Description& scene, const PlacementName& name) {
    return list_of(scene, name)[at(name.placement)];
}

} // namespace

MovingScene::MovingScene(SceneDescription moving) : moving_(std::move(moving)) {
    const auto list = [&](const std::vector<ObjectDescription>& objects, std::int32_t group) {
        for (std::size_t i = 0; i < objects.size(); ++i)
            if (objects[i].keys.any() || objects[i].attachment)
                objects_.push_back({group, static_cast<std::int32_t>(i)});
    };
    list(moving_.objects, -1);
    for (std::size_t g = 0; g < moving_.groups.size(); ++g)
        list(moving_.groups[g].objects, static_cast<std::int32_t>(g));
    for (std::size_t m = 0; m < moving_.meshes.size(); ++m)
        if (changes_shape(moving_.meshes[m]))
            meshes_.push_back(m);
}

void MovingScene::go_to(double seconds) {
    if (!std::exchange(begun_, false)) { // until this has ended well
        begin(seconds);
        begun_ = true;
        return;
    }
    changes_.emplace();
    for (const std::size_t mesh : meshes_)
        move_mesh(mesh, seconds);
    for (const PlacementName& object : objects_)
        move(object, seconds);
    for (const PlacementName& object : edited_)
        move(object, seconds);
    edited_.clear();
    pose_view(posed_, moving_, seconds);
    scene_.camera = posed_.camera;
    scene_.lights = posed_.lights;
    scene_.dicing_camera = posed_.dicing_camera;
    scene_.sky = posed_.sky;
    begun_ = true;
}

void MovingScene::take_over(const SceneDescription& edited, std::span<const PlacementName> objects) {
    moving_.camera = edited.camera;
    moving_.camera_keys = edited.camera_keys;
    moving_.camera_from = edited.camera_from;
    moving_.lights = edited.lights;
    moving_.light_keys = edited.light_keys;
    moving_.lights_from = edited.lights_from;
    moving_.dicing_camera = posed_.dicing_camera = edited.dicing_camera;
    moving_.sky = posed_.sky = edited.sky;
    for (const PlacementName& name : objects) {
        object_of(moving_, name).transform = object_of(edited, name).transform;
        object_of(moving_, name).keys = object_of(edited, name).keys;
        edited_.push_back(name);
    }
}

void MovingScene::begin(double seconds) {
    changes_.reset();
    edited_.clear();
    posed_ = pose_at(moving_, seconds);
    scene_ = build_scene(posed_);
}

void MovingScene::move(const PlacementName& object, double seconds) {
    // What build_graph() makes of objects: of those of group g group g + 1 of the graph, of those of none the
    // last placements of its first.
    const auto before = static_cast<std::int32_t>(
        scene_.graph.groups.empty() ? 0
                                    : scene_.graph.groups.front().placements.size() - moving_.objects.size());
    const PlacementName placed = object.group < 0 ? PlacementName{0, before + object.placement}
                                                  : PlacementName{object.group + 1, object.placement};
    const Transform transform = place_at(moving_, list_of(moving_, object), at(object.placement), seconds);
    ObjectDescription& posed = object_of(posed_, object);
    if (same_transform(transform, posed.transform))
        return;
    posed.transform = transform;
    scene_.graph.groups[at(placed.group)].placements[at(placed.placement)].local = transform;
    changes_->placements.push_back(placed);
}

void MovingScene::move_mesh(std::size_t mesh, double seconds) {
    posed_.meshes[mesh] = mesh_at(moving_, mesh, seconds);
    Mesh cage = build_mesh(posed_, mesh);
    if (same_cage(cage, scene_.meshes[mesh]))
        return;
    scene_.meshes[mesh] = std::move(cage);
    changes_->meshes.push_back(static_cast<int>(mesh));
}

} // namespace razor
