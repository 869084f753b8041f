// Opening a patch and making it finer: blocks of one level, announced or filled in whole.
#pragma once

#include "razor/kernels/block_bounds.h"
#include "razor/kernels/budget_room.h"
#include "razor/kernels/displaced_block.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// What a block's BlockHeader::triangles has besides their number: of a material that is seen from the front
/// only, from where they are seen.
inline sint seen_sides(const Context& c, const Dicing& d) {
    sint some = load(field(c.frame, &FrameHeader::one_sided));
    if (branch(some == 0))
        return 0;
    pointer<InstanceRecord> instance = c.instances + d.instance;
    sint material = load(field(instance, &InstanceRecord::material));
    if (branch(material < 0)) {
        pointer<std::int32_t> of_faces = load(field(c.frame, &FrameHeader::face_materials));
        material = load(of_faces + d.face);
    }
    pointer<MaterialRecord> materials = load(field(c.frame, &FrameHeader::materials));
    sint one_sided = load(field(materials + material, &MaterialRecord::one_sided));
    sint moved = load(field(instance, &InstanceRecord::moved));
    sint front = select(moved < 0, sint(seen_from_mirrored_front), sint(seen_from_front));
    sint from = front << 2;
    return select(one_sided != 0, from, sint(seen_from_both_sides));
}

/// The header of block (column, row) of the patch at `line`, but for what depends on its vertices.
inline Block begin_block(const Context& c, const Dicing& d, const Shape& s, sint line, sint column, sint row,
                         sint parent) {
    Block b;
    b.quads_u = s.quads_u;
    b.quads_v = s.quads_v;
    b.stride = s.stride;
    b.corners_at = s.corners_at;
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
    sint sides = seen_sides(c, d);
    store(field(h, &BlockHeader::triangles), s.triangles + sides);
    store(field(h, &BlockHeader::stride), s.stride);
    store(field(h, &BlockHeader::exponent), d.nu);
    store(field(h, &BlockHeader::exponent) + 1, d.nv);
    store(field(h, &BlockHeader::cells_at), s.cells_at);
    store(field(h, &BlockHeader::ancestors_at), s.ancestors_at);
    store(field(h, &BlockHeader::middles), s.middles_at);
    store(field(h, &BlockHeader::normals_at), s.normals_at);
    store(field(h, &BlockHeader::parent), parent);
    store_release(field(h, &BlockHeader::made), absent);
    store_release(field(h, &BlockHeader::normals), absent);
    store_release(field(h, &BlockHeader::children), absent);
    store_release(field(h, &BlockHeader::seen), absent);
    if (branch(s.shaded_at != 0))
        store_release(as<shared_int>(b.words + s.shaded_at), absent);
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
    sbool part = half(d.side[0]) != 0;
    sbool fixed = s.stride <= 4;
    fixed = fixed & (parent < 0);
    fixed = fixed & !part;
    fixed = fixed | is_flat(d);
    sint corners_at = select(fixed, sint(no_vertex_moves), s.corners_at);
    store(field(h, &BlockHeader::corners_at), corners_at);
    return b;
}

/// The vertices of a block, and what of it depends on them as long as they lie on the surface, before the
/// sides are put where their owners have them: boxes of parts, and if `bounded` that of all finer vertices.
[[gnu::noinline]] inline void place_vertices(const Context& c, const Cage& g, const Dicing& d, const Shape& s,
                                             const Block& b, sbool bounded) {
    auto bound = [&] {
        if (branch(bounded))
            bound_finer(c, g, d, b);
        if (branch(s.parts))
            bound_parts(b, s);
    };
    if (branch(d.displaced)) {
        place_displaced(c, g, d, b, bounded);
    } else if (branch(is_flat(d))) {
        place_flat(g, d, b);
    } else if (branch(d.kind == static_cast<int>(PatchKind::bilinear))) {
        place_bilinear(c, g, d, b);
        bound();
        place_sides<true>(c, g, d, b);
    } else {
        sint face_class = load(field(g.faces + d.face, &FaceRecord::face_class));
        sint control_first = load(field(g.faces + d.face, &FaceRecord::control_first));
        sint control_count = load(field(g.faces + d.face, &FaceRecord::control_count));
        sint index = block_page_index(g, face_class, d.sub, d.nu, d.nv, b.column, b.row);
        pointer<float> weights = page_weights(c, g, face_class, PageKind::block, index);
        weigh_all(g, weights, page_stride(b.stride), control_first, control_count, b.stride, b.x, b.stride);
        bound();
        place_sides<false>(c, g, d, b);
    }
}

