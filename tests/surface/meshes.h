// Cages for the tests: small ones made here, real ones read from RAZOR_SHARED_SCENES.
#pragma once

#include "razor/scene/scene.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace razor::test {

/// Faces as lists of points; point positions are pseudo-random in [-1, 1]^3 unless given.
Mesh cage(int points, const std::vector<std::vector<int>>& faces, Scheme scheme = Scheme::catmull_clark);

Mesh quad_grid(int columns, int rows);
Mesh cube();
/// `valence` quads round one interior point.
Mesh quad_pole(int valence);
/// `valence` triangles round one interior point, and a ring of quads outside them.
Mesh triangle_pole(int valence);
/// A prism over an n-gon.
Mesh prism(int sides);
/// Two n-gons back to back: every point is interior and has two faces.
Mesh pillow(int sides);

bool have_shared_scenes();
Mesh shared_mesh(const std::string& path_below_scenes);
/// All of osd/ that can be rendered, sorted; the bilinear_* files as bilinear meshes. Says why of each that
/// cannot.
std::vector<Mesh> osd_meshes();
/// Small cages that are hard in one way each.
std::vector<Mesh> hard_meshes();

double extent(const Mesh& mesh); // diagonal of the bounding box

} // namespace razor::test
