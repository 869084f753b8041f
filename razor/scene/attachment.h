// Objects that hang on tags or nodes of other objects' meshes, as a head on a body or a sword in a hand.
#pragma once

#include "razor/scene/description.h"

#include <cstddef>
#include <vector>

namespace razor {

/// Where object number `object` of a list (a group's, or the scene's) is `seconds` after the scene's
/// beginning, in the units of the group that holds the list: by its transform and keys alone, unless it is
/// attached. Then these say where it is beside the tag or node, and the result is a matrix: where the carrier
/// is, after the tag's or node's place, after the object's own transform.
///
/// Tags are turns and shifts in the coordinates of the carrier's file, nodes whole maps: what hangs on a node
/// is scaled as the node's children are. Scale, rotate and translate of the carrier's [[mesh]], M, carry
/// either over to the coordinates in which that mesh is placed, as M tag M^-1. So a model with the same three
/// numbers is where the file says; and what stands on a tag that does not move from the file's origin is
/// where it would stand beside the carrier.
///
/// Throws UserError where a node is flat at that moment.
Transform place_at(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                   std::size_t object, double seconds);

/// The same when the scene begins, and without what keys say.
Transform stated_place(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                       std::size_t object);

/// Whether it hangs on something that moves in its carrier's mesh.
bool hangs_on_motion(const SceneDescription& description, const ObjectDescription& object);

} // namespace razor
