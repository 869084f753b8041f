// In which order the vertices of a block are blended, coarse ones first: see blend_pass in
// razor/frame/layout.h.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace morph_kernel {

inline vvec gather_vertex(pointer<float> x, sint stride, const vint& i, const vmask& m) {
    vvec p;
    p.x = gather(x, i, m);
    p.y = gather(x + stride, i, m);
    p.z = gather(x + stride * 2, i, m);
    return p;
}

inline sint log2_quads(sint quads) { // of 1, 2, 4, 8
    sint half = quads >> 1;
    return half - (quads >> 3);
}

/// The order in which a block of this shape is blended.
inline pointer<std::int32_t> blend_table(const Context& c, sint quads_u, sint quads_v) {
    sint shape = log2_quads(quads_u) * (block_log2 + 1);
    shape = shape + log2_quads(quads_v);
    pointer<std::int32_t> table = load(field(c.frame, &FrameHeader::blend_table));
    return table + shape * (blend_passes * pass_words);
}
/// The passes for vertices as they lie in a block of this shape: parents, then sides of each.
inline pointer<std::int32_t> pass_rows(const Context& c, sint quads_u, sint quads_v) {
    sint shape = log2_quads(quads_u) * (block_log2 + 1);
    shape = shape + log2_quads(quads_v);
    pointer<std::int32_t> table = load(field(c.frame, &FrameHeader::blend_table));
    shape = shape * (blend_passes * 2 * row_vertices);
    return table + (shape + blend_rows(0, 0, 0));
}
/// Some vertices of a pass, one a lane.
struct BlendStep {
    vint vertex, one, other, side;
};
inline BlendStep load_step(pointer<std::int32_t> pass, sint from, const vmask& m) {
    pointer<std::int32_t> list = pass + (line_bytes / 4) + from;
    BlendStep s;
    s.vertex = load_vector(list, m);
    s.one = load_vector(list + pass_vertices, m);
    s.other = load_vector(list + 2 * pass_vertices, m);
    s.side = load_vector(list + 3 * pass_vertices, m);
    return s;
}

} // namespace morph_kernel
} // namespace razor::ISA_TARGET
