// Surfaces that are lights: rays to points of them, and how bounces that meet them share what both find.
//
// Points lie on the surface by definition; the surface that a ray sees differs from it by as much as its
// level of detail does. So a ray arrives if it meets nothing before the point, or only what must be the point
// itself as it sees it: the same instance, from the same side, nearer by less than triangles of the emitter,
// and those that the ray asks for, are off a surface that turns by an edge's length over an edge. Where maps
// are looked up rays go on until just behind the point, so that they meet also what is flat.
#pragma once

#include "razor/frame/emitter_record.h"
#include "razor/kernels/bounce.h"
#include "razor/kernels/light_cut.h"
#include "razor/kernels/sky_map.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Hits no further before a point than so much of the way to it are behind it, or are it.
inline constexpr float arrival_room = 2.0e-5F;

struct EmitterRays : LightRays {
    vvec colour;   // radiance, without what maps show there, / (pi x density by area) x the ray's share
    vfloat scale;  // that over radiance
    vfloat domain; // all rays / expected density of them all, by area
    vfloat distance, margin;
    vint instance, material;
    vmask front; // of the surface, or its back
};

/// The part of the cut that a hit's ray goes to, of all rays in turn.
struct EmitterTurn {
    vint part;      // first, then the next, ...
    vint round;     // how many rays went there before
    vint rounds;    // how many do in all
    vfloat per_ray; // 1 / that
};
inline EmitterTurn turn_of(const vint& number, const vint& parts, sint samples) {
    vfloat per_part = reciprocal(to_float(parts));
    vfloat half(0.5F); // so that rounding does not matter
    EmitterTurn t;
    t.round = to_int((to_float(number) + half) * per_part);
    t.part = number - t.round * parts;
    vint after = vint(samples - 1) - t.part;
    t.rounds = to_int((to_float(after) + half) * per_part) + vint(1);
    t.per_ray = reciprocal(to_float(t.rounds));
    return t;
}

/// A triangle for each lane: of the part of the cut whose turn it is some group, of that one.
struct EmitterChoice {
    vmask some;
    vint triangle;
    vfloat u, v;   // evenly in [0, 1], to choose a point by
    vfloat weight; // of what a point of all emitters stands for, which the point of this one does
    vfloat chance; // of its group, that the tree leads there from its root, over its share of all
};
[[gnu::noinline]] inline EmitterChoice choose_emitter(const Context& c, const Surface& s, const vint& number,
                                                      const vint& lane, sint samples) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::emitter_nodes));
    pointer<EmitterGroup> groups = load(field(c.frame, &FrameHeader::emitter_groups));
    pointer<float> sums = load(field(c.frame, &FrameHeader::emitter_sums));
    sint step = load(field(c.frame, &FrameHeader::emitter_step));
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vint parts = gather(as<std::int32_t>(c.cuts) + int{cut_count}, lane, s.hit);
    EmitterTurn turn = turn_of(number, select(s.hit, parts, vint(1)), samples);
    vint at = turn.part * vint(isa::width) + lane;
    vmask present = s.hit & (number < vint(samples));
    vfloat of_part = gather(c.cuts + int{cut_chance}, at, present);
    Surface here = s;
    here.hit = present & (of_part > zero);
    vint node = gather(as<std::int32_t>(c.cuts) + int{cut_node}, at, here.hit);
    vint key = s.pixel + turn.part * vint(std::int32_t(part_step));
    vint sample = s.sample * turn.rounds + turn.round;
    vpoint which = sample_square(key, sample, dimension_which_light);
    LightChoice group = choose_light(nodes, here, node, which.u);
    EmitterChoice e;
    e.some = here.hit & (group.chance > zero);
    constexpr int group_stride = sizeof(EmitterGroup) / 4;
    vint record = group.light * vint(group_stride);
    vint first_sum = gather(field(groups, &EmitterGroup::sums), record, e.some);
    vint count = gather(field(groups, &EmitterGroup::count), record, e.some);
    vpoint square = sample_square(key, sample, dimension_emitters);
    vint interval = find_interval(sums, first_sum, count, step, square.u, e.some);
    vfloat length;
    e.u = within_interval(sums, first_sum + interval, square.u, e.some, length);
    e.v = square.v;
    e.triangle = gather(field(groups, &EmitterGroup::first), record, e.some) + interval;
    vfloat share = gather(field(groups, &EmitterGroup::chance), record, e.some);
    vfloat chance = select(e.some, group.chance, one);
    e.weight = (share / chance) * turn.per_ray;
    vfloat of_all = select(e.some, share, one);
    e.chance = (of_part * chance) / of_all;
    return e;
}

