// Shadow rays: to points of lights, in directions to distant ones, and to a constant sky.
#pragma once

#include "razor/kernels/basis.h"
#include "razor/kernels/leave.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Rays to the light and what they carry if nothing is in the way.
struct LightRays {
    Rays rays;
    vfloat weight; // of the light's radiance (or the sky's), before albedo
};

/// Rays to a point of the light for each lane, active where there is one, and 1 / their length.
inline LightRays rays_to(const Surface& s, const vvec& point, vfloat& inverse) {
    vvec way = point - s.position;
    vfloat square = dot(way, way);
    vfloat zero(0.0F);
    vmask apart = square > zero;
    inverse = reciprocal_sqrt(select(apart, square, vfloat(1.0F)));
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = way * inverse;
    l.rays.t_min = zero;
    l.rays.t_max = (square * inverse) * (1.0F - 1.0e-5F);
    l.rays.active = apart;
    return l;
}

/// The light of a flat one-sided shape, sampled by area: `point` of it for each lane.
inline LightRays sample_area(const Context& c, const Surface& s, pointer<LightRecord> light,
                             const vvec& point) {
    vvec normal = load_broadcast_vec(field(light, &LightRecord::normal));
    vfloat inverse;
    LightRays l = rays_to(s, point, inverse);
    vfloat zero(0.0F);
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vfloat cos_light = -dot(normal, l.rays.direction);
    vmask faces = l.rays.active & (cos_surface > zero);
    faces = faces & (cos_light > zero);
    l.rays.active = s.hit & faces;
    vfloat spacing = load_broadcast(field(light, &LightRecord::spacing));
    leave_surface(c, s, growth_to_area(s.target, spacing, cos_light, inverse), l.rays);
    vfloat cosines = cos_surface * cos_light;
    l.weight = cosines * (inverse * inverse);
    return l;
}

inline LightRays sample_rectangle(const Context& c, const Surface& s, pointer<LightRecord> light,
                                  const vpoint& at) {
    vvec corner = load_broadcast_vec(field(light, &LightRecord::corner));
    vvec edge_u = load_broadcast_vec(field(light, &LightRecord::edge_u));
    vvec edge_v = load_broadcast_vec(field(light, &LightRecord::edge_v));
    return sample_area(c, s, light, madd(at.v, edge_v, madd(at.u, edge_u, corner)));
}

inline LightRays sample_disk(const Context& c, const Surface& s, pointer<LightRecord> light,
                             const vpoint& square) {
    vpoint at = concentric_disk(square);
    vvec middle = load_broadcast_vec(field(light, &LightRecord::corner));
    vvec edge_u = load_broadcast_vec(field(light, &LightRecord::edge_u));
    vvec edge_v = load_broadcast_vec(field(light, &LightRecord::edge_v));
    return sample_area(c, s, light, madd(at.v, edge_v, madd(at.u, edge_u, middle)));
}

/// A direction in the cone about the unit vector `axis` whose 1 - cos is `versine`, each solid angle as
/// likely as any other; `sine_square` of its angle to the axis. By 1 - cos, which is exact also for narrow
/// cones.
inline vvec sample_cone(const vvec& axis, const vpoint& square, const vfloat& versine, vfloat& sine_square) {
    vfloat own = square.u * versine;
    sine_square = own * (vfloat(2.0F) - own);
    sine_square = max(sine_square, 0.0F);
    vfloat radius = sqrt(sine_square);
    vfloat angle = square.v * 6.28318530717958647692F;
    vfloat x = radius * cos(angle);
    vfloat y = radius * sin(angle);
    vfloat z = vfloat(1.0F) - own;
    return to_world(axis, x, y, z);
}

/// Of the cone in which the sphere is seen (Shirley, Wang & Zimmerman, Monte Carlo Techniques for Direct
/// Lighting Calculations, 1996). Hits within the sphere see nothing of it.
inline LightRays sample_sphere(const Context& c, const Surface& s, pointer<LightRecord> light,
                               const vpoint& square) {
    vvec middle = load_broadcast_vec(field(light, &LightRecord::corner));
    vfloat radius = load_broadcast(field(light, &LightRecord::radius));
    vfloat inverse;
    LightRays l = rays_to(s, middle, inverse);
    vvec way = middle - s.position;
    vfloat away = dot(way, way);
    vfloat own = radius * radius;
    vmask outside = away > own;
    vfloat zero(0.0F);
    vfloat sine = radius * inverse;
    vfloat of_cone = min(sine * sine, 1.0F);
    vfloat versine = of_cone / (sqrt(vfloat(1.0F) - of_cone) + vfloat(1.0F));
    vfloat sine_square;
    vvec axis = l.rays.direction;
    l.rays.direction = sample_cone(axis, square, versine, sine_square);
    vfloat along = dot(way, l.rays.direction);
    vfloat depth = own - away * sine_square;
    vfloat first = along - sqrt(max(depth, 0.0F));
    l.rays.t_max = first * (1.0F - 1.0e-5F);
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vmask faces = outside & (cos_surface > zero);
    l.rays.active = s.hit & faces;
    vfloat spacing = load_broadcast(field(light, &LightRecord::spacing));
    leave_surface(c, s, growth_to_area(s.target, spacing, vfloat(1.0F), inverse), l.rays);
    l.weight = cos_surface * versine;
    return l;
}

