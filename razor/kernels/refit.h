// Refitting: the boxes of clusters of meshes, in mesh coordinates, by all workers together, however often the
// meshes are drawn: of those that the header lists, as others keep theirs from frame to frame. What lies
// above, instances and groups, has its boxes from the host: they move with transforms, not with control
// points.
#pragma once

#include "razor/kernels/hull.h"

namespace razor::ISA_TARGET {
inline namespace animate_kernel {

inline void refit_cluster(const Context& c, const Cage& g, sint cluster) {
    sint stride = load(field(c.frame, &FrameHeader::clusters_stride));
    pointer<float> boxes = load(field(c.frame, &FrameHeader::cluster_boxes));
    pointer<std::int32_t> counts = load(field(c.frame, &FrameHeader::cluster_patches));
    sint count = load(counts + cluster);
    vfloat big(3.0e38F);
    vfloat small(-3.0e38F);
    vvec low{big, big, big};
    vvec high{small, small, small};
    pointer<float> displacements = load(field(c.frame, &FrameHeader::cluster_displacements));
    sfloat displacement = 0.0F;
    if (branch(!is_null(displacements)))
        displacement = load(displacements + cluster);
    for (sint from = 0; branch(from < count); from += isa::width) {
        vmask m = first_lanes(count - from);
        vint record = lane_index() + vint((cluster << refit_log2) + from);
        Hulls h = hulls_of<false>(g, c.patches, record, m);
        vfloat slack = largest(h.high - h.low) * hull_growth;
        slack = fma(h.reach, vfloat(hull_rounding), slack);
        slack = slack + vfloat(displacement);
        vvec wide{slack, slack, slack};
        vvec lower = h.low - wide;
        vvec upper = h.high + wide;
        lower = {min(lower.x, low.x), min(lower.y, low.y), min(lower.z, low.z)};
        upper = {max(upper.x, high.x), max(upper.y, high.y), max(upper.z, high.z)};
        low = select(m, lower, low);
        high = select(m, upper, high);
    }
    vfloat lows[3] = {low.x, low.y, low.z};
    vfloat highs[3] = {high.x, high.y, high.z};
    for (int k = 0; k < 3; ++k) {
        pointer<float> out = boxes + stride * k + cluster;
        store(out, reduce_min(lows[k]));
        out = out + stride * 3;
        store(out, reduce_max(highs[k]));
    }
}

/// Refits every cluster that is listed once, whoever takes part; returns when all are done.
[[gnu::noinline]] inline void refit(const Context& c) {
    phase_scope phase(phase_animate);
    pointer<QueueRecord> queues = load(field(c.frame, &FrameHeader::queues));
    sint clusters = load(field(c.frame, &FrameHeader::refit_count));
    pointer<std::int32_t> listed = load(field(c.frame, &FrameHeader::refit_list));
    Cage g = load_topology(c);
    sint next = fetch_add(field(queues, &QueueRecord::next_refit), 1);
    while (branch(next < clusters)) {
        sint cluster = load(listed + next);
        refit_cluster(c, g, cluster);
        fetch_add(field(queues, &QueueRecord::refitted), 1);
        next = fetch_add(field(queues, &QueueRecord::next_refit), 1);
    }
    sint done = load_acquire(field(queues, &QueueRecord::refitted));
    while (branch(done != clusters))
        done = await_other(c, field(queues, &QueueRecord::refitted), done);
    note_time(*c.watch, moment_refitted);
}

} // namespace animate_kernel
} // namespace razor::ISA_TARGET
