#include "razor/kernels/matte.h"
#include "razor/kernels/worker.h"

namespace razor::ISA_TARGET {

namespace {

template <Features F> void trace_all(const WorkerArguments& w, const TraceArguments& a) {
    Context c = begin(w);
    refit(c);
    clear_blends(c);
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
        sint number = load(field(c.self, &WorkerRecord::next_field));
        r.number = lane_index() + vint(number);
        store(field(c.self, &WorkerRecord::next_field), number + isa::width);
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

/// The blocks that a leaf lists.
void make_listed(const Context& c, pointer<KdNode> leaf) {
    sint line = load(field(leaf, &KdNode::link));
    if (branch(line < 0))
        return;
    List l = read_list(c, line);
    for (sint i = 0; branch(i < l.count); ++i) {
        sint block = sint(-1) - load(l.items + i);
        ensure_made(c, as<BlockHeader>(c.grids + block));
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
        state = split_node(c, node, state);
        if (branch(state == node_leaf))
            make_listed(c, node);
        ++number;
        end = load(field(c.self, &WorkerRecord::node_next));
    }
}

/// Depth first, the blocks left to look at on the traversal stack.
void dice_all(const WorkerArguments& w) {
    Context c = begin(w);
    refit(c);
    Rays r;
    ask_for_camera(c, r);
    FieldBounds asked = bound_fields(r, vmask(true));
    sfloat slack = position_slack(c);
    sint patches = load(field(c.frame, &FrameHeader::patch_count));
    pointer<std::int32_t> left = as<std::int32_t>(c.stack);
    for (sint patch = 0; branch(patch < patches); ++patch) {
        sint instance = load(c.cluster_instance + (patch >> refit_log2));
        pointer<InstanceRecord> record = c.instances + instance;
        sint first = load(field(record, &InstanceRecord::first_patch));
        sint count = load(field(record, &InstanceRecord::patch_count));
        if (branch(patch - first >= count))
            continue;
        svec origin = load_svec(field(record, &InstanceRecord::origin));
        pointer<OpenPatch> open = open_patch(c, patch);
        sint root = load(field(open, &OpenPatch::root));
        store(left, root);
        sint depth = 1;
        while (branch(depth > 0)) {
            --depth;
            sint line = load(left + depth);
            pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
            sint level = load(field(block, &BlockHeader::level));
            sint absolute = load(field(block, &BlockHeader::absolute));
            svec low = load_svec(field(block, &BlockHeader::box_low)) + origin;
            svec high = load_svec(field(block, &BlockHeader::box_high)) + origin;
            sfloat least = least_target_in(asked, low, high, slack);
            sbool finer = least < power_of_two(absolute);
            if (branch(finer & (level > 0))) {
                ensure_children(c, line, block);
                sint child = load(field(block, &BlockHeader::child_line));
                sint shape = load(field(block, &BlockHeader::child_shape));
                sint lines = lines_between(shape);
                sint children = children_in(shape);
                for (sint i = children; branch(i > 0); --i) {
                    store(left + depth, child);
                    child = child + lines;
                    ++depth;
                }
            } else {
                ensure_made(c, block);
                ensure_normals(c, line);
            }
        }
    }
}

void place_tiles(const WorkerArguments& w, std::int32_t* places) {
    Context c = begin(w);
    sint columns = load(field(c.frame, &FrameHeader::tiles_x));
    sint rows = load(field(c.frame, &FrameHeader::tiles_y));
    sint in_rows = load(field(c.frame, &FrameHeader::tile_rows));
    pointer<std::int32_t> at(places);
    for (sint tile = 0; branch(tile < columns * rows); ++tile) {
        TilePlace place =
            branch(in_rows != 0) ? place_in_rows(columns, tile) : place_on_curve(columns, rows, tile);
        store(at, place.column);
        store(at + 1, place.row);
        at = at + 2;
    }
}

#define RAZOR_NAME(target) #target
#define RAZOR_TARGET_NAME(target) RAZOR_NAME(target)

} // namespace

constinit const KernelTable kernels = {
    RAZOR_TARGET_NAME(ISA_TARGET),
    isa::width,
    {{render<flat, MatteSampler<false>>, render<hanging, MatteSampler<false>>},
     {render_mapped<flat>, render_mapped<hanging>},
     {render_glossy<flat>, render_glossy<hanging>},
     {render_glossy_mapped<flat>, render_glossy_mapped<hanging>}},
    {trace_all<flat>, trace_all<hanging>},
    build_all,
    dice_all,
    {see_mapped<flat>, see_mapped<hanging>},
    place_tiles};

} // namespace razor::ISA_TARGET
