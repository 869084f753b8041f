// Surfaces that are lights: rays to points of them, and how bounces that meet them share what both find.
//
// Points lie on the surface by definition; the surface that a ray sees differs from it by as much as its
// level of detail does. So a ray arrives if it meets nothing before the point, or only what must be the point
// itself as it sees it: the same instance, from the same side, nearer by less than triangles of the emitter,
// and those that the ray asks for, are off a surface that turns by an edge's length over an edge.
#pragma once

#include "razor/frame/emitter_record.h"
#include "razor/kernels/bounce.h"
#include "razor/kernels/sky_map.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

struct EmitterRays : LightRays {
    vvec colour;   // radiance, without what maps show there, / (pi x density by area)
    vfloat domain; // 1 / density by area
    vfloat distance, margin;
    vint instance, material;
    vmask front; // of the surface, or its back
};

/// A point of some triangle for each lane; rays to it.
[[gnu::noinline]] inline EmitterRays sample_emitters(const Context& c, const Surface& s, const vint& sample) {
    pointer<float> sums = load(field(c.frame, &FrameHeader::emitter_sums));
    pointer<EmitterRecord> first = load(field(c.frame, &FrameHeader::emitters));
    sint count = load(field(c.frame, &FrameHeader::emitter_count));
    sint step = load(field(c.frame, &FrameHeader::emitter_step));
    vpoint square = sample_square(s.pixel, sample, dimension_emitters);
    vint which = find_interval(sums, vint(0), count, step, square.u, s.hit);
    vfloat chance;
    vfloat rest = within_interval(sums, which, square.u, s.hit, chance);
    constexpr int stride = sizeof(EmitterRecord) / 4;
    vint record = which * vint(stride);
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
    vfloat away = sqrt(rest);
    vfloat along_v = away * square.v;
    vfloat along_u = away - along_v;
    vvec edge_u = vector(&EmitterRecord::edge_u);
    vvec edge_v = vector(&EmitterRecord::edge_v);
    vvec corner = vector(&EmitterRecord::corner);
    vvec point = madd(along_v, edge_v, madd(along_u, edge_u, corner));
    vfloat inverse;
    EmitterRays l;
    static_cast<LightRays&>(l) = rays_to(s, point, inverse);
    l.colour = vector(&EmitterRecord::radiance);
    l.domain = number(&EmitterRecord::domain);
    l.margin = number(&EmitterRecord::margin);
    l.instance = word(&EmitterRecord::instance);
    l.material = word(&EmitterRecord::material);
    pointer<MaterialRecord> materials = load(field(c.frame, &FrameHeader::materials));
    vint sides =
        gather(field(materials, &MaterialRecord::one_sided), l.material * vint(material_stride), s.hit);
    vmask one_sided = sides != vint(0);
    l.distance = l.rays.t_max;
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

/// Whether rays meet the triangles that they hit from their front.
[[gnu::noinline]] inline vmask hits_front(const Context& c, const Rays& r, const Hits& h, const vmask& hit,
                                          const vint& instance) {
    Shaded none_known = nothing_shaded();
    Corners k = find_triangles<false, false>(c, r, h, hit, false, none_known);
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

/// Of these, which arrive.
inline vmask arriving(const Context& c, const EmitterRays& l, const Hits& h) {
    vmask hit = l.rays.active & (h.patch >= vint(0));
    vmask open = l.rays.active & !hit;
    constexpr int instance_word = offsetof(BlockHeader, instance) / 4;
    vint block = h.block << 4;
    vint instance = gather(as<std::int32_t>(c.grids) + instance_word, block, hit);
    vmask near = hit & (instance == l.instance);
    vvec way = madd(l.distance, l.rays.direction, l.rays.origin - l.rays.field_origin);
    vfloat facets = asked_at(l.rays, way) * 0.25F;
    vmask curved = l.margin > vfloat(0.0F);
    vfloat wider = l.margin + facets;
    vfloat margin = select(curved, wider, vfloat(0.0F)); // flat ones are seen where they are
    near = near & (h.t + margin >= l.distance);
    if (branch(none(near)))
        return open;
    vmask other_side = hits_front(c, l.rays, h, near, instance) ^ l.front;
    return open | (near & !other_side);
}

struct EachDomain {
    vfloat domain;
    vfloat load() const { return domain; }
};

template <bool Mapped> struct TowardsEmitters {
    static constexpr RayKind kind = kind_light;
    const Context& context;
    EmitterRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_emitters(c, s, number);
    }
    template <class Response>
    void reflect(const Tinted<Response>& r, const Surface& s, const EmitterRays& l, sint samples,
                 vfloat (&part)[3 * Response::lobes]) const {
        vfloat own[Response::lobes];
        r.response.reflect(s, l, EachDomain{l.domain}, samples, own);
        tint(own, l.colour, part);
    }
    /// Of rays traced to their closest hits, which arrive; their colours multiplied by what maps show there,
    /// or the mean of them where what a ray sees is not quite there.
    vmask arrive(EmitterRays& l, const Hits& h) const {
        vmask arrives = arriving(context, l, h);
        if constexpr (Mapped) {
            sint maps = load(field(context.frame, &FrameHeader::emitter_maps));
            if (branch(maps == 0))
                return arrives;
            vmask seen = arrives & (h.patch >= vint(0));
            if (branch(none(seen)))
                return arrives;
            Hits found = h;
            found.patch = select(seen, h.patch, vint(-1));
            Beyond beyond;
            find_surface<look_mapped>(context, l.rays, found, false, beyond);
            Materials of = materials_of(context, l.material, seen);
            vvec map = of.mapped(context, map_emission, beyond.map, seen);
            constexpr float per_domain = 0.318309886183790672F; // 1 / pi
            vfloat scale = l.domain * per_domain;
            vvec shown = times(of.colour(&MaterialRecord::emission), map) * scale;
            l.colour = select(seen, shown, l.colour);
        }
        return arrives;
    }
};

template <Features F, bool Mapped, class Response>
inline GatheredColours<Response> gather_emitters(const Context& c, const Surface& s, const Response& response,
                                                 sint samples) {
    return {gather_light<F, Mapped>(c, s, TowardsEmitters<Mapped>{c}, Tinted<Response>{response}, samples)};
}

/// What is left of emission to bounces that meet surfaces which are lights. `fewer`: one ray went to them
/// from where the bounces left.
inline vfloat left_of_emitters(const Context& c, const Surface& s, const Beyond& b, const Hits& h,
                               const Bounce& bounce, sbool fewer) {
    vfloat density_of_light = materials_of(c, b.material, s.hit).number(&MaterialRecord::light_density);
    sint all = load(field(c.frame, &FrameHeader::emitter_samples));
    sint samples = select(fewer, sint(1), all);
    vfloat cosine = max(abs(dot(s.geometric, b.toward)), 1.0e-6F);
    vfloat by_angle = ((h.t * h.t) * density_of_light) / cosine;
    vfloat of_light = by_angle * vfloat(to_float(samples));
    vfloat share = vfloat(1.0F) - power_share(of_light, bounce.density);
    vmask light = density_of_light > vfloat(0.0F);
    return select(light, share, vfloat(1.0F));
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