/// A point of some triangle for each lane; rays to it.
[[gnu::noinline]] inline EmitterRays sample_emitters(const Context& c, const Surface& from,
                                                     const vint& number_of_ray, const vint& lane,
                                                     sint samples) {
    EmitterChoice choice = choose_emitter(c, from, number_of_ray, lane, samples);
    Surface s = from;
    s.hit = choice.some;
    pointer<EmitterRecord> first = load(field(c.frame, &FrameHeader::emitters));
    constexpr int stride = sizeof(EmitterRecord) / 4;
    vint record = choice.triangle * vint(stride);
    const auto number = [&](float EmitterRecord::*member) {
        return gather(field(first, member), record, s.hit);
    };
    const auto word = [&](std::int32_t EmitterRecord::*member) {
        return gather(field(first, member), record, s.hit);
    };
    const auto vector = [&](float(EmitterRecord::*member)[3]) {
        return gather_vec(field(first, member), record, vint(1), s.hit);
    };
    // Evenly over a triangle: the root of one number away from the first corner.
    vfloat away = sqrt(choice.u);
    vfloat along_v = away * choice.v;
    vfloat along_u = away - along_v;
    vvec edge_u = vector(&EmitterRecord::edge_u);
    vvec edge_v = vector(&EmitterRecord::edge_v);
    vvec corner = vector(&EmitterRecord::corner);
    vvec point = madd(along_v, edge_v, madd(along_u, edge_u, corner));
    vfloat inverse;
    EmitterRays l;
    static_cast<LightRays&>(l) = rays_to(s, point, inverse);
    l.colour = vector(&EmitterRecord::radiance) * choice.weight;
    vfloat domain = number(&EmitterRecord::domain);
    constexpr float per_domain = 0.318309886183790672F; // 1 / pi
    l.scale = (domain * choice.weight) * per_domain;
    l.domain = domain / max(choice.chance, 1.0e-30F);
    l.margin = number(&EmitterRecord::margin);
    l.instance = word(&EmitterRecord::instance);
    l.material = word(&EmitterRecord::material);
    pointer<MaterialRecord> materials = load(field(c.frame, &FrameHeader::materials));
    vint sides =
        gather(field(materials, &MaterialRecord::one_sided), l.material * vint(material_stride), s.hit);
    vmask one_sided = sides != vint(0);
    l.distance = l.rays.t_max;
    sint maps = load(field(c.frame, &FrameHeader::emitter_maps));
    if (branch(maps != 0))
        l.rays.t_max = l.distance * (1.0F + 2 * arrival_room);
    vfloat zero(0.0F);
    vvec normal = normalise(cross(edge_u, edge_v), {zero, zero, zero});
    vfloat cos_light = -dot(normal, l.rays.direction);
    l.front = cos_light > zero;
    cos_light = abs(cos_light);
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vmask faces = l.rays.active & (cos_surface > zero);
    faces = faces & (cos_light > zero);
    faces = faces & (l.front | !one_sided);
    l.rays.active = s.hit & faces;
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::emitter_spacing));
    leave_surface(c, s, growth_to_area(s.target, spacing, cos_light, inverse), l.rays);
    vfloat cosines = cos_surface * cos_light;
    l.weight = cosines * (inverse * inverse);
    return l;
}

/// Whether rays meet the triangles that they hit from their front. What is kept of blended blocks is made
/// once, for whoever comes later too: with all that `Mapped` ones have.
template <bool Mapped>
[[gnu::noinline]] inline vmask hits_front(const Context& c, const Rays& r, const Hits& h, const vmask& hit,
                                          const vint& instance) {
    Shaded none_known = nothing_shaded();
    Corners k = find_triangles<Mapped, false>(c, r, h, hit, false, none_known);
    vvec edge_u = k.b - k.a;
    vvec edge_v = k.c - k.a;
    vvec area = cross(edge_u, edge_v);
    vmask front = dot(area, r.direction) < vfloat(0.0F);
    constexpr int instance_words = sizeof(InstanceRecord) / 4;
    constexpr int moved_word = offsetof(InstanceRecord, moved) / 4;
    vint record = instance * vint(instance_words);
    vint moved = gather(as<std::int32_t>(c.instances) + moved_word, record, hit);
    return front ^ (moved < vint(0));
}

/// Of these, which arrive, and which of them meet what must be the point.
struct Arrivals {
    vmask all, seen;
};
template <bool Mapped> inline Arrivals arriving(const Context& c, const EmitterRays& l, const Hits& h) {
    vmask hit = l.rays.active & (h.patch >= vint(0));
    vmask open = l.rays.active & !hit;
    constexpr int instance_word = offsetof(BlockHeader, instance) / 4;
    vint block = h.block << 4;
    vint instance = gather(as<std::int32_t>(c.grids) + instance_word, block, hit);
    vmask same = hit & (instance == l.instance);
    vfloat room = l.distance * arrival_room;
    open = open | (hit & (h.t + room >= l.distance));
    vvec way = madd(l.distance, l.rays.direction, l.rays.origin - l.rays.field_origin);
    vfloat facets = asked_at(l.rays, way) * 0.25F;
    vmask curved = l.margin > vfloat(0.0F);
    vfloat wider = l.margin + facets;
    vfloat margin = select(curved, wider, room); // flat ones are seen where they are
    vmask near = same & (h.t + margin >= l.distance);
    if (branch(none(near)))
        return {open, near};
    vmask other_side = hits_front<Mapped>(c, l.rays, h, near, instance) ^ l.front;
    vmask seen = near & !other_side;
    return {open | seen, seen};
}

