// Polygons of PLY files (Turk 1994), in text or binary of either byte order, as cages.
//
// Read: of `vertex` x, y, z of any type, and texture coordinates (s, t; u, v; texture_u, texture_v; or
// texture_s, texture_t; v upwards); of `face` the list vertex_indices or vertex_index, of any number of
// corners. Their order and that of elements is free. Where vertices have texture coordinates or normals,
// those at one place are joined, as with MD3 and glTF: files keep them apart for these alone, and the surface
// is closed there; corners that so become one count once, and faces that lose their area to it are left out.
// Passed over: all other properties and elements, among them normals, colours, texture coordinates of faces,
// edges, triangle strips; comments, also those that name a TextureFile: a [[material]] says what shows it.
#pragma once

#include "razor/scene/scene.h"

#include <filesystem>
#include <string_view>

namespace razor {

/// The mesh is named by the file's stem, and has no materials. Throws UserError: one line, `file:line: cause;
/// mend` for what is text, else `file: face 3: cause; mend`; faces and vertices count from 0.
Mesh read_ply(const std::filesystem::path& path);

/// The same of a file's bytes; `file_name` is used in messages and for the mesh's name.
Mesh parse_ply(std::string_view bytes, std::string_view file_name);

} // namespace razor
