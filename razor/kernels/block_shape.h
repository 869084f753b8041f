// What a patch's blocks look like at one level, and what each of them keeps where.
#pragma once

#include "razor/kernels/dicing.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// Before normals: of displaced blocks kept_deviation(), and see chords_at().
inline constexpr int words_before_normals = 6;

/// Where boxes of parts are kept, of a block that has some and whose normals lie at word `normals_at`.
inline sint parts_at(sint normals_at) {
    return normals_at - (words_before_normals + parts_words);
}

/// How the blocks of a patch at one level look.
struct Shape {
    sint quads_u, quads_v;
    sint columns, rows; // of blocks
    sint stride;        // vertices
    sbool parts;        // have boxes, before the normals
    sint corners_at, cells_at, ancestors_at, middles_at, normals_at, lines;
    sint shaded_at; // a BuildState, behind what is shaded; 0: nothing is
    sint triangles;
};

inline Shape block_shape(const Dicing& d) {
    Shape s;
    s.quads_u = sint(1) << min(d.nu, block_log2);
    s.quads_v = sint(1) << min(d.nv, block_log2);
    s.columns = sint(1) << max(d.nu - block_log2, 0);
    s.rows = sint(1) << max(d.nv - block_log2, 0);
    s.stride = vertex_count(s.quads_u, s.quads_v);
    sbool several_cells = s.quads_u > 2;
    several_cells = several_cells | (s.quads_v > 2);
    sbool hang = false;
    sbool long_ancestor = false;
    for (int k = 0; k < 4; ++k) {
        sint segments = k % 2 == 0 ? s.quads_u : s.quads_v;
        hang = hang | (d.side[k].hang > 0);
        long_ancestor = long_ancestor | ((sint(1) << d.side[k].hang) > segments);
    }
    sbool flat = is_flat(d);
    sbool middles = d.level == d.coarsest;
    middles = middles & (half(d.side[0]) != 0);
    sint vertex_words = s.stride * 3;
    sint words = vertex_words + block_header_words;
    // Blocks that are a part of their parent can be announced; then they have no vertices yet.
    sbool corners = long_ancestor & (d.kind == static_cast<int>(PatchKind::catmull_clark));
    corners = corners | (max(d.nu, d.nv) > block_log2);
    s.corners_at = select(corners, words, sint(corners_lie_in_vertices));
    words = words + select(corners, sint(corner_words), sint(0));
    s.cells_at = select(several_cells, words, sint(0));
    words = words + select(several_cells, sint(6 * cell_boxes), sint(0));
    s.ancestors_at = select(long_ancestor, words, sint(0));
    words = words + select(long_ancestor, sint(ancestor_box + 6), sint(0));
    s.middles_at = select(middles, words, sint(0));
    words = words + select(middles, sint(ends_words), sint(0));
    s.parts = d.level > 0;
    s.parts = s.parts & hang;
    s.parts = s.parts & (max(d.nu, d.nv) >= block_log2);
    s.parts = s.parts & !d.displaced;
    words = words + select(s.parts, sint(parts_words), sint(0));
    // Normals; what lies on vertices besides follows them, and brings them along where they are not needed.
    // Flat patches have no vertices inside, so nothing is shaded at theirs.
    sint attributes = texcoord_arrays(d.shading);
    attributes = attributes + rest_arrays(d.shading);
    sbool plain = flat & (attributes == 0);
    words = words + select(plain, sint(0), sint(words_before_normals));
    s.normals_at = select(plain, sint(0), words);
    words = words + select(plain, sint(0), vertex_words);
    words = words + s.stride * attributes;
    s.shaded_at = 0;
    if (branch(d.shading > 15)) {
        sint arrays = select(flat, sint(0), shaded_arrays_in(d.shading));
        words = words + s.stride * arrays;
        s.shaded_at = select(arrays > 0, words, sint(0));
        words = words + 1;
    }
    s.lines = (words + 15) >> 4;
    s.triangles = select(d.kind == static_cast<int>(PatchKind::flat_triangle), sint(1), sint(2));
    return s;
}

/// Which half of a block along u and v: 0 or 1; -1: all of it.
struct Part {
    sint u = -1, v = -1;
};

/// Which part of its parent a block is.
inline Part part_of_parent(const Dicing& d, sint column, sint row) {
    Part part;
    sint odd_column = column & 1;
    part.u = select(d.nu > block_log2, odd_column, sint(-1));
    sint odd_row = row & 1;
    part.v = select(d.nv > block_log2, odd_row, sint(-1));
    return part;
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
