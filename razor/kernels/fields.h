// What the rays of a packet ask for: the field of each lane, and bounds of the target edge lengths that these
// have in a box, for one lane each or for all together. Rounded outward: what decides by them never takes a
// block that is too coarse.
#pragma once

#include "razor/kernels/morph.h"

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

struct Rays {
    vvec origin, direction; // scene coordinates; unit directions
    vfloat t_min, t_max;
    vmask active;
    // What each asks for: see Field.
    vvec field_origin, slope;
    vfloat radius, base, growth;
    vint number; // of the field: lanes of the same number have the same
    /// First line of the block that each leaves so steeply that it does not meet it again (chords.h); -1: of
    /// none.
    vint left = vint(-1);
};

/// Bounds of the fields of a packet's rays: often enough to decide for all of them at once.
struct FieldBounds {
    svec low, high; // of the origins
    svec least_slope, most_slope;
    sbool sloped; // whether any slope is not 0
    sfloat least_radius, most_radius, least_base, most_base, least_growth, most_growth;
    sfloat spread; // how far origins are apart, and radii
};

/// All ask for the same everywhere.
inline void fix_target(sfloat target, Rays& r) {
    r.base = vfloat(target);
    r.growth = vfloat(0.0F);
    r.slope = {r.growth, r.growth, r.growth};
    r.number = vint(0);
}

/// What rays of the camera ask for, all the same.
inline void ask_for_camera(const Context& c, Rays& r) {
    r.field_origin = load_broadcast_vec(field(c.frame, &FrameHeader::field_origin));
    r.radius = vfloat(0.0F);
    r.base = load_broadcast(field(c.frame, &FrameHeader::camera_base));
    r.growth = load_broadcast(field(c.frame, &FrameHeader::camera_growth));
    r.slope = load_broadcast_vec(field(c.frame, &FrameHeader::camera_slope));
    r.number = vint(0);
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    if (branch(fixed > 0.0F))
        fix_target(fixed, r);
}

/// The rays' fields, one a lane.
struct Fields {
    vvec origin, slope;
    vfloat radius, base, growth;
};
inline Fields load_fields(const Context& c) {
    pointer<float> at = c.packets + packet_field;
    Fields f;
    f.origin.x = load_vector(at);
    f.origin.y = load_vector(at + isa::width);
    f.origin.z = load_vector(at + 2 * isa::width);
    f.radius = load_vector(at + 3 * isa::width);
    f.base = load_vector(at + 4 * isa::width);
    f.growth = load_vector(at + 5 * isa::width);
    f.slope.x = load_vector(at + 6 * isa::width);
    f.slope.y = load_vector(at + 7 * isa::width);
    f.slope.z = load_vector(at + 8 * isa::width);
    return f;
}

/// The field of a lane, in the coordinates of the mesh whose origin is given.
inline Field field_of(const Context& c, sint lane, const svec& mesh_origin) {
    pointer<float> at = c.packets + packet_field + lane;
    Field f;
    f.origin.x = load(at);
    f.origin.y = load(at + isa::width);
    f.origin.z = load(at + 2 * isa::width);
    f.radius = load(at + 3 * isa::width);
    f.base = load(at + 4 * isa::width);
    f.growth = load(at + 5 * isa::width);
    f.slope.x = load(at + 6 * isa::width);
    f.slope.y = load(at + 7 * isa::width);
    f.slope.z = load(at + 8 * isa::width);
    f.origin = f.origin - mesh_origin;
    return f;
}

/// Nearest and furthest distance of a box from each field's origin, along one axis.
struct Span {
    vfloat near, far;
};
inline Span span_of(const vfloat& origin, const vfloat& low, const vfloat& high) {
    vfloat before = low - origin;
    vfloat after = origin - high;
    Span s;
    s.near = max(max(before, after), vfloat(0.0F));
    vfloat most = min(before, after);
    s.far = -most;
    return s;
}

