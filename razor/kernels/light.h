// The light that hits receive and reflect, by shadow rays. Packets of them hold a sample of each hit, of a
// quarter of the light, where the light is large beside the hits; else of width/4 hits near each other 4
// samples.
#pragma once

#include "razor/kernels/cutout.h"
#include "razor/kernels/glossy.h"
#include "razor/kernels/near_hits.h"
#include "razor/kernels/quarters.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

inline Surface permute(const Surface& s, const vint& from, const vmask& m) {
    Surface p;
    p.hit = m;
    p.position = permute(s.position, from);
    p.geometric = permute(s.geometric, from);
    p.shading = permute(s.shading, from);
    p.target = permute(s.target, from);
    p.growth = permute(s.growth, from);
    p.pixel = permute(s.pixel, from);
    p.sample = permute(s.sample, from);
    p.block = permute(s.block, from);
    p.chord_normal = permute(s.chord_normal, from);
    p.chord_slope = permute(s.chord_slope, from);
    p.chord_growth = permute(s.chord_growth, from);
    return p;
}

/// Rays of one hit in a packet, at most: 2^rays_log2.
inline constexpr int rays_of_hit_log2 = 2;

/// What a light's samples are spread over.
struct LightDomain {
    pointer<LightRecord> light;
    vfloat load() const { return load_broadcast(field(light, &LightRecord::domain)); }
};

/// Where shadow rays go: to points of one light, or in directions about the normal. dimension(): of the
/// points of the unit square that samples stand for; extent(): how far apart their rays may end.
struct TowardsLight {
    static constexpr RayKind kind = kind_light;
    pointer<LightRecord> light;
    sint dimension() const { return load(field(light, &LightRecord::dimension)); }
    sfloat extent(const Context& c) const { return extent_of(c, light); }
    template <class Response>
    void reflect(const Response& r, const Surface& s, const LightRays& l, sint samples,
                 vfloat (&part)[Response::lobes]) const {
        r.reflect(s, l, LightDomain{light}, samples, part);
    }
};
struct TowardsRectangle : TowardsLight {
    LightRays sample(const Context& c, const Surface& s, const vpoint& at) const {
        return sample_rectangle(c, s, light, at);
    }
};
struct TowardsShape : TowardsLight {
    LightRays sample(const Context& c, const Surface& s, const vpoint& at) const {
        return sample_shape(c, s, light, at);
    }
};
struct TowardsSky {
    static constexpr RayKind kind = kind_sky;
    sint dimension() const { return sint(dimension_sky); }
    sfloat extent(const Context&) const { return infinite; }
    LightRays sample(const Context& c, const Surface& s, const vpoint& at) const {
        return sample_sky(c, s, at);
    }
    template <class Response>
    void reflect(const Response& r, const Surface& s, const LightRays& l, sint,
                 vfloat (&part)[Response::lobes]) const {
        r.reflect_sky(s, l, part);
    }
};

/// Where a light's samples are points of the unit square, and how far apart they may be is known.
template <class Towards>
concept towards_points = requires(const Towards& t, const Context& c) {
    t.dimension();
    t.extent(c);
};

/// Of each lobe.
template <class Response> struct Gathered { vfloat lobe[Response::lobes]; };
template <class Response> inline pointer<float> lobe_sums(const Context& c, int lobe) {
    return lobe == 0 ? c.packets + packet_sum : c.packets + (packet_lobes + (lobe - 1) * isa::width);
}

template <class Response>
inline void add_to_lobe(const Context& c, int lobe, const vint& lane, const vmask& m, const vfloat& sum) {
    pointer<float> sums = lobe_sums<Response>(c, lobe);
    vfloat before = gather(sums, lane, m);
    scatter(sums, lane, before + sum, m);
}

