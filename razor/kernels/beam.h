// The hull of a group's rays between two planes across its axis, as a line below and one above them along
// each of the other axes. A node or a box beside it concerns none of the rays, which a few scalars tell.
// Their directions may differ in sign, and the hull of those that leave a point is as tight as of those that
// reach one (after the frusta of Reshetov, Soupikov & Hurley, "Multi-level ray tracing algorithm", SIGGRAPH
// 2005).
#pragma once

#include "razor/kernels/triangles.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

/// Slacks of positions (16 roundings, each of half an ulp u of the scene's reach R) by which lines keep
/// off rays. A ray's place at a plane, fma(plane - o, d / d_z, o), is off by 25 R u, as |d / d_z| <= 2; a
/// line through two such places by 12 for its rate, 13 for where it begins, 7 where it is evaluated and 20
/// where that is moved to an instance's origin; what is compared with it by a slack of its own, 16.
inline constexpr float beam_slack = 9.0F;
/// Beams shorter than this part of the reach have no slope: it would be mostly rounding.
inline constexpr float shortest_beam = 1.0F / 1024;

inline pointer<float> beam_lines(const Context& c, sint axis) {
    pointer<float> first = c.packets + packet_beam;
    return first + axis * beam_axis;
}

inline void store_line(pointer<float> at, sfloat base, sfloat rate) {
    store(at + beam_base, base);
    store(at + beam_rate, rate);
}

/// The beam of the rays `inside` the tree, between their distances `enter` and `leave`.
inline void find_beam(const Context& c, Group& g, const vmask& inside, const vfloat& enter,
                      const vfloat& leave) {
    vfloat far(infinite);
    vfloat dz = reciprocal(g.scale_z);
    vfloat one = fma(dz, enter, g.oz);
    vfloat other = fma(dz, leave, g.oz);
    vfloat low = min(one, other);
    vfloat high = max(one, other);
    sfloat margin = g.slack * beam_slack;
    Beam& b = g.beam;
    b.begin = reduce_min(select(inside, low, far)) - margin;
    b.end = reduce_max(select(inside, high, -far)) + margin;
    g.begin = b.begin;
    g.end = b.end;
    sfloat reach = load(field(c.frame, &FrameHeader::reach));
    sfloat length = b.end - b.begin;
    sbool slopes = length > reach * shortest_beam;
    sfloat scale = select(slopes, sfloat(1.0F) / length, sfloat(0.0F));
    vfloat to_begin = vfloat(b.begin) - g.oz;
    vfloat to_end = vfloat(b.end) - g.oz;
    for (int k = 0; k < 2; ++k) {
        vfloat shear = k == 0 ? g.shear_x : g.shear_y;
        vfloat o = k == 0 ? g.ox : g.oy;
        vfloat at_begin = fma(to_begin, shear, o);
        vfloat at_end = fma(to_end, shear, o);
        sfloat first = reduce_min(select(inside, at_begin, far));
        sfloat last = reduce_min(select(inside, at_end, far));
        b.low_rate[k] = (last - first) * scale;
        first = select(slopes, first, min(first, last));
        b.low_base[k] = fnma(b.low_rate[k], b.begin, first) - margin;
        first = reduce_max(select(inside, at_begin, -far));
        last = reduce_max(select(inside, at_end, -far));
        b.high_rate[k] = (last - first) * scale;
        first = select(slopes, first, max(first, last));
        b.high_base[k] = fnma(b.high_rate[k], b.begin, first) + margin;
        sint axis = k == 0 ? g.kx : g.ky;
        pointer<float> at = beam_lines(c, axis);
        store_line(at, b.low_base[k], b.low_rate[k]);
        store_line(at + beam_above, b.high_base[k], b.high_rate[k]);
    }
    pointer<float> at = beam_lines(c, g.kz);
    store_line(at, -margin, 1.0F);
    store_line(at + beam_above, margin, 1.0F);
}

/// On which side of a plane across `axis` all of the beam in the cell at hand is.
struct BeamSide {
    sbool low, high;
};
[[gnu::always_inline]] inline BeamSide side_of_beam(const Context& c, const Group& g, sint axis,
                                                    sfloat plane) {
    pointer<float> lines = beam_lines(c, axis);
    sfloat base = load(lines + beam_base);
    sfloat rate = load(lines + beam_rate);
    sfloat begins = fma(g.begin, rate, base);
    sfloat ends = fma(g.end, rate, base);
    BeamSide side;
    side.high = min(begins, ends) > plane;
    base = load(lines + (beam_above + beam_base));
    rate = load(lines + (beam_above + beam_rate));
    begins = fma(g.begin, rate, base);
    ends = fma(g.end, rate, base);
    side.low = max(begins, ends) < plane;
    return side;
}

/// Of a beam that a plane across `axis` cuts, what may be on either side: all of it, but where the plane is
/// across the rays' own axis. (Where lines cross other planes was measured to cost as much as it spares.)
struct CutBeam {
    sfloat low_end, high_begin;
};
[[gnu::always_inline]] inline CutBeam cut_beam(const Group& g, sint axis, sfloat plane) {
    sbool across = axis == g.kz;
    sfloat margin = g.slack * beam_slack;
    sfloat bound = min(g.end, plane + margin);
    CutBeam cut;
    cut.low_end = select(across, bound, g.end);
    bound = max(g.begin, plane - margin);
    cut.high_begin = select(across, bound, g.begin);
    return cut;
}

/// Goes on on one side.
inline void clip_beam(Group& g, const CutBeam& cut, sbool high) {
    g.begin = select(high, cut.high_begin, g.begin);
    g.end = select(high, g.end, cut.low_end);
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