/// Makes a block at once, with the tightest box.
inline void place_block(const Context& c, const Cage& g, const Dicing& d, const Shape& s, sint line,
                        sint column, sint row, sint parent) {
    Block b = begin_block(c, d, s, line, column, row, parent);
    pointer<BlockHeader> h = b.header;
    sbool finer = d.level > 0;
    sbool limit = d.kind == static_cast<int>(PatchKind::catmull_clark);
    store(field(h, &BlockHeader::deviation), 0.0F);
    place_vertices(c, g, d, s, b, finer);
    if (branch(s.corners_at != corners_lie_in_vertices)) {
        if (branch(limit))
            place_corners<false>(c, g, d, b);
        else
            place_corners<true>(c, g, d, b);
    }
    if (branch(s.middles_at != 0)) {
        if (branch(limit))
            place_middles<false>(c, g, d, b.words + s.middles_at);
        else
            place_middles<true>(c, g, d, b.words + s.middles_at);
    }
    Box box = bound_block(b, s.cells_at);
    if (branch(finer))
        box = hold(box, box_of(h));
    store_box(h, box);
    if (branch(s.ancestors_at != 0))
        bound_ancestors(b);
    sfloat corners = 0.0F;
    if (branch(!is_flat(d))) {
        measure_sway(c, b);
        if (branch(limit & has_ancestors(c, b, parent))) {
            corners = corners_lie(b);
            corners = corners + corners_off(c, d, b, parent);
        }
    }
    store(field(h, &BlockHeader::corner_sway), corners);
    sfloat middle = 0.0F;
    if (branch(half(d.side[0]) != 0)) {
        middle = middle_sway(c, d, s, b, parent, [&](int k) {
            return load_vertex(b.x, b.stride, corner_vertex(k, b.quads_u, b.quads_v));
        });
    }
    store(field(h, &BlockHeader::middle_sway), middle);
    store_release(field(h, &BlockHeader::made), ready);
}

/// Boxes of blocks that have no vertices yet may be wider than their parent's vertices by this much of their
/// largest side.
inline constexpr float worth_waiting = 1.0F / 8;

/// The header of a block with what its parent knows of it: a box and corners. Its vertices wait for the first
/// ray that meets the box. False if they cannot: if a side hangs from an edge longer than the block, or the
/// surface leaves the parent's triangles by so much that the box would be too wide.
inline sbool announce_block(const Context& c, const Cage& g, const Dicing& d, const Shape& s, sint line,
                            sint column, sint row, sint parent_line, const svec& deviation) {
    Part part = part_of_parent(d, column, row);
    if (branch(max(part.u, part.v) < 0))
        return false;
    pointer<BlockHeader> parent = as<BlockHeader>(c.grids + parent_line);
    if (branch(d.displaced)) { // what its sides hang from leaves it in another way
        sint hangs = load(field(parent, &BlockHeader::hangs));
        if (branch(hangs != 0))
            return false;
    }
    Box own = surface_of(parent, part);
    Box wider{own.low - deviation, own.high + deviation};
    Box box = common(box_of(parent), wider);
    sfloat size = largest_component_of(box.high - box.low);
    sfloat widest = size * worth_waiting;
    if (branch(largest_component_of(deviation) > widest))
        return false;
    sbool border[4] = {row == 0, column == s.columns - 1, row == s.rows - 1, column == 0};
    for (int k = 0; k < 4; ++k) {
        sint quads = k % 2 == 0 ? s.quads_u : s.quads_v;
        if (branch(border[k] & ((sint(1) << d.side[k].hang) > quads)))
            return false;
    }
    Block b = begin_block(c, d, s, line, column, row, parent_line);
    pointer<BlockHeader> h = b.header;
    store_box(h, box);
    store(field(h, &BlockHeader::deviation), -1.0F);
    take_corners(parent, part, b);
    sbool limit = d.kind == static_cast<int>(PatchKind::catmull_clark);
    if (branch(limit))
        place_hanging_corners(c, g, d, b, [](sint) { return sint(1); });
    if (branch(s.ancestors_at != 0))
        bound_ancestors(b);
    sfloat corners = 0.0F;
    if (branch(limit & has_ancestors(c, b, parent_line)))
        corners = corners_off(c, d, b, parent_line);
    store(field(h, &BlockHeader::corner_sway), corners);
    sfloat middle = 0.0F;
    if (branch(half(d.side[0]) != 0))
        middle = middle_sway(c, d, s, b, parent_line, [&](int k) { return corner_anchor(h, k); });
    store(field(h, &BlockHeader::middle_sway), middle);
    return true;
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
    sint line = allocate_blocks(c, s.lines, 1);
    place_block(c, g, d, s, line, 0, 0, -1);
    store(field(entry, &OpenPatch::root), line);
    tally(c.counters->patches_opened, 1);
    count_blocks(c, s, d.level, 1);
}

