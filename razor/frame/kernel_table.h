// What a target's kernels offer to the host: one table of functions, the same signature for every target.
#pragma once

#include "isa/services.h"
#include "razor/frame/counters.h"
#include "razor/frame/layout.h"

namespace razor {

struct WorkerArguments {
    FrameHeader* frame = nullptr;
    int worker = 0;
    isa::page_service* pages = nullptr;
    Counters* counters = nullptr;      // one a kind of ray
    isa::mark_set* opened = nullptr;   // of the worker's tree: graph nodes, then clusters of instances
    isa::stopwatch* watch = nullptr;   // of Moment
    isa::lap_timer* tiles = nullptr;   // of the worker
    isa::lap_timer* waits = nullptr;   // likewise
    isa::memory_log* memory = nullptr; // with a budget
};

/// Rays as arrays of `count` floats in frame memory; results likewise. Directions are unit vectors, scene
/// coordinates.
struct TraceArguments {
    const float* origin[3] = {};
    const float* direction[3] = {};
    const float* t_min = nullptr;
    const float* t_max = nullptr;
    /// Target edge lengths: |base + slope . way| + growth |way|, `way` from where the ray begins; |slope| +
    /// |growth| at most gradation_cap. Null: the finest level everywhere.
    const float* base = nullptr;
    const float* growth = nullptr;
    const float* slope[3] = {};
    int count = 0;
    bool any_hit = false;
    // Closest hit: distance, weights, patch (-1: none), block number * 128 + quad * 2 + which. Any hit: patch
    // only.
    float* t = nullptr;
    float* u = nullptr;
    float* v = nullptr;
    std::int32_t* patch = nullptr;
    std::int32_t* triangle = nullptr;
};

/// `count` pixels of the picture, seen by a ray each: through the pixel's centre, with a lens from its
/// middle. Closest hits, named as TraceArguments does; `block`: the hit block's line of the grids; `point`:
/// where it is hit, scene coordinates.
struct SeeArguments {
    const std::int32_t* column = nullptr;
    const std::int32_t* row = nullptr;
    int count = 0;
    float* point[3] = {};
    float* t = nullptr;
    float* u = nullptr;
    float* v = nullptr;
    std::int32_t* patch = nullptr;
    std::int32_t* triangle = nullptr;
    std::int32_t* block = nullptr;
};

/// What tracing rays is compiled for: whether some patch has sides coarser than its grid.
enum Grids : int { grids_flat = 0, grids_hanging = 1, grids_count = 2 };
/// What shading is compiled for: everything matte, or also what reflects, lets through and emits; one
/// material a mesh, or also textures and materials of faces.
enum Look : int { look_matte = 0, look_mapped = 1, look_glossy = 2, look_glossy_mapped = 3, look_count = 4 };

/// Which instantiations of the kernels a frame needs.
struct Plan {
    Grids grids = grids_flat;
    Look look = look_matte;
};

struct KernelTable {
    const char* name;
    int width; // lanes
    /// One worker's share of a frame. Every worker of the frame must call it.
    void (*render[look_count][grids_count])(const WorkerArguments&);
    /// Refits, then traces rays in packets of consecutive rays: for tests and benchmarks. One worker only.
    void (*trace[grids_count])(const WorkerArguments&, const TraceArguments&);
    /// Refits and splits every node, so that every patch is opened and nothing is lazy: the oracle's tree.
    /// One worker only.
    void (*build_all)(const WorkerArguments&);
    /// Refits and makes, of every patch, the blocks that camera rays may ask for anywhere, seen or not, with
    /// normals. One worker only.
    void (*dice_all)(const WorkerArguments&);
    /// Traces what camera rays see, as the frame's own do: with their field, past what textures cut out,
    /// within the memory budget, counted as theirs; in packets of consecutive rays. One worker only.
    void (*see[grids_count])(const WorkerArguments&, const SeeArguments&);
    /// Column and row of each screen tile of the part that is rendered, by its number, counted in tiles from
    /// the part's first: two numbers a tile.
    void (*place_tiles)(const WorkerArguments&, std::int32_t* places);
};

// One a target; those that the build left out are not defined.
namespace plain {
extern const KernelTable kernels;
}
namespace sse4 {
extern const KernelTable kernels;
}
namespace avx2 {
extern const KernelTable kernels;
}
namespace avx512 {
extern const KernelTable kernels;
}
namespace simulated {
extern const KernelTable kernels;
}

} // namespace razor
