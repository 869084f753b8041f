// The records that a frame reads and builds, exactly as they lie in frame memory on every target. Plain data, shared by
// the host code that fills the persistent part and the kernels that read it. Lengths are world units relative to the
// mesh's double-precision origin unless stated. Indices are 32 bits and count records of the array they name.
//
// A *patch* is a quadrilateral piece of surface with parameters (u, v) in [0,1]^2: a quad face, one sub-face of an n-gon
// (corner c to its two edge midpoints and the centre), or a flat triangle. Corner 0 is (0,0), 1 (1,0), 2 (1,1), 3 (0,1).
// Side 0 is v = 0 and side 2 is v = 1 (both run along u); side 1 is u = 1 and side 3 is u = 0 (both run along v).
//
// A *curve* is what patches share: a cage edge, running from its lower- to its higher-numbered point, or a *spoke* of an
// n-gon, running from an edge midpoint to the face centre. Its points are evaluated by its owner only, whoever asks
// (design: shared points have one owner), so that neighbours agree bit for bit.
#pragma once

#include <cstdint>

namespace razor {

enum class PatchKind : std::int32_t {
    catmull_clark = 0, // limit surface: positions from pages of weights
    bilinear = 1,      // bilinear in its four corners
    flat_quad = 2,     // planar convex quad of a bilinear mesh: two triangles at every level
    flat_triangle = 3, // corners 0, 1, 2; corner 3 repeats corner 2
};

/// A limit-surface face (quad or n-gon) of a cage, or any face of a bilinear mesh (face_class -1; controls = its corners).
struct FaceRecord {
    std::int32_t face_class;    // index of the ClassRecord, or -1
    std::int32_t control_first; // its control points: controls[control_first ... + control_count)
    std::int32_t control_count;
    std::int32_t corner_count;
    std::int32_t curve_first; // face_curves[curve_first + i] is the curve of the edge from corner i to corner i+1
};

/// Where the limit position of a cage point is evaluated: the lowest-numbered incident face, its lowest such corner.
struct VertexRecord {
    std::int32_t owner_face;
    std::int32_t owner_corner;
};

enum CurveFlags : std::int32_t {
    curve_owner_reversed = 1, // the owner's edge runs from the higher- to the lower-numbered point
    curve_spoke = 2,
};

struct CurveRecord {
    std::int32_t owner_face;
    std::int32_t owner_local; // edges: corner i of the owner's edge i -> i+1; spokes: corner_count + i, from midpoint of edge i
    std::int32_t flags;
    std::int32_t end0, end1; // edges: points, end0 < end1. Spokes: end0 = the curve of edge i, end1 = the face
};

enum SideFlags : std::int32_t {
    side_reversed = 1, // the side runs against its curve
    side_half = 2,     // the side is the half of its curve next to the side's start (always a cage point)
};

enum class CornerKind : std::int32_t { vertex = 0, curve_middle = 1, face_centre = 2 };

/// 64 bytes. With s in [0,1] along a side, its curve parameter is t = half ? s/2 : s, then 1 - t if reversed.
struct PatchRecord {
    PatchKind kind;
    std::int32_t mesh;
    std::int32_t face;
    std::int32_t sub; // sub-face (corner) of an n-gon, else 0
    std::int32_t side_curve[4];
    std::int32_t side_flags[4];
    std::int32_t corner[4]; // quads and triangles: points. Sub-faces: point, curve (middle), face (centre), curve (middle)
};
static_assert(sizeof(PatchRecord) == 64);

// --- grids and blocks -------------------------------------------------------------------------------------------------
// A patch of exponents (Nu, Nv) has 2^Nu x 2^Nv quads, cut into blocks of at most 8 x 8 quads (9 x 9 vertices).
inline constexpr int block_log2 = 3;
inline constexpr int block_quads = 1 << block_log2;
inline constexpr int block_side = block_quads + 1;
inline constexpr int block_vertices = block_side * block_side;
inline constexpr int max_exponent_limit = 8; // of a curve; a mesh may have to use less (MeshRecord::max_exponent)

// Strips number the block columns (or rows, or curve chunks) of all exponents in one sequence:
// exponent N has max(1, 2^(N-3)) of them, the first at strip_first(N).
template <class Int> constexpr Int strip_first_large(Int power) { return power + 2; } // power = 2^(N-3), N >= 3
constexpr int strip_first(int exponent) { return exponent < 3 ? exponent : (1 << (exponent - 3)) + 2; }
constexpr int strip_count(int exponent) { return exponent < 3 ? 1 : 1 << (exponent - 3); }

// --- topology pages ---------------------------------------------------------------------------------------------------
// Weights over a face's control points, made by the host on request and immutable from then on. Each has an address fixed
// by its key: lines are 64 bytes; page = class base + section first + index * section stride. Line 0 of a page holds the
// word PageHeader::present; the rows of weights follow from line 1.
inline constexpr int line_bytes = 64;
struct alignas(line_bytes) Line {
    std::int32_t word[line_bytes / 4];
};

enum class PageKind : std::int32_t {
    vertex = 0,     // index = corner (or corner_count: the centre). One row of control_count weights, zero-padded to the width
    curve = 1,      // index = ((local * 2 + reversed) * strips + strip). control_count rows of 16: points (8*chunk + i)/2^N, i = 0..8
    block = 2,      // index = (sub * strips + u strip) * strips + v strip. control_count rows, one weight a vertex j*(nu+1)+i,
                    // padded to the width; positions
    derivative = 3, // as block; two rows a control point: d/du then d/dv (only their cross product's direction matters)
};
inline constexpr int page_kinds = 4;
inline constexpr int curve_row = 16; // floats a row of a curve page

struct ClassRecord {
    std::int64_t base_line; // of the class's pages, relative to the first page line of the frame
    std::int32_t control_count;
    std::int32_t corner_count;
    std::int32_t strips;                 // strip_first(max_exponent + 1) of the mesh
    std::int32_t first[page_kinds];      // lines from the base
    std::int32_t stride[page_kinds];     // lines a page
    std::int32_t padding;
};

// --- scene ------------------------------------------------------------------------------------------------------------
struct MeshRecord {
    float origin[3]; // of the mesh, relative to the scene's origin, rounded to float
    float edge_length; // target edge length, a power of two
    std::int32_t max_exponent;
    std::int32_t first_patch, patch_count;
    float albedo[3];
};

} // namespace razor