/// Returns once the patch is open in the worker's tree, opening it if nobody else does.
inline pointer<OpenPatch> open_patch(const Context& c, sint patch) {
    pointer<OpenPatch> entry = c.open + patch;
    build_once(c, field(entry, &OpenPatch::state), [&] { dice_patch(c, patch, entry); });
    return entry;
}

/// The vertices of a block that was announced.
[[gnu::noinline]] inline void make_block(const Context& c, pointer<BlockHeader> header) {
    phase_scope phase(phase_tessellate);
    sint patch = load(field(header, &BlockHeader::patch));
    sint instance = load(field(header, &BlockHeader::instance));
    sint level = load(field(header, &BlockHeader::level));
    Cage g = load_cage(c, instance, level);
    Dicing d = plan_dicing(c, g, instance, patch, level);
    Shape s = block_shape(d);
    Block b;
    b.quads_u = s.quads_u;
    b.quads_v = s.quads_v;
    b.stride = s.stride;
    b.corners_at = s.corners_at;
    b.ancestors_at = s.ancestors_at;
    b.column = load(field(header, &BlockHeader::column));
    b.row = load(field(header, &BlockHeader::row));
    b.header = header;
    b.words = as<float>(header);
    b.x = b.words + block_header_words;
    place_vertices(c, g, d, s, b, false);
    bound_block(b, s.cells_at);
    measure_sway(c, b);
    count_blocks(c, s, d.level, 1);
}

[[gnu::noinline]] inline void make_once(const Context& c, pointer<BlockHeader> header) {
    build_once(c, field(header, &BlockHeader::made), [&] { make_block(c, header); });
}

/// Returns once the block has vertices, making them if nobody else does.
inline void ensure_made(const Context& c, pointer<BlockHeader> header) {
    sint made = load_acquire(field(header, &BlockHeader::made));
    if (branch(made != ready))
        make_once(c, header);
}

/// Makes the blocks of the next finer level under a block, or announces them.
[[gnu::noinline]] inline void dice_children(const Context& c, sint line, pointer<BlockHeader> header) {
    phase_scope phase(phase_tessellate);
    ensure_made(c, header);
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
    svec deviation{sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)};
    if (branch(blocks > 1))
        deviation = deviation_of(c, g, d, header);
    sint first = allocate_blocks(c, s.lines, blocks);
    sint child = first;
    sint made = 0;
    for (sint j = 0; branch(j < rows); ++j) {
        for (sint i = 0; branch(i < columns); ++i) {
            sint at_column = (column << columns_log2) + i;
            sint at_row = (row << rows_log2) + j;
            if (branch(!announce_block(c, g, d, s, child, at_column, at_row, line, deviation))) {
                place_block(c, g, d, s, child, at_column, at_row, line);
                ++made;
            }
            child = child + s.lines;
        }
    }
    store(field(header, &BlockHeader::child_line), first);
    sint lines = s.lines << 3;
    store(field(header, &BlockHeader::child_shape), lines | blocks);
    count_blocks(c, s, d.level, made);
}

/// Returns once the block's children are there, making them if nobody else does.
inline void ensure_children(const Context& c, sint line, pointer<BlockHeader> header) {
    build_once(c, field(header, &BlockHeader::children), [&] { dice_children(c, line, header); });
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
