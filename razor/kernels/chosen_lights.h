// Shadow rays to a few of many lights: one to a light of each part that their tree is cut into for the hit
// (razor/kernels/light_cut.h).
#pragma once

#include "razor/kernels/emitter_samples.h"
#include "razor/kernels/light_cut.h"
#include "razor/kernels/seen_lights.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

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
    pointer<LightNode> nodes = load(field(c.frame, &FrameHeader::light_nodes));
    LightChoice choice = choose_light(nodes, here, node, which.u);
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
    cut_lights(c, load(field(c.frame, &FrameHeader::light_nodes)), s, parts);
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
            vfloat chance = chance_of_light(nodes, n - 1, from);
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
