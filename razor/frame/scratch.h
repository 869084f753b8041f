// Where a worker's scratch lies, in floats. The stack region: the traversal stack first, then what builders
// need while a traversal is under way. The packet region: the rays in flight.
#pragma once

#ifndef ISA_WIDTH
#error "ISA_WIDTH is the logical width; link the isa library"
#endif
#include "razor/frame/layout.h"

namespace razor {

inline constexpr int stack_entry = 2 * ISA_WIDTH + 16; // node; entry and exit distance of each lane
inline constexpr int scratch_curve =
    (kd_depth_limit + 4) * stack_entry; // real points of a curve chunk: x[16], y, z; three times
inline constexpr int scratch_curve_size = 3 * curve_row;
inline constexpr int scratch_mailbox = scratch_curve + 3 * scratch_curve_size;
/// A block as one field sees it, laid out as a block, each part at its largest. On the stack, one from which
/// another hangs.
inline constexpr int blend_cells = block_header_words + 3 * row_vertices;
inline constexpr int blend_ancestors = blend_cells + 6 * cell_boxes;
inline constexpr int blend_weights = blend_ancestors + 24;
inline constexpr int blend_normals_at = blend_weights + row_vertices;
inline constexpr int blend_floats = blend_normals_at + 3 * row_vertices;
inline constexpr int scratch_blend = (scratch_mailbox + mailbox_slots + 15) / 16 * 16;
/// While a block of a displaced mesh is placed, in the same room: arrays of its vertices one after the other,
/// of its own stride; those of a curve's chunk; and how far finer vertices leave its sides.
inline constexpr int scratch_displaced = scratch_blend;
enum DisplacedArray : int {
    displaced_surface = 0,  // x, y, z: before displacement, instance coordinates
    displaced_normal = 3,   // mesh coordinates; then, once it is known how they turn, where vertices lie
    displaced_texcoord = 6, // u, v
    displaced_arrays = 8
};
inline constexpr int scratch_chunk = scratch_displaced + displaced_arrays * block_vertices; // normals, u, v
inline constexpr int scratch_sides = scratch_chunk + 5 * curve_row;
enum SideBound : int { side_height = 0, side_turn = 1, side_seam = 2, side_bounds = 3 };
static_assert(scratch_sides + side_bounds <= scratch_blend + blend_floats);
/// Blocks on the way to the one whose corners do not move, and corners: [corner][box], twice.
inline constexpr int scratch_climb = scratch_blend + blend_floats;
inline constexpr int scratch_corners = scratch_climb + 16;
/// First line of the worker's unused item lists of each size, -1: none. Their first words are the lines of
/// the next ones.
inline constexpr int scratch_free_lists = scratch_corners + 48;
inline constexpr int list_sizes = 48;
/// The corners of a block whose children ask for theirs: [corner][box].
inline constexpr int scratch_siblings = scratch_free_lists + list_sizes;
inline constexpr int stack_floats = scratch_siblings + 24;

/// A block as a field sees it is kept with its key in a slot. The camera's field is one for the whole frame:
/// what it sees lies among the grids, once for all who share them (BlockHeader::seen). What others lately
/// saw, each worker has in `blend_slots` of its own. Fields that hits share come back to a block more often
/// than 8 are enough for; of more than 32, few are found again.
inline constexpr int blend_slots = 32;
static_assert(blend_slots >= 4); // two fields of neighbouring numbers need slots of their own (paper_scale.h)
enum BlendSlot : int {
    slot_line = 0,    // of the block; -1: the slot is empty
    slot_field = 1,   // its number
    slot_level = 2,   // of the leaf, which decides what its sides hang from
    slot_normals = 3, // a BuildState
    slot_longest = 4, // 4 sides: log2 of their sub-edges on one edge, as packets test them
    slot_block = 16,  // laid out as a block
    slot_texcoords = slot_block + blend_floats, // u, v, one row_vertices each, where some mesh has them
    /// Likewise as many arrays as the instance has of what is shaded, of the camera's field; then, where its
    /// mesh has them, x, y, z at rest.
    slot_shaded = slot_texcoords + 2 * row_vertices
};
/// Words from a slot to what is at rest.
template <class Int> constexpr Int slot_rest(Int shading) {
    return shaded_arrays_in(shading) * row_vertices + slot_shaded;
}
/// `arrays`: from slot_shaded on, of any instance.
constexpr int slot_floats(bool texcoords, int arrays) {
    return arrays > 0 ? slot_shaded + arrays * row_vertices : texcoords ? slot_shaded : slot_texcoords;
}
inline constexpr int line_floats_log2 = 4;
static_assert(4 << line_floats_log2 == line_bytes);

inline constexpr int packet_inverse = 0; // 3 vectors: 1 / direction
/// 3 vectors each: what is added to a plane's coordinate / direction for when the ray is there, at the
/// earliest and the latest.
inline constexpr int packet_early = packet_inverse + 3 * ISA_WIDTH;
inline constexpr int packet_late = packet_early + 3 * ISA_WIDTH;
inline constexpr int packet_sum =
    packet_late + 3 * ISA_WIDTH; // light gathered for each lane of a camera packet
/// Target edge lengths: origin x, y, z, radius, base, growth and slope x, y, z of each lane's field, and its
/// number: lanes of one number have the same field, in whatever packet of the worker.
inline constexpr int packet_field = packet_sum + ISA_WIDTH;
inline constexpr int packet_number = packet_field + 9 * ISA_WIDTH;
inline constexpr int camera_number = 0; // of the field of all camera rays
/// Fields that rays lately left surfaces with.
inline constexpr int packet_left = packet_number + ISA_WIDTH;
inline constexpr int left_fields = 8;
enum LeftField : int {
    left_origin = 0, // 3
    left_reach = 3,  // how far from the origin a hit may be
    left_radius = 4,
    left_base = 5,
    left_growth = 6,
    left_least = 7, // target edge lengths of hits
    left_most = 8,
    left_number = 9, // -1: none
    left_floats = 16
};
inline constexpr int packet_left_next = packet_left + left_fields * left_floats;
/// The beam of a group's rays (razor/kernels/beam.h): for each axis a line below and one above them.
inline constexpr int packet_beam = packet_left_next + 16;
enum BeamLine : int {
    beam_base = 0, // at 0 of the group's axis
    beam_rate = 1,
    beam_above = 2, // the line above, likewise
    beam_axis = 4   // the next axis
};
/// Light gathered for each lane by lobes (razor/kernels/glossy.h) other than the first.
inline constexpr int packet_lobes = (packet_beam + 3 * beam_axis + 15) / 16 * 16;
inline constexpr int most_lobes = 15; // five, each in red, green and blue where light has many colours
/// Points that the hits of a packet sample on a light, four of each (razor/kernels/quarters.h): u, v and
/// which of the four it is; and what the surface makes of each, by that, of every lobe.
inline constexpr int packet_quarters = packet_lobes + (most_lobes - 1) * ISA_WIDTH;
inline constexpr int quarters = 4;
inline constexpr int packet_parts = packet_quarters + 3 * quarters * ISA_WIDTH;
/// The block that each ray leaves for good (Rays::left).
inline constexpr int packet_block_left = packet_parts + most_lobes * quarters * ISA_WIDTH;
inline constexpr int packet_floats = packet_block_left + ISA_WIDTH;

/// Where lights are chosen from, nodes of their tree that between them hold all that may light each lane's
/// hit: three arrays of a vector each, for each part of the cut; nodes, chances, and while nodes are divided
/// what it is worth to divide them. Then how many parts each lane has.
inline constexpr int most_light_choices = 64;
enum LightCut : int {
    cut_node = 0,
    cut_chance = most_light_choices * ISA_WIDTH, // that the tree leads there from its root
    cut_worth = 2 * cut_chance,
    cut_count = 3 * cut_chance,
    light_cut_floats = (cut_count + ISA_WIDTH + 15) / 16 * 16
};

/// So much further lies the scratch for tiles that are rendered in place of a wait (render_meanwhile() in
/// razor/kernels/render.h).
inline constexpr int spare_stack = (stack_floats + 15) / 16 * 16;
inline constexpr int spare_packets = (packet_floats + 15) / 16 * 16;

} // namespace razor
