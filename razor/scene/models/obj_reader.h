// Wavefront OBJ cages with OpenSubdiv's tag lines.
//
// Read: v (x y z; further numbers tolerated), vt, f (v, v/t, v//n, v/t/n, negative indices, any number of
// corners), and `t NAME nInts/nFloats/nStrings ...` tags: crease, corner, hole, interpolateboundary,
// facevaryinginterpolateboundary, creasemethod, smoothtriangles. Objects, groups, materials and smoothing are
// passed over: one file is one cage. Normals, points and lines are passed over too, whatever their indices;
// free-form geometry is refused. A file without vt lines has no texture coordinates, whatever its faces name;
// faces that name none in a file where others do get (0, 0).
#pragma once

#include "razor/scene/scene.h"

#include <filesystem>
#include <string_view>

namespace razor {

/// Reads `path`; the mesh is named by the file's stem. Throws UserError: one line `file:line: cause; mend`.
Mesh read_obj(const std::filesystem::path& path);

/// The same from text; `file_name` is used in messages and for the mesh's name.
Mesh parse_obj(std::string_view text, std::string_view file_name);

} // namespace razor
