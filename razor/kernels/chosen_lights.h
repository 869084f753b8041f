// One light of many for each shadow ray, chosen by how much it may light the hit: down a tree of lights, at
// each node by what is known of both children (Conty Estevez & Kulla, Importance Sampling of Many Lights with
// Adaptive Tree Splitting, HPG 2018; the measure of importance is that of pbrt-4's LightBounds).
#pragma once

#include "razor/frame/light_node.h"
#include "razor/kernels/emitter_samples.h"
#include "razor/kernels/seen_lights.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// What a node says, of one node a lane or of one for all.
struct LightBounds {
    vvec low, high, axis;
    vfloat cos_normals, cos_emission, power;
};
inline LightBounds bounds_at(pointer<LightNode> first, const vint& node, const vmask& m) {
    constexpr int stride = sizeof(LightNode) / 4;
    vint record = node * vint(stride);
    LightBounds b;
    b.low = gather_vec(field(first, &LightNode::low), record, vint(1), m);
    b.high = gather_vec(field(first, &LightNode::high), record, vint(1), m);
    b.axis = gather_vec(field(first, &LightNode::axis), record, vint(1), m);
    b.cos_normals = gather(field(first, &LightNode::cos_normals), record, m);
    b.cos_emission = gather(field(first, &LightNode::cos_emission), record, m);
    b.power = gather(field(first, &LightNode::power), record, m);
    return b;
}
inline LightBounds bounds_of(pointer<LightNode> node) {
    LightBounds b;
    b.low = load_broadcast_vec(field(node, &LightNode::low));
    b.high = load_broadcast_vec(field(node, &LightNode::high));
    b.axis = load_broadcast_vec(field(node, &LightNode::axis));
    b.cos_normals = load_broadcast(field(node, &LightNode::cos_normals));
    b.cos_emission = load_broadcast(field(node, &LightNode::cos_emission));
    b.power = load_broadcast(field(node, &LightNode::power));
    return b;
}

inline vfloat sine_of(const vfloat& cosine) {
    vfloat square = fnma(cosine, cosine, vfloat(1.0F));
    return sqrt(max(square, 0.0F));
}
/// Cosine of what angle a is larger than angle b, or 1.
inline vfloat cosine_beyond(const vfloat& cos_a, const vfloat& cos_b) {
    vfloat sine_a = sine_of(cos_a);
    vfloat sines = sine_a * sine_of(cos_b);
    vfloat within = fma(cos_a, cos_b, sines);
    return select(cos_a > cos_b, vfloat(1.0F), within);
}

/// A bound, but for the size of the bounds, on what lights there give to the hit; 0 where they give nothing.
inline vfloat importance(const LightBounds& b, const vvec& position, const vvec& normal) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vvec half = (b.high - b.low) * 0.5F;
    vvec way = position - (b.low + half);
    vfloat square = max(dot(way, way), 1.0e-30F);
    vfloat size = dot(half, half);
    vvec towards = way * reciprocal_sqrt(square);
    // The angle in which half of the bounds is seen; all, from inside.
    vfloat seen = one - size / square;
    vmask outside = seen > zero;
    vfloat cos_bounds = select(outside, sqrt(max(seen, 0.0F)), vfloat(-1.0F));
    vfloat cos_axis = min(max(dot(b.axis, towards), -1.0F), 1.0F);
    vfloat cos_normal = cosine_beyond(cos_axis, b.cos_normals);
    vfloat cos_emitted = cosine_beyond(cos_normal, cos_bounds);
    vfloat cos_hit = min(max(-dot(normal, towards), -1.0F), 1.0F);
    vfloat cos_received = cosine_beyond(cos_hit, cos_bounds);
    vmask lit = cos_emitted > b.cos_emission;
    lit = lit & (cos_received > zero);
    vfloat cosines = max(cos_emitted, 0.0F) * cos_received;
    vfloat given = b.power * cosines;
    vfloat value = given / max(square, size);
    return select(lit, value, zero);
}

struct LightChoice {
    vint light;
    vfloat chance; // 0: no light is worth it
};

