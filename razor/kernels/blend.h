// A block as the rays of one field see it: every vertex between its anchor and the mean of its parents, they
// between theirs, and so on. One lane a vertex. Parents lie in the block, but those of its corners: these are
// found from the coarser blocks above, down from the first one whose corners do not move.
#pragma once

#include "razor/kernels/budget_room.h"
#include "razor/kernels/reach.h"

namespace razor::ISA_TARGET {
inline namespace morph_kernel {

/// The largest target edge length where vertices of the block, or what they hang from, can be; roundings as
/// of targets_in() (fields.h).
inline sfloat largest_target(const Field& f, pointer<BlockHeader> block) {
    pointer<float> box = box_with_ancestors(block);
    svec low = load_svec(box);
    svec high = load_svec(box + 3);
    svec before = f.origin - low;
    svec after = high - f.origin;
    sfloat far_x = max(before.x, after.x);
    sfloat far_y = max(before.y, after.y);
    sfloat far_z = max(before.z, after.z);
    sfloat near_x = max(-min(before.x, after.x), 0.0F);
    sfloat near_y = max(-min(before.y, after.y), 0.0F);
    sfloat near_z = max(-min(before.z, after.z), 0.0F);
    sbool shrinks = f.growth < 0.0F;
    sfloat x = select(shrinks, near_x, far_x);
    sfloat y = select(shrinks, near_y, far_y);
    sfloat z = select(shrinks, near_z, far_z);
    sfloat square = fma(x, x, fma(y, y, z * z));
    sfloat outward = select(shrinks, sfloat(few_down), sfloat(few_up));
    sfloat distance = sqrt(square) * outward;
    distance = max(distance - f.radius, 0.0F);
    // The slope's term is largest at one of two opposite corners.
    sfloat one = f.base;
    sfloat other = f.base;
    sfloat size = 0.0F; // of what is summed up, for its rounding
    sfloat slopes[3] = {f.slope.x, f.slope.y, f.slope.z};
    sfloat lows[3] = {before.x, before.y, before.z};
    sfloat highs[3] = {after.x, after.y, after.z};
    for (int k = 0; k < 3; ++k) {
        sfloat at_low = -(slopes[k] * lows[k]);
        sfloat at_high = slopes[k] * highs[k];
        sfloat more = max(at_low, at_high);
        sfloat less = min(at_low, at_high);
        one = one + more;
        other = other + less;
        size = size + max(-less, more);
    }
    sfloat blurred = max(one, -other);
    blurred = fma(size, few_roundings, blurred);
    sfloat target = fma(f.growth, distance, blurred) * few_up;
    return max(target, least_target);
}

inline svec blend_vertex(const Field& f, sint birth, const svec& anchor, const svec& one, const svec& other) {
    sfloat weight = weight_of(target_at(f, anchor), birth);
    return blend_vertex(weight, anchor, one, other);
}

/// Corners of blocks as a field sees them.
struct SeenCorners {
    static constexpr int words = 3;
    const Field& f;

    /// Whether corners born at this level or above are at their anchors.
    sbool at_rest(pointer<BlockHeader> block, sint birth) const {
        sfloat most = largest_target(f, block);
        return most <= moving_from(birth);
    }
    void climb(pointer<BlockHeader>) {}
    svec place(const svec& anchor) const { return anchor; }
    svec load_place(pointer<float> at) const { return load_svec(at); }
    void store_place(pointer<float> at, const svec& p) const { store_svec(at, p); }
    svec moved(sint birth, const svec& anchor, const svec& one, const svec& other) const {
        return blend_vertex(f, birth, anchor, one, other);
    }
};

/// At which levels vertices of a block are born: of the finest inside it, and how much earlier on each side.
struct Births {
    sint inside, earliest, first_level;
    vint early[4];

    /// Of vertices on these sides, one a lane, that would be born at `birth` inside.
    vint on_sides(sint birth, const vint& side) const {
        vint sooner = vint(0);
        for (int s = 0; s < 4; ++s)
            sooner = select(side == vint(s), early[s], sooner);
        return birth_from(vint(birth) + sooner, first_level);
    }
};
inline Births births_in(pointer<BlockHeader> block) {
    Births b;
    b.inside = load(field(block, &BlockHeader::absolute));
    b.earliest = earliest_inside(block);
    b.first_level = first_level_of(block);
    for (int s = 0; s < 4; ++s)
        b.early[s] = vint(early_on_side(block, s));
    return b;
}

/// Both parents of vertices as they lie, `along_u` words apart along u, and so on; beyond them whatever is in
/// the slot.
struct ParentSteps {
    sint along_u, along_v, diagonal;
};
inline vvec load_parents(pointer<float> x, sint stride, const ParentSteps& to, const vmask& along_u,
                         const vmask& along_v) {
    vvec p;
    for (int k = 0; k < 3; ++k) {
        vfloat q = load_vector(x + to.diagonal);
        vfloat v = load_vector(x + to.along_v);
        q = select(along_v, v, q);
        vfloat u = load_vector(x + to.along_u);
        (k == 0 ? p.x : k == 1 ? p.y : p.z) = select(along_u, u, q);
        x = x + stride;
    }
    return p;
}

/// The vertices of one pass, born at `birth` inside: all of the block as they lie, so that nothing is
/// gathered.
[[gnu::noinline]] inline void blend_pass_of(const Field& f, const Births& births, sint birth, sint step,
                                            pointer<std::int32_t> rows, sint quads_u, pointer<float> anchors,
                                            pointer<float> out, sint stride) {
    sint down = step * (quads_u + 1);
    ParentSteps after{step, down, down + step};
    ParentSteps before{-step, -down, -after.diagonal};
    for (sint from = 0; branch(from < stride); from += isa::width) {
        vmask m = first_lanes(stride - from);
        vint parents = load_vector(rows + from, m);
        m = m & (parents != vint(blend_none));
        if (branch(none(m)))
            continue;
        vint side = load_vector(rows + (from + row_vertices), m);
        vmask along_u = parents == vint(blend_along_u);
        vmask along_v = parents == vint(blend_along_v);
        vvec anchor;
        pointer<float> at = anchors + from;
        anchor.x = load_vector(at, m);
        anchor.y = load_vector(at + stride, m);
        anchor.z = load_vector(at + stride * 2, m);
        pointer<float> x = out + block_header_words + from;
        vvec a = load_parents(x, stride, before, along_u, along_v);
        vvec b = load_parents(x, stride, after, along_u, along_v);
        vint born = births.on_sides(birth, side);
        vfloat weight = weight_of(target_at(f, anchor), born);
        vvec q = blend_vertex(weight, anchor, a, b);
        store_vector(x, q.x, m);
        store_vector(x + stride, q.y, m);
        store_vector(x + stride * 2, q.z, m);
        store_vector(out + blend_weights + from, weight, m);
    }
}

/// The vertices, x[stride], y, z, behind a header that only holds a box, and the weights that made them.
/// `out` is one of the two blend areas.
inline void blend_vertices(const Context& c, const Field& f, sint line, pointer<float> out) {
    SeenCorners seen{f};
    pointer<float> corners = find_corners(c, seen, line);
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    pointer<float> anchors = as<float>(block) + block_header_words;
    pointer<float> x = out + block_header_words;
    pointer<float> weights = out + blend_weights;
    sint values = stride * 3;
    for (sint from = 0; branch(from < values); from += isa::width) {
        vmask m = first_lanes(values - from);
        vfloat anchor = load_vector(anchors + from, m);
        store_vector(x + from, anchor, m);
        vmask vertices = first_lanes(stride - from);
        store_vector(weights + from, vfloat(1.0F), vertices);
    }
    for (int k = 0; k < 4; ++k) {
        sint vertex = corner_vertex(k, quads_u, quads_v);
        svec p = load_svec(corners + 3 * k);
        store(x + vertex, p.x);
        store(x + stride + vertex, p.y);
        store(x + stride * 2 + vertex, p.z);
    }
    Births births = births_in(block);
    sfloat most = largest_target(f, block);
    pointer<std::int32_t> rows = pass_rows(c, quads_u, quads_v);
    // Where nothing moves, anchors it is.
    for (int p = 0; p < blend_passes; ++p) {
        int step = 1 << (block_log2 - 1 - p);
        sint birth = births.inside + (block_log2 - 1 - p);
        sbool moves = most > moving_from(birth + births.earliest);
        if (branch(moves & (max(quads_u, quads_v) > step)))
            blend_pass_of(f, births, birth, sint(step), rows, quads_u, anchors, out, stride);
        rows = rows + 2 * row_vertices;
    }
}

/// The ends of the flat edge, longer than the block, that side s of block `line` hangs from: found in the
/// first coarser block that has both, or beyond the patch if it is the whole edge of which the side is half.
inline void blend_ancestor(const Context& c, const Field& f, sint line, int s, sint hang,
                           pointer<float> out) {
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint strip = load(field(block, s % 2 == 0 ? &BlockHeader::column : &BlockHeader::row));
    sint segment = strip * block_quads;
    sint quads = 0;
    for (;;) {
        quads = load(field(block, s % 2 == 0 ? &BlockHeader::quads_u : &BlockHeader::quads_v));
        sint parent = load(field(block, &BlockHeader::parent));
        if (branch((sint(1) << hang) <= quads))
            break;
        if (branch(parent < 0))
            break;
        line = parent;
        block = as<BlockHeader>(c.grids + line);
        segment = segment >> 1;
        --hang;
    }
    if (branch((sint(1) << hang) > quads)) {
        sint middles = load(field(block, &BlockHeader::middles));
        svec near = corner_anchor(block, 0);
        svec far = load_svec(as<float>(block) + middles + (ends_far + (s == 0 ? 0 : 3)));
        store_svec(out, near);
        store_svec(out + 3, far);
        return;
    }
    pointer<float> area = c.stack + scratch_blend;
    blend_vertices(c, f, line, area);
    strip = load(field(block, s % 2 == 0 ? &BlockHeader::column : &BlockHeader::row));
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    sint from = segment - strip * block_quads;
    from = (from >> hang) << hang;
    sint width = quads_u + 1;
    sint first = s == 1 ? quads_u : s == 2 ? width * quads_v : sint(0);
    sint step = s % 2 == 0 ? sint(1) : width;
    pointer<float> x = area + block_header_words;
    sint to = from + (sint(1) << hang);
    store_svec(out, load_vertex(x, stride, first + from * step));
    store_svec(out + 3, load_vertex(x, stride, first + to * step));
}

/// Whether side s of a block blended in `out`, if all of it is the half of an edge of which the block's patch
/// is a part, lies on the whole edge but for rounding: the field has the edge's middle at the mean of its
/// ends. Then these are stored as the side's ancestor.
inline sbool blend_whole_edge(const Context& c, const Field& f, pointer<BlockHeader> block, int s,
                              pointer<float> out) {
    sbool whole = false;
    if (s != 0 && s != 3)
        return whole;
    sint patch = load(field(block, &BlockHeader::patch));
    sint root_line = load(field(c.open + patch, &OpenPatch::root));
    pointer<BlockHeader> root = as<BlockHeader>(c.grids + root_line);
    sint middles = load(field(root, &BlockHeader::middles));
    sint curve = load(field(block, &BlockHeader::curve) + s);
    sint exponent = load(field(block, &BlockHeader::exponent) + (s == 0 ? 0 : 1));
    sbool beyond = curve >= 0;
    beyond = beyond & (middles != 0);
    beyond = beyond & (exponent <= block_log2);
    if (branch(beyond)) {
        svec middle = corner_anchor(block, s == 0 ? 1 : 3);
        sfloat target = target_at(f, middle);
        sfloat weight = weight_of(target, birth_of_middle(root, s));
        whole = weight == 0.0F;
        pointer<float> ends = out + (blend_ancestors + 6 * s);
        store_svec(ends, corner_anchor(block, 0));
        store_svec(ends + 3, load_svec(as<float>(root) + middles + (ends_far + s)));
    }
    return whole;
}

/// How far vertices of the block are from their anchors where target edge lengths are at most `target`.
inline sfloat sway_of(const Context& c, pointer<BlockHeader> block, sfloat target) {
    sint absolute = load(field(block, &BlockHeader::absolute));
    sint earliest = absolute + earliest_inside(block);
    sfloat sway = load(field(block, &BlockHeader::sway));
    for (int p = 1; p < blend_passes; ++p) {
        sfloat more = load(field(block, &BlockHeader::sway) + p);
        sway = select(target > moving_from(earliest + p), more, sway);
    }
    return sway + corners_move(c, block, target);
}

/// log2 of the sub-edges of side s on one edge of the curve at absolute level `level` (or the block's, if
/// that is coarser).
inline sint hang_at(pointer<BlockHeader> block, int s, sint level) {
    sint hang = load(field(block, &BlockHeader::hang) + s);
    sint curve = load(field(block, &BlockHeader::curve) + s);
    sint own = load(field(block, &BlockHeader::level));
    sint absolute = load(field(block, &BlockHeader::absolute));
    sint asked = max(level - absolute, 0) + own;
    sint left = max(curve - asked, 0);
    sint more = max(curve - own, 0) - left;
    return hang + select(curve < 0, sint(0), more);
}

/// Of a blended block: whether that is how rays see it in a leaf of `level` ("no leaf": whatever its sides
/// hang from).
inline constexpr int no_leaf = -1000;
inline sbool fits_leaf(pointer<float> slot, sint level) {
    sbool any = level == no_leaf;
    return any | (load(as<std::int32_t>(slot) + slot_level) == level);
}

/// A slot, and whether it holds what was asked for.
struct Kept {
    pointer<float> slot;
    sbool there;
};

/// Block `line` as field `number` sees it in a leaf of `level`, if it is kept; else the worker's slot for it.
inline Kept find_blended(const Context& c, sint number, sint line, sint level) {
    Kept kept;
    if (branch(number == camera_number)) {
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint seen = load_acquire(field(block, &BlockHeader::seen));
        if (branch(seen == ready)) {
            sint at = load(field(block, &BlockHeader::seen_line));
            kept.slot = as<float>(c.grids + at);
            kept.there = fits_leaf(kept.slot, level);
            if (branch(kept.there))
                return kept;
        }
    }
    sint mixed = number * 40503;
    mixed = line * 7919 + mixed;
    sint slot = (mixed >> 8) & (blend_slots - 1);
    kept.slot = c.blends + slot * c.slot_floats;
    pointer<std::int32_t> key = as<std::int32_t>(kept.slot);
    kept.there = load(key + slot_line) == line;
    kept.there = kept.there & (load(key + slot_field) == number);
    kept.there = kept.there & fits_leaf(kept.slot, level);
    return kept;
}

/// Forgets all.
inline void clear_blends(const Context& c) {
    for (int i = 0; i < blend_slots; ++i)
        store(as<std::int32_t>(c.blends + c.slot_floats * i) + slot_line, -1);
}

/// Blends block `line` as the field, of this number, sees it in a leaf of `level`: vertices, boxes of cells,
/// ancestors.
[[gnu::noinline]] inline void blend_block(const Context& c, const Field& f, sint number, sint line,
                                          sint level, pointer<float> slot) {
    phase_scope phase(phase_morph);
    tally(c.counters->blended_blocks, 1);
    pointer<std::int32_t> key = as<std::int32_t>(slot);
    store(key + slot_line, line);
    store(key + slot_field, number);
    store(key + slot_level, level);
    store_release(as<shared_int>(slot) + slot_normals, absent);
    pointer<float> out = slot + slot_block;
    blend_vertices(c, f, line, out);
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    for (int s = 0; s < 4; ++s) {
        sint hang = hang_at(block, s, level);
        sint quads = load(field(block, s % 2 == 0 ? &BlockHeader::quads_u : &BlockHeader::quads_v));
        if (branch((sint(1) << hang) > quads))
            blend_ancestor(c, f, line, s, hang, out + (blend_ancestors + 6 * s));
    }
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    sint shift = cells_shift(quads_u);
    sint cells = ((quads_v + 1) >> 1) << shift;
    for (sint from = 0; branch(from < cells); from += isa::width) {
        vmask m = first_lanes(cells - from);
        vvec lo, hi;
        bound_cells(out + block_header_words, stride, quads_u, quads_v, shift, from, m, lo, hi);
        store_cells(out + blend_cells + from, lo, hi, m);
    }
}

/// Blends a block that find_blended() did not find, and keeps it, for all if the field is the camera's (and
/// no leaf of another level was first), else in the worker's slot; finish(slot) does what is left to do.
/// Returns where it lies.
template <class Finish>
inline pointer<float> keep_blended(const Context& c, const Field& f, sint number, sint line, sint level,
                                   pointer<float> slot, Finish finish) {
    if (branch(number == camera_number)) {
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        build_once(c, field(block, &BlockHeader::seen), [&] {
            sint lines = (c.slot_floats + ((1 << line_floats_log2) - 1)) >> line_floats_log2;
            sint at = allocate(c, &WorkerRecord::grid_next, &WorkerRecord::grid_end, lines, trap_grids_full);
            sint absolute = load(field(block, &BlockHeader::absolute));
            note_level(c.grids + at, lines, absolute);
            pointer<float> shared = as<float>(c.grids + at);
            blend_block(c, f, number, line, level, shared);
            finish(shared);
            store(field(block, &BlockHeader::seen_line), at);
        });
        sint at = load(field(block, &BlockHeader::seen_line));
        pointer<float> shared = as<float>(c.grids + at);
        if (branch(fits_leaf(shared, level)))
            return shared;
    }
    blend_block(c, f, number, line, level, slot);
    finish(slot);
    return slot;
}

} // namespace morph_kernel
} // namespace razor::ISA_TARGET
