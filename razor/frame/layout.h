// The records that a frame reads and builds, exactly as they lie in frame memory on every target. Plain data,
// shared by the host code that fills the persistent part and the kernels that read it. Lengths are in the
// frame's unit (razor/frame/unit.h), relative to the instance's origin unless stated. Indices are 32 bits and
// count records of the array they name.
//
// A *patch* is a quadrilateral piece of surface with parameters (u, v) in [0,1]^2: a quad face, one sub-face
// of an n-gon (corner c to its two edge midpoints and the centre), or a flat triangle. Corner 0 is (0,0), 1
// (1,0), 2 (1,1), 3 (0,1). Side 0 is v = 0 and side 2 is v = 1 (both run along u); side 1 is u = 1 and side 3
// is u = 0 (both run along v).
//
// A *curve* is what patches share: a cage edge, running from its lower- to its higher-numbered point, or a
// *spoke* of an n-gon, running from an edge midpoint to the face centre. Its points are evaluated by its
// owner only, whoever asks (design: shared points have one owner), so that neighbours agree bit for bit.
#pragma once

#include "isa/memory_types.h"
#include "razor/frame/emitter_record.h"
#include "razor/frame/film_record.h"
#include "razor/frame/light_node.h"
#include "razor/frame/light_record.h"
#include "razor/frame/line.h"
#include "razor/frame/material_record.h"
#include "razor/frame/stretches.h"

#include <cstdint>

namespace razor {

enum class PatchKind : std::int32_t {
    catmull_clark = 0, // limit surface: positions from pages of weights
    bilinear = 1,      // bilinear in its four corners
    flat_quad = 2,     // planar convex quad of a bilinear mesh: two triangles at every level
    flat_triangle = 3, // corners 0, 1, 2; corner 3 repeats corner 2
};

/// A limit-surface face (quad or n-gon) of a cage, or any face of a bilinear mesh (face_class -1; controls =
/// its corners).
struct FaceRecord {
    std::int32_t face_class;    // index of the ClassRecord, or -1
    std::int32_t control_first; // its control points: controls[control_first ... + control_count)
    std::int32_t control_count;
    std::int32_t corner_count;
    std::int32_t
        curve_first; // face_curves[curve_first + i] is the curve of the edge from corner i to corner i+1
};

/// Where the limit position of a cage point is evaluated: the lowest-numbered incident face, its lowest such
/// corner.
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
    std::int32_t owner_local; // edges: corner i of the owner's edge i -> i+1; spokes: corner_count + i, from
                              // midpoint of edge i
    std::int32_t flags;
    std::int32_t end0,
        end1; // edges: points, end0 < end1. Spokes: end0 = the curve of edge i, end1 = the face
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
    std::int32_t corner[4]; // quads and triangles: points. Sub-faces: point, curve (middle), face (centre),
                            // curve (middle)
};
static_assert(sizeof(PatchRecord) == 64);

// --- grids and blocks
// ------------------------------------------------------------------------------------------------- A patch
// of exponents (Nu, Nv) has 2^Nu x 2^Nv quads, cut into blocks of at most 8 x 8 quads (9 x 9 vertices).
inline constexpr int block_log2 = 3;
inline constexpr int block_quads = 1 << block_log2;
inline constexpr int block_side = block_quads + 1;
inline constexpr int block_vertices = block_side * block_side;
inline constexpr int blend_passes = block_log2; // steps of 4, 2 and 1 quads: see blend_pass
/// Of a curve: fourteen levels. A mesh may have to use less (InstanceRecord::max_exponent).
inline constexpr int max_exponent_limit = 13;

// Strips number the block columns (or rows, or curve chunks) of all exponents in one sequence:
// exponent N has max(1, 2^(N-3)) of them, the first at strip_first(N).
template <class Int> constexpr Int strip_first_large(Int power) {
    return power + 2;
} // power = 2^(N-3), N >= 3
constexpr int strip_first(int exponent) {
    return exponent < 3 ? exponent : (1 << (exponent - 3)) + 2;
}
constexpr int strip_count(int exponent) {
    return exponent < 3 ? 1 : 1 << (exponent - 3);
}
// Pairs of strips are numbered by the larger one first: coarse grids have the low numbers, whatever exponent
// a mesh ends at.
constexpr int strip_pair(int u, int v) {
    return u < v ? v * v + v + 1 + u : u * u + v;
}

