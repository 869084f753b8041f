// Closed cages for the experiments, and points inside them.
#pragma once

#include "razor/scene/scene.h"

#include <glm/vec3.hpp>

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace razor::reference {

using Shape = std::function<glm::dvec3(glm::dvec3)>;
using PointMaker = std::function<glm::dvec3(std::mt19937&)>;

/// A closed cage, a map that bends its bilinear patches, and a way to make points well inside.
struct Case {
    std::string name;
    Mesh mesh;
    Shape shape;        // pure function of a point; empty: leave it
    bool limit = false; // Catmull-Clark limit instead of bent bilinear patches
    double relief = 0;  // size of the displacement that is filtered by level; 0: none
    PointMaker inside;  // inside at every level
    bool convex = false;
};

/// "sphere" (bumpy), "torus" (bumpy), "ball" (convex), "prism" (pentagons, bent to a ball), "relief" (the
/// sphere, displaced), "limit" (Catmull-Clark torus). Throws std::invalid_argument on other names.
Case make_case(const std::string& name);
const std::vector<std::string>& case_names();

/// Uniform in [0, 1).
double uniform(std::mt19937& random);
glm::dvec3 random_direction(std::mt19937& random);

} // namespace razor::reference
