// A packet of rays of one kind.
#pragma once

#include "razor/kernels/traverse.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

/// Traces a packet as trace() does: camera rays and bounces to their closest hits, shadow rays to any, unless
/// stated otherwise. What that takes and builds counts for the kind.
template <Features F, RayKind Kind, bool AnyHit = Kind == kind_light || Kind == kind_sky>
inline Hits trace_packet(const Context& c, const Rays& r) {
    Context own = c;
    own.counters = c.counters + Kind;
    tally(own.counters->packets, 1);
    tally(own.counters->rays, count(r.active));
    kind_scope kind(Kind);
    lane_scope lanes(r.active);
    return trace<F, AnyHit>(own, r);
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