// --- topology pages
// ---------------------------------------------------------------------------------------------------
// Weights over a face's control points, made by the host on request and immutable from then on, in whole
// lines of 64 bytes. The number of lines that a class could need is beyond any memory, so each page has an
// entry that says where it lies: entries[first of its kind + index].
enum class PageKind : std::int32_t {
    vertex = 0, // index = corner (or corner_count: the centre). One row of control_count weights, zero-padded
                // to the width. Of a displaced mesh three such rows: position, d/du, d/dv
    curve = 1, // index = strip * curve_ways + local * 2 + reversed. control_count rows of 16: points (8*chunk
               // + i)/2^N, i = 0..8. Of a displaced mesh two more such rows a control point follow all of
               // these: d/du then d/dv
    block = 2, // index = (strip_pair(u strip, v strip) * subs + sub) * block_kinds. control_count rows, one
               // weight a vertex j*(nu+1)+i, padded to the width; positions
    derivative = 3, // as block; two rows a control point: d/du then d/dv (only their cross product's
                    // direction matters). Of a displaced mesh three more rows a control point follow all
                    // of these, d2/du2, d2/dudv, d2/dv2, and derivatives are by the patch's own (u, v)
    deviation = 4,  // as block; three rows of control_count numbers, zero-padded to a multiple of 64. First
                    // bounds: how far the weight of any finer vertex is from the mean of its parents'
                    // weights, summed over the levels. Then, for u and v, a row of length 1 and sum 0 for
                    // which these differences of weights sum up to nothing, or zeros
};
inline constexpr int page_kinds = 5;
inline constexpr int block_kinds = 3; // pages of one block: their entries lie side by side
inline constexpr int curve_row = 16;  // floats a row of a curve page

struct PageEntry {
    isa::shared<std::int32_t> line; // of the page, from ClassRecord::lines; 0 until the weights are there
};

struct ClassRecord {
    isa::ref<PageEntry> entries; // the class's
    isa::ref<Line> lines;        // of all classes' pages
    std::int32_t control_count;
    std::int32_t corner_count;
    std::int32_t subs;              // blocks of one pair of strips: 1, or the corners of an n-gon
    std::int32_t curve_ways;        // 2 a curve
    std::int32_t first[page_kinds]; // from `entries`
    std::int32_t padding[3];
};
static_assert(sizeof(ClassRecord) == line_bytes);

// --- scene
// ------------------------------------------------------------------------------------------------------------
// A mesh's patches, faces, curves and control points lie in memory once. What an instance builds (blocks)
// lies in a space of its own, turned and scaled as the scene is and relative to the instance's origin, so
// that rays meet it as they are.
//
// Patches are grouped in *clusters* of refit_patches consecutive ones; a mesh's first is the first of a
// cluster, so that record r belongs to cluster r / refit_patches. An instance's patches are numbered
// likewise: number n names record first_record + (n - first_patch), and cluster_instance[n / refit_patches]
// the instance.
inline constexpr int refit_log2 = 6;
inline constexpr int refit_patches = 1 << refit_log2; // a multiple of every width

/// One mesh where the scene draws it.
struct InstanceRecord {
    float origin[3];          // scene coordinates
    float edge_length;        // at level 0
    std::int32_t first_level; // its log2, rounded
    float mesh_edge_length;   // the same in the mesh's units, a power of two
    std::int32_t max_exponent;
    std::int32_t mesh;
    std::int32_t first_patch; // the number that names its first patch, a multiple of refit_patches
    std::int32_t patch_count;
    std::int32_t first_record;                 // of its mesh's patches
    std::int32_t first_cluster, cluster_count; // of its mesh
    std::int32_t moved; // 0: mesh coordinates are the instance's own; -1: they come to lie mirrored
    float linear[9];    // rows: of the map from mesh coordinates to the instance's own ...
    float offset[3];    // ... and what rounding the origin left over
    float albedo[3];
    std::int32_t material;      // where the frame has materials; -1: see FrameHeader::face_materials
    std::int32_t shading;       // which arrays follow the normals of a block: see pack_shading()
    std::int32_t texture_faces; // from the mesh's faces to those of its texture cage
};
static_assert(sizeof(InstanceRecord) == 128);

