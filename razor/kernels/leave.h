// The fields of rays that leave surfaces: which target edge lengths they ask for, and who shares them.
#pragma once

#include "razor/kernels/shade.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Rays that leave hits near each other share a field, whatever packet they are in, so that blocks need not
/// be blended for each of them: hits no further from the first one, in target edge lengths, and whose target
/// edge lengths differ by no more than this factor.
inline constexpr float shared_reach = 16.0F;
/// A field's own growth lacks this part of what the ray asked for that it was made for; of others up to twice
/// as much. Growths are not rounded: what rays see moves with what they ask for.
inline constexpr float growth_slack = 0.125F;

inline void forget_fields(const Context& c) {
    for (int i = 0; i < left_fields; ++i)
        store(as<std::int32_t>(c.packets + (packet_left + i * left_floats)) + left_number, -1);
    store(as<std::int32_t>(c.packets + packet_left_next), 0);
}

/// Puts a field around lane `lane`'s hit where it is found again. Within the ball that holds its hits the
/// field is constant, and no finer than any ray that found them asked for at its hit.
inline pointer<float> make_field(const Context& c, const Surface& s, sfloat growth, sint lane) {
    pointer<std::int32_t> next = as<std::int32_t>(c.packets + packet_left_next);
    sint slot = load(next);
    store(next, (slot + 1) & (left_fields - 1));
    pointer<float> f = c.packets + (packet_left + slot * left_floats);
    sfloat target = extract(s.target, lane);
    sfloat reach = target * shared_reach;
    sfloat base = target * shared_ratio; // that of no hit is larger
    store(f + left_origin, extract(s.position.x, lane));
    store(f + left_origin + 1, extract(s.position.y, lane));
    store(f + left_origin + 2, extract(s.position.z, lane));
    store(f + left_reach, reach);
    store(f + left_radius, fma(base, leaving_reach, reach));
    store(f + left_base, base);
    store(f + left_growth, growth);
    store(f + left_least, target * (1.0F / shared_ratio));
    store(f + left_most, base);
    sint number = load(field(c.self, &WorkerRecord::next_field));
    store(as<std::int32_t>(f) + left_number, number);
    sint later = max(number + 1, camera_number + 1); // after the largest the first that is no other's
    store(field(c.self, &WorkerRecord::next_field), later);
    return f;
}

/// Gives a kept field to those of the lanes `left` that may share it, and takes them from there.
inline void share_field(pointer<float> f, const Surface& s, vmask& left, Rays& r) {
    vvec origin = load_broadcast_vec(f + left_origin);
    vfloat reach = load_broadcast(f + left_reach);
    vvec d = s.position - origin;
    vfloat square = dot(d, d);
    vfloat most_square = reach * reach;
    vmask same = left & (square <= most_square);
    vfloat least = load_broadcast(f + left_least);
    same = same & (s.target >= least);
    vfloat most = load_broadcast(f + left_most);
    same = same & (s.target <= most);
    if (branch(none(same)))
        return;
    left = left & !same;
    r.field_origin = select(same, origin, r.field_origin);
    r.radius = select(same, load_broadcast(f + left_radius), r.radius);
    r.base = select(same, load_broadcast(f + left_base), r.base);
    r.growth = select(same, load_broadcast(f + left_growth), r.growth);
    r.number = select(same, load_broadcast(as<std::int32_t>(f) + left_number), r.number);
}

/// The growth that one of a packet's rays asks for, the slowest.
inline vfloat slowest_growth(const vmask& active, const vfloat& growth) {
    vfloat cap(gradation_cap);
    vfloat slowest = vfloat(reduce_min(select(active, growth, cap)));
    slowest = min(slowest, gradation_cap); // which no lane stands for where all are active
    return max(slowest, -cap);
}

/// Rays that leave surfaces go on with the target edge lengths that they begin with. Within the ball that
/// holds its hits a field is constant, and no finer than any ray that found them asked for at its hit: there
/// a convex shape stays behind what was hit of it. Further away it falls back from any ray's plane by more
/// than finer levels can bring it forward (its fall grows with the square of the distance, 32 times what an
/// edge's chord cuts off at leaving_reach), so that from there on targets may shrink as well as grow.
inline void leave_surface(const Context& c, const Surface& s, const vfloat& wanted, Rays& r) {
    r.field_origin = s.position;
    r.radius = vfloat(0.0F);
    r.base = s.target;
    r.growth = slowest_growth(r.active, wanted);
    vmask steep = dot(s.chord_normal, r.direction) > s.chord_slope;
    steep = steep & (r.growth <= s.chord_growth);
    r.left = select(steep, s.block, vint(-1));
    vfloat zero(0.0F);
    r.slope = {zero, zero, zero};
    r.number = vint(-1);
    sfloat fixed = load(field(c.frame, &FrameHeader::fixed_target));
    if (branch(fixed > 0.0F)) {
        fix_target(fixed, r);
        return;
    }
    sint one_field = load(field(c.frame, &FrameHeader::one_field));
    if (branch(one_field != 0)) {
        ask_for_camera(c, r);
        return;
    }
    sfloat growth = extract(r.growth, 0);
    sfloat slack = abs(growth) * growth_slack;
    sfloat least = growth - (slack + slack);
    vmask left = s.hit;
    for (int i = 0; i < left_fields; ++i) {
        pointer<float> f = c.packets + (packet_left + i * left_floats);
        sbool fits = load(as<std::int32_t>(f) + left_number) >= 0;
        sfloat kept = load(f + left_growth);
        fits = fits & (kept <= growth);
        fits = fits & (kept >= least);
        fits = fits & any(left);
        if (branch(fits))
            share_field(f, s, left, r);
    }
    growth = max(growth - slack, -gradation_cap);
    while (branch(any(left))) {
        sint lane = first(left);
        pointer<float> f = make_field(c, s, growth, lane);
        share_field(f, s, left, r);
        left = left & (lane_index() != vint(lane)); // one at no place at all does not find even itself
    }
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