/// Bounds of |base + slope . (place - origin)| over a box, one a lane; `margin`: what roundings may add to
/// it. Of each term here 5 at most (difference, product, three sums), of each in target_at() 5 likewise (8 on
/// sse4): of the sizes of all terms together.
struct Blur {
    vfloat least, most, margin;
};
inline Blur blur_in(const Fields& f, const vvec& low, const vvec& high) {
    const vfloat* origins[3] = {&f.origin.x, &f.origin.y, &f.origin.z};
    const vfloat* slopes[3] = {&f.slope.x, &f.slope.y, &f.slope.z};
    const vfloat* lows[3] = {&low.x, &low.y, &low.z};
    const vfloat* highs[3] = {&high.x, &high.y, &high.z};
    vfloat least = f.base;
    vfloat most = f.base;
    vfloat size = abs(f.base);
    for (int k = 0; k < 3; ++k) {
        vfloat at_low = *lows[k] - *origins[k];
        vfloat at_high = *highs[k] - *origins[k];
        at_low = at_low * *slopes[k];
        at_high = at_high * *slopes[k];
        vfloat less = min(at_low, at_high);
        vfloat more = max(at_low, at_high);
        least = least + less;
        most = most + more;
        size = size + max(-less, more);
    }
    Blur b;
    b.margin = size * few_roundings;
    b.most = max(most, -least);
    b.least = max(max(least, -most), 0.0F);
    return b;
}

/// Bounds of each field's target edge lengths in a box (scene coordinates), rounded outward. Least is no more
/// than any target there, by more than what positions are rounded by; most no less. A distance here has 4.5
/// roundings (of each square its difference, twice, and up to 3 sums or products, of which the root leaves
/// half; the root; the product with what makes it more or less), on sse4 5.5, and no more in target_at();
/// what comes of it has 3 on either side.
struct Targets {
    vfloat least, most;
};
inline Targets targets_in(const Context& c, const FieldBounds& all, const svec& low, const svec& high,
                          sfloat slack) {
    Fields f = load_fields(c);
    vvec lowest = broadcast(low);
    vvec highest = broadcast(high);
    Span x = span_of(f.origin.x, lowest.x, highest.x);
    Span y = span_of(f.origin.y, lowest.y, highest.y);
    Span z = span_of(f.origin.z, lowest.z, highest.z);
    vfloat near = sqrt(fma(x.near, x.near, fma(y.near, y.near, z.near * z.near)));
    vfloat far = sqrt(fma(x.far, x.far, fma(y.far, y.far, z.far * z.far)));
    vfloat wide = vfloat(slack);
    near = fma(near, vfloat(few_down), -wide) - f.radius;
    near = max(near, vfloat(0.0F));
    far = fma(far, vfloat(few_up), wide) - f.radius;
    far = max(far, vfloat(0.0F));
    Blur blur{f.base, f.base, abs(f.base) * few_roundings};
    if (branch(all.sloped)) {
        // Positions are off by their slack.
        vvec room{wide, wide, wide};
        vvec lower = lowest - room;
        vvec higher = highest + room;
        blur = blur_in(f, lower, higher);
    }
    vfloat at_near = f.growth * near;
    vfloat at_far = f.growth * far;
    Targets t;
    vfloat less = min(at_near, at_far) + blur.least;
    vfloat more = max(at_near, at_far) + blur.most;
    vfloat margin = blur.margin;
    t.least = fma(less, vfloat(few_down), -margin);
    t.most = fma(more, vfloat(few_up), margin);
    vfloat floor(least_target);
    t.least = max(t.least, floor);
    t.most = max(t.most, floor);
    return t;
}

/// Bounds of all fields' |base + slope . (place - origin)| over a box, their roundings included: those of
/// blur_in(), one more of each term for the slack.
struct CommonBlur {
    sfloat least, most;
};
inline CommonBlur common_blur_in(const FieldBounds& f, const svec& low, const svec& high, sfloat slack) {
    sfloat lows[3] = {low.x, low.y, low.z};
    sfloat highs[3] = {high.x, high.y, high.z};
    sfloat first[3] = {f.low.x, f.low.y, f.low.z};
    sfloat last[3] = {f.high.x, f.high.y, f.high.z};
    sfloat least_slope[3] = {f.least_slope.x, f.least_slope.y, f.least_slope.z};
    sfloat most_slope[3] = {f.most_slope.x, f.most_slope.y, f.most_slope.z};
    sfloat least = f.least_base;
    sfloat most = f.most_base;
    sfloat size = max(most, -least);
    for (int k = 0; k < 3; ++k) {
        sfloat at_low = lows[k] - last[k] - slack;
        sfloat at_high = highs[k] - first[k] + slack;
        sfloat a = at_low * least_slope[k];
        sfloat b = at_low * most_slope[k];
        sfloat c = at_high * least_slope[k];
        sfloat d = at_high * most_slope[k];
        sfloat less = min(a, min(b, min(c, d)));
        sfloat more = max(a, max(b, max(c, d)));
        least = least + less;
        most = most + more;
        size = size + max(-less, more);
    }
    sfloat margin = size * more_roundings;
    CommonBlur blur;
    blur.most = max(most, -least) + margin;
    blur.least = max(max(least, -most) - margin, 0.0F);
    return blur;
}