/// A box in scene coordinates, and what to look at if a ray comes near it. Node 0 is the root. Nodes that are
/// none's children have neither instance (-1) nor children.
struct GraphNodeRecord {
    float low[3], high[3];
    std::int32_t first_child; // children are consecutive
    std::int32_t child_count; // of a leaf: its mesh's clusters
    std::int32_t instance;    // of a leaf; else -1
    std::int32_t padding;
};
static_assert(sizeof(GraphNodeRecord) == 40);

// --- grids: what tessellating a patch yields
// --------------------------------------------------------------------------
// Levels. At level 0 of its instance a patch has 2^Nu x 2^Nv quads and a curve 2^N segments of about the
// instance's edge_length; at level d it has 2^(Nu-d) x 2^(Nv-d), d = 0 ... min(Nu, Nv), and a curve
// 2^max(N-d, 0). Across instances levels are named by absolute powers of two: level A has edges of about 2^A,
// A = first_level + d.
//
// A vertex is born at the coarsest level that has it. Its place on the surface is its *anchor*; where a ray
// finds it depends on the ray's target edge length there (razor/kernels/morph.h). A vertex on a curve is born
// by the curve: that at dyadic depth j of a curve of exponent N at level N - j. If that is negative it never
// leaves the mean of its parents: it *hangs*.
//
// The blocks of a patch form a tree. Its root is the one block of the patch's coarsest level (exponents of a
// patch differ by block_log2 at most); a block of 8 quads a side has two children along that side, a smaller
// one has one, twice as fine.

/// Followed by words: anchors x[stride], y[stride], z[stride] (row j, column i at j * (quads_u + 1) + i);
/// then, where the header gives an offset, corners, cell boxes, ancestors, middles, normals. A cell is 2 x 2
/// quads. Before the normals, where a side of the patch hangs, blocks have 8 quads along a side and there are
/// finer ones, boxes of parts.
struct alignas(line_bytes) BlockHeader {
    float box_low[3], box_high[3]; // of its vertices and all finer ones, the instance's coordinates
    std::int32_t patch;
    std::int32_t number; // of the block in its patch and level, row by row
    std::int32_t instance;
    std::int32_t level;            // of the instance
    std::int32_t absolute;         // level: first_level + level
    std::int32_t column, row;      // of the block in its patch and level
    std::int32_t quads_u, quads_v; // 1, 2, 4 or 8
    std::int32_t triangles;        // see triangles_in
    std::int32_t stride;
    std::int32_t exponent[2]; // of the patch along u and v, at this level
    std::int32_t hangs;       // not 0 if any of hang[] is not
    std::int32_t hang[4];     // log2 of the sub-edges of this side that lie on one flat ancestor edge
    std::int32_t curve[4]; // exponent at level 0 of the curve this side lies on; straight_curve; inner_side
    std::int32_t
        cells_at; // words from the block's begin: low x[16], y, z, high x[16], y, z; 0: one cell only
    std::int32_t ancestors_at; // [side][end][xyz], for sides whose ancestor is longer than the block; 0:
                               // none. Then a box, low and high: the block's own made to hold these ends
    std::int32_t normals_at;   // x[stride], y[stride], z[stride]; 0: geometric normals (flat patches)
    isa::shared<std::int32_t> normals;    // a BuildState
    isa::shared<std::int32_t> children;   // a BuildState
    std::int32_t child_line, child_shape; // of the first child; see children_in
    std::int32_t group; // with a memory budget: the record of what is dropped with it (razor/frame/budget.h)
    isa::shared<std::int32_t> made; // a BuildState: of all that needs vertices (razor/kernels/tessellate.h)
    std::int32_t parent;            // line of the block that this is a child of; -1: the root
    std::int32_t corners_at;        // [corner][xyz]: see corner_anchor; corners_lie_in_vertices; or
                                    // no_vertex_moves: each is at its anchor for all rays
    std::int32_t middles;           // root, n-gons: words from the block's begin: see PatchEnds; 0: none
    /// How far vertices leave their anchors along any axis, if those born 0, 1 or 2 levels above the block's
    /// and below move, and its corners do not.
    float sway[blend_passes];
    float middle_sway; // how far a corner that is the middle of an edge does; 0: none is
    /// How far corners on sides that hang from longer edges are born from where the block has them, and from
    /// the means of the parent's; 0: there are none in either.
    float corner_sway;
    /// By which the box is wider than its vertices, along any axis, for finer ones; less than 0: it was made
    /// from the parent's, before there were vertices.
    float deviation;
    isa::shared<std::int32_t> seen; // a BuildState ...
    std::int32_t seen_line;         // ... of the block as the camera's field sees it: the line of its slot
};
static_assert(sizeof(BlockHeader) == 192);
inline constexpr int block_header_words = 48;
/// Blocks of one size, made together, in one word: how many (1, 2 or 4), and lines from one to the next.
template <class Int> constexpr Int children_in(Int shape) {
    return shape & 7;
}
template <class Int> constexpr Int lines_between(Int shape) {
    return shape >> 3;
}
/// Of a block, in one word: how many triangles a quad has (2, or 1 of a flat triangle), and from where they
/// are seen.
enum SeenFrom : std::int32_t {
    seen_from_both_sides = 0,
    seen_from_front = 1,         // from where their vertices run counter-clockwise
    seen_from_mirrored_front = 2 // a mirror turned them over: from where they run clockwise
};
template <class Int> constexpr Int triangles_in(Int word) {
    return word & 3;
}
template <class Int> constexpr Int seen_from(Int word) {
    return word >> 2;
}
inline constexpr int ancestor_words = 24;
inline constexpr int ancestor_box = ancestor_words;
inline constexpr int corner_words = 12;
inline constexpr int no_vertex_moves = 0, corners_lie_in_vertices = 1; // BlockHeader::corners_at
inline constexpr int cell_boxes = 16;
/// Target edge lengths grow by no more than this per unit of distance: steeper rays see a finer surface than
/// they ask for, which stays within three levels of itself over a block.
inline constexpr float gradation_cap = 0.125F;
/// Levels are powers of two: fields are held times this, so that the level used is the nearest in the
/// logarithm.
inline constexpr float level_rounding = 1.41421356F;
inline constexpr float least_curve_length = 1.0e-30F; // to be told from 0
inline constexpr float least_target_edge = 1.0e-30F;  // edge lengths asked for are positive
inline constexpr int straight_curve = -2;             // of a bilinear patch: its vertices never leave it
inline constexpr int inner_side = -1;                 // the side is no side of the patch

