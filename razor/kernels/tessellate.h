// Opening a patch and making it finer: blocks of one level, filled in whole.
#pragma once

#include "razor/kernels/block_bounds.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// Fills in block (column, row) of the patch at `line`.
inline void place_block(const Context& c, const Cage& g, const Dicing& d, const Shape& s, sint line,
                        sint column, sint row, sint parent) {
    Block b;
    b.quads_u = s.quads_u;
    b.quads_v = s.quads_v;
    b.stride = s.stride;
    b.ancestors_at = s.ancestors_at;
    b.column = column;
    b.row = row;
    b.header = as<BlockHeader>(c.grids + line);
    b.words = as<float>(c.grids + line);
    b.x = b.words + block_header_words;
    pointer<BlockHeader> h = b.header;
    sint first_level = load(field(c.instances + d.instance, &InstanceRecord::first_level));
    store(field(h, &BlockHeader::patch), d.patch);
    store(field(h, &BlockHeader::number), row * s.columns + column);
    store(field(h, &BlockHeader::instance), d.instance);
    store(field(h, &BlockHeader::level), d.level);
    sint absolute = first_level + d.level;
    store(field(h, &BlockHeader::absolute), absolute);
    note_level(as<Line>(h), s.lines, absolute);
    store(field(h, &BlockHeader::column), column);
    store(field(h, &BlockHeader::row), row);
    store(field(h, &BlockHeader::quads_u), s.quads_u);
    store(field(h, &BlockHeader::quads_v), s.quads_v);
    store(field(h, &BlockHeader::triangles), s.triangles);
    store(field(h, &BlockHeader::stride), s.stride);
    store(field(h, &BlockHeader::exponent), d.nu);
    store(field(h, &BlockHeader::exponent) + 1, d.nv);
    store(field(h, &BlockHeader::cells_at), s.cells_at);
    store(field(h, &BlockHeader::ancestors_at), s.ancestors_at);
    store(field(h, &BlockHeader::middles), s.middles_at);
    store(field(h, &BlockHeader::normals_at), s.normals_at);
    store(field(h, &BlockHeader::parent), parent);
    store_release(field(h, &BlockHeader::normals), absent);
    store_release(field(h, &BlockHeader::children), absent);
    store_release(field(h, &BlockHeader::seen), absent);
    // Only sides on the patch's border can hang.
    sbool border[4] = {row == 0, column == s.columns - 1, row == s.rows - 1, column == 0};
    sint hangs = 0;
    for (int k = 0; k < 4; ++k) {
        sint hang = select(border[k], d.side[k].hang, sint(0));
        hangs = hangs | hang;
        store(field(h, &BlockHeader::hang) + k, hang);
        sint curve = select(border[k], d.side[k].whole, sint(inner_side));
        store(field(h, &BlockHeader::curve) + k, curve);
    }
    store(field(h, &BlockHeader::hangs), hangs);
    sbool flat = d.kind >= static_cast<int>(PatchKind::flat_quad);
    sbool part = half(d.side[0]) != 0;
    sbool fixed = s.stride <= 4;
    fixed = fixed & (parent < 0);
    fixed = fixed & !part;
    store(field(h, &BlockHeader::movable), select(flat | fixed, sint(0), sint(1)));
    clear_box(b);
    if (branch(flat)) {
        place_flat(g, d, b);
    } else if (branch(d.kind == static_cast<int>(PatchKind::bilinear))) {
        place_bilinear(c, g, d, b);
        if (branch(d.level > 0))
            bound_bilinear(c, g, d, b);
        place_sides<true>(c, g, d, b);
        if (branch(s.ancestors_at != 0))
            place_corners<true>(c, g, d, b);
        if (branch(s.middles_at != 0))
            place_middles<true>(c, g, d, b.words + s.middles_at);
    } else {
        sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
        sint control_first = load(field(g.faces + d.face, &FaceRecord::control_first));
        sint control_count = load(field(g.faces + d.face, &FaceRecord::control_count));
        sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, column, row);
        pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
        weigh_all(g, weights, page_stride(s.stride), control_first, control_count, s.stride, b.x, s.stride);
        if (branch(d.level > 0))
            bound_limit(c, g, d, b);
        place_sides<false>(c, g, d, b);
        if (branch(s.ancestors_at != 0))
            place_corners<false>(c, g, d, b);
        if (branch(s.middles_at != 0))
            place_middles<false>(c, g, d, b.words + s.middles_at);
    }
    bound_block(b, s.cells_at);
    if (branch(s.ancestors_at != 0))
        bound_ancestors(b);
    sfloat corners = 0.0F;
    if (branch(!flat)) {
        measure_sway(c, b);
        if (branch(d.kind == static_cast<int>(PatchKind::catmull_clark)))
            corners = measure_corners(c, d, b, parent);
    }
    store(field(h, &BlockHeader::corner_sway), corners);
    sfloat middle = 0.0F;
    if (branch(part))
        middle = middle_sway(c, d, s, b, parent);
    store(field(h, &BlockHeader::middle_sway), middle);
}

