// What camera rays see, and no more: for reports of a frame that is rendered, or one that is not.
#pragma once

#include "razor/kernels/cutout.h"
#include "razor/kernels/render.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

template <Features F, bool Mapped> inline void see(const Context& c, const SeeArguments& l) {
    refit(c);
    clear_blends(c);
    Camera camera = load_camera(c);
    camera.lens = sbool(false);
    vpoint centre{vfloat(0.5F), vfloat(0.5F)};
    using in = pointer<const std::int32_t>;
    for (sint i = 0; branch(i < l.count); i += isa::width) {
        vmask active = first_lanes(sint(l.count) - i);
        vint column = load_vector(in(l.column) + i, active);
        vint row = load_vector(in(l.row) + i, active);
        Rays r = camera_rays(c, camera, column, row, centre, vint(0), vint(0), active);
        render_within_budget(c, [&](const Context& within) {
            Hits h = trace_seen<F, kind_camera, Mapped>(within, r);
            vvec point = madd(h.t, r.direction, r.origin);
            store_vector(pointer<float>(l.point[0]) + i, point.x, r.active);
            store_vector(pointer<float>(l.point[1]) + i, point.y, r.active);
            store_vector(pointer<float>(l.point[2]) + i, point.z, r.active);
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
