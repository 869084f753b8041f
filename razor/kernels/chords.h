// Which rays that leave a block may meet it again: those that are no steeper than its chords, the lines
// between two of its points. The others need not be tested against it, and packets of shadow rays mostly
// leave blocks by such rays.
//
// A block is a sheet over its parameters (u, v). From one of its points to another there is a way along u,
// then along v, which is a sum of parts of its edges: dP/du is one of its edges along u in each triangle, and
// so along v. Let t_u and t_v be unit vectors, about along the edges; n the normal of both; and of all edges
// e along u
//     |n . e| <= k t_u . e   and   t_u . e >= cos(a_u) |e|,
// and so along v. Both hold for sums of edges, too. So a chord is A a + B b, where A, B >= 0, a and b are
// unit vectors, or their opposites, within a_u of t_u and a_v of t_v, |n . a| and |n . b| <= k; and
//     |a . b| <= m = |t_u . t_v| + 2 sin(a_u / 2) + 2 sin(a_v / 2),
//     |A a + B b|^2 >= A^2 + B^2 - 2 m A B >= (A + B)^2 (1 - m) / 2,
//     |n . (A a + B b)| <= k (A + B),
// so that |n . c| <= k sqrt(2 / (1 - m)) for the direction c of every chord, if m < 1. A sheet that overlaps
// itself, as a ramp may, has an m of 1 or more.
//
// Rays see vertices off their anchors, by w at most: then k is the largest (|n . e| + 2 w) / (t_u . e - 2 w),
// and cos(a_u) the least (t_u . e - 2 w) / (|e| + 2 w).
#pragma once

#include "razor/kernels/blend.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// What a block's chords are like: |normal . chord| <= slope |chord|, for rays that ask for edges of length
/// `most` at most in all of it, as fields hold them. A slope of never_leaves is not known.
enum ChordWord : int { chord_normal = 0, chord_slope = 3, chord_most = 4, chord_words = 5 };
static_assert(chord_words + 1 == words_before_normals);
inline constexpr float never_leaves = 2.0F; // steeper than any direction
/// What a few roundings of numbers near 1 may come to, with room.
inline constexpr float chord_rounding = 1.0e-5F;

/// Where they are kept, of a block whose normals lie at word `normals_at`: before these, and before what
/// displaced blocks keep there (kept_deviation()).
inline pointer<float> chords_at(pointer<BlockHeader> block, sint normals_at) {
    return as<float>(block) + (normals_at - words_before_normals);
}

/// Bounds of all edges along one parameter, of some a lane.
struct EdgeSpread {
    vfloat slope = vfloat(0.0F), cosine = vfloat(1.0F);

    /// With these edges; `along` and `normal` are unit vectors.
    void add(const vvec& edge, const svec& along, const svec& normal, sfloat sway, const vmask& m) {
        vfloat off = vfloat(sway * 2.0F);
        vfloat length = sqrt(dot(edge, edge)) + off;
        vmask some = m & !(length == vfloat(0.0F)); // one of no length adds nothing to a sum
        vfloat forward = dot(edge, broadcast(along)) - off;
        vfloat rise = abs(dot(edge, broadcast(normal))) + off;
        vfloat one(1.0F);
        vmask low = rise < forward; // of no number it is not
        vfloat of_edge = rise / select(low, forward, one);
        of_edge = select(low, of_edge, one);
        slope = select(some, max(of_edge, slope), slope);
        vfloat straight = forward / select(some, length, one);
        cosine = select(some, min(straight, cosine), cosine);
    }
};

inline svec first_of(const vvec& v) {
    svec one;
    one.x = extract(v.x, 0);
    one.y = extract(v.y, 0);
    one.z = extract(v.z, 0);
    return one;
}

