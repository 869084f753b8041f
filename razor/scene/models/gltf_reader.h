// Cages from glTF 2.0 files (.gltf, .glb), with their animations.
//
// Read: triangles (lists, strips, fans), nodes, skins, morph targets, animations of nodes and of morph
// weights, sparse accessors, quantised meshes. Points that a file keeps apart only for their normals or
// texture coordinates are joined, so that the surface is closed there; texture coordinates become
// face-varying. Where normals differ between faces by more than is asked for, edges become creases.
// Materials: gltf/materials.h; cameras and lights: gltf_stage.h. Passed over: points, lines, what normals are
// besides. Refused: compressed geometry and other required extensions that could change shapes.
#pragma once

#include "razor/scene/animation/moving_cage.h"
#include "razor/scene/animation/named_nodes.h"
#include "razor/scene/models/hard_edges.h"
#include "razor/scene/textures/texture_cache.h"

#include <filesystem>
#include <string>
#include <vector>

namespace razor {

/// One cage of all meshes that the file's scene draws, in the scene's coordinates: right-handed, y up,
/// metres.
struct GltfModel {
    std::shared_ptr<const Mesh> cage;         // at rest: the nodes stand as without animation
    std::shared_ptr<const MovingCage> motion; // null: no animation, or one that does not move the cage
    std::shared_ptr<const NamedNodes> nodes;  // null: none has a name. They move also where the cage does not
    std::vector<std::string> clips;           // names of the animations, "clip 0" etc. for those without
};

/// The cage is named by the file's stem. `clip`: name of an animation; empty: the first. `cycle`: seconds
/// after which the motion begins again; 0: it holds its last keys. Materials are read if there is a place to
/// keep their pictures. `clip_file`: where the animations are, instead of in the file itself: joints move as
/// those of the same name there (animation/retarget.h; of a file without skins, nodes). `crease_degrees`: see
/// hard_edges(). Throws UserError: one line `file: cause; mend`.
GltfModel read_gltf(const std::filesystem::path& path, const std::string& clip, double cycle,
                    TextureCache* textures = nullptr, const std::filesystem::path& clip_file = {},
                    double crease_degrees = no_crease_angle);

} // namespace razor
