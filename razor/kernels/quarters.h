// The points that neighbouring hits sample on a light, four of each at a time, dealt so that packets hold
// like ones: a packet of the first points of 32 hits sees about a quarter of the light, one of four points of
// eight hits all of it. What each hit samples is the same; rays of a packet keep together, so that they meet
// fewer nodes and blocks and fall into fewer groups.
#pragma once

#include "razor/frame/scratch.h"
#include "razor/kernels/sampling.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// A point of each lane, and which of its four it is.
struct Dealt {
    vpoint at;
    vint number;
};

/// Exchanges points where b's coordinate `by` is the smaller one.
inline void exchange(vfloat vpoint::*by, Dealt& a, Dealt& b) {
    vmask swapped = b.at.*by < a.at.*by;
    Dealt low{{select(swapped, b.at.u, a.at.u), select(swapped, b.at.v, a.at.v)},
              select(swapped, b.number, a.number)};
    Dealt high{{select(swapped, a.at.u, b.at.u), select(swapped, a.at.v, b.at.v)},
               select(swapped, a.number, b.number)};
    a = low;
    b = high;
}

struct Quarters {
    Dealt point[quarters];
};

/// Of each lane's points first the two of least u, and of either two first that of less v. Points that are
/// beyond all others in both stay last.
inline void deal(Quarters& q) {
    exchange(&vpoint::u, q.point[0], q.point[2]);
    exchange(&vpoint::u, q.point[1], q.point[3]);
    exchange(&vpoint::u, q.point[0], q.point[3]);
    exchange(&vpoint::u, q.point[1], q.point[2]);
    exchange(&vpoint::v, q.point[0], q.point[1]);
    exchange(&vpoint::v, q.point[2], q.point[3]);
}

/// The point that each hit samples as its number k of `samples`, from `first` of its pixel on, where every
/// four of them are dealt.
[[gnu::noinline]] inline Dealt dealt_point(const Context& c, const vint& pixel, const vint& first, sint k,
                                           sint samples, sint dimension) {
    phase_scope phase(phase_light);
    pointer<float> kept = c.packets + packet_quarters;
    sint quarter = k & (quarters - 1);
    if (branch(quarter == 0)) {
        Quarters q;
        for (int i = 0; i < quarters; ++i) {
            q.point[i].number = vint(i);
            q.point[i].at = {vfloat(2.0F), vfloat(2.0F)}; // one too many is beyond all others
            if (branch(k + i < samples))
                q.point[i].at = sample_square(pixel, first + vint(k + i), dimension);
        }
        deal(q);
        for (int i = 0; i < quarters; ++i) {
            store_vector(kept + 3 * i * isa::width, q.point[i].at.u);
            store_vector(kept + (3 * i + 1) * isa::width, q.point[i].at.v);
            store_vector(as<std::int32_t>(kept + (3 * i + 2) * isa::width), q.point[i].number);
        }
    }
    kept = kept + quarter * (3 * isa::width);
    Dealt d;
    d.at = {load_vector(kept), load_vector(kept + isa::width)};
    d.number = load_vector(as<std::int32_t>(kept + 2 * isa::width));
    return d;
}

/// What the surface makes of four points is kept by their numbers, to be added up in their order: then sums
/// have the bits that they have in packets of several points of each hit.
inline pointer<float> parts_of(const Context& c, int lobe) {
    return c.packets + (packet_parts + lobe * (quarters * isa::width));
}
inline void clear_parts(const Context& c, int lobe) {
    for (int i = 0; i < quarters; ++i)
        store_vector(parts_of(c, lobe) + i * isa::width, vfloat(0.0F));
}
inline void keep_part(const Context& c, int lobe, const vint& number, const vfloat& part) {
    pointer<float> at = parts_of(c, lobe);
    for (int i = 0; i < quarters; ++i) {
        vmask own = number == vint(i);
        store_vector(at, part, own);
        at = at + isa::width;
    }
}
inline vfloat sum_of_parts(const Context& c, int lobe) {
    pointer<float> parts = parts_of(c, lobe);
    vfloat first = load_vector(parts);
    vfloat second = load_vector(parts + isa::width);
    vfloat third = load_vector(parts + 2 * isa::width);
    vfloat fourth = load_vector(parts + 3 * isa::width);
    first = first + second;
    third = third + fourth;
    return first + third;
}
/// Whether sample k is the first or the last of a four.
inline sbool begins_quarters(sint k) {
    return (k & (quarters - 1)) == 0;
}
inline sbool ends_quarters(sint k, sint samples) {
    sint next = k + 1;
    sbool last = next == samples;
    return last | begins_quarters(next);
}

/// Dealing pays where hits are so many that few lanes have none; nearer to each other, along each axis, than
/// this share of how far apart points of the light are; and few of them on blocks of several cells, as there
/// the cells that rays leave from are many in a packet of many hits, and take longer than is spared on the
/// way (showcase: a third more tests of quads, a tenth more time).
inline constexpr int least_dealt_hits = isa::width / 2;
inline constexpr float hits_beside_light = 0.5F;
inline constexpr int fine_hits = 4; // one in so many at most

/// `place`: of the lanes that hit; `fine`: those on blocks of several cells; `extent`: of the light.
[[gnu::noinline]] inline sbool quarters_pay(const vvec& place, const vmask& hit, const vmask& fine,
                                            sfloat extent) {
    sint hits = count(hit);
    sbool pays = hits > least_dealt_hits;
    pays = pays & (count(hit & fine) * fine_hits <= hits);
    if (branch(!pays))
        return false;
    vfloat far(infinite);
    const vfloat* along[3] = {&place.x, &place.y, &place.z};
    sfloat near = extent * hits_beside_light;
    for (const vfloat* at : along) {
        sfloat least = reduce_min(select(hit, *at, far));
        sfloat most = reduce_max(select(hit, *at, -far));
        pays = pays & (most - least <= near);
    }
    return pays;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
