// A scene as its author states it: what a scene file holds, every default filled in. It is what
// --print-config prints and what outputs embed; build_scene() makes the renderer's Scene from it, once
// animation/pose.h has put what moves where it is at one moment.
#pragma once

#include "razor/scene/animation/deformer.h"
#include "razor/scene/animation/keys.h"
#include "razor/scene/animation/moving_cage.h"
#include "razor/scene/animation/named_nodes.h"
#include "razor/scene/animation/playback.h"
#include "razor/scene/animation/tags.h"
#include "razor/scene/from_model.h"
#include "razor/scene/graph/flatten.h"
#include "razor/scene/instance_table.h"
#include "razor/scene/models/hard_edges.h"
#include "razor/scene/scene.h"

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace razor {

/// One cage, where it comes from and where it goes. A point p lands at translate + Rz Ry Rx (scale p), in
/// double precision; objects place what has so become of it.
struct MeshDescription {
    std::string name;
    std::string file;                                       // absolute path of a model, or empty: a shape
    std::string shape;                                      // see razor/scene/shapes/shapes.h
    std::vector<std::pair<std::string, double>> parameters; // of the shape, all of them
    Scheme scheme = Scheme::catmull_clark;
    std::string material; // of all faces; empty: those that the file itself states, but for
    std::vector<std::pair<std::string, std::string>> materials; // names of these, each with what replaces it
    glm::dvec3 scale{1, 1, 1};                                  // positive
    glm::dvec3 rotate{0, 0, 0};    // degrees, about x, then y, then z; quarter turns are exact
    glm::dvec3 translate{0, 0, 0}; // world units
    double edge_length = 0;        // see Mesh::edge_length
    /// Of MD3 and glTF models, degrees: see hard_edges() (razor/scene/models/hard_edges.h).
    double crease_angle = no_crease_angle;
    Playback playback;               // of the file's motion, and when the deformers are at work
    std::vector<Deformer> deformers; // one after the other
    // As read or generated, before deformers, scale, rotate and translate: at the beginning, and its motion,
    // if any.
    std::shared_ptr<const Mesh> source;
    std::shared_ptr<const MovingCage> motion;
    std::shared_ptr<const Tags> tags;        // of MD3 models that have some, of the frames played
    std::shared_ptr<const NamedNodes> nodes; // of glTF models that have some, as its clip moves them
    std::shared_ptr<const Mesh> cage; // when the scene begins, or at playback.moment; before scale and so on
};

/// Lights [first, first + count) of a scene are these.
struct LightsFromModel {
    FromModel from;
    std::size_t first = 0, count = 0;
};

/// Whether the cage has other shapes at other moments.
bool changes_shape(const MeshDescription& mesh);

/// Where an object hangs: on a tag, or a node, of the mesh that another object of its list places
/// (attachment.h).
struct Attachment {
    std::string object, tag, node; // names; of tag and node one is empty
    // The same by number, which readers find: in the list, of its mesh in the scene, in the mesh's tags or
    // nodes.
    std::size_t carrier = 0, mesh = 0, place = 0;
};

/// Puts a mesh, a group, or all rows of a table of instances somewhere, once or as a regular array.
struct ObjectDescription {
    std::string name;
    std::string mesh, group;                    // name of what is placed, or empty
    std::string instances;                      // absolute path of a table, or empty
    std::shared_ptr<const InstanceTable> table; // as read from there
    std::string material;                       // of all below that states none itself; empty: as it has
    Transform transform;
    TransformKeys keys; // of the transform, which is no matrix then
    std::optional<Attachment> attachment;
    glm::ivec3 copies{1, 1, 1};  // see Placement
    glm::dvec3 spacing{0, 0, 0}; // units of the group that holds the object
    int level_offset = 0;
    double rate = 1;
};

/// Objects that other objects place together; not drawn by itself.
struct GroupDescription {
    std::string name;
    std::vector<ObjectDescription> objects;
};

/// A mesh that some object places (by name, or as a row of a table) is drawn there only; every other mesh is
/// drawn where it stands.
struct SceneDescription {
    std::string name;
    Settings settings;
    Camera camera;
    std::optional<Camera> dicing_camera;
    glm::vec3 sky{0};
    SkyMap sky_map; // names one of these textures
    std::vector<Light> lights;
    double frame_rate = 24; // frames a second
    CameraKeys camera_keys;
    std::vector<LightKeys> light_keys; // of each light, or none
    // What models bring; camera and lights are then as when the scene begins, in a picture of its size.
    std::optional<FromModel> camera_from;
    std::vector<LightsFromModel> lights_from; // in order
    std::vector<Texture> textures;
    std::vector<Material> materials; // their maps name these textures
    std::vector<MeshDescription> meshes;
    std::vector<GroupDescription> groups;
    std::vector<ObjectDescription> objects;
};

/// The cage's points where the scene has them.
std::vector<glm::dvec3> placed_points(const MeshDescription& mesh);

/// Of the points that faces use, where each mesh stands before objects place it.
std::vector<Box> mesh_bounds(const SceneDescription& description);

/// Where the meshes are drawn. Of two meshes read from one file, tables place the first. Empty where there
/// are neither objects nor groups. Throws UserError for names that are not there.
SceneGraph build_graph(const SceneDescription& description);

/// Of that number, where the scene has it.
Mesh build_mesh(const SceneDescription& description, std::size_t mesh);

/// What keys say is left out: see animation/pose.h. Tags are where they are when the scene begins.
Scene build_scene(const SceneDescription& description);

/// What of its models' files was not read though it would be seen, a line each.
std::vector<std::string> notes_of(const SceneDescription& description);

/// A complete scene file: loading it gives the same scene.
std::string to_toml(const SceneDescription& description);

} // namespace razor
