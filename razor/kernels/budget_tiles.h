// Tiles within a memory budget: who renders while memory is dropped, and what happens to a tile that finds no
// more.
#pragma once

#include "razor/kernels/budget_drop.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

/// Returns once the gate is open.
inline void wait_at_gate(const Context& c, pointer<shared_int> gate) {
    sint seen = load_acquire(gate);
    if (branch(seen >= gate_closed))
        note_event(*c.memory, budget_wait);
    while (branch(seen >= gate_closed))
        seen = wait_while(gate, seen);
}

/// The worker renders from now on: until it leaves, nothing is dropped.
inline void enter(const Context& c, pointer<shared_int> gate) {
    sint others = fetch_add(gate, 1);
    while (branch(others >= gate_closed)) {
        fetch_add(gate, -1);
        wait_at_gate(c, gate);
        others = fetch_add(gate, 1);
    }
}
inline void leave(pointer<shared_int> gate) {
    fetch_add(gate, -1);
}

/// Closes the gate and returns once nobody renders; false if another did, once it is open again.
inline sbool close_gate(const Context& c, pointer<shared_int> gate) {
    sint seen = load_acquire(gate);
    for (;;) {
        if (branch(seen >= gate_closed)) {
            wait_at_gate(c, gate);
            return false;
        }
        sint before = compare_exchange(gate, seen, seen + gate_closed);
        if (branch(before == seen))
            break;
        seen = before;
    }
    seen = seen + gate_closed;
    while (branch(seen != gate_closed))
        seen = wait_while(gate, seen);
    return true;
}
inline void open_gate(pointer<shared_int> gate) {
    fetch_add(gate, -gate_closed);
}

/// What a worker does before a tile, the gate being held.
inline void begin_bounded(const Context& c, pointer<WorkerBudget> own, pointer<TreeBudget> tree) {
    sint era = load(field(tree, &TreeBudget::era));
    sint known = load(field(own, &WorkerBudget::era));
    if (branch(era != known)) {
        clear_blends(c); // they are named by lines
        store(field(own, &WorkerBudget::era), era);
    }
    sint epoch = epoch_now(tree);
    sint before = load(field(own, &WorkerBudget::epoch));
    if (branch(epoch != before)) {
        put_to_sleep(c, own);
        store(field(own, &WorkerBudget::epoch), epoch);
    }
    store(field(own, &WorkerBudget::tile_grains), 0);
}

/// Whether what is free will not do for a tile of each worker, if they take as much as the worker's last one.
inline sbool is_short(pointer<WorkerBudget> own, pointer<TreeBudget> tree) {
    sint cursor = load_acquire(field(tree, &TreeBudget::cursor));
    sint grains = load(field(tree, &TreeBudget::grains));
    sfloat share = load(field(tree, &TreeBudget::free_share));
    sint workers = load(field(tree, &TreeBudget::workers));
    sint wanted = load(field(own, &WorkerBudget::tile_grains)) * workers;
    sbool begun = cursor > 0; // something was taken since the last time
    sfloat unused = to_float(grains - cursor) * share;
    return begun & (unused < to_float(wanted));
}

/// Renders a tile; false if there was not enough memory for it.
template <class Tile> inline bool fits(const Context& c, Tile tile) {
    HeldWords held;
    Context own = c;
    own.held = &held;
    const bool done = isa::ends_without_trap(trap_memory_spent, [&] { tile(own); });
    if (!done)
        held.release();
    return done;
}

/// Holds the gate open for others, or shut, until its end, however that comes.
template <class Release> class GateGuard {
public:
    explicit GateGuard(Release release) : release_(release) {}
    GateGuard(const GateGuard&) = delete;
    GateGuard& operator=(const GateGuard&) = delete;
    ~GateGuard() { release_(); }

private:
    Release release_;
};

/// How often a worker tries to render a tile while the others wait. The first time the arena is empty; then
/// it holds what the tile was found to need, without lists and the like that were only needed on the way.
inline constexpr int alone_tries = 4;

template <class Tile>
[[gnu::noinline]] inline void render_bounded(const Context& c, pointer<WorkerBudget> own, Tile tile) {
    pointer<TreeBudget> tree = load(field(own, &WorkerBudget::tree));
    pointer<shared_int> gate = field(tree, &TreeBudget::gate);
    sbool fresh = true;
    for (sint failed = 0;;) {
        {
            enter(c, gate);
            GateGuard guard([&] { leave(gate); });
            sbool wait = fresh & is_short(own, tree);
            fresh = false;
            if (branch(!wait)) {
                begin_bounded(c, own, tree);
                if (fits(c, tile))
                    return;
                note_event(*c.memory, budget_restart);
                ++failed;
            }
        }
        if (branch(!close_gate(c, gate)))
            continue;
        GateGuard guard([&] { open_gate(gate); });
        drop_oldest(c, tree, failed > 1);
        if (branch(failed > 1)) {
            note_event(*c.memory, budget_alone);
            for (int left = alone_tries; left > 0; --left) {
                begin_bounded(c, own, tree);
                if (fits(c, tile))
                    return;
                drop_oldest(c, tree, false);
            }
            trap(trap_budget_too_small);
        }
    }
}

/// Calls tile(context) once, or with a memory budget until it has what it needs.
template <class Tile> inline void render_within_budget(const Context& c, Tile tile) {
    pointer<WorkerBudget> own = budget_of(c);
    if (branch(is_null(own)))
        tile(c);
    else
        render_bounded(c, own, tile);
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
