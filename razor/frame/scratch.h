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
    (kd_depth_limit + 4) * stack_entry; // real points of a curve chunk: x[16], y, z; twice
inline constexpr int scratch_curve_size = 3 * curve_row;
inline constexpr int scratch_mailbox = scratch_curve + 2 * scratch_curve_size;
/// A block as one field sees it, and another that it hangs from; laid out as a block, each part at its
/// largest.
inline constexpr int blend_cells = block_header_words + 3 * 96;
inline constexpr int blend_ancestors = blend_cells + 6 * cell_boxes;
inline constexpr int blend_weights = blend_ancestors + 24;
inline constexpr int blend_normals_at = blend_weights + 96;
inline constexpr int blend_floats = blend_normals_at + 3 * 96;
inline constexpr int scratch_blend = (scratch_mailbox + mailbox_slots + 15) / 16 * 16;
/// Blocks on the way to the one whose corners do not move, and corners: [corner][xyz], twice.
inline constexpr int scratch_climb = scratch_blend + 2 * blend_floats;
inline constexpr int scratch_corners = scratch_climb + 16;
/// First line of the worker's unused item lists of each size, -1: none. Their first words are the lines of
/// the next ones.
inline constexpr int scratch_free_lists = scratch_corners + 32;
inline constexpr int list_sizes = 48;
inline constexpr int stack_floats = scratch_free_lists + list_sizes;

inline constexpr int packet_origin = 0;                              // 3 vectors
inline constexpr int packet_inverse = packet_origin + 3 * ISA_WIDTH; // 3 vectors: 1 / direction
inline constexpr int packet_error = packet_inverse + 3 * ISA_WIDTH;  // 3 vectors: slack of a plane's distance
inline constexpr int packet_sum =
    packet_error + 3 * ISA_WIDTH; // light gathered for each lane of a camera packet
/// Target edge lengths: origin x, y, z, radius, base, growth and slope x, y, z of each lane's field, and the
/// first lane with the same one.
inline constexpr int packet_field = packet_sum + ISA_WIDTH;
inline constexpr int packet_leader = packet_field + 9 * ISA_WIDTH;
inline constexpr int packet_floats = packet_leader + ISA_WIDTH;

} // namespace razor
