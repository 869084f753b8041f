#include "razor/scene/attachment.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

namespace razor {
namespace {

/// A tag or node where the mesh is placed.
Affine place_on(const SceneDescription& description, const ObjectDescription& object, double scene_seconds) {
    const Attachment& on = *object.attachment;
    const MeshDescription& mesh = description.meshes[on.mesh];
    const double seconds = mesh.playback.seconds(scene_seconds);
    const Affine place = mesh.nodes ? mesh.nodes->at(on.place, seconds) : mesh.tags->at(on.place, seconds);
    // Tags are turns; readers know nodes at their keys alone.
    if (mesh.nodes && !can_carry(place))
        throw UserError(
            fmt::format("{}: {} s after the beginning '{}' hangs on the node '{}' of '{}', which is "
                        "flat or not finite then; mend the scales of the model's animation",
                        description.name, scene_seconds, printable(object.name), printable(on.node),
                        printable(mesh.name)));
    const Affine placed =
        to_affine({.scale = mesh.scale, .rotate = mesh.rotate, .translate = mesh.translate});
    return placed * place * inverse(placed);
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
        const ObjectDescription& carrier = objects[hanging->attachment->carrier];
        all = to_affine(own(carrier)) * place_on(description, *hanging, seconds) * all;
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

bool hangs_on_motion(const SceneDescription& description, const ObjectDescription& object) {
    if (!object.attachment)
        return false;
    const MeshDescription& mesh = description.meshes[object.attachment->mesh];
    return mesh.nodes ? !mesh.playback.moment && mesh.nodes->moves(object.attachment->place)
                      : changes_shape(mesh);
}

} // namespace razor
