// The light that hits receive and reflect, by shadow rays. Shadow packets hold width/4 neighbouring
// hits x 4 samples.
#pragma once

#include "razor/kernels/cutout.h"
#include "razor/kernels/glossy.h"

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
    return p;
}

/// Rays of one hit in a packet, at most: 2^rays_log2.
inline constexpr int rays_of_hit_log2 = 2;

/// What a light's samples are spread over.
struct LightDomain {
    pointer<LightRecord> light;
    vfloat load() const { return load_broadcast(field(light, &LightRecord::domain)); }
};

/// Where shadow rays go: to points of one light, or in directions about the normal.
struct TowardsRectangle {
    static constexpr RayKind kind = kind_light;
    pointer<LightRecord> light;
    LightRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_rectangle(c, s, light, number);
    }
    template <class Response>
    void reflect(const Response& r, const Surface& s, const LightRays& l, sint samples,
                 vfloat (&part)[Response::lobes]) const {
        r.reflect(s, l, LightDomain{light}, samples, part);
    }
};
struct TowardsShape {
    static constexpr RayKind kind = kind_light;
    pointer<LightRecord> light;
    LightRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_shape(c, s, light, number);
    }
    template <class Response>
    void reflect(const Response& r, const Surface& s, const LightRays& l, sint samples,
                 vfloat (&part)[Response::lobes]) const {
        r.reflect(s, l, LightDomain{light}, samples, part);
    }
};
struct TowardsSky {
    static constexpr RayKind kind = kind_sky;
    LightRays sample(const Context& c, const Surface& s, const vint& number) const {
        return sample_sky(c, s, number);
    }
    template <class Response>
    void reflect(const Response& r, const Surface& s, const LightRays& l, sint,
                 vfloat (&part)[Response::lobes]) const {
        r.reflect_sky(s, l, part);
    }
};

/// Of each hit its sample of that number, where `first` come before it; `lane`: the hit's.
template <class Towards>
inline auto sample_towards(const Context& c, const Towards& towards, const Surface& here, const vint& number,
                           const vint& first, const vint& lane) {
    if constexpr (requires { towards.sample_lane(c, here, number, lane); })
        return towards.sample_lane(c, here, number, lane);
    else
        return towards.sample(c, here, number + first);
}

/// Of each lobe.
template <class Response> struct Gathered { vfloat lobe[Response::lobes]; };
template <class Response> inline pointer<float> lobe_sums(const Context& c, int lobe) {
    return lobe == 0 ? c.packets + packet_sum : c.packets + (packet_lobes + (lobe - 1) * isa::width);
}

/// Sums over `samples` shadow rays a hit of what the surface makes of the weights of those that arrive.
template <Features F, bool Mapped, class Towards, class Response>
[[gnu::noinline]] inline Gathered<Response> gather_light(const Context& c, const Surface& s,
                                                         const Towards& towards, const Response& response,
                                                         sint samples) {
    phase_scope phase(phase_light);
    constexpr int lobes = Response::lobes;
    // Few samples leave room for more hits.
    sint fewer_log2 = samples - 1;
    sint per_hit_log2 = select(samples > 2, sint(rays_of_hit_log2), fewer_log2);
    sint per_hit = sint(1) << per_hit_log2;
    sint hits_per_packet = sint(isa::width) >> per_hit_log2;
    for (int k = 0; k < lobes; ++k)
        store_vector(lobe_sums<Response>(c, k), vfloat(0.0F));
    vint order = compress(lane_index(), s.hit);
    sint hits = count(s.hit);
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
            auto l = sample_towards(c, towards, here, number, first_sample, lane);
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
                    for (sint step = 1; branch(step < per_hit); step = step + step) {
                        vint pair = lane_index() ^ vint(step);
                        sum = sum + permute(sum, pair);
                    }
                    pointer<float> sums = lobe_sums<Response>(c, lobe);
                    vfloat before = gather(sums, lane, leader);
                    scatter(sums, lane, before + sum, leader);
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
        return gather_light<F, Mapped>(c, s, TowardsRectangle{light}, response, samples);
    return gather_light<F, Mapped>(c, s, TowardsShape{light}, response, samples);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
