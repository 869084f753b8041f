// A sky that a map shows, by longitude and latitude: what rays see of it, and directions sampled by its
// brightness (razor/frame/sky_record.h).
#pragma once

#include "razor/frame/sky_record.h"
#include "razor/kernels/light.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// A direction on the map: turns along it, and the share of the way from straight up to straight down.
struct SkyPlace {
    vfloat across, down;
    vfloat sine; // of the angle from straight up
};

inline SkyPlace place_in_sky(pointer<SkyRecord> sky, const vvec& direction) {
    vfloat level = fma(direction.x, direction.x, direction.z * direction.z);
    SkyPlace p;
    p.sine = sqrt(level);
    vfloat longitude = atan2(direction.x, -direction.z);
    vfloat from_up = atan2(p.sine, direction.y);
    vfloat turn = load_broadcast(field(sky, &SkyRecord::turn)) + vfloat(0.5F);
    constexpr float turns = 0.159154943091895336F; // 1 / (2 pi)
    p.across = fma(longitude, vfloat(turns), turn);
    p.across = p.across - floor(p.across);
    p.down = from_up * (2.0F * turns);
    return p;
}

/// The map's colour there, for rays that stand for so much solid angle each; 0: as sharp as it is.
inline vvec sky_colour(const Context& c, pointer<SkyRecord> sky, const SkyPlace& p, const vfloat& solid_angle,
                       const vmask& m) {
    vfloat zero(0.0F);
    Mapping at;
    at.at.u = p.across;
    at.at.v = vfloat(1.0F) - p.down;
    constexpr float per_steradian = 0.0506605918211688857F; // 1 / (2 pi^2): of the map, on the horizon
    vfloat shrunk = max(p.sine, 1.0e-4F);
    at.footprint = (solid_angle * per_steradian) / shrunk;
    at.along_u = at.along_v = {zero, zero, zero};
    sint number = load(field(sky, &SkyRecord::map));
    pointer<MapRecord> maps = load(field(c.frame, &FrameHeader::maps));
    return sample_map<false>(c, maps + number, at, m);
}

/// Of `count` intervals of each lane the one that x in [0, 1) lies in: the last whose sum does not exceed it.
/// `sums`: from word `first` of each lane on. `largest_step`: a power of two, no less than the largest below
/// any count.
inline vint find_interval(pointer<float> sums, const vint& first, const vint& count, sint largest_step,
                          const vfloat& x, const vmask& m) {
    vint found(0);
    for (sint step = largest_step; branch(step > 0); step = step >> 1) {
        vint next = found + vint(step);
        vmask within = m & (next < count);
        vfloat sum = gather(sums, first + next, within);
        found = select(within & (sum <= x), next, found);
    }
    return found;
}

/// Where x lies in the interval, in [0, 1], and how long that is.
inline vfloat within_interval(pointer<float> sums, const vint& at, const vfloat& x, const vmask& m,
                              vfloat& length) {
    vfloat low = gather(sums, at, m);
    vfloat high = gather(sums, at + vint(1), m);
    length = high - low;
    vfloat divisor = max(length, 1.0e-30F);
    vfloat share = (x - low) / divisor;
    return min(max(share, 0.0F), 1.0F);
}

/// A direction for each lane, and its density by solid angle.
struct SkySample {
    vvec direction;
    vfloat density;
};

[[gnu::noinline]] inline SkySample sample_sky_direction(pointer<SkyRecord> sky, const vpoint& square,
                                                        const vmask& m) {
    pointer<float> row_sums = load(field(sky, &SkyRecord::row_sums));
    pointer<float> cell_sums = load(field(sky, &SkyRecord::cell_sums));
    pointer<float> heights = load(field(sky, &SkyRecord::heights));
    pointer<float> row_density = load(field(sky, &SkyRecord::row_density));
    sint rows = load(field(sky, &SkyRecord::rows));
    sint columns = load(field(sky, &SkyRecord::columns));
    sint row_step = load(field(sky, &SkyRecord::row_step));
    sint column_step = load(field(sky, &SkyRecord::column_step));
    vint row = find_interval(row_sums, vint(0), vint(rows), row_step, square.v, m);
    vfloat chance;
    vfloat down = within_interval(row_sums, row, square.v, m, chance);
    vint first = row * vint(columns + 1);
    vint column = find_interval(cell_sums, first, vint(columns), column_step, square.u, m);
    vfloat across = within_interval(cell_sums, first + column, square.u, m, chance);
    SkySample s;
    s.density = gather(row_density, row, m) * chance;
    vfloat upper = gather(heights, row, m);
    vfloat lower = gather(heights, row + vint(1), m);
    vfloat height = fma(down, lower - upper, upper);
    vfloat above = vfloat(1.0F) - height;
    vfloat level = above * (vfloat(1.0F) + height);
    vfloat sine = sqrt(max(level, 0.0F));
    vfloat place = to_float(column) + across;
    place = place / vfloat(to_float(columns));
    vfloat turn = load_broadcast(field(sky, &SkyRecord::turn)) + vfloat(0.5F);
    vfloat longitude = (place - turn) * 6.28318530717958647692F;
    vfloat x = sine * sin(longitude);
    vfloat z = sine * cos(longitude);
    s.direction = {x, height, -z};
    return s;
}

