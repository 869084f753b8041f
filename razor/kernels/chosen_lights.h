// Shadow rays to a few of many lights. For each hit the tree of lights is cut into as many parts as there are
// rays, where lights are near and bright into the smallest ones: those that matter most have rays of their
// own. Each part's ray goes to one of its lights, down the tree by what is known of both children (Conty
// Estevez & Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, HPG 2018; here the number
// of parts is given, not the error of one. The measure of importance is that of pbrt-4's LightBounds).
#pragma once

#include "razor/frame/light_node.h"
#include "razor/kernels/emitter_samples.h"
#include "razor/kernels/seen_lights.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Added to the numbers of pixels for each part of a cut: samples of one have nothing to do with another's.
inline constexpr std::uint32_t part_step = 0xc2b2ae35U;

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
/// `spread`: how much lights there differ by where they are, at most 1.
inline vfloat importance(const LightBounds& b, const vvec& position, const vvec& normal, vfloat& spread) {
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
    spread = sqrt(size / max(square, size));
    vmask lit = cos_emitted > b.cos_emission;
    lit = lit & (cos_received > zero);
    vfloat cosines = max(cos_emitted, 0.0F) * cos_received;
    vfloat given = b.power * cosines;
    vfloat value = given / max(square, size);
    return select(lit, value, zero);
}

inline vfloat importance(const LightBounds& b, const vvec& position, const vvec& normal) {
    vfloat spread;
    return importance(b, position, normal, spread);
}

/// Cuts the tree of lights for each hit, into `parts` or as many as there are lights that may light it: what
/// gives most, and most unevenly, is divided first.
[[gnu::noinline]] inline void cut_lights(const Context& c, const Surface& s, sint parts) {
    phase_scope phase(phase_light);
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    constexpr int stride = sizeof(LightNode) / 4;
    pointer<std::int32_t> seconds = field(nodes, &LightNode::second);
    pointer<std::int32_t> node_at = as<std::int32_t>(c.cuts) + int{cut_node};
    pointer<float> chance_at = c.cuts + int{cut_chance};
    pointer<float> worth_at = c.cuts + int{cut_worth};
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vfloat done(-1.0F);
    store_vector(node_at, vint(0));
    store_vector(chance_at, one);
    store_vector(worth_at, one);
    for (sint k = 1; branch(k < parts); ++k) {
        sint row = k * isa::width;
        store_vector(chance_at + row, zero);
        store_vector(worth_at + row, done);
    }
    vint count(1);
    for (;;) {
        vfloat best = zero;
        vint row(0);
        for (sint k = 0; branch(k < parts); ++k) {
            sint at = k * isa::width;
            vfloat worth = load_vector(worth_at + at);
            vmask more = worth > best;
            best = select(more, worth, best);
            row = select(more, vint(k), row);
        }
        vmask going = s.hit & (count < vint(parts));
        going = going & (best > zero);
        if (branch(none(going)))
            return;
        vint at = row * vint(isa::width) + lane_index();
        vint node = gather(node_at, at, going);
        vfloat chance = gather(chance_at, at, going);
        vint first = node + vint(1);
        vint second = gather(seconds, node * vint(stride), going);
        vfloat spread;
        vfloat of_first = importance(bounds_at(nodes, first, going), s.position, s.shading, spread);
        vfloat worth_of_first = of_first * spread;
        vfloat of_second = importance(bounds_at(nodes, second, going), s.position, s.shading, spread);
        vfloat worth_of_second = of_second * spread;
        // Of leaves there is nothing to divide.
        vint below = gather(seconds, first * vint(stride), going);
        worth_of_first = select(below < vint(0), done, worth_of_first);
        below = gather(seconds, second * vint(stride), going);
        worth_of_second = select(below < vint(0), done, worth_of_second);
        vfloat sum = of_first + of_second;
        vfloat share = of_first / max(sum, 1.0e-37F);
        // In its row one of the children that give something, none if there is none; in the next row the
        // other.
        vmask only_second = of_first <= zero;
        vmask both = going & (of_second > zero);
        both = both & !only_second;
        vmask dark = sum <= zero;
        vfloat kept = select(only_second, one, share);
        kept = select(dark, zero, kept);
        vfloat worth = select(only_second, worth_of_second, worth_of_first);
        scatter(node_at, at, select(only_second, second, first), going);
        scatter(chance_at, at, chance * kept, going);
        scatter(worth_at, at, select(dark, done, worth), going);
        vint next = count * vint(isa::width) + lane_index();
        scatter(node_at, next, second, both);
        vfloat rest = one - share;
        scatter(chance_at, next, chance * rest, both);
        scatter(worth_at, next, worth_of_second, both);
        count = select(both, count + vint(1), count);
    }
}

