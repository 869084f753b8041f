// A mesh as grids of one level: every patch 2^n x 2^n quads (sub-faces of n-gons 2^(n-1) x 2^(n-1)), flat
// patches of bilinear meshes one. What depends on topology alone is made once: which vertices there are, how
// each follows from control points (limit stencils by OpenSubdiv), how quads join them.
#pragma once

#include "razor/scene/scene.h"
#include "razor/surface/pages.h"
#include "razor/surface/topology.h"
#include "tests/benchmarks/embree/records.h"

#include <cstdint>
#include <vector>

namespace razor::baseline {

inline constexpr int finest_level = 10;

struct GridMesh {
    int level = 0; // n, after clamping
    std::vector<GridBlock> blocks;
    std::vector<float> weights;
    std::vector<std::int32_t> controls;
    std::vector<std::int32_t> quads; // four vertices each, for RTC_GEOMETRY_TYPE_QUAD: cut from the second to
                                     // the fourth, as Razor cuts from (0, 0) to (1, 1)
    std::int64_t triangles = 0;
    std::int32_t vertices = 0;
    /// Where patches meet all have the first one's vertex, so that there are no cracks: `to` becomes `from`.
    /// Where a flat patch meets a finer one, vertices in between lie on its edge but for rounding.
    struct Weld {
        std::int32_t to, from;
    };
    std::vector<Weld> welds;

    std::int64_t quad_count() const { return static_cast<std::int64_t>(quads.size() / 4); }
    std::int64_t bytes() const;
};

/// The coarsest level: 0, or 1 where there are n-gons.
int coarsest_level(const Topology& topology);

/// How many triangles a grid mesh of that level has.
std::int64_t triangles_at(const Topology& topology, int level);

/// `pages`: of the mesh and its topology; null for bilinear meshes.
GridMesh make_grid_mesh(const Topology& topology, const PageMaker* pages, int level);

} // namespace razor::baseline