/// The slope of the chords of quads_u x quads_v quads, x[stride], y, z, whose vertices may be up to `sway`
/// away; and the normal that it is of.
inline sfloat chord_slope_of(pointer<float> x, sint stride, sint quads_u, sint quads_v, sfloat sway,
                             svec& normal) {
    svec corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = load_vertex(x, stride, corner_vertex(k, quads_u, quads_v));
    svec to_u = corner[1] - corner[0];
    svec other = corner[2] - corner[3];
    to_u = to_u + other;
    svec to_v = corner[3] - corner[0];
    other = corner[2] - corner[1];
    to_v = to_v + other;
    vvec none = broadcast({sfloat(0.0F), sfloat(0.0F), sfloat(0.0F)});
    vvec unit_u = normalise(broadcast(to_u), none);
    vvec unit_v = normalise(broadcast(to_v), none);
    vvec upright = normalise(cross(unit_u, unit_v), none);
    svec along_u = first_of(unit_u);
    svec along_v = first_of(unit_v);
    normal = first_of(upright);
    EdgeSpread spread[2];
    sint width = quads_u + 1;
    sint vertices = width * (quads_v + 1);
    for (sint from = 0; branch(from < vertices); from += isa::width) {
        vmask m = first_lanes(vertices - from);
        vint column, row;
        vertex_place(quads_u, lane_index() + vint(from), column, row);
        pointer<float> at = x + from;
        vvec here, right, above;
        vmask has_right = m & (column < vint(quads_u));
        vmask has_above = m & (row < vint(quads_v));
        for (int k = 0; k < 3; ++k) {
            (k == 0 ? here.x : k == 1 ? here.y : here.z) = load_vector(at, m);
            (k == 0 ? right.x : k == 1 ? right.y : right.z) = load_vector(at + 1, has_right);
            (k == 0 ? above.x : k == 1 ? above.y : above.z) = load_vector(at + width, has_above);
            at = at + stride;
        }
        spread[0].add(right - here, along_u, normal, sway, has_right);
        spread[1].add(above - here, along_v, normal, sway, has_above);
    }
    // 2 sin(a / 2) = sqrt(2 - 2 cos(a)).
    sfloat apart = abs(dot(along_u, along_v));
    sfloat steepest = 0.0F;
    for (const EdgeSpread& edges : spread) {
        sfloat versine = sfloat(1.0F + chord_rounding) - reduce_min(edges.cosine);
        apart = apart + sqrt(versine * 2.0F);
        steepest = max(reduce_max(edges.slope), steepest);
    }
    sfloat share = (sfloat(1.0F) - apart) * 0.5F;
    sbool known = share > chord_rounding;
    known = known & (steepest < 1.0F);
    sfloat slope = steepest / sqrt(select(known, share, sfloat(1.0F)));
    slope = fma(slope, 1.0F + chord_rounding, chord_rounding);
    return select(known, slope, sfloat(never_leaves));
}

/// Measures and stores them. A flat block has no chords but such as lie in its plane.
[[gnu::noinline]] inline void measure_chords(const Context& c, pointer<BlockHeader> block, sint normals_at,
                                             sbool flat) {
    phase_scope phase(phase_tessellate);
    pointer<float> out = chords_at(block, normals_at);
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    sfloat most = infinite;
    sfloat sway = 0.0F;
    sint corners_at = load(field(block, &BlockHeader::corners_at));
    if (branch(corners_at != no_vertex_moves)) {
        sint absolute = load(field(block, &BlockHeader::absolute));
        most = gone_from(absolute);               // for longer ones there are coarser blocks
        sway = sway_of(c, block, most) * 1.7321F; // along any axis, that is
    }
    svec normal;
    sfloat slope =
        chord_slope_of(as<float>(block) + block_header_words, stride, quads_u, quads_v, sway, normal);
    slope = select(flat, sfloat(0.0F), slope);
    store_svec(out + int{chord_normal}, normal);
    store(out + int{chord_slope}, slope);
    store(out + int{chord_most}, most);
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
