// A scene as its author states it: what a scene file holds, every default filled in. It is what
// --print-config prints and what outputs embed; build_scene() makes the renderer's Scene from it.
#pragma once

#include "razor/scene/scene.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace razor {

/// One cage, where it comes from and where it goes. A point p lands at translate + Rz Ry Rx (scale p), in
/// double precision.
struct MeshDescription {
    std::string name;
    std::string file;                                       // absolute path of an OBJ file, or empty: a shape
    std::string shape;                                      // see razor/scene/shapes/shapes.h
    std::vector<std::pair<std::string, double>> parameters; // of the shape, all of them
    Scheme scheme = Scheme::catmull_clark;
    std::string material;
    glm::dvec3 scale{1, 1, 1};        // positive
    glm::dvec3 rotate{0, 0, 0};       // degrees, about x, then y, then z; quarter turns are exact
    glm::dvec3 translate{0, 0, 0};    // world units
    double edge_length = 0;           // see Mesh::edge_length
    std::shared_ptr<const Mesh> cage; // as read or generated, before scale, rotate and translate
};

struct SceneDescription {
    std::string name;
    Settings settings;
    Camera camera;
    glm::vec3 sky{0};
    std::vector<RectangleLight> lights;
    std::vector<Material> materials;
    std::vector<MeshDescription> meshes;
};

/// Reads or generates the cage of a mesh whose file or shape and parameters are set. Throws UserError.
void load_cage(MeshDescription& mesh);

/// The cage's points where the scene has them.
std::vector<glm::dvec3> placed_points(const MeshDescription& mesh);

Scene build_scene(const SceneDescription& description);

/// A complete scene file: loading it gives the same scene.
std::string to_toml(const SceneDescription& description);

} // namespace razor