/// Of the four parts that a block's children are, (0, 0), (1, 0), (0, 1), (1, 1): the boxes of its vertices
/// as they lie before sides that hang are put on their edges. [part][low, high].
inline constexpr int parts_words = 24;

/// Sub-faces of n-gons end in the middle of edges, at corners 1 and 3. What is known of the two edges beyond:
/// [edge][xyz], edge 0 of side 0, edge 1 of side 3.
enum PatchEnds : int {
    ends_mean = 0, // of the whole edge's ends, where its middle lies if it is not born
    ends_far = 6,  // the end that the sub-face does not have
    ends_words = 12
};

/// Of whatever is built on demand by one worker and used by all that share it.
enum BuildState : std::int32_t { absent = 0, busy = 1, ready = 2 };

struct OpenPatch {
    isa::shared<std::int32_t> state; // a BuildState
    std::int32_t root;               // line of its coarsest block, from Frame::grids
    std::int32_t padding[2];
};

// --- kd-tree
// ----------------------------------------------------------------------------------------------------------
// One tree, cut by level. A leaf lists what meets its cell at one level; rays for which that is too coarse go
// on to the leaf's *finer* node, which covers the same cell and lists the blocks' children.
/// With a memory budget a node may also be asleep: -1 - the number of its Anchor (razor/frame/budget.h).
enum NodeState : std::int32_t { node_unsplit = 0, node_busy = 1, node_inner = 2, node_leaf = 3 };
struct KdNode {
    isa::shared<std::int32_t> state; // a NodeState
    float split;
    std::int32_t axis; // inner: 0, 1, 2. Unsplit: not 0 if the list is a coarser node's, to be refined first
    std::int32_t link; // inner: index of the lower child, the upper follows; else: first line of its item
                       // list; -1: an empty leaf, which has none
};
static_assert(sizeof(KdNode) == 16);

