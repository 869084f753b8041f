// Joints of glTF files by their names.
#pragma once

#include "razor/scene/models/gltf/document.h"

namespace razor::gltf {

/// For each node of `document` the one of `other` that is called like it, -1: none. Only joints of skins
/// count; in a file without skins all nodes do. Throws UserError where none is, and where names that matter
/// come twice.
std::vector<int> match_joints(const Document& document, const Document& other);

} // namespace razor::gltf
