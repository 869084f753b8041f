// The frame that Razor renders, by Embree: cages tessellated at fixed levels, BVHs built anew, packets of
// sixteen.
#pragma once

#include "razor/image/image.h"
#include "razor/scene/scene.h"
#include "tests/benchmarks/embree/records.h"

#include <cstdint>
#include <memory>

namespace razor::baseline {

enum class Quality { low, medium, high }; // of BVHs: Embree's build quality

/// How finely what is tessellated, whatever the scene says (levels.h).
enum class Levels {
    instance,  // by edges, at the nearest point of each instance
    mesh,      // ... of all instances of a mesh
    deviation, // of each instance's from the surface; as meshes are when they first appear
    uniform,   // one for all
};

struct Options {
    int threads = 1;
    std::string isa = "auto"; // of tessellation and shading; Embree takes what it likes best
    Quality quality = Quality::medium;
    Levels levels = Levels::instance;
    int finer = 0; // than levels_of() or levels_by_deviation() else
    /// Meshes whose instances have no more triangles together than this are drawn as so many meshes of their
    /// own, whose rays need no transform; larger ones once, by instances.
    std::int64_t flatten = 0;
    std::int64_t most_triangles = 100'000'000; // of all that is tessellated
};

struct Seconds {
    double place = 0;      // world transforms, control points and levels
    double tessellate = 0; // vertices and normals
    double build = 0;      // BVHs
    double trace = 0;      // with shading
    double processor = 0;  // of all threads, of all the above
    double topology = 0;   // beside them: stencils and indices that later frames find

    double all() const { return place + tessellate + build + trace; }
};

struct Report {
    Seconds seconds;
    std::int64_t triangles = 0;           // tessellated
    std::int64_t instanced_triangles = 0; // drawn
    std::int64_t pieces = 0, grid_meshes = 0;
    std::int64_t bvh_bytes = 0, vertex_bytes = 0, topology_bytes = 0;
    RayCounts rays;
};

class Renderer {
public:
    /// Throws UserError where `options` cannot be had.
    explicit Renderer(const Options& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Everything but topology is made anew. Throws UserError for scenes that cannot be rendered.
    Film render(Scene scene, Report& report);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor::baseline