struct EachDomain {
    vfloat domain;
    vfloat load() const { return domain; }
};

template <bool Mapped> struct TowardsEmitters {
    static constexpr RayKind kind = kind_light;
    const Context& context;
    sint samples;
    EmitterRays sample_lane(const Context& c, const Surface& s, const vint& number, const vint& lane) const {
        return sample_emitters(c, s, number, lane, samples);
    }
    template <class Response>
    void reflect(const Tinted<Response>& r, const Surface& s, const EmitterRays& l, sint,
                 vfloat (&part)[3 * Response::lobes]) const {
        vfloat own[Response::lobes];
        r.response.reflect(s, l, EachDomain{l.domain}, samples, own);
        tint(own, l.colour, part);
    }
    /// Of rays traced to their closest hits, which arrive; their colours multiplied by what maps show there,
    /// or the mean of them where what a ray sees is not quite there.
    vmask arrive(EmitterRays& l, const Hits& h) const {
        Arrivals of = arriving<Mapped>(context, l, h);
        vmask arrives = of.all;
        if constexpr (Mapped) {
            sint maps = load(field(context.frame, &FrameHeader::emitter_maps));
            if (branch(maps == 0))
                return arrives;
            const vmask& seen = of.seen;
            if (branch(none(seen)))
                return arrives;
            Hits found = h;
            found.patch = select(seen, h.patch, vint(-1));
            Beyond beyond;
            find_surface<look_mapped>(context, l.rays, found, false, beyond);
            Materials emitting = materials_of(context, l.material, seen);
            vvec map = emitting.mapped(context, map_emission, beyond.map, seen);
            vvec shown = times(emitting.colour(&MaterialRecord::emission), map) * l.scale;
            l.colour = select(seen, shown, l.colour);
        }
        return arrives;
    }
};

template <Features F, bool Mapped, class Response>
inline GatheredColours<Response> gather_emitters(const Context& c, const Surface& s, const Response& response,
                                                 sint samples) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::emitter_nodes));
    cut_lights(c, nodes, s, min(samples, sint(most_light_choices)));
    TowardsEmitters<Mapped> towards{c, samples};
    return {gather_light<F, Mapped>(c, s, towards, Tinted<Response>{response}, samples)};
}

/// With which chance the tree leads from its root to the group of each lane's patch, over that group's share
/// of all emitters. `from`: where the ray that met it left.
[[gnu::noinline]] inline vfloat chance_of_emitter(const Context& c, const vint& patch, const Surface& from,
                                                  const vmask& m) {
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::emitter_nodes));
    pointer<EmitterGroup> groups = load(field(c.frame, &FrameHeader::emitter_groups));
    sint count = load(field(c.frame, &FrameHeader::emitter_group_count));
    constexpr int stride = sizeof(EmitterGroup) / 4;
    vint group(0); // the last that does not begin behind it
    for (sint step = load(field(c.frame, &FrameHeader::emitter_group_step)); branch(step > 0);
         step = step >> 1) {
        vint next = group + vint(step);
        vmask within = m & (next < vint(count));
        vint begins = gather(field(groups, &EmitterGroup::first_patch), next * vint(stride), within);
        group = select(within & (begins <= patch), next, group);
    }
    vint record = group * vint(stride);
    vint leaf = gather(field(groups, &EmitterGroup::leaf), record, m);
    vfloat share = gather(field(groups, &EmitterGroup::chance), record, m);
    vmask left = m & (share > vfloat(0.0F));
    vfloat chance(0.0F);
    while (branch(any(left))) {
        sint one = extract(leaf, first(left));
        vmask same = left & (leaf == vint(one));
        left = left & !same;
        chance = select(same, chance_of_light(nodes, one, from) / share, chance);
    }
    return chance;
}

/// What is left of emission to bounces that meet surfaces which are lights. `fewer`: one ray went to them
/// from where the bounces left, `from`.
inline vfloat left_of_emitters(const Context& c, const Surface& s, const Beyond& b, const Hits& h,
                               const Bounce& bounce, const Surface& from, sbool fewer) {
    vfloat density_of_light = materials_of(c, b.material, s.hit).number(&MaterialRecord::light_density);
    vmask light = s.hit & (density_of_light > vfloat(0.0F));
    if (branch(none(light)))
        return vfloat(1.0F);
    sint all = load(field(c.frame, &FrameHeader::emitter_samples));
    sint samples = select(fewer, sint(1), all);
    vfloat cosine = max(abs(dot(s.geometric, b.toward)), 1.0e-6F);
    vfloat by_angle = ((h.t * h.t) * density_of_light) / cosine;
    vfloat chance = chance_of_emitter(c, h.patch, from, light);
    vfloat rays = chance * vfloat(to_float(samples));
    vfloat of_light = by_angle * rays;
    vfloat share = vfloat(1.0F) - power_share(of_light, bounce.density);
    return select(light, share, vfloat(1.0F));
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
