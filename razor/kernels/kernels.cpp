#include "razor/frame/kernel_table.h"
#include "razor/kernels/render.h"

namespace razor::ISA_TARGET {

namespace {

Context begin(const WorkerArguments& a) {
    Context c = make_context(pointer<FrameHeader>(a.frame), sint(a.worker));
    c.pages = a.pages;
    c.counters = a.counters;
    c.opened = a.opened;
    c.watch = a.watch;
    return c;
}

template <Features F> void render(const WorkerArguments& a) {
    render_worker<F>(begin(a));
}

template <Features F> void trace_all(const WorkerArguments& w, const TraceArguments& a) {
    Context c = begin(w);
    refit(c);
    using in = pointer<const float>;
    for (sint i = 0; branch(i < a.count); i += isa::width) {
        Rays r;
        r.active = first_lanes(sint(a.count) - i);
        r.origin.x = load_vector(in(a.origin[0]) + i, r.active);
        r.origin.y = load_vector(in(a.origin[1]) + i, r.active);
        r.origin.z = load_vector(in(a.origin[2]) + i, r.active);
        r.direction.x = load_vector(in(a.direction[0]) + i, r.active);
        r.direction.y = load_vector(in(a.direction[1]) + i, r.active);
        r.direction.z = load_vector(in(a.direction[2]) + i, r.active);
        r.t_min = load_vector(in(a.t_min) + i, r.active);
        r.t_max = load_vector(in(a.t_max) + i, r.active);
        r.field_origin = r.origin;
        r.radius = vfloat(0.0F);
        r.leader = lane_index();
        if (a.base == nullptr) {
            fix_target(least_target, r);
        } else {
            r.base = load_vector(in(a.base) + i, r.active);
            r.growth = load_vector(in(a.growth) + i, r.active);
            r.slope.x = load_vector(in(a.slope[0]) + i, r.active);
            r.slope.y = load_vector(in(a.slope[1]) + i, r.active);
            r.slope.z = load_vector(in(a.slope[2]) + i, r.active);
        }
        if (a.any_hit) {
            Hits h = trace<F, true>(c, r);
            store_vector(pointer<std::int32_t>(a.patch) + i, h.patch, r.active);
        } else {
            Hits h = trace<F, false>(c, r);
            store_vector(pointer<float>(a.t) + i, h.t, r.active);
            store_vector(pointer<float>(a.u) + i, h.u, r.active);
            store_vector(pointer<float>(a.v) + i, h.v, r.active);
            store_vector(pointer<std::int32_t>(a.patch) + i, h.patch, r.active);
            store_vector(pointer<std::int32_t>(a.triangle) + i, h.triangle, r.active);
        }
    }
}

/// Nodes lie one after the other in the arena, children behind their parents.
void build_all(const WorkerArguments& w) {
    Context c = begin(w);
    refit(c);
    ensure_root(c);
    sint number = load(field(c.tree, &TreeRecord::root));
    sint end = load(field(c.self, &WorkerRecord::node_next));
    while (branch(number < end)) {
        pointer<KdNode> node = c.nodes + number;
        sint state = load_acquire(field(node, &KdNode::state));
        split_node(c, node, state);
        ++number;
        end = load(field(c.self, &WorkerRecord::node_next));
    }
}

constexpr Features flat{.hanging = false};
constexpr Features hanging{.hanging = true};
#define RAZOR_NAME(target) #target
#define RAZOR_TARGET_NAME(target) RAZOR_NAME(target)

} // namespace

constinit const KernelTable kernels = {RAZOR_TARGET_NAME(ISA_TARGET),
                                       isa::width,
                                       {render<flat>, render<hanging>},
                                       {trace_all<flat>, trace_all<hanging>},
                                       build_all};

} // namespace razor::ISA_TARGET
