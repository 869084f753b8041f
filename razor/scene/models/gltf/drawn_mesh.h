// One mesh of a glTF file as one of its nodes draws it.
#pragma once

#include "razor/scene/animation/skin.h"
#include "razor/scene/models/gltf/document.h"
#include "razor/scene/models/hard_edges.h"

#include <glm/vec2.hpp>

namespace razor::gltf {

/// Triangles over shared points: what the file splits at seams of texture and of normals is joined again.
struct DrawnMesh {
    Skin skin;
    std::vector<int> triangles;        // points of `skin`, three a triangle, all distinct
    std::vector<int> materials;        // of each triangle, in the file; -1: none
    std::vector<glm::vec2> texcoords;  // v upwards
    std::vector<int> corner_texcoords; // texture coordinate of each corner, -1: none
    std::vector<Crease> creases;       // between points of `skin`
};

/// All triangles of the node's mesh; points and lines are passed over. `crease_degrees`: see hard_edges();
/// normals are of the mesh at rest. Throws UserError.
DrawnMesh read_drawn_mesh(const Document& document, int node, double crease_degrees = no_crease_angle);

} // namespace razor::gltf