/// The one ray to a point; of a spot as much as its cone lets through, a cubic of the cosine from its end to
/// where it is whole.
inline LightRays sample_point(const Context& c, const Surface& s, pointer<LightRecord> light) {
    vvec axis = load_broadcast_vec(field(light, &LightRecord::normal));
    vfloat end = load_broadcast(field(light, &LightRecord::cone_end));
    vfloat scale = load_broadcast(field(light, &LightRecord::cone_scale));
    vfloat inverse;
    LightRays l = rays_to(s, load_broadcast_vec(field(light, &LightRecord::corner)), inverse);
    vfloat zero(0.0F);
    vvec aside = axis + l.rays.direction; // |aside|^2 / 2 is 1 - cos, exact also for narrow cones
    vfloat versine = dot(aside, aside) * 0.5F;
    vfloat share = (end - versine) * scale;
    share = min(max(share, 0.0F), 1.0F);
    vfloat bend = fma(share, vfloat(-2.0F), vfloat(3.0F));
    vfloat smooth = (share * share) * bend;
    vfloat cos_surface = dot(s.shading, l.rays.direction);
    vmask faces = l.rays.active & (cos_surface > zero);
    faces = faces & (share > zero);
    l.rays.active = s.hit & faces;
    leave_surface(c, s, growth_to_area(s.target, zero, vfloat(1.0F), inverse), l.rays);
    vfloat received = cos_surface * smooth;
    l.weight = received * (inverse * inverse);
    return l;
}

inline LightRays sample_directional(const Context& c, const Surface& s, pointer<LightRecord> light,
                                    const vpoint& square) {
    vvec axis = load_broadcast_vec(field(light, &LightRecord::normal));
    vfloat versine = load_broadcast(field(light, &LightRecord::versine));
    vfloat sine_square;
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = sample_cone(axis, square, versine, sine_square);
    vfloat zero(0.0F);
    l.rays.t_min = zero;
    l.rays.t_max = vfloat(infinite);
    l.weight = dot(s.shading, l.rays.direction);
    l.rays.active = s.hit & (l.weight > zero);
    leave_surface(c, s, load_broadcast(field(light, &LightRecord::spacing)), l.rays);
    return l;
}

/// Of all shapes but rectangles.
inline LightRays sample_shape(const Context& c, const Surface& s, pointer<LightRecord> light,
                              const vpoint& at) {
    sint shape = load(field(light, &LightRecord::shape));
    if (branch(shape == light_point))
        return sample_point(c, s, light);
    if (branch(shape == light_disk))
        return sample_disk(c, s, light, at);
    if (branch(shape == light_sphere))
        return sample_sphere(c, s, light, at);
    return sample_directional(c, s, light, at);
}

/// How far from each other points of the light may be that rays go to.
inline sfloat extent_of(const Context& c, pointer<LightRecord> light) {
    sint shape = load(field(light, &LightRecord::shape));
    if (branch(shape == light_point))
        return 0.0F;
    svec u = load_svec(field(light, &LightRecord::edge_u));
    svec v = load_svec(field(light, &LightRecord::edge_v));
    sfloat square = dot(u, u);
    square = max(dot(v, v), square);
    if (branch(shape == light_rectangle))
        return sqrt(square);
    if (branch(shape == light_sphere))
        return load(field(light, &LightRecord::radius)) * 2.0F;
    if (branch(shape == light_directional)) {
        sfloat versine = load(field(light, &LightRecord::versine));
        sfloat sine_square = versine * (sfloat(2.0F) - versine);
        sfloat reach = load(field(c.frame, &FrameHeader::reach));
        sfloat across = reach * 2.0F;
        return sqrt(sine_square) * across;
    }
    return sqrt(square) * 2.0F;
}

/// A direction about the normal for each lane whose density is its cosine over pi, and that cosine.
inline vvec sample_cosine(const vvec& normal, const vpoint& square, vfloat& cosine) {
    vfloat radius = sqrt(square.u);
    cosine = sqrt(vfloat(1.0F) - square.u);
    vfloat angle = square.v * 6.28318530717958647692F;
    vfloat x = radius * cos(angle);
    vfloat y = radius * sin(angle);
    return to_world(normal, x, y, cosine);
}

/// A cosine-distributed direction about the shading normal for each lane. header.sky holds radiance /
/// samples.
inline LightRays sample_sky(const Context& c, const Surface& s, const vpoint& at) {
    LightRays l;
    l.rays.origin = s.position;
    vfloat height;
    l.rays.direction = sample_cosine(s.shading, at, height);
    vfloat zero(0.0F);
    l.rays.t_min = zero;
    l.rays.t_max = vfloat(infinite);
    l.rays.active = s.hit & (dot(s.geometric, l.rays.direction) > zero);
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::sky_spacing));
    leave_surface(c, s, growth_to_sky(spacing, height), l.rays);
    l.weight = vfloat(1.0F);
    return l;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
