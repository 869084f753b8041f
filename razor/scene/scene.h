// What the user asked to have rendered, as plain host data: cages, materials, lights, camera, settings.
// World space is right-handed, y up; lengths are in the scene's own unit. Coordinates are double: one
// double-precision origin is subtracted from each mesh before anything becomes single precision.
#pragma once

#include "razor/scene/filter.h"
#include "razor/scene/graph/graph.h"
#include "razor/scene/light.h"
#include "razor/scene/material.h"
#include "razor/scene/texture.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace razor {

enum class Scheme : std::uint8_t { catmull_clark, bilinear };
enum class BoundaryInterpolation : std::uint8_t { none, edge_only, edge_and_corner };
enum class CreaseMethod : std::uint8_t { normal, chaikin };
enum class TriangleSubdivision : std::uint8_t { catmull_clark, smooth };
/// OpenSubdiv's Sdc::Options::FVarLinearInterpolation, in its order.
enum class FaceVaryingInterpolation : std::uint8_t {
    none,
    corners_only,
    corners_plus1,
    corners_plus2,
    boundaries,
    all
};

/// Sharpness of 10 and above is infinitely sharp (OpenSubdiv).
inline constexpr float infinite_sharpness = 10.0F;

struct Crease {
    int v0 = 0, v1 = 0;
    float sharpness = 0;

    bool operator==(const Crease&) const = default;
};
struct Corner {
    int vertex = 0;
    float sharpness = 0;

    bool operator==(const Corner&) const = default;
};

/// What a model's file says that its surfaces are made of; maps name its own textures.
struct ModelMaterials {
    std::vector<Material> materials;
    std::vector<Texture> textures;
    /// What of their files was not read though it would be seen: a line each, for users.
    std::vector<std::string> notes{};
    /// Of each material what else users may call it by: the surface of an MD3 model that it is of. Or empty.
    std::vector<std::string> parts{};
};

/// A cage: polygons over shared points. Invariants (checked by validate_mesh): at least one face; every face
/// has 3 or more distinct corners; every index in range; points finite; as many in rest, and materials of as
/// many faces, if any.
struct Mesh {
    std::string name;
    Scheme scheme = Scheme::catmull_clark;
    std::vector<glm::dvec3> points;
    /// Of a cage that changes its shape: points by which polygons are cut into triangles, and none is taken
    /// as planar, so that all its shapes consist of the same patches. Empty: `points` stay as they are.
    std::vector<glm::dvec3> rest;
    std::vector<int> face_sizes; // corners of each face
    std::vector<int>
        face_vertices; // point indices, concatenated over faces, counter-clockwise seen from outside
    std::vector<glm::vec2> texcoords;
    std::vector<int> face_texcoords; // per corner like face_vertices, or empty: no texture coordinates
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<int> holes; // face numbers
    BoundaryInterpolation boundary = BoundaryInterpolation::edge_only;
    FaceVaryingInterpolation face_varying = FaceVaryingInterpolation::corners_only;
    CreaseMethod crease_method = CreaseMethod::normal;
    TriangleSubdivision triangles = TriangleSubdivision::catmull_clark;
    int material = 0; // index into Scene::materials
    /// Of each face, indices likewise; empty: all are of `material`.
    std::vector<int> face_materials;
    /// Of a cage as its file has it: what `material` and `face_materials` are indices into, -1 standing for
    /// none of them. Null, as in every scene: Scene::materials.
    std::shared_ptr<const ModelMaterials> own_materials{};
    /// Target edge length in world units. 0: from the camera (settings.edge_pixels). Rounded to a power of
    /// two when used.
    double edge_length = 0;
};

enum class Projection : std::uint8_t { perspective, orthographic };

/// Rays of an orthographic camera are parallel: they begin on the film, which is at `position`, and what is
/// behind it is not seen. It has no lens: what rays ask for has one constant term (razor/kernels/morph.h),
/// which is the lens' blur or a pixel's size, not the sum of both.
struct Camera {
    glm::dvec3 position{0, 1, 5};
    glm::dvec3 target{0, 0, 0};
    glm::dvec3 up{0, 1, 0};
    Projection projection = Projection::perspective;
    double fov_degrees = 35; // of a perspective one: vertical, full angle, in (0, 180)
    double height = 2;       // of an orthographic one: what its film covers, world units
    /// Of a perspective camera's thin lens, world units; 0: a pinhole, everything is in focus.
    double aperture_radius = 0;
    /// From the camera to the plane in focus, along the line of sight; 0: to the target.
    double focus_distance = 0;
};

