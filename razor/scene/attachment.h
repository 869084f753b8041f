// Objects that hang on tags of other objects' meshes, as a head on a body.
#pragma once

#include "razor/scene/description.h"

#include <cstddef>
#include <vector>

namespace razor {

/// Where object number `object` of a list (a group's, or the scene's) is `seconds` after the scene's
/// beginning, in the units of the group that holds the list: by its transform and keys alone, unless it is
/// attached. Then these say where it is beside the tag, and the result is a matrix: where the carrier is,
/// after the tag's place, after the object's own transform.
///
/// A tag is a map in the coordinates of the carrier's file. Scale, rotate and translate of the carrier's
/// [[mesh]], M, carry it over to the coordinates in which that mesh is placed, as M tag M^-1. So a model with
/// the same three numbers is where the file says; and what stands on a tag that does not move from the file's
/// origin is where it would stand beside the carrier.
Transform place_at(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                   std::size_t object, double seconds);

/// The same when the scene begins, and without what keys say.
Transform stated_place(const SceneDescription& description, const std::vector<ObjectDescription>& objects,
                       std::size_t object);

} // namespace razor
