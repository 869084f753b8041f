// Quake III MD3 models (binary, little endian, version 15): triangles whose points move from frame to frame.
//
// Read: of every surface the triangles, names of shaders, texture coordinates and, in every frame, the
// points. All surfaces become one cage. The format splits points where texture coordinates or normals differ
// and between surfaces; points that lie at the same place in every frame are joined again, so that the cage
// has no seams to open when it is subdivided. Triangles of which two corners are joined are left out, then
// points that no triangle names. Points and texture coordinates keep the order of the file. The format's
// triangles run clockwise seen from outside, and its t downwards: corners are turned, and v = 1 - t. A
// texture coordinate is shared between corners where the points are joined and both numbers agree; elsewhere
// there is a seam.
//
// Of stored normals those of frame 0 say, if that is asked for, which edges are hard: these become creases.
//
// Also read: tags, the places where other models are attached, in every frame. Whether their axes are any is
// asked of those that are used (razor/scene/animation/tags.h).
//
// Passed over: boxes of frames. What surfaces look like: md3_materials.h.
// Coarser levels of detail are files of their own (_1.md3, _2.md3). Which frames make which movement, and at
// what rate, stands in the game's animation.cfg, which is not read. The limits of the game (1024 frames, 32
// surfaces, 4096 vertices a surface) are not enforced.
#pragma once

#include "razor/scene/animation/tags.h"
#include "razor/scene/models/hard_edges.h"
#include "razor/scene/scene.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

struct Md3Surface {
    std::string name;
    std::vector<std::string> shaders{}; // names or paths, as the file has them
};

/// One cage of all surfaces, with the points of frame 0, and where the points are in every frame (also frame
/// 0). Lengths in units of the game (multiples of 1/64, in [-512, 512)), z up.
struct Md3Model {
    Mesh cage;
    std::vector<std::vector<glm::dvec3>> frames; // one or more, each as long as cage.points
    std::vector<TagFrames> tags;                 // of as many frames, in the order of the file
    std::vector<Md3Surface> surfaces{};          // likewise
    std::vector<int> face_surfaces{};            // of each face of the cage the number of its surface
};

/// Reads `path`; the cage is named by the file's stem. `crease_degrees`: see hard_edges(). Throws UserError:
/// one line `file: cause; mend`, with the surface and where it begins in the file, if it is about one.
Md3Model read_md3(const std::filesystem::path& path, double crease_degrees = no_crease_angle);

/// The same from the file's bytes; `file_name` is used in messages and for the cage's name.
Md3Model parse_md3(std::string_view bytes, std::string_view file_name,
                   double crease_degrees = no_crease_angle);

} // namespace razor
