// Wavefront OBJ cages with OpenSubdiv's tag lines.
//
// Read: v (x y z; further numbers tolerated), vt, f (v, v/t, v//n, v/t/n, negative indices, any number of
// corners), and `t NAME nInts/nFloats/nStrings ...` tags: crease, corner, hole, interpolateboundary,
// facevaryinginterpolateboundary, creasemethod, smoothtriangles; the names of materials (what they are:
// obj_materials.h). Objects, groups and smoothing are passed over: one file is one cage. Normals, points and
// lines are passed over too, whatever their indices; free-form geometry is refused. A file without vt lines
// has no texture coordinates, whatever its faces name; faces that name none in a file where others do get (0,
// 0).
#pragma once

#include "razor/scene/scene.h"

#include <filesystem>
#include <string_view>

namespace razor {

/// What an OBJ file says of materials, as it says it.
struct ObjMaterialNames {
    std::vector<std::string> libraries; // what follows mtllib: one file's name, or several
    std::vector<std::string> names;     // what follows usemtl, each once
};

/// Reads `path` without materials; the mesh is named by the file's stem. Throws UserError: one line
/// `file:line: cause; mend`.
Mesh read_obj(const std::filesystem::path& path);

/// The same from text; `file_name` is used in messages and for the mesh's name. With `materials`,
/// Mesh::face_materials are indices into its names, -1 for faces before any; or empty, where there are no
/// names.
Mesh parse_obj(std::string_view text, std::string_view file_name, ObjMaterialNames* materials = nullptr);

} // namespace razor
