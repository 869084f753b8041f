// A glTF file's nodes and animations as skeleton and clip.
#pragma once

#include "razor/scene/animation/skeleton.h"
#include "razor/scene/models/gltf/document.h"

namespace razor::gltf {

/// All nodes of the file. Throws UserError: circles, two parents, numbers that are not finite.
Skeleton read_skeleton(const Document& document);

/// Nodes that the file's scene draws (without scenes: all), each after its parent.
std::vector<int> nodes_to_draw(const Document& document, const Skeleton& skeleton);

/// Names of the animations, "clip 0" and so on for those without.
std::vector<std::string> clip_names(const Document& document);

/// The number of the one called so. Throws UserError, telling those that there are.
std::size_t find_clip(const Document& document, const std::vector<std::string>& clips,
                      const std::string& name);

/// The channels of an animation that do something to a node. Throws UserError.
Clip read_clip(const Document& document, const Skeleton& skeleton, std::size_t animation);

/// Morph targets of a mesh: the most that any of its primitives has.
std::size_t target_count(const MeshEntry& mesh);

/// By columns; the last row must be 0, 0, 0, 1. Throws UserError.
Affine to_affine(const Document& document, const double* matrix, std::string_view what);

} // namespace razor::gltf
