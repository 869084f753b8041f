// The corners of a block are all of it that moves towards vertices outside it. They are found from the
// coarser blocks above, down from the first one whose corners do not move: where one field sees them
// (blend.h), or where any of several may (reach.h).
#pragma once

#include "razor/kernels/morph.h"
#include "razor/kernels/tessellate.h"

namespace razor::ISA_TARGET {
inline namespace morph_kernel {

/// Corners of a sub-face that are middles of edges move towards the mean of the edge's ends.
template <class Corners>
inline void move_middles(const Corners& seen, pointer<BlockHeader> block, pointer<BlockHeader> root,
                         pointer<float> corners) {
    sint middles = load(field(root, &BlockHeader::middles));
    if (branch(middles == 0))
        return;
    sint column = load(field(block, &BlockHeader::column));
    sint row = load(field(block, &BlockHeader::row));
    sint log2_u = load(field(block, &BlockHeader::exponent));
    sint log2_v = load(field(block, &BlockHeader::exponent) + 1);
    sint last_column = (sint(1) << max(log2_u - block_log2, 0)) - 1;
    sint last_row = (sint(1) << max(log2_v - block_log2, 0)) - 1;
    sbool there[2] = {column == last_column, column == 0};
    there[0] = there[0] & (row == 0);
    there[1] = there[1] & (row == last_row);
    for (int k = 0; k < 2; ++k) {
        if (branch(there[k])) {
            int corner = k == 0 ? 1 : 3;
            svec mean = load_svec(as<float>(root) + middles + (ends_mean + 3 * k));
            svec anchor = corner_anchor(block, corner);
            auto end = seen.place(mean);
            auto p = seen.moved(birth_of_middle(root, k), anchor, end, end);
            seen.store_place(corners + corner * Corners::words, p);
        }
    }
}

/// Number of the corner at (i, j), each 0 or 1.
inline sint corner_number(sint i, sint j) {
    sint odd = i ^ j;
    return odd + j * 2;
}

/// The corners of a block's child from its own.
template <class Corners>
inline void move_corners(const Corners& seen, pointer<BlockHeader> block, pointer<BlockHeader> child,
                         pointer<float> from, pointer<float> to) {
    sint absolute = load(field(block, &BlockHeader::absolute));
    sint column = load(field(child, &BlockHeader::column));
    sint row = load(field(child, &BlockHeader::row));
    sint log2_u = load(field(child, &BlockHeader::exponent));
    sint log2_v = load(field(child, &BlockHeader::exponent) + 1);
    sbool split_u = log2_u > block_log2;
    sbool split_v = log2_v > block_log2;
    sint early[4];
    for (int s = 0; s < 4; ++s)
        early[s] = early_on_side(block, s);
    sint first_level = first_level_of(block);
    for (int k = 0; k < 4; ++k) {
        int right = k == 1 || k == 2 ? 1 : 0;
        int up = k >= 2 ? 1 : 0;
        // In halves of the block.
        sint i = select(split_u, (column & 1) + right, sint(2 * right));
        sint j = select(split_v, (row & 1) + up, sint(2 * up));
        sint odd_i = i & 1;
        sint odd_j = j & 1;
        sint low_i = (i - odd_i) >> 1;
        sint low_j = (j - odd_j) >> 1;
        pointer<float> one_at = from + corner_number(low_i, low_j) * Corners::words;
        auto p = seen.load_place(one_at);
        if (branch((odd_i | odd_j) != 0)) {
            sint other_i = low_i + odd_i;
            pointer<float> other_at = from + corner_number(other_i, low_j + odd_j) * Corners::words;
            auto other = seen.load_place(other_at);
            sint along_u = select(j == 0, early[0], early[2]);
            sint along_v = select(i == 0, early[3], early[1]);
            sint sooner = select(odd_j != 0, along_v, along_u);
            sooner = select((odd_i & odd_j) != 0, sint(0), sooner);
            svec anchor = corner_anchor(child, k);
            sint birth = birth_from(absolute + (block_log2 - 1) + sooner, first_level);
            p = seen.moved(birth, anchor, p, other);
        }
        seen.store_place(to + Corners::words * k, p);
    }
}

/// The corners of a block: [corner][words], in scratch.
template <class Corners> inline pointer<float> find_corners(const Context& c, Corners& seen, sint line) {
    pointer<std::int32_t> climb = as<std::int32_t>(c.stack + scratch_climb);
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint patch = load(field(block, &BlockHeader::patch));
    sint root_line = load(field(c.open + patch, &OpenPatch::root));
    pointer<BlockHeader> root = as<BlockHeader>(c.grids + root_line);
    sint depth = 0;
    sint at = line;
    for (;;) {
        sint parent = load(field(block, &BlockHeader::parent));
        if (branch(parent < 0))
            break;
        if (branch(seen.at_rest(block, birth_of_corners(block))))
            break;
        store(climb + depth, at);
        ++depth;
        at = parent;
        block = as<BlockHeader>(c.grids + at);
        seen.climb(block);
    }
    pointer<float> corners = c.stack + scratch_corners;
    pointer<float> spare = corners + 4 * Corners::words;
    for (int k = 0; k < 4; ++k)
        seen.store_place(corners + Corners::words * k, seen.place(corner_anchor(block, k)));
    move_middles(seen, block, root, corners);
    while (branch(depth > 0)) {
        --depth;
        sint child_line = load(climb + depth);
        pointer<BlockHeader> child = as<BlockHeader>(c.grids + child_line);
        move_corners(seen, block, child, corners, spare);
        move_middles(seen, child, root, spare);
        pointer<float> swap = corners;
        corners = spare;
        spare = swap;
        block = child;
    }
    return corners;
}

} // namespace morph_kernel
} // namespace razor::ISA_TARGET