/// From every field's origin no place in the box is further, its radius taken off.
[[gnu::always_inline]] inline sfloat furthest_in(const FieldBounds& f, const svec& low, const svec& high,
                                                 sfloat slack) {
    sfloat lows[3] = {low.x, low.y, low.z};
    sfloat highs[3] = {high.x, high.y, high.z};
    sfloat first[3] = {f.low.x, f.low.y, f.low.z};
    sfloat last[3] = {f.high.x, f.high.y, f.high.z};
    sfloat furthest = 0.0F; // the square of a distance
    for (int k = 0; k < 3; ++k) {
        sfloat before = last[k] - lows[k];
        sfloat after = highs[k] - first[k];
        sfloat far = max(before, after);
        furthest = fma(far, far, furthest);
    }
    sfloat far = sqrt(furthest) * more_up + slack;
    return max(far - f.least_radius, 0.0F);
}
/// From no field's origin any place in the box is nearer.
[[gnu::always_inline]] inline sfloat nearest_in(const FieldBounds& f, const svec& low, const svec& high,
                                                sfloat slack) {
    sfloat lows[3] = {low.x, low.y, low.z};
    sfloat highs[3] = {high.x, high.y, high.z};
    sfloat first[3] = {f.low.x, f.low.y, f.low.z};
    sfloat last[3] = {f.high.x, f.high.y, f.high.z};
    sfloat nearest = 0.0F; // the square of a distance
    for (int k = 0; k < 3; ++k) {
        sfloat before = lows[k] - last[k];
        sfloat after = first[k] - highs[k];
        sfloat near = max(max(before, after), 0.0F);
        nearest = fma(near, near, nearest);
    }
    sfloat near = sqrt(nearest) * more_down - slack;
    return max(near - f.most_radius, 0.0F);
}

/// What is seldom asked, out of line: fields of a lens, and those that shrink.
[[gnu::noinline]] inline sfloat least_blur_in(const FieldBounds& f, const svec& low, const svec& high,
                                              sfloat slack) {
    return common_blur_in(f, low, high, slack).least;
}
[[gnu::noinline]] inline sfloat most_blur_in(const FieldBounds& f, const svec& low, const svec& high,
                                             sfloat slack) {
    return common_blur_in(f, low, high, slack).most;
}
[[gnu::noinline]] inline sfloat furthest_of_shrinking(const FieldBounds& f, const svec& low, const svec& high,
                                                      sfloat slack) {
    return furthest_in(f, low, high, slack);
}

/// No field's target edge length in the box is less. Growth of either sign: shrinking fields are bounded by
/// what they begin with. Asked at every leaf: calls would cost as much as what is computed.
[[gnu::always_inline]] inline sfloat least_target_in(const FieldBounds& f, const svec& low, const svec& high,
                                                     sfloat slack) {
    sfloat least = f.least_base;
    if (branch(f.sloped))
        least = least_blur_in(f, low, high, slack);
    sfloat distance = branch(f.least_growth < 0.0F) ? furthest_of_shrinking(f, low, high, slack)
                                                    : nearest_in(f, low, high, slack);
    return fma(f.least_growth, distance, least) * more_down;
}

/// No field's target edge length in the box is more.
[[gnu::always_inline]] inline sfloat most_target_in(const FieldBounds& f, const svec& low, const svec& high,
                                                    sfloat slack) {
    sfloat most = f.most_base;
    if (branch(f.sloped))
        most = most_blur_in(f, low, high, slack);
    constexpr float up = more_up;
    if (branch(f.most_growth <= 0.0F))
        return most * up;
    sfloat distance = furthest_in(f, low, high, slack);
    return fma(f.most_growth, distance, most) * up;
}

/// In any box that holds this one most_target_in() is no more than this and what the growth makes of that
/// box's diagonal: a place there is no further from a field's origin than this box is from the nearest, the
/// spread of origins and that diagonal together. Of fields that are not sloped. A quarter of this box is
/// allowed for: that of a finer block may be outside its parent's by as much as its own finer vertices may be
/// off it, of which announce_block() allows half.
inline sfloat most_near(const FieldBounds& f, const svec& low, const svec& high, sfloat slack) {
    if (branch(f.most_growth <= 0.0F))
        return f.most_base;
    svec extent = high - low;
    sfloat distance = nearest_in(f, low, high, slack) + f.spread;
    distance = fma(sqrt(dot(extent, extent)), 0.25F, distance);
    distance = fma(slack, 4.0F, distance);
    return fma(f.most_growth, distance, f.most_base);
}

} // namespace intersect_kernel
} // namespace razor::ISA_TARGET
