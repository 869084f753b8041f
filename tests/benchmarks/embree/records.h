// What the baseline's host code and its kernels share: plain data, scene coordinates (world minus the scene's
// origin) unless stated.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

namespace razor::baseline {

/// Of one grid of vertices: each is a sum of control points, weighted; so are its derivatives.
struct GridBlock {
    std::int64_t weights;     // of positions, from the mesh's weights: a row a control point
    std::int64_t derivatives; // likewise, two rows a control point: d/du, then d/dv; -1: flat
    std::int32_t row;         // floats of a row
    std::int32_t first_control, controls;
    std::int32_t first_vertex, vertices; // of the mesh
};

/// Geometry of the top scene: a tessellated mesh in scene coordinates, or an instance of one in its own.
struct Piece {
    std::int32_t first_quad;   // of its table, in the array of all quads' vertices
    std::int32_t first_vertex; // in the array of all vertices
    std::int32_t moved;        // 0: linear is 1 and shift 0
    float linear[9], shift[3]; // by rows
    float cofactors[9];        // of linear: where normals go
    float albedo[3];
};

struct LightSource {
    float corner[3], edge_u[3], edge_v[3], normal[3];
    float radiance[3];      // x area / (pi x samples)
    std::int32_t dimension; // of its sample points (razor/kernels/sampling.h)
};

struct FrameView {
    std::int32_t width, height, samples, light_samples, sky_samples, sample_seed;
    float camera[3], film_corner[3], film_x[3], film_y[3];
    float lens_x[3], lens_y[3], focus; // focus 0: a pinhole
    float sky[3], background[3];       // sky: radiance / samples
};

struct RenderArguments {
    RTCScene scene;
    const FrameView* view;
    const LightSource* lights;
    int light_count;
    const Piece* pieces;
    const float *positions, *normals; // x, y, z of each vertex
    const std::int32_t* quads;        // four vertices each, of the piece
    float* film;                      // planes as Film has them
};

struct TessellateArguments {
    const GridBlock* blocks;
    int count;
    const float* weights;
    const std::int32_t* controls; // point of each control
    const float* points;          // x, y, z
    float *positions, *normals;   // of the table's vertex 0
};

/// Rays traced, by kind.
struct RayCounts {
    std::int64_t camera = 0, light = 0, sky = 0, hits = 0;
};

/// The kernels of one target.
struct Kernels {
    const char* name;
    void (*tessellate)(const TessellateArguments&);
    void (*render_tile)(const RenderArguments&, int tile, RayCounts& counts);
};

} // namespace razor::baseline

#define RAZOR_BASELINE_TARGET(target)                                                                        \
    namespace razor::target {                                                                                \
    extern const razor::baseline::Kernels baseline_kernels;                                                  \
    }
RAZOR_BASELINE_TARGET(plain)
RAZOR_BASELINE_TARGET(sse4)
RAZOR_BASELINE_TARGET(avx2)
RAZOR_BASELINE_TARGET(avx512)
#undef RAZOR_BASELINE_TARGET