/// An item is a block (~first line), or closed: a patch (its number), a cluster of an instance's patches
/// (cluster_items + the number of its first patch / refit_patches) or a node of the scene graph (graph_items
/// + its number). The list's arrays follow: item[stride], then the boxes low x[stride], y, z, high x[stride],
/// y, z in scene coordinates.
inline constexpr std::int32_t cluster_items = 1 << 30;
inline constexpr std::int32_t graph_items = cluster_items + (1 << 29);
inline constexpr std::int32_t most_patches = cluster_items; // that can be numbered
struct ItemList {
    // What rays read, in one line.
    std::int32_t count;
    std::int32_t stride;
    std::int32_t in_cell; // leaves: so many items are in the cell themselves, the first ones; of the others,
                          // only what is finer
    std::int32_t level;   // leaves: the absolute level of every block that has children
    std::int32_t finer; // leaves: the node for rays that this level is too coarse for; -1: it is fine enough
                        // for all
    float coarse;       // leaves: the target edge length from which on it is fine enough
    float coarsest;     // leaves: what is finer is bounded for target edge lengths up to this
    float most;         // the largest target edge length of rays that come here
    float low[3], high[3];            // leaves: of all that is finer or can move, scene coordinates
    isa::shared<std::int32_t> beyond; // leaves: a list many levels finer (razor/kernels/chain.h)
    std::int32_t padding;
    // What only builders read.
    std::int32_t depth;
    float cell_low[3], cell_high[3];
    std::int32_t padding2[9];
};
static_assert(sizeof(ItemList) == 2 * line_bytes);
inline constexpr int item_list_words = 32;

struct alignas(line_bytes) TreeRecord {
    isa::shared<std::int32_t> root_state; // a BuildState
    std::int32_t root;
    float low[3], high[3]; // of everything, scene coordinates
    isa::ref<OpenPatch> patches;
    isa::ref<isa::shared<std::int32_t>> curve_lengths; // floats, mesh units; 0: nobody asked for it yet
    std::int32_t first_place, end_place;               // of the workers that use it: WorkerRecord::place
    isa::shared<std::int32_t> left;                    // workers that are done with it ...
    std::int32_t sharers;                              // ... of so many
};

struct WorkerBudget; // razor/frame/budget.h
struct SkyRecord;    // razor/frame/sky_record.h
/// What one worker allocates from: lines or nodes, counted from the base of the family.
struct alignas(line_bytes) WorkerRecord {
    std::int32_t grid_next, grid_end;
    std::int32_t node_next, node_end;
    std::int32_t list_next, list_end;
    std::int32_t tree;
    std::int32_t next_field; // the next number of a field: see packet_field in razor/frame/scratch.h
    isa::ref<float> stack;   // traversal stack and builders' scratch
    isa::ref<float> packets; // the rays in flight
    isa::ref<float> blends;  // blocks lately blended
    isa::ref<float> cuts;    // of the tree of lights, where they are chosen from: light_cut in scratch.h
    std::int32_t place;      // among the workers: who share a tree, and then who are near, have near ones
    isa::ref<WorkerBudget> budget; // null: no memory budget
};

// --- the frame
// --------------------------------------------------------------------------------------------------------
struct alignas(line_bytes) QueueRecord {
    isa::shared<std::int32_t> stopped; // not 0: workers take no tile any more
    std::int32_t padding[15];
    isa::shared<std::int32_t> next_refit;
    std::int32_t padding2[15];
    isa::shared<std::int32_t> refitted; // clusters done
    std::int32_t padding3[15];
};

// --- in which order the vertices of a block are blended
// A block of 2^a x 2^b quads: pass 0 blends the vertices at steps of 4 quads that are no corners, pass 1
// those of 2, pass 2 the rest. A pass lists `count`, then arrays of pass_vertices numbers: vertices, their
// two parents, and the side they lie on (-1: none).
inline constexpr int pass_vertices = 64;
inline constexpr int pass_words = line_bytes / 4 + 4 * pass_vertices;
constexpr int blend_pass(int log2_u, int log2_v, int pass) {
    return ((log2_u * (block_log2 + 1) + log2_v) * blend_passes + pass) * pass_words;
}
// Beside the lists, for each pass all vertices of the block as they lie in it, with what their parents are
// (BlendParents) and their sides: nothing is gathered then.
enum BlendParents : std::int32_t { blend_none = 0, blend_along_u = 1, blend_along_v = 2, blend_diagonal = 3 };
inline constexpr int row_vertices = 96; // a block's at most, in whole lines
constexpr int blend_rows(int log2_u, int log2_v, int pass) {
    return blend_pass(block_log2 + 1, 0, 0) +
           ((log2_u * (block_log2 + 1) + log2_v) * blend_passes + pass) * 2 * row_vertices;
}
inline constexpr int blend_table_words = blend_rows(block_log2 + 1, 0, 0);

