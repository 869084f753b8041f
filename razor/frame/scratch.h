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
inline constexpr int stack_floats = scratch_mailbox + mailbox_slots;

inline constexpr int packet_origin = 0;                              // 3 vectors
inline constexpr int packet_inverse = packet_origin + 3 * ISA_WIDTH; // 3 vectors: 1 / direction
inline constexpr int packet_error = packet_inverse + 3 * ISA_WIDTH;  // 3 vectors: slack of a plane's distance
inline constexpr int packet_sum =
    packet_error + 3 * ISA_WIDTH; // light gathered for each lane of a camera packet
inline constexpr int packet_floats = packet_sum + ISA_WIDTH;

} // namespace razor