constexpr bool has_lens(const Camera& camera) {
    return camera.projection == Projection::perspective && camera.aperture_radius > 0;
}

/// The same, resolved.
inline double focus_distance(const Camera& camera) {
    return camera.focus_distance > 0 ? camera.focus_distance : glm::length(camera.target - camera.position);
}

/// A picture of all directions, by longitude and latitude: its top row is straight up (y), its middle column
/// where -z is, and what lies to the right of that (x) is right of the middle.
struct SkyMap {
    int texture = -1;    // index into Scene::textures; -1: none
    double rotation = 0; // degrees about y, counter-clockwise seen from above

    bool operator==(const SkyMap&) const = default;
};

/// Which level of detail rays see.
enum class Lod : std::uint8_t {
    recursive, // every ray its own, continuously (razor/kernels/morph.h)
    discrete,  // the same levels, from one to the next at once: with holes and pops, to compare with
    patch,     // every ray each patch at one level: with cracks between patches, to compare with
    paper,     // "Razor" (Djeu et al., TOG 2011): with holes, to compare with
    camera,    // all rays what the camera's rays see
    object,    // all rays one level of each instance, that of its nearest point
    fixed,     // all rays one level of each mesh, the finest that any instance of it has with `object`
};

/// Whether rays see the finest level everywhere.
constexpr bool one_level(Lod lod) {
    return lod == Lod::object || lod == Lod::fixed;
}

struct LevelOfDetail {
    Lod lod = Lod::recursive;
    int coarser = 0; // one level: so many above the finest, each doubling the target edge

    bool operator==(const LevelOfDetail&) const = default;
    bool operator==(Lod other) const { return lod == other; }
    LevelOfDetail() = default;
    constexpr LevelOfDetail(Lod l, int c = 0) : lod(l), coarser(c) {}
};

/// A part of a picture, pixels from its top left corner.
struct Crop {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const Crop&) const = default;
};

/// Where what textures make of surfaces is found: at vertices of the grids that camera rays hit, as far as
/// surfaces have any, and at other hits; at hits only; or as with grids, flat faces being cut into grids,
/// too.
enum class Shading : std::uint8_t { grids, hits, diced };

struct Settings {
    LevelOfDetail lod{};
    Shading shading = Shading::grids;
    int width = 512, height = 512; // pixels
    Crop crop{};                   // what is rendered of them; without width and height: all
    Filter filter{};               // what pixels are of the light about them
    int samples = 4;               // camera samples a pixel
    /// Not 0: each screen tile takes as many as it needs for its noise to be no more, at most `samples`
    /// (razor/native/adaptive_sampling.h says what is measured).
    double noise_threshold = 0;
    int light_samples = 4; // shadow rays a hit to each light; 0: lights are left out
    /// Where more than twelve times so many lights have a place, so many shadow rays a hit go to some that
    /// are chosen by what they may give, in place of some to each; 0: always to each.
    int light_choices = 16;
    int sky_samples = 4;      // shadow rays a hit to the sky; 0: it lights nothing
    int bounces = 4;          // reflections and refractions in a row that are followed
    int diffuse_bounces = 0;  // the first so many of them also of light that goes in all directions
    bool everything = false;  // kernels that can do all that a scene may need, whether this one does
    int seed = 0;             // another takes other samples of the same picture
    double edge_pixels = 1.0; // target edge length in pixels where a mesh states no length
};

/// What is rendered of the picture, all of it where no crop is set.
constexpr Crop shown_part(const Settings& s) {
    return s.crop == Crop{} ? Crop{0, 0, s.width, s.height} : s.crop;
}

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    SceneGraph graph; // where they are drawn; without groups: each once, where its points lie
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Light> lights;
    glm::vec3 sky{0}; // radiance from infinitely far away; with a map, times what that shows
    SkyMap sky_map;
    Camera camera;
    std::optional<Camera> dicing_camera; // from which levels of detail are measured; else `camera`
    Settings settings;
};

/// The camera from which levels of detail are measured.
inline const Camera& dicing_camera(const Scene& scene) {
    return scene.dicing_camera ? *scene.dicing_camera : scene.camera;
}

} // namespace razor
