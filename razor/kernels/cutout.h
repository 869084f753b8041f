// Rays through what textures cut out of surfaces: where the albedo map's opacity is below the material's
// cutoff, nothing is there (glTF 2.0, alpha mode MASK).
#pragma once

#include "razor/kernels/packet.h"
#include "razor/kernels/shade.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// So many holes a ray may pass in a row: what is behind all of them is there, whatever its opacity.
inline constexpr int most_holes = 64;
/// Beyond a hole rays go on so much further, of its distance.
inline constexpr float hole_step = 1.0e-6F;

/// Of these hits, which lie in holes.
[[gnu::noinline]] inline vmask find_holes(const Context& c, const Rays& r, const Hits& h) {
    Beyond beyond;
    Surface s = find_surface<look_mapped>(c, r, h, false, beyond);
    Materials of = materials_of(c, beyond.material, s.hit);
    vfloat cutoff = of.number(&MaterialRecord::alpha_cutoff);
    vmask may = s.hit & (cutoff > vfloat(0.0F));
    if (branch(none(may)))
        return may;
    vint map = gather(field(of.first, &MaterialRecord::map) + map_albedo, of.record, may);
    vvec opacity = mapped_colour<true>(c, map, beyond.map, may);
    return may & (opacity.x < cutoff);
}

/// trace_packet(), Mapped: past holes.
template <Features F, RayKind Kind, bool Mapped, bool AnyHit = Kind == kind_light || Kind == kind_sky>
inline Hits trace_seen(const Context& c, const Rays& r) {
    if constexpr (Mapped) {
        sint cutouts = load(field(c.frame, &FrameHeader::cutouts));
        if (branch(cutouts != 0)) {
            Rays left = r;
            Hits h = trace_packet<F, Kind, false>(c, left);
            for (sint n = 0; branch(n < most_holes); ++n) {
                vmask holes = left.active & find_holes(c, left, h);
                if (branch(none(holes)))
                    return h;
                left.active = holes;
                left.t_min = h.t * vfloat(1.0F + hole_step);
                Hits next = trace_packet<F, Kind, false>(c, left);
                h.t = select(holes, next.t, h.t);
                h.u = select(holes, next.u, h.u);
                h.v = select(holes, next.v, h.v);
                h.patch = select(holes, next.patch, h.patch);
                h.triangle = select(holes, next.triangle, h.triangle);
                h.block = select(holes, next.block, h.block);
                h.field = select(holes, next.field, h.field);
            }
            return h;
        }
    }
    return trace_packet<F, Kind, AnyHit>(c, r);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