[[gnu::noinline]] inline LightChoice choose_light(const Context& c, const Surface& s, const vfloat& number) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    constexpr int stride = sizeof(LightNode) / 4;
    pointer<std::int32_t> seconds = field(nodes, &LightNode::second);
    vfloat one(1.0F);
    vfloat left_of = number;
    vint node(0);
    LightChoice choice;
    choice.chance = one;
    vint second = gather(seconds, node, s.hit);
    vmask going = s.hit & (second >= vint(0));
    while (branch(any(going))) {
        vint first = node + vint(1);
        vfloat of_first = importance(bounds_at(nodes, first, going), s.position, s.shading);
        vfloat of_second = importance(bounds_at(nodes, second, going), s.position, s.shading);
        vfloat sum = of_first + of_second;
        vmask dark = going & !(sum > vfloat(0.0F));
        choice.chance = select(dark, vfloat(0.0F), choice.chance);
        going = going & !dark;
        vfloat share = of_first / max(sum, 1.0e-37F);
        vmask low = left_of < share;
        vfloat beyond = left_of - share;
        vfloat rest = one - share;
        vfloat taken = select(low, share, rest);
        vfloat place = select(low, left_of, beyond);
        place = place / max(taken, 1.0e-37F);
        left_of = select(going, min(place, 0.99999994F), left_of);
        choice.chance = select(going, choice.chance * taken, choice.chance);
        node = select(going, select(low, first, second), node);
        vint record = node * vint(stride);
        second = select(going, gather(seconds, record, going), second);
        going = going & (second >= vint(0));
    }
    vmask found = s.hit & (choice.chance > vfloat(0.0F));
    choice.light = select(found, vint(-1) - second, vint(0));
    return choice;
}

/// With which chance rays of each lane's hit choose the light of a leaf.
[[gnu::noinline]] inline vfloat chance_of_light(const Context& c, sint leaf, const Surface& from) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    vfloat chance(1.0F);
    sint child = leaf;
    sint parent = load(field(nodes + child, &LightNode::parent));
    while (branch(parent >= 0)) {
        sint first = parent + 1;
        sint second = load(field(nodes + parent, &LightNode::second));
        vfloat of_first = importance(bounds_of(nodes + first), from.position, from.shading);
        vfloat of_second = importance(bounds_of(nodes + second), from.position, from.shading);
        vfloat own = select(vmask(child == first), of_first, of_second);
        vfloat sum = of_first + of_second;
        chance = chance * (own / max(sum, 1.0e-37F));
        child = parent;
        parent = load(field(nodes + parent, &LightNode::parent));
    }
    return chance;
}

struct ChosenRays : LightRays {
    vvec colour;   // radiance, as LightRecord has it, / chance
    vfloat domain; // / chance
};

/// Towards spheres, as sample_sphere() does, where the rays go to their middles.
inline void aim_at_spheres(const Surface& s, const vvec& middle, const vfloat& radius, const vpoint& square,
                           const vmask& spheres, const vfloat& inverse, LightRays& l) {
    vvec way = middle - s.position;
    vfloat away = dot(way, way);
    vfloat own = radius * radius;
    vmask outside = away > own;
    vfloat sine = radius * inverse;
    vfloat of_cone = min(sine * sine, 1.0F);
    vfloat versine = of_cone / (sqrt(vfloat(1.0F) - of_cone) + vfloat(1.0F));
    vfloat sine_square;
    vvec direction = sample_cone(l.rays.direction, square, versine, sine_square);
    vfloat along = dot(way, direction);
    vfloat depth = own - away * sine_square;
    vfloat first = along - sqrt(max(depth, 0.0F));
    vfloat cos_surface = dot(s.shading, direction);
    l.rays.direction = select(spheres, direction, l.rays.direction);
    l.rays.t_max = select(spheres, first * (1.0F - 1.0e-5F), l.rays.t_max);
    l.weight = select(spheres, cos_surface * versine, l.weight);
    vmask faces = outside & (cos_surface > vfloat(0.0F));
    l.rays.active = l.rays.active & (faces | !spheres);
}

