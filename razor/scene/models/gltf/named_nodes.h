// Which nodes of a glTF file can be told by their names.
#pragma once

#include "razor/scene/animation/named_nodes.h"
#include "razor/scene/models/gltf/document.h"

#include <vector>

namespace razor::gltf {

/// Those with a name, each after what it is below: of the nodes that the file's scene draws, and joints of
/// skins. Throws UserError as nodes_to_draw() does.
std::vector<NamedNode> named_nodes(const Document& document, const Skeleton& skeleton);

} // namespace razor::gltf