struct LightChoice {
    vint light;
    vfloat chance; // in its part; 0: no light is worth it
};

/// Of the parts with those nodes.
[[gnu::noinline]] inline LightChoice choose_light(const Context& c, const Surface& s, const vint& part,
                                                  const vfloat& number) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    constexpr int stride = sizeof(LightNode) / 4;
    pointer<std::int32_t> seconds = field(nodes, &LightNode::second);
    vfloat one(1.0F);
    vfloat left_of = number;
    vint node = part;
    LightChoice choice;
    choice.chance = one;
    vint second = gather(seconds, node * vint(stride), s.hit);
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

/// With which chance the tree leads from its root to a leaf.
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
    vfloat domain; // of the light, / expected_rays()
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

/// How many rays go to a light that the tree leads to with that chance, on average, about: what multiple
/// importance sampling takes for it on both sides. (How many do is known where the tree is cut, not where a
/// bounce meets the light.)
inline vfloat expected_rays(const vfloat& chance, sint parts) {
    return min(chance * vfloat(to_float(parts)), 1.0F);
}

/// A light of each lane's own, of any shape that has a place, and a ray to it: of the part of that number of
/// those that the hit of `lane` has.
[[gnu::noinline]] inline ChosenRays sample_chosen(const Context& c, const Surface& s, const vint& part,
                                                  const vint& lane, sint parts) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vmask present = s.hit & (part < vint(parts));
    vint at = part * vint(isa::width) + lane;
    vfloat chance = gather(c.cuts + int{cut_chance}, at, present);
    Surface here = s;
    here.hit = present & (chance > zero);
    vint node = gather(as<std::int32_t>(c.cuts) + int{cut_node}, at, here.hit);
    vint key = s.pixel + part * vint(std::int32_t(part_step));
    vpoint which = sample_square(key, s.sample, dimension_which_light);
    LightChoice choice = choose_light(c, here, node, which.u);
    vmask some = here.hit & (choice.chance > zero);
    pointer<LightRecord> lights = load(field(c.frame, &FrameHeader::chosen_lights));
    constexpr int stride = sizeof(LightRecord) / 4;
    vint record = choice.light * vint(stride);
    const auto number = [&](float LightRecord::*member) {
        return gather(field(lights, member), record, some);
    };
    const auto three = [&](float(LightRecord::*member)[3]) {
        return gather_vec(field(lights, member), record, vint(1), some);
    };
    vpoint square = sample_square(key, s.sample, dimension_chosen_light);
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
    vfloat rays = expected_rays(chance * choice.chance, parts);
    vfloat domain = number(&LightRecord::domain);
    l.domain = domain / select(some, rays, one);
    return l;
}

struct TowardsChosen {
    static constexpr RayKind kind = kind_light;
    sint parts;
    ChosenRays sample_lane(const Context& c, const Surface& s, const vint& number, const vint& lane) const {
        return sample_chosen(c, s, number, lane, parts);
    }
    template <class Response>
    void reflect(const Tinted<Response>& r, const Surface& s, const ChosenRays& l, sint,
                 vfloat (&part)[3 * Response::lobes]) const {
        vfloat lobe[Response::lobes];
        r.response.reflect(s, l, EachDomain{l.domain}, sint(1), lobe);
        tint(lobe, l.colour, part);
    }
};

/// Sums over so many rays.
template <Features F, bool Mapped, class Response>
inline GatheredColours<Response> gather_chosen(const Context& c, const Surface& s, const Response& response,
                                               sint parts) {
    cut_lights(c, s, parts);
    return {gather_light<F, Mapped>(c, s, TowardsChosen{parts}, Tinted<Response>{response}, parts)};
}

/// How many parts the tree is cut into where bounces hit: a few, as what they find counts for less.
inline sint parts_after_bounces(sint parts) {
    sint quarter = parts >> 2;
    return max(quarter, sint(1));
}

/// As meet_lights(), of lights that are chosen from. `from`: where the rays left.
[[gnu::noinline]] inline vvec meet_chosen(const Context& c, const Rays& r, const vfloat& hit_t,
                                          const vfloat& density, const Surface& from, sint parts) {
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
            vfloat of_rays = at.density * expected_rays(chance, parts);
            vfloat share = vfloat(1.0F) - power_share(of_rays, density);
            vvec emitted = load_broadcast_vec(field(light, &LightRecord::emitted));
            sum = sum + select(seen, emitted * share, {zero, zero, zero});
        }
    }
    return sum;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
