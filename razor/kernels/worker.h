// What a target's table of kernels is made of: how a worker begins.
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/kernels/render.h"

namespace razor::ISA_TARGET {

inline constexpr Features flat{.hanging = false};
inline constexpr Features hanging{.hanging = true};

inline Context begin(const WorkerArguments& a) {
    Context c = make_context(pointer<FrameHeader>(a.frame), sint(a.worker));
    c.pages = a.pages;
    c.counters = c.by_kind = a.counters;
    c.opened = a.opened;
    c.watch = a.watch;
    c.tiles = a.tiles;
    c.waits = a.waits;
    c.memory = a.memory;
    return c;
}

template <Features F, class Sampler> void render(const WorkerArguments& a) {
    Context c = begin(a);
    if (a.memory == nullptr) // else a tile may have to be begun again
        c.other_work = render_meanwhile<F, Sampler>;
    render_worker<F, Sampler>(c);
}

/// Compiled apart, see apart.h.
template <Features F> void render_mapped(const WorkerArguments& a);
template <Features F> void see_mapped(const WorkerArguments& a, const SeeArguments& l);
template <Features F> void render_glossy(const WorkerArguments& a);
template <Features F> void render_glossy_mapped(const WorkerArguments& a);

} // namespace razor::ISA_TARGET