/// By what it is decided which level a ray sees of a block: its own box and those beside it in a leaf, its
/// patch's (razor/kernels/patch_levels.h), or how far along the ray it is (razor/kernels/paper_levels.h).
enum LevelChoice : std::int32_t { by_leaf = 0, by_patch = 1, by_stretch = 2 };

struct FrameHeader {
    std::int32_t width, height;
    std::int32_t samples;             // of each pixel that are taken now ...
    std::int32_t first_sample;        // ... of these numbers
    std::int32_t packet_samples_log2; // samples of one pixel that a packet of camera rays takes together
    std::int32_t tiles_x, tiles_y;
    std::int32_t first_column, first_row; // of the tiles of the part that is rendered, in the whole picture
    std::int32_t tiles;                   // all of that part
    std::int32_t tiles_first, tiles_end;  // those to be rendered, by their numbers along the curve
    std::int32_t stride_log2;             // a stride is 2^stride_log2 tiles, the first one from tiles_first
    std::int32_t tile_rows;               // not 0: tiles are numbered row by row
    std::int32_t worker_count;
    std::int32_t place_span; // the next power of two, or the same
    std::int32_t light_count, sky_samples;
    std::int32_t patch_count;   // numbers of patches; where one instance follows another some are unused
    std::int32_t cluster_count; // of all meshes
    std::int32_t graph_count;   // nodes of the scene graph, used or not
    std::int32_t refit_count;   // clusters listed in refit_list
    float camera[3];            // scene coordinates
    float film_corner[3], film_x[3],
        film_y[3];             // direction of the film's top left corner, and a pixel's steps
    float line_of_sight[3];    // unit
    std::int32_t orthographic; // not 0: all rays go along it, and the film's corner is where it is
    float sky[3];              // radiance / samples; of a map, what multiplies it, / (pi samples)
    float background[3];       // what a camera ray that hits nothing sees, or what multiplies the sky's map
    float reach;               // no two points of scene and camera are further apart
    isa::ref<GraphNodeRecord> graph;
    isa::ref<InstanceRecord> instances;
    isa::ref<LightRecord> lights;
    isa::ref<std::int32_t> cluster_instance; // of every refit_patches patch numbers
    isa::ref<PatchRecord> patches;
    isa::ref<FaceRecord> faces;
    isa::ref<VertexRecord> vertices;
    isa::ref<CurveRecord> curves;
    isa::ref<std::int32_t> face_curves;
    isa::ref<std::int32_t> controls;
    isa::ref<float> points; // x, y, z of each control point, relative to its mesh's origin
    isa::ref<ClassRecord> classes;
    isa::ref<std::int32_t> cluster_patches; // how many each cluster has
    isa::ref<float> cluster_boxes;          // low x[clusters_stride], y, z, high x, y, z, mesh coordinates
    isa::ref<std::int32_t> refit_list;      // clusters whose boxes this frame makes; others have theirs
    std::int32_t clusters_stride;
    isa::ref<TreeRecord> trees;
    isa::ref<WorkerRecord> workers;
    isa::ref<KdNode> nodes;
    isa::ref<Line> lists;
    isa::ref<Line> grids;
    isa::ref<QueueRecord> queues;
    isa::ref<StretchRecord> stretches; // one a place
    isa::ref<float> film;
    /// Planes of sums over the samples before first_sample, and those to be left for the next pass. Two sets,
    /// since what is begun again must find the first as it was. Null: there is no next pass.
    isa::ref<float> sums_before, sums_after;
    isa::ref<TilePass> tile_passes;   // by the tiles' numbers; null: samples are as said above, of all tiles
    isa::ref<FilterBin> filter_table; // filter_bins of x, then of y
    isa::ref<std::int32_t> blend_table;
    float field_origin[3];            // of the field of all camera rays (razor/kernels/morph.h): where the
                                      // dicing camera is
    float camera_base, camera_growth; // of it
    float camera_slope[3];
    float lens_x[3], lens_y[3]; // radii of the lens
    float focus;                // depth in focus; 0: a pinhole
    float sky_spacing;          // see growth_to_sky(), times edge_pixels; of a map, as of density 1
    std::int32_t morphs;        // 0: vertices stay at their anchors
    std::int32_t
        leaving_morphs;     // not 0: rays that leave a surface may see another one than those that found it
    std::int32_t one_field; // not 0: rays that leave surfaces ask for what camera rays do
    float fixed_target;     // not 0: what all rays ask for, everywhere
    std::int32_t level_choice; // a LevelChoice
    std::int32_t filter_use;   // a FilterUse
    std::int32_t sample_seed;  // added to the numbers of pixels: razor/kernels/sampling.h
    std::int32_t discards;     // not 0: see razor/kernels/dead.h
    std::int32_t grid_lines, node_count, list_lines; // of a worker's arenas, up to their ends
    std::int32_t bounces, diffuse_bounces;           // see Settings
    float lobe_spacing;                 // of a pixel's samples in directions of density 1, times edge_pixels
    isa::ref<MaterialRecord> materials; // where the plan needs them; likewise:
    isa::ref<MapRecord> maps;
    isa::ref<TextureRecord> textures;
    isa::ref<SolidRecord> solids; // of each instance, where some texture is a pattern of objects; else null
    /// Parallel to `points`, in their meshes' coordinates: where points are of meshes that change their shape
    /// (Mesh::rest) and have patterns of objects, which stay on the surface so. Null: no mesh has both.
    isa::ref<float> rest_points;
    isa::ref<SkyRecord> sky_map;           // null: the sky is the same everywhere
    isa::ref<std::int32_t> texels;         // of all textures
    isa::ref<std::int32_t> face_materials; // of every face
    /// Null if nothing is displaced. Otherwise: of each instance by how much at most, in its mesh's units,
    /// and of each cluster by how much at most any instance of it is. 0: not at all.
    isa::ref<float> displacement_bounds, cluster_displacements;
    isa::ref<DisplacementRecord> displacements;
    /// Of every face: measure_texture_density() in razor/frame/displacement.h.
    isa::ref<float> texture_densities;
    std::int32_t cutouts;            // not 0: some material has an alpha_cutoff and opacity in its texture
    std::int32_t slot_floats;        // of a blended block: see razor/frame/scratch.h
    std::int32_t one_sided;          // not 0: some material is seen from the front only
    std::int32_t sheens;             // a SheenUse
    isa::ref<LightNode> light_nodes; // over chosen_lights
    isa::ref<LightRecord> chosen_lights; // as of one sample each
    std::int32_t light_node_count;
    std::int32_t light_choices;       // rays a hit to lights that are chosen; 0: each has its own
    isa::ref<EmitterRecord> emitters; // triangles of surfaces that are lights
    isa::ref<EmitterGroup> emitter_groups;
    isa::ref<LightNode> emitter_nodes; // over groups
    isa::ref<float> emitter_sums;      // of chances in each group: before each triangle, and at the end
    std::int32_t emitter_count;
    std::int32_t emitter_group_count;
    std::int32_t emitter_group_step;     // the largest power of two below it
    std::int32_t emitter_step;           // no less than the largest power of two below any group's count
    std::int32_t emitter_samples;        // rays to all of them together, a hit
    std::int32_t emitter_maps;           // not 0: some of them have maps of what they emit
    float emitter_spacing;               // see growth_to_area(), times edge_pixels
    isa::ref<float> sheen_albedo;        // sheen_steps a row, razor/frame/sheen_albedo.h; first that of none
    isa::ref<SheenRecord> sheen_records; // where some material has sheen
};

/// Pixels along a tile's sides. Rays that leave hits of one tile share fields (forget_fields() in
/// razor/kernels/leave.h), so pictures depend on it: it is the same for all pictures and workers. A packet of
/// 64 rays fills it.
inline constexpr int tile_side = 8;

// --- scratch of a worker, in floats
// -----------------------------------------------------------------------------------
inline constexpr int kd_depth_limit = 72;
inline constexpr int mailbox_slots = 16;

/// Why a kernel gave up (isa::trap).
enum TrapCode : int {
    trap_grids_full = 1,
    trap_nodes_full = 2,
    trap_lists_full = 3,
    trap_pages_full = 4,
    trap_memory_spent = 5,    // of a budget: something has to be dropped first
    trap_budget_too_small = 6 // one tile alone does not fit
};

} // namespace razor
