// Lights that bounces meet. Lights have no surfaces in the scene: they hide nothing, not even each other.
#pragma once

#include "razor/kernels/bounce.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Where a ray meets a light: its distance, infinite where it does not, and the density of the light's
/// samples, by solid angle, in that direction.
struct Met {
    vfloat t, density;
};

/// A flat shape that emits towards where its normal points. Where on it: multiples of its edges.
inline Met meet_plane(pointer<LightRecord> light, const Rays& r, vvec& place) {
    vvec normal = load_broadcast_vec(field(light, &LightRecord::normal));
    vvec corner = load_broadcast_vec(field(light, &LightRecord::corner));
    vfloat area = load_broadcast(field(light, &LightRecord::domain));
    vfloat facing = -dot(normal, r.direction);
    vmask faces = facing > vfloat(0.0F);
    vfloat away = dot(normal, r.origin - corner);
    Met met;
    met.t = away / select(faces, facing, vfloat(1.0F));
    faces = faces & (met.t > vfloat(0.0F));
    vfloat projected = max(area * facing, 1.0e-30F);
    met.density = (met.t * met.t) / projected;
    met.t = select(faces, met.t, vfloat(infinite));
    vfloat t = select(faces, met.t, vfloat(0.0F));
    place = madd(t, r.direction, r.origin - corner);
    return met;
}

inline Met meet_rectangle(pointer<LightRecord> light, const Rays& r) {
    vvec place;
    Met met = meet_plane(light, r, place);
    vvec normal = load_broadcast_vec(field(light, &LightRecord::normal));
    vvec edge_u = load_broadcast_vec(field(light, &LightRecord::edge_u));
    vvec edge_v = load_broadcast_vec(field(light, &LightRecord::edge_v));
    vfloat area = dot(cross(edge_u, edge_v), normal);
    vfloat u = dot(cross(place, edge_v), normal);
    vfloat v = dot(cross(edge_u, place), normal);
    vmask within = u >= vfloat(0.0F);
    within = within & (u <= area);
    within = within & (v >= vfloat(0.0F));
    within = within & (v <= area);
    met.t = select(within, met.t, vfloat(infinite));
    return met;
}

inline Met meet_disk(pointer<LightRecord> light, const Rays& r) {
    vvec place;
    Met met = meet_plane(light, r, place);
    vvec edge_u = load_broadcast_vec(field(light, &LightRecord::edge_u));
    vfloat size = dot(edge_u, edge_u);
    vmask within = dot(place, place) <= size;
    met.t = select(within, met.t, vfloat(infinite));
    return met;
}

/// From within nothing is seen of it.
inline Met meet_sphere(pointer<LightRecord> light, const Rays& r) {
    vvec middle = load_broadcast_vec(field(light, &LightRecord::corner));
    vfloat radius = load_broadcast(field(light, &LightRecord::radius));
    vvec way = middle - r.origin;
    vfloat away = dot(way, way);
    vfloat own = radius * radius;
    vmask outside = away > own;
    vfloat along = dot(way, r.direction);
    vvec aside = way - r.direction * along;
    vfloat depth = own - dot(aside, aside);
    vmask within = outside & (depth >= vfloat(0.0F));
    within = within & (along > vfloat(0.0F));
    Met met;
    met.t = along - sqrt(max(depth, 0.0F));
    met.t = select(within, met.t, vfloat(infinite));
    vfloat sine_square = min(own / max(away, 1.0e-30F), 1.0F);
    vfloat versine = sine_square / (sqrt(vfloat(1.0F) - sine_square) + vfloat(1.0F));
    constexpr float per_turn = 0.159154943091895336F;
    met.density = vfloat(per_turn) / max(versine, 1.0e-20F);
    return met;
}

/// Further away than everything else.
inline Met meet_directional(pointer<LightRecord> light, const Rays& r) {
    vvec axis = load_broadcast_vec(field(light, &LightRecord::normal));
    vfloat versine = load_broadcast(field(light, &LightRecord::versine));
    vfloat domain = load_broadcast(field(light, &LightRecord::domain));
    vvec aside = r.direction - axis; // |aside|^2 / 2 is 1 - cos
    vfloat own = dot(aside, aside) * 0.5F;
    Met met;
    met.t = select(own <= versine, vfloat(0.99F * infinite), vfloat(infinite));
    met.density = vfloat(1.0F) / max(domain, 1.0e-30F);
    return met;
}

inline Met meet_light(pointer<LightRecord> light, const Rays& r) {
    sint shape = load(field(light, &LightRecord::shape));
    Met met{vfloat(infinite), vfloat(0.0F)};
    if (branch(shape == light_rectangle)) {
        met = meet_rectangle(light, r);
    } else if (branch(shape == light_disk)) {
        met = meet_disk(light, r);
    } else if (branch(shape == light_sphere)) {
        met = meet_sphere(light, r);
    } else if (branch(shape == light_directional)) {
        met = meet_directional(light, r);
    }
    return met;
}

/// The radiance that rays meet before they hit anything: of each light the share that its own samples leave.
/// `density`: of the bounces; `fewer`: whether only one sample was taken of each light where they left.
[[gnu::noinline]] inline vvec meet_lights(const Context& c, const Rays& r, const vfloat& hit_t,
                                          const vfloat& density, sbool fewer) {
    phase_scope phase(phase_light);
    vfloat zero(0.0F);
    vvec sum{zero, zero, zero};
    sint lights = load(field(c.frame, &FrameHeader::light_count));
    pointer<LightRecord> light = load(field(c.frame, &FrameHeader::lights));
    for (sint n = 0; branch(n < lights); ++n) {
        Met met = meet_light(light, r);
        vmask seen = r.active & (met.t < hit_t);
        if (branch(any(seen))) {
            sint samples = load(field(light, &LightRecord::samples));
            samples = select(fewer, sint(1), samples);
            vfloat of_light = met.density * vfloat(to_float(samples));
            vfloat share = vfloat(1.0F) - power_share(of_light, density);
            vvec emitted = load_broadcast_vec(field(light, &LightRecord::emitted));
            sum = sum + select(seen, emitted * share, {zero, zero, zero});
        }
        light = light + 1;
    }
    return sum;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
