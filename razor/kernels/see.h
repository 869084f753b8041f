// What camera rays see, and no more: for reports of a frame that is rendered, or one that is not.
#pragma once

#include "razor/kernels/cutout.h"
#include "razor/kernels/render.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

template <Features F, bool Mapped> inline void see(const Context& c, const SeeArguments& l) {
    refit(c);
    clear_blends(c);
    using in = pointer<const float>;
    for (sint i = 0; branch(i < l.count); i += isa::width) {
        Rays r;
        r.active = first_lanes(sint(l.count) - i);
        r.origin = load_broadcast_vec(field(c.frame, &FrameHeader::camera));
        r.direction.x = load_vector(in(l.direction[0]) + i, r.active);
        r.direction.y = load_vector(in(l.direction[1]) + i, r.active);
        r.direction.z = load_vector(in(l.direction[2]) + i, r.active);
        r.t_min = vfloat(0.0F);
        r.t_max = vfloat(infinite);
        ask_for_camera(c, r);
        render_within_budget(c, [&](const Context& within) {
            Hits h = trace_seen<F, kind_camera, Mapped>(within, r);
            store_vector(pointer<float>(l.t) + i, h.t, r.active);
            store_vector(pointer<float>(l.u) + i, h.u, r.active);
            store_vector(pointer<float>(l.v) + i, h.v, r.active);
            store_vector(pointer<std::int32_t>(l.patch) + i, h.patch, r.active);
            store_vector(pointer<std::int32_t>(l.triangle) + i, h.triangle, r.active);
            store_vector(pointer<std::int32_t>(l.block) + i, h.block, r.active);
        });
    }
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
