// What a kernel carries with it: the handles it loaded once from the frame header, in registers, and its
// worker's own.
// Each phase's code lies in an inline namespace of its own, PHASE_kernel, and the functions that enter a
// phase are not inlined: code_size.cmake reads the size of every phase's code off the symbols.
#pragma once

#include "isa/isa.h"
#include "razor/frame/counters.h"
#include "razor/frame/layout.h"
#include "razor/frame/phases.h"

#include <limits>

namespace razor::ISA_TARGET {

using namespace isa::ISA_TARGET;

using shared_int = isa::shared<std::int32_t>;

inline constexpr float infinity = std::numeric_limits<float>::infinity();
/// Distances beyond every scene, whose sums and products stay finite enough.
inline constexpr float infinite = 3.0e38F;

struct Context;
using OtherWork = bool(const Context&);
class HeldWords;

struct Context {
    pointer<FrameHeader> frame;
    pointer<WorkerRecord> self;
    pointer<TreeRecord> tree;
    pointer<OpenPatch> open;
    pointer<shared_int> curve_lengths;
    pointer<KdNode> nodes;
    pointer<Line> lists, grids;
    pointer<PatchRecord> patches;
    pointer<GraphNodeRecord> graph;
    pointer<InstanceRecord> instances;
    pointer<std::int32_t> cluster_instance;
    pointer<float> stack;   // traversal stack, then builders' scratch (scratch.h)
    pointer<float> packets; // rays in flight (scratch.h)
    pointer<float> blends;  // blocks lately blended (scratch.h)
    pointer<float> cuts;    // of the tree of lights (scratch.h), where there is one
    sint slot_floats;       // from one blended block to the next
    sbool discards;         // what is done with is said to be dead
    isa::page_service* pages = nullptr;
    Counters* counters = nullptr;    // of kind_none, or of the rays that are traced
    isa::mark_set* opened = nullptr; // graph nodes, then clusters of instances
    isa::stopwatch* watch = nullptr;
    isa::lap_timer* tiles = nullptr;
    isa::lap_timer* waits = nullptr; // for others
    Counters* by_kind = nullptr;     // all of the worker's, of kind_none first
    /// What else there is to do for a worker that must wait and holds nothing others wait for; false:
    /// nothing. Null: it only waits.
    OtherWork* other_work = nullptr;
    isa::memory_log* memory = nullptr; // with a budget; likewise:
    HeldWords* held = nullptr;         // by builders that were thrown out of a tile
};

inline Context make_context(pointer<FrameHeader> frame, sint worker) {
    Context c;
    c.frame = frame;
    pointer<WorkerRecord> workers = load(field(frame, &FrameHeader::workers));
    c.self = workers + worker;
    pointer<TreeRecord> trees = load(field(frame, &FrameHeader::trees));
    sint tree = load(field(c.self, &WorkerRecord::tree));
    c.tree = trees + tree;
    c.open = load(field(c.tree, &TreeRecord::patches));
    c.curve_lengths = load(field(c.tree, &TreeRecord::curve_lengths));
    c.nodes = load(field(frame, &FrameHeader::nodes));
    c.lists = load(field(frame, &FrameHeader::lists));
    c.grids = load(field(frame, &FrameHeader::grids));
    c.patches = load(field(frame, &FrameHeader::patches));
    c.graph = load(field(frame, &FrameHeader::graph));
    c.instances = load(field(frame, &FrameHeader::instances));
    c.cluster_instance = load(field(frame, &FrameHeader::cluster_instance));
    c.stack = load(field(c.self, &WorkerRecord::stack));
    c.packets = load(field(c.self, &WorkerRecord::packets));
    c.blends = load(field(c.self, &WorkerRecord::blends));
    c.cuts = load(field(c.self, &WorkerRecord::cuts));
    c.slot_floats = load(field(frame, &FrameHeader::slot_floats));
    sint discards = load(field(frame, &FrameHeader::discards));
    c.discards = discards != 0;
    return c;
}

/// Build states that builders left behind when they were thrown out of a tile that is to be begun again. They
/// are reset once the exception is caught: in the machine others hear of nothing that is written before.
class HeldWords {
public:
    HeldWords() = default;
    HeldWords(const HeldWords&) = delete;
    HeldWords& operator=(const HeldWords&) = delete;
    ~HeldWords() { release(); } // whatever else was thrown
    void add(pointer<shared_int> word, int idle) {
        if (count_ == most)
            return store_release(word, idle);
        held_[count_].word = word;
        held_[count_].idle = idle;
        ++count_;
    }
    void release() {
        for (int i = 0; i < most; ++i)
            if (i < count_)
                store_release(held_[i].word, held_[i].idle);
        count_ = 0;
    }

private:
    static constexpr int most = 8; // builds in progress one in the other: three
    struct {
        pointer<shared_int> word;
        int idle = 0;
    } held_[most];
    int count_ = 0;
};

/// Resets a build state if its builder is thrown out, so that others that wait try for themselves.
class BusyGuard {
public:
    BusyGuard(const Context& c, pointer<shared_int> word, int idle)
        : held_(c.held), word_(word), idle_(idle) {}
    BusyGuard(const BusyGuard&) = delete;
    BusyGuard& operator=(const BusyGuard&) = delete;
    ~BusyGuard() {
        if (published_)
            return;
        if (held_ != nullptr)
            held_->add(word_, idle_); // lint: allow memory because it lies on the worker's own stack
        else
            store_release(word_, idle_);
    }
    /// Everything written before is visible to whoever reads `state`.
    void publish(sint state) {
        store_release(word_, state);
        published_ = true;
    }

private:
    HeldWords* held_;
    pointer<shared_int> word_;
    int idle_;
    bool published_ = false;
};

/// Waits until another worker has changed the word from `value`; returns what it is then.
[[gnu::noinline]] inline sint await_other(const Context& c, pointer<shared_int> word, sint value) {
    tally(c.counters->waits, 1);
    begin_lap(*c.waits);
    sint seen = wait_while(word, value);
    end_lap(*c.waits, 0);
    return seen;
}

/// The same, but does other work first if there is some, a piece of it; the word may still be `value` then.
inline sint work_while(const Context& c, pointer<shared_int> word, sint value) {
    if (c.other_work != nullptr && c.other_work(c))
        return load_acquire(word);
    return await_other(c, word, value);
}

/// Returns once `state` is ready: by `build`, if nobody else has built or is building.
template <class Build> inline void build_once(const Context& c, pointer<shared_int> state, Build build) {
    sint seen = load_acquire(state);
    while (branch(seen != ready)) {
        if (branch(seen == absent)) {
            seen = compare_exchange(state, absent, busy);
            if (branch(seen == absent)) {
                BusyGuard guard(c, state, absent);
                build();
                guard.publish(ready);
                return;
            }
        } else {
            seen = await_other(c, state, busy);
        }
    }
}

} // namespace razor::ISA_TARGET
