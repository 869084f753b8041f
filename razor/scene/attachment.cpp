#include "razor/scene/attachment.h"

#include "razor/scene/animation/pose.h"

namespace razor {
namespace {

/// A tag where the mesh is placed.
Affine tag_place(const MeshDescription& mesh, std::size_t tag, double scene_seconds) {
    const Affine placed =
        to_affine({.scale = mesh.scale, .rotate = mesh.rotate, .translate = mesh.translate});
    return placed * mesh.tags->at(tag, mesh.playback.seconds(scene_seconds)) * inverse(placed);
}

/// own(object): its transform beside what it hangs on, or by itself. Carriers hang on no object that they
/// carry, so the way ends.
template <class Own>
Transform place(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                const ObjectDescription& object, double seconds, Own own) {
    if (!object.attachment)
        return own(object);
    Affine all = to_affine(own(object));
    for (const ObjectDescription* hanging = &object; hanging->attachment;) {
        const Attachment& on = *hanging->attachment;
        const ObjectDescription& carrier = objects[on.carrier];
        all = to_affine(own(carrier)) * tag_place(description.meshes[on.mesh], on.tag_number, seconds) * all;
        hanging = &carrier;
    }
    return {.matrix = all};
}

} // namespace

Transform place_at(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                   std::size_t object, double seconds) {
    return place(description, objects, objects[object], seconds,
                 [&](const ObjectDescription& o) { return transform_at(o, seconds); });
}

Transform stated_place(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                       std::size_t object) {
    return place(description, objects, objects[object], 0,
                 [](const ObjectDescription& o) { return o.transform; });
}

} // namespace razor