/// Sums over `samples` shadow rays a hit of what the surface makes of the weights of those that arrive.
template <Features F, bool Mapped, class Towards, class Response>
[[gnu::noinline]] inline Gathered<Response> gather_light(const Context& c, const Surface& s,
                                                         const Towards& towards, const Response& response,
                                                         sint samples) {
    phase_scope phase(phase_light);
    constexpr int lobes = Response::lobes;
    constexpr bool may_deal = towards_points<Towards>;
    // Few samples leave room for more hits.
    sint fewer_log2 = samples - 1;
    sint per_hit_log2 = select(samples > 2, sint(rays_of_hit_log2), fewer_log2);
    [[maybe_unused]] sbool dealt = false;
    if constexpr (may_deal) {
        if (branch(samples > 1))
            dealt = quarters_pay(s.position, s.hit, s.fine, towards.extent(c));
        per_hit_log2 = select(dealt, sint(0), per_hit_log2);
    }
    sint per_hit = sint(1) << per_hit_log2;
    sint hits_per_packet = sint(isa::width) >> per_hit_log2;
    for (int k = 0; k < lobes; ++k)
        store_vector(lobe_sums<Response>(c, k), vfloat(0.0F));
    sint hits = count(s.hit);
    sbool shared = hits > hits_per_packet;
    shared = shared & !dealt;
    vint order = branch(shared) ? near_order(s.position, s.hit) : compress(lane_index(), s.hit);
    vint member = lane_index() & vint(per_hit - 1);
    vint rank = lane_index() >> vint(per_hit_log2);
    for (sint from = 0; branch(from < hits); from += hits_per_packet) {
        vint place = rank + vint(from);
        vmask present = place < vint(hits);
        vint lane = permute(order, place);
        Surface here = permute(s, lane, present);
        Response responds = response.permuted(lane);
        vint first_sample = here.sample * vint(samples);
        for (sint k = 0; branch(k < samples); k += per_hit) {
            vint number = member + vint(k);
            vmask wanted = number < vint(samples);
            [[maybe_unused]] vint own = number; // of each hit's four, where they are dealt
            if constexpr (may_deal) {
                if (branch(dealt & begins_quarters(k))) {
                    for (int lobe = 0; lobe < lobes; ++lobe)
                        clear_parts(c, lobe);
                }
            }
            auto l = [&] {
                if constexpr (may_deal) {
                    if (branch(dealt)) {
                        Dealt d = dealt_point(c, here.pixel, first_sample, k, samples, towards.dimension());
                        own = d.number;
                        return towards.sample(c, here, d.at);
                    }
                    vint of_pixel = first_sample + number;
                    return towards.sample(c, here, sample_square(here.pixel, of_pixel, towards.dimension()));
                } else {
                    return towards.sample_lane(c, here, number, lane);
                }
            }();
            l.rays.active = l.rays.active & wanted;
            if (branch(any(l.rays.active))) {
                vmask arrives;
                if constexpr (requires(const Hits& h) { towards.arrive(l, h); }) {
                    arrives = towards.arrive(l, trace_seen<F, Towards::kind, Mapped, false>(c, l.rays));
                } else {
                    Hits blocked = trace_seen<F, Towards::kind, Mapped>(c, l.rays);
                    arrives = l.rays.active & (blocked.patch < vint(0));
                }
                vfloat part[lobes];
                towards.reflect(responds, here, l, samples, part);
                vmask leader = present & (member == vint(0));
                for (int lobe = 0; lobe < lobes; ++lobe) {
                    vfloat sum = select(arrives, part[lobe], vfloat(0.0F));
                    if constexpr (may_deal) {
                        if (branch(dealt)) {
                            keep_part(c, lobe, own, sum);
                            continue;
                        }
                    }
                    for (sint step = 1; branch(step < per_hit); step = step + step) {
                        vint pair = lane_index() ^ vint(step);
                        sum = sum + permute(sum, pair);
                    }
                    add_to_lobe<Response>(c, lobe, lane, leader, sum);
                }
            }
            if constexpr (may_deal) {
                if (branch(dealt & ends_quarters(k, samples))) {
                    for (int lobe = 0; lobe < lobes; ++lobe)
                        add_to_lobe<Response>(c, lobe, lane, present, sum_of_parts(c, lobe));
                }
            }
        }
    }
    Gathered<Response> gathered;
    for (int k = 0; k < lobes; ++k)
        gathered.lobe[k] = load_vector(lobe_sums<Response>(c, k));
    return gathered;
}

/// The same of a light. Rectangles, the usual ones, have a loop of their own.
template <Features F, bool Mapped, class Response>
inline Gathered<Response> gather_light(const Context& c, const Surface& s, pointer<LightRecord> light,
                                       const Response& response, sint samples) {
    sint shape = load(field(light, &LightRecord::shape));
    if (branch(shape == light_rectangle))
        return gather_light<F, Mapped>(c, s, TowardsRectangle{{light}}, response, samples);
    return gather_light<F, Mapped>(c, s, TowardsShape{{light}}, response, samples);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
