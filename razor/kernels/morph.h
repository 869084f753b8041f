// From which target edge length on a vertex moves, and how far. A vertex born at absolute level b is at its
// anchor while the ray's target edge length there is at most moving_from(b); from gone_from(b) on it is the
// mean of its parents, where its level's triangles are those of level b + 1. In between it is blended. Of its
// own it has this one weight: a vertex of level b belongs to all finer levels too, but has stopped moving
// wherever they are asked for. (Design: one surface per ray, rules 1 and 2.)
#pragma once

#include "razor/frame/transition.h"
#include "razor/kernels/rounding.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace morph_kernel {

inline constexpr float least_target = least_target_edge;
inline constexpr float unbounded_target = 3.0e38F; // of lists for all rays

/// 2^level, of levels that floats can tell.
inline sfloat power_of_two(sint level) {
    sint exponent = min(max(level, -126), 127);
    return as_float((exponent + 127) << 23);
}
inline sfloat gone_from(sint birth) {
    return power_of_two(birth + 1);
}
inline sfloat moving_from(sint birth) {
    return gone_from(birth) * morph_begin;
}

/// What a ray, or several, ask for: edges of length |base + slope . (place - origin)| + growth x distance
/// from a ball about `origin`. The first term is what a lens blurs, nothing on the plane in focus; without a
/// lens the slope is 0. |slope| + |growth| is at most gradation_cap. All are held times level_rounding.
struct Field {
    svec origin;
    svec slope;
    sfloat radius, base, growth;
};

inline vfloat target_at(const Field& f, const vvec& anchor) {
    vvec d = anchor - broadcast(f.origin);
    vfloat distance = sqrt(dot(d, d));
    distance = distance - vfloat(f.radius);
    distance = max(distance, 0.0F);
    vfloat along = dot(broadcast(f.slope), d);
    along = along + vfloat(f.base);
    vfloat growth = vfloat(f.growth);
    vfloat target = fma(growth, distance, abs(along));
    return max(target, vfloat(least_target));
}
inline sfloat target_at(const Field& f, const svec& anchor) {
    svec d = anchor - f.origin;
    sfloat square = fma(d.x, d.x, fma(d.y, d.y, d.z * d.z));
    sfloat distance = sqrt(square) - f.radius;
    distance = max(distance, 0.0F);
    sfloat along = dot(f.slope, d) + f.base;
    sfloat target = fma(f.growth, distance, abs(along));
    return max(target, least_target);
}

/// The weight of a vertex born at level `birth` (1: at its anchor, 0: at its parents' mean), exactly 1 and 0
/// at the ends. One number or one a lane, the same bits either way.
template <class Float, class Int> inline Float weight_of(const Float& target, const Int& birth) {
    constexpr float steps = 1.0F / (1.0F - morph_begin);
    Int exponent = max(birth, Int(-126));
    exponent = min(exponent, Int(120));
    Float per_gone = as_float((Int(126) - exponent) << 23); // 1 / gone_from(birth)
    Float x = target * per_gone;
    x = (x - morph_begin) * steps;
    x = max(x, 0.0F);
    x = min(x, 1.0F);
    Float rest = x * -2.0F;
    rest = rest + 3.0F;
    Float square = x * x;
    square = square * rest;
    return -square + 1.0F;
}

/// Between a vertex's anchor (weight 1) and the mean of its parents; exactly at either end.
inline vvec blend_vertex(const vfloat& weight, const vvec& anchor, const vvec& one, const vvec& other) {
    vvec mean = (one + other) * vfloat(0.5F);
    vfloat rest = vfloat(1.0F) - weight;
    return madd(weight, anchor, mean * rest);
}
inline svec blend_vertex(sfloat weight, const svec& anchor, const svec& one, const svec& other) {
    svec mean = (one + other) * sfloat(0.5F);
    sfloat rest = sfloat(1.0F) - weight;
    svec part = mean * rest;
    return {fma(weight, anchor.x, part.x), fma(weight, anchor.y, part.y), fma(weight, anchor.z, part.z)};
}

/// Of vertices that would be born below the instance's level 0: they hang at all levels, and are the means of
/// their parents whatever is asked for.
inline constexpr int never_born = -126;
template <class Int> inline Int birth_from(const Int& birth, sint first_level) {
    auto below = birth < Int(first_level);
    Int never(never_born);
    return select(below, never, birth);
}
/// The instance's level 0, absolute.
inline sint first_level_of(pointer<BlockHeader> block) {
    sint absolute = load(field(block, &BlockHeader::absolute));
    return absolute - load(field(block, &BlockHeader::level));
}

/// On side k of a block, how many levels earlier than inside it a vertex is born: 0 or less. A straight
/// side's vertices never move.
inline sint early_on_side(pointer<BlockHeader> block, int k) {
    sint curve = load(field(block, &BlockHeader::curve) + k);
    sint level = load(field(block, &BlockHeader::level));
    sint hang = load(field(block, &BlockHeader::hang) + k);
    sint early = min(curve - level, 0) - hang;
    sint of_straight = select(curve == straight_curve, sint(64), sint(0));
    return select(curve < 0, of_straight, early);
}

/// The least of those of the sides that have vertices between their ends; at most 0.
inline sint earliest_inside(pointer<BlockHeader> block) {
    sint early = 0;
    for (int k = 0; k < 4; ++k) {
        sint quads = load(field(block, k % 2 == 0 ? &BlockHeader::quads_u : &BlockHeader::quads_v));
        sint on_side = early_on_side(block, k);
        early = min(early, select(quads > 1, on_side, sint(0)));
    }
    return early;
}

/// Corners of the block that are born at all are born at this absolute level or above. Those of the patch
/// never move, so that sides no longer than the block do not count.
inline sint birth_of_corners(pointer<BlockHeader> block) {
    sint early = 0;
    for (int k = 0; k < 4; ++k) {
        sint exponent = load(field(block, &BlockHeader::exponent) + k % 2);
        sint on_side = early_on_side(block, k);
        early = min(early, select(exponent > block_log2, on_side, sint(0)));
    }
    return load(field(block, &BlockHeader::absolute)) + block_log2 + early;
}

/// Absolute level at which the middle of a sub-face's edge k (0: side 0, 1: side 3) is born.
inline sint birth_of_middle(pointer<BlockHeader> root, int k) {
    sint curve = load(field(root, &BlockHeader::curve) + (k == 0 ? 0 : 3));
    sint level = load(field(root, &BlockHeader::level));
    sint absolute = load(field(root, &BlockHeader::absolute));
    sint birth = absolute - level + curve - 1;
    return select(curve == straight_curve, sint(100), birth);
}

/// The largest target edge length that a ray can have in a box of this extent if it is below `some` somewhere
/// in it.
inline sfloat coarsest_target(sfloat some, const svec& extent) {
    sfloat square = fma(extent.x, extent.x, fma(extent.y, extent.y, extent.z * extent.z));
    sfloat grown = sqrt(square) * (gradation_cap * level_rounding * 1.001F);
    return fma(some, 1.001F, grown);
}

} // namespace morph_kernel
} // namespace razor::ISA_TARGET
