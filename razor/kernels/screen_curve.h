// The order of screen tiles: along a curve that fills the rectangle they make, of whatever size, each tile
// beside the one before (Hilbert's curve generalised to rectangles, after Červený, "Generalized Hilbert
// space-filling curve for rectangular domains", 2018; where the longer side is odd and the shorter even, one
// step is along a diagonal). So any stretch of it is in one piece and about as wide as high, and what its
// tiles need of the tree overlaps. Morton's order would leave holes unless sides are powers of two, and
// jumps.
#pragma once

#include "razor/kernels/context.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

struct TilePlace {
    sint column, row;
};

/// Half of a side, even if there is a choice: parts of even sides begin and end beside each other.
inline sint curve_half(sint side) {
    sint half = side >> 1;
    sbool odd = (half & 1) != 0;
    return half + select(odd & (side > 2), sint(1), sint(0));
}

/// Where tile `number` of columns x rows lies. The rectangle is cut up until what holds the tile is one row:
/// across if it is long, else into a part that goes up, one that goes along and one that comes down.
[[gnu::noinline]] inline TilePlace place_on_curve(sint columns, sint rows, sint number) {
    sbool wide = columns >= rows;
    sint length = max(columns, rows);
    sint height = min(columns, rows);
    // One tile along the rectangle's length and along its height.
    sint along_x = select(wide, sint(1), sint(0));
    sint along_y = sint(1) - along_x;
    sint up_x = along_y;
    sint up_y = along_x;
    sint x = 0;
    sint y = 0;
    while (branch(min(length, height) > 1)) {
        sint threefold = height * 3;
        if (branch(threefold < length * 2)) {
            sint half = curve_half(length);
            sint first = half * height;
            if (branch(number < first)) {
                length = half;
                continue;
            }
            number = number - first;
            x = x + along_x * half;
            y = y + along_y * half;
            length = length - half;
            continue;
        }
        sint up = curve_half(height);
        sint half = length >> 1;
        sint rising = up * half;
        if (branch(number < rising)) {
            sint old_x = along_x;
            sint old_y = along_y;
            along_x = up_x;
            along_y = up_y;
            up_x = old_x;
            up_y = old_y;
            length = up;
            height = half;
            continue;
        }
        number = number - rising;
        sint level = length * (height - up);
        if (branch(number < level)) {
            x = x + up_x * up;
            y = y + up_y * up;
            height = height - up;
            continue;
        }
        number = number - level;
        sint last = length - 1;
        x = x + along_x * last;
        y = y + along_y * last;
        last = up - 1;
        x = x + up_x * last;
        y = y + up_y * last;
        sint old_x = along_x;
        sint old_y = along_y;
        along_x = -up_x;
        along_y = -up_y;
        up_x = -old_x;
        up_y = -old_y;
        height = length - half;
        length = up;
    }
    sbool row = height == 1;
    along_x = select(row, along_x, up_x);
    along_y = select(row, along_y, up_y);
    return {x + along_x * number, y + along_y * number};
}

/// Row by row, to compare with.
inline TilePlace place_in_rows(sint columns, sint number) {
    sfloat across = to_float(columns);
    sint row = to_int(to_float(number) / across); // rounded: off by one at most
    sint column = number - row * columns;
    sint more = select(column >= columns, sint(1), sint(0));
    more = more - select(column < 0, sint(1), sint(0));
    row = row + more;
    return {number - row * columns, row};
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