/// With which density directions there are sampled.
inline vfloat sky_density(pointer<SkyRecord> sky, const SkyPlace& p, const vmask& m) {
    pointer<float> cell_sums = load(field(sky, &SkyRecord::cell_sums));
    pointer<float> row_density = load(field(sky, &SkyRecord::row_density));
    sint rows = load(field(sky, &SkyRecord::rows));
    sint columns = load(field(sky, &SkyRecord::columns));
    vint row = to_int(p.down * vfloat(to_float(rows)));
    row = min(row, vint(rows - 1));
    vint column = to_int(p.across * vfloat(to_float(columns)));
    column = min(column, vint(columns - 1));
    vint cell = row * vint(columns + 1);
    cell = cell + column;
    vfloat low = gather(cell_sums, cell, m);
    vfloat high = gather(cell_sums, cell + vint(1), m);
    vfloat chance = high - low;
    return gather(row_density, row, m) * chance;
}

/// A shadow ray for each lane.
inline LightRays sample_mapped_sky(const Context& c, pointer<SkyRecord> sky, const Surface& s,
                                   const vpoint& at) {
    SkySample way = sample_sky_direction(sky, at, s.hit);
    LightRays l;
    l.rays.origin = s.position;
    l.rays.direction = way.direction;
    vfloat zero(0.0F);
    l.rays.t_min = zero;
    l.rays.t_max = vfloat(infinite);
    vfloat cosine = dot(s.shading, way.direction);
    vmask above = cosine > zero;
    above = above & (dot(s.geometric, way.direction) > zero);
    above = above & (way.density > zero);
    l.rays.active = s.hit & above;
    vfloat spacing = load_broadcast(field(c.frame, &FrameHeader::sky_spacing));
    vfloat density = max(way.density, 1.0e-12F);
    leave_surface(c, s, spacing * reciprocal_sqrt(density), l.rays);
    l.weight = cosine / density;
    return l;
}

/// What another response makes of light that has a colour of its own from each direction: red, green and blue
/// of each lobe.
template <class Response> struct Tinted {
    static constexpr int lobes = 3 * Response::lobes;
    Response response;
    Tinted permuted(const vint& from) const { return {response.permuted(from)}; }
};
/// What each lobe makes of it, times the colour.
template <int lobes>
inline void tint(const vfloat (&lobe)[lobes], const vvec& colour, vfloat (&part)[3 * lobes]) {
    for (int k = 0; k < lobes; ++k) {
        part[3 * k] = lobe[k] * colour.x;
        part[3 * k + 1] = lobe[k] * colour.y;
        part[3 * k + 2] = lobe[k] * colour.z;
    }
}

/// Samples are spread over all directions by density alone.
struct UnitDomain {
    vfloat load() const { return vfloat(1.0F); }
};

struct TowardsMappedSky {
    static constexpr RayKind kind = kind_sky;
    const Context& context;
    pointer<SkyRecord> sky;
    sint dimension() const { return sint(dimension_sky); }
    sfloat extent(const Context&) const { return infinite; }
    LightRays sample(const Context& c, const Surface& s, const vpoint& at) const {
        return sample_mapped_sky(c, sky, s, at);
    }
    template <class Response>
    void reflect(const Tinted<Response>& r, const Surface& s, const LightRays& l, sint samples,
                 vfloat (&part)[3 * Response::lobes]) const {
        vfloat own[Response::lobes];
        r.response.reflect(s, l, UnitDomain{}, samples, own);
        SkyPlace place = place_in_sky(sky, l.rays.direction);
        vvec colour = sky_colour(context, sky, place, vfloat(0.0F), l.rays.active);
        tint(own, colour, part);
    }
};

/// As Gathered, in colours.
template <class Response> struct GatheredColours {
    Gathered<Tinted<Response>> parts;
    vvec of(int lobe) const {
        return {parts.lobe[3 * lobe], parts.lobe[3 * lobe + 1], parts.lobe[3 * lobe + 2]};
    }
};
template <Features F, class Response>
inline GatheredColours<Response> gather_mapped_sky(const Context& c, pointer<SkyRecord> sky, const Surface& s,
                                                   const Response& response, sint samples) {
    return {gather_light<F, true>(c, s, TowardsMappedSky{c, sky}, Tinted<Response>{response}, samples)};
}

/// What rays that hit nothing see of it. `density`: of the directions that they took, beside which `samples`
/// shadow rays went to the sky from where they left; what those have of it is left to them. Mirrors and
/// cameras leave nothing, and see the map no sharper than they ask for.
[[gnu::noinline]] inline vvec see_mapped_sky(const Context& c, pointer<SkyRecord> sky, const Rays& r,
                                             const vfloat& density, sint samples, const vmask& m) {
    phase_scope phase(phase_light);
    SkyPlace place = place_in_sky(sky, r.direction);
    vfloat number(to_float(samples));
    vfloat of_samples = sky_density(sky, place, m) * number;
    vfloat share = vfloat(1.0F) - power_share(of_samples, density);
    vmask sharp = density >= vfloat(delta_density);
    vfloat asked = select(sharp, r.growth * r.growth, vfloat(0.0F));
    vvec colour = sky_colour(c, sky, place, asked, m);
    vvec radiance = load_broadcast_vec(field(c.frame, &FrameHeader::background));
    return times(radiance * share, colour);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