inline void count_blocks(const Context& c, const Shape& s, sint level, sint blocks) {
    tally(c.counters->blocks_made, blocks);
    tally(c.counters->vertices_made, blocks * s.stride);
    sint quads = s.quads_u * s.quads_v;
    tally(c.counters->triangles_made, blocks * s.triangles * quads);
    tally(c.counters->finest_blocks, select(level == 0, blocks, sint(0)));
}

/// Makes a patch's coarsest block and fills in its entry of the tree's table (all but the state).
[[gnu::noinline]] inline void dice_patch(const Context& c, sint patch, pointer<OpenPatch> entry) {
    phase_scope phase(phase_tessellate);
    sint instance = load(c.cluster_instance + (patch >> refit_log2));
    Cage g = load_cage(c, instance, 0);
    Dicing d = plan_dicing(c, g, instance, patch, -1);
    g.level = d.level;
    Shape s = block_shape(d);
    sint line = allocate(c, &WorkerRecord::grid_next, &WorkerRecord::grid_end, s.lines, trap_grids_full);
    place_block(c, g, d, s, line, 0, 0, -1);
    store(field(entry, &OpenPatch::root), line);
    tally(c.counters->patches_opened, 1);
    count_blocks(c, s, d.level, 1);
}

/// Returns once the patch is open in the worker's tree, opening it if nobody else does.
inline pointer<OpenPatch> open_patch(const Context& c, sint patch) {
    pointer<OpenPatch> entry = c.open + patch;
    build_once(field(entry, &OpenPatch::state), [&] { dice_patch(c, patch, entry); });
    return entry;
}

/// Makes the blocks of the next finer level under a block.
[[gnu::noinline]] inline void dice_children(const Context& c, sint line, pointer<BlockHeader> header) {
    phase_scope phase(phase_tessellate);
    sint patch = load(field(header, &BlockHeader::patch));
    sint instance = load(field(header, &BlockHeader::instance));
    sint level = load(field(header, &BlockHeader::level));
    sint column = load(field(header, &BlockHeader::column));
    sint row = load(field(header, &BlockHeader::row));
    Cage g = load_cage(c, instance, level - 1);
    Dicing d = plan_dicing(c, g, instance, patch, level - 1);
    Shape s = block_shape(d);
    sint columns_log2 = select(d.nu > block_log2, sint(1), sint(0));
    sint rows_log2 = select(d.nv > block_log2, sint(1), sint(0));
    sint columns = sint(1) << columns_log2;
    sint rows = sint(1) << rows_log2;
    sint blocks = columns * rows;
    sint first =
        allocate(c, &WorkerRecord::grid_next, &WorkerRecord::grid_end, s.lines * blocks, trap_grids_full);
    sint child = first;
    for (sint j = 0; branch(j < rows); ++j) {
        for (sint i = 0; branch(i < columns); ++i) {
            sint at_column = (column << columns_log2) + i;
            sint at_row = (row << rows_log2) + j;
            place_block(c, g, d, s, child, at_column, at_row, line);
            child = child + s.lines;
        }
    }
    store(field(header, &BlockHeader::child_line), first);
    store(field(header, &BlockHeader::child_lines), s.lines);
    store(field(header, &BlockHeader::child_columns), columns);
    store(field(header, &BlockHeader::child_rows), rows);
    count_blocks(c, s, d.level, blocks);
}

/// Returns once the block's children are there, making them if nobody else does.
inline void ensure_children(const Context& c, sint line, pointer<BlockHeader> header) {
    build_once(field(header, &BlockHeader::children), [&] { dice_children(c, line, header); });
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