/// A light of each lane's own, of any shape that has a place, and a ray to it.
[[gnu::noinline]] inline ChosenRays sample_chosen(const Context& c, const Surface& s, const vint& sample) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vpoint which = sample_square(s.pixel, sample, dimension_which_light);
    LightChoice choice = choose_light(c, s, which.u);
    vmask some = s.hit & (choice.chance > zero);
    pointer<LightRecord> lights = load(field(c.frame, &FrameHeader::chosen_lights));
    constexpr int stride = sizeof(LightRecord) / 4;
    vint record = choice.light * vint(stride);
    const auto number = [&](float LightRecord::*member) {
        return gather(field(lights, member), record, some);
    };
    const auto three = [&](float(LightRecord::*member)[3]) {
        return gather_vec(field(lights, member), record, vint(1), some);
    };
    vpoint square = sample_square(s.pixel, sample, dimension_chosen_light);
    vint shape = gather(field(lights, &LightRecord::shape), record, some);
    vmask disk = shape == vint(light_disk);
    vmask flat = disk | (shape == vint(light_rectangle));
    vmask sphere = some & (shape == vint(light_sphere));
    vpoint on_disk = concentric_disk(square);
    vfloat u = select(disk, on_disk.u, square.u);
    vfloat v = select(disk, on_disk.v, square.v);
    vvec corner = three(&LightRecord::corner);
    vvec edge_u = three(&LightRecord::edge_u); // of points and spheres none
    vvec edge_v = three(&LightRecord::edge_v);
    vvec along_u = madd(u, edge_u, corner);
    vfloat inverse;
    ChosenRays l;
    static_cast<LightRays&>(l) = rays_to(s, madd(v, edge_v, along_u), inverse);
    l.rays.active = some & l.rays.active;
    vvec normal = three(&LightRecord::normal);
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vfloat cos_light = select(flat, -dot(normal, l.rays.direction), one);
    vmask faces = cos_surface > zero;
    faces = faces & (cos_light > zero);
    l.rays.active = l.rays.active & (faces | sphere);
    // Of a spot as much as its cone lets through: see sample_point().
    vvec aside = normal + l.rays.direction;
    vfloat versine = dot(aside, aside) * 0.5F;
    vfloat lack = number(&LightRecord::cone_end) - versine;
    vfloat share = lack * number(&LightRecord::cone_scale);
    share = min(max(share, 0.0F), 1.0F);
    vfloat bend = fma(share, vfloat(-2.0F), vfloat(3.0F));
    vfloat smooth = (share * share) * bend;
    vfloat given = select(flat, cos_light, smooth);
    vfloat received = cos_surface * given;
    l.weight = received * (inverse * inverse);
    if (branch(any(sphere)))
        aim_at_spheres(s, corner, number(&LightRecord::radius), square, sphere, inverse, l);
    l.rays.active = l.rays.active & (l.weight > zero);
    vfloat spacing = number(&LightRecord::spacing);
    leave_surface(c, s, growth_to_area(s.target, spacing, cos_light, inverse), l.rays);
    vfloat per_chance = reciprocal(select(some, choice.chance, one));
    l.colour = three(&LightRecord::radiance) * per_chance;
    l.domain = number(&LightRecord::domain) * per_chance;
    return l;
}

struct TowardsChosen {
    static constexpr RayKind kind = kind_light;
    ChosenRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_chosen(c, s, number);
    }
    template <class Response>
    void reflect(const Tinted<Response>& r, const Surface& s, const ChosenRays& l, sint samples,
                 vfloat (&part)[3 * Response::lobes]) const {
        vfloat lobe[Response::lobes];
        r.response.reflect(s, l, EachDomain{l.domain}, samples, lobe);
        tint(lobe, l.colour, part);
    }
};

template <Features F, bool Mapped, class Response>
inline GatheredColours<Response> gather_chosen(const Context& c, const Surface& s, const Response& response,
                                               sint samples) {
    return {gather_light<F, Mapped>(c, s, TowardsChosen{}, Tinted<Response>{response}, samples)};
}

/// As meet_lights(), of lights that are chosen from. `from`: where the rays left.
[[gnu::noinline]] inline vvec meet_chosen(const Context& c, const Rays& r, const vfloat& hit_t,
                                          const vfloat& density, const Surface& from, sint samples) {
    phase_scope phase(phase_light);
    vfloat zero(0.0F);
    vvec sum{zero, zero, zero};
    vvec inverse;
    inverse.x = safe_inverse(r.direction.x);
    inverse.y = safe_inverse(r.direction.y);
    inverse.z = safe_inverse(r.direction.z);
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    pointer<LightRecord> lights = load(field(c.frame, &FrameHeader::chosen_lights));
    sint count = load(field(c.frame, &FrameHeader::light_node_count));
    for (sint n = 0; branch(n < count);) {
        pointer<LightNode> node = nodes + n;
        vvec low = times(load_broadcast_vec(field(node, &LightNode::low)) - r.origin, inverse);
        vvec high = times(load_broadcast_vec(field(node, &LightNode::high)) - r.origin, inverse);
        vfloat enter = max(min(low.x, high.x), 0.0F);
        enter = max(enter, min(low.y, high.y));
        enter = max(enter, min(low.z, high.z));
        vfloat leave = min(max(low.x, high.x), hit_t);
        leave = min(leave, max(low.y, high.y));
        leave = min(leave, max(low.z, high.z));
        vmask met = r.active & (enter <= leave);
        sint second = load(field(node, &LightNode::second));
        sint next = load(field(node, &LightNode::next));
        if (branch(none(met))) {
            n = next;
            continue;
        }
        ++n; // also the one after a leaf
        if (branch(second >= 0))
            continue;
        pointer<LightRecord> light = lights + (sint(-1) - second);
        Met at = meet_light(light, r);
        vmask seen = r.active & (at.t < hit_t);
        if (branch(any(seen))) {
            vfloat chance = chance_of_light(c, n - 1, from);
            vfloat of_samples = chance * vfloat(to_float(samples));
            vfloat share = vfloat(1.0F) - power_share(at.density * of_samples, density);
            vvec emitted = load_broadcast_vec(field(light, &LightRecord::emitted));
            sum = sum + select(seen, emitted * share, {zero, zero, zero});
        }
    }
    return sum;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
