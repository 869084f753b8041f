// Opening what lies closed in item lists: nodes of the scene graph to their children, instances to clusters
// of patches, clusters to patches, patches to their coarsest blocks. Only what meets the list's cell is kept.
#pragma once

#include "razor/kernels/hull.h"
#include "razor/kernels/kd_leaf.h"

namespace razor::ISA_TARGET {
inline namespace build_kernel {

inline vmask is_closed(const Items& v) {
    return v.item >= vint(0);
}
inline vmask is_patch(const Items& v) {
    vmask closed = is_closed(v);
    return closed & (v.item < vint(cluster_items));
}

/// Appends those of the lanes in m that meet the list's cell.
inline sint append_met(const List& l, sint at, const Items& v, vmask m) {
    sfloat lows[3] = {l.low.x, l.low.y, l.low.z};
    sfloat highs[3] = {l.high.x, l.high.y, l.high.z};
    for (int k = 0; k < 3; ++k) {
        m = m & (v.box[k] <= vfloat(highs[k]));
        m = m & (v.box[k + 3] >= vfloat(lows[k]));
    }
    return append(l, at, v, m);
}

/// How many items opening one yields, at most.
inline sint yield_of(const Context& c, sint item) {
    if (branch(item < cluster_items))
        return 1;
    if (branch(item < graph_items))
        return refit_patches;
    pointer<GraphNodeRecord> node = c.graph + (item - graph_items);
    sint children = load(field(node, &GraphNodeRecord::child_count));
    sint instance = load(field(node, &GraphNodeRecord::instance));
    sbool opens_cluster = instance >= 0;
    opens_cluster = opens_cluster & (children == 1);
    return select(opens_cluster, sint(refit_patches), children);
}

/// Boxes in the instance's coordinates become ones in the scene's, as wide as their rounding needs: `reach`
/// is the largest number on the way to them.
inline void to_scene(const svec& origin, const vfloat& reach, const vfloat& grow, Items& v) {
    sfloat o[3] = {origin.x, origin.y, origin.z};
    for (int k = 0; k < 3; ++k) {
        vfloat at = vfloat(o[k]);
        vfloat size = max(abs(at), reach);
        vfloat slack = fma(size, vfloat(hull_rounding), grow);
        v.box[k] = (v.box[k] - slack) + at;
        v.box[k + 3] = (v.box[k + 3] + slack) + at;
    }
}

/// By how much a place stretches the largest coordinate of a point, at most.
inline sfloat stretch_of(const Place& place) {
    sfloat most = 1.0F;
    if (branch(place.moved)) {
        most = 0.0F;
        for (const svec& row : place.row) {
            sfloat sum = abs(row.x);
            sum = sum + abs(row.y);
            sum = sum + abs(row.z);
            most = max(sum, most);
        }
    }
    return most;
}

/// Patches of an instance's cluster `local` of its mesh. One lane a patch.
inline sint open_cluster(const Context& c, const List& l, sint at, sint instance, sint local) {
    tally(c.counters->cluster_openings, 1);
    pointer<InstanceRecord> record = c.instances + instance;
    sint first = load(field(record, &InstanceRecord::first_patch));
    sint cluster = load(field(record, &InstanceRecord::first_cluster));
    svec origin = load_svec(field(record, &InstanceRecord::origin));
    sint graph_nodes = load(field(c.frame, &FrameHeader::graph_count));
    mark(*c.opened, graph_nodes + ((first >> refit_log2) + local));
    cluster = cluster + local;
    pointer<std::int32_t> counts = load(field(c.frame, &FrameHeader::cluster_patches));
    sint count = load(counts + cluster);
    Cage g = load_cage(c, instance, 0);
    vfloat stretch = vfloat(stretch_of(g.place));
    for (sint from = 0; branch(from < count); from += isa::width) {
        vmask m = first_lanes(count - from);
        vint place = lane_index() + vint(from);
        vint number = place + vint(cluster << refit_log2);
        Hulls h;
        if (branch(g.place.moved))
            h = hulls_of<true>(g, c.patches, number, m);
        else
            h = hulls_of<false>(g, c.patches, number, m);
        Items v;
        v.item = place + vint(first + (local << refit_log2));
        vfloat corner[6] = {h.low.x, h.low.y, h.low.z, h.high.x, h.high.y, h.high.z};
        for (int k = 0; k < 6; ++k)
            v.box[k] = corner[k];
        vfloat grow = largest(h.high - h.low) * hull_growth;
        if (branch(g.displaced))
            grow = fma(stretch, vfloat(g.displacement), grow);
        to_scene(origin, h.reach * stretch, grow, v);
        at = append_met(l, at, v, m);
    }
    return at;
}

/// An instance's clusters. One lane a cluster.
inline sint open_instance(const Context& c, const List& l, sint at, sint instance, sint clusters) {
    if (branch(clusters == 1))
        return open_cluster(c, l, at, instance, 0);
    pointer<InstanceRecord> record = c.instances + instance;
    sint first_patch = load(field(record, &InstanceRecord::first_patch));
    sint first = load(field(record, &InstanceRecord::first_cluster));
    svec origin = load_svec(field(record, &InstanceRecord::origin));
    sint stride = load(field(c.frame, &FrameHeader::clusters_stride));
    pointer<float> boxes = load(field(c.frame, &FrameHeader::cluster_boxes));
    Place place = load_place(record);
    vfloat stretch = vfloat(stretch_of(place));
    for (sint from = 0; branch(from < clusters); from += isa::width) {
        vmask m = first_lanes(clusters - from);
        Items v;
        v.item = lane_index() + vint((first_patch >> refit_log2) + from);
        v.item = v.item + vint(cluster_items);
        pointer<float> box = boxes + (first + from);
        vfloat reach = vfloat(0.0F);
        for (int k = 0; k < 6; ++k) {
            v.box[k] = load_vector(box, m);
            reach = max(abs(v.box[k]), reach);
            box = box + stride;
        }
        if (branch(place.moved)) {
            vvec low{v.box[0], v.box[1], v.box[2]};
            vvec high{v.box[3], v.box[4], v.box[5]};
            vfloat half = vfloat(0.5F);
            low = low * half;
            high = high * half;
            vvec centre = moved_points(place, low + high);
            vvec arm = high - low;
            vfloat middle[3] = {centre.x, centre.y, centre.z};
            for (int k = 0; k < 3; ++k) {
                svec row{abs(place.row[k].x), abs(place.row[k].y), abs(place.row[k].z)};
                vfloat out = moved_along(row, 0.0F, arm);
                v.box[k] = middle[k] - out;
                v.box[k + 3] = middle[k] + out;
            }
        }
        to_scene(origin, reach * stretch, vfloat(0.0F), v);
        at = append_met(l, at, v, m);
    }
    return at;
}

/// The children of a node of the scene graph; at a leaf, an instance's clusters.
inline sint open_graph_node(const Context& c, const List& l, sint at, sint number) {
    tally(c.counters->graph_openings, 1);
    mark(*c.opened, number);
    pointer<GraphNodeRecord> node = c.graph + number;
    sint instance = load(field(node, &GraphNodeRecord::instance));
    sint children = load(field(node, &GraphNodeRecord::child_count));
    if (branch(instance >= 0))
        return open_instance(c, l, at, instance, children);
    sint first = load(field(node, &GraphNodeRecord::first_child));
    constexpr int node_words = sizeof(GraphNodeRecord) / 4;
    for (sint from = 0; branch(from < children); from += isa::width) {
        vmask m = first_lanes(children - from);
        vint child = lane_index() + vint(first + from);
        vint word = child * vint(node_words);
        Items v;
        v.item = child + vint(graph_items);
        for (int k = 0; k < 3; ++k) {
            v.box[k] = gather(field(c.graph, &GraphNodeRecord::low) + k, word, m);
            v.box[k + 3] = gather(field(c.graph, &GraphNodeRecord::high) + k, word, m);
        }
        at = append_met(l, at, v, m);
    }
    return at;
}

inline sint open_item(const Context& c, const List& l, sint at, sint item) {
    if (branch(item < cluster_items)) {
        pointer<OpenPatch> entry = open_patch(c, item);
        sint line = load(field(entry, &OpenPatch::root));
        Siblings siblings(l.most);
        Box box = reach_of(c, line, siblings);
        return append_block(l, at, line, box);
    }
    if (branch(item < graph_items)) {
        sint cluster = item - cluster_items;
        sint instance = load(c.cluster_instance + cluster);
        sint first = load(field(c.instances + instance, &InstanceRecord::first_patch));
        return open_cluster(c, l, at, instance, cluster - (first >> refit_log2));
    }
    return open_graph_node(c, l, at, item - graph_items);
}

/// Opens, by one step, the closed items that `wanted` chooses and returns the list with what is in them
/// instead.
template <class Wanted> inline List open_items(const Context& c, const List& old, Wanted wanted) {
    sint total = old.count;
    for (sint from = 0; branch(from < old.count); from += isa::width) {
        vmask valid = first_lanes(old.count - from);
        Items v = load_items(old, from, valid);
        vmask m = valid & wanted(v);
        m = m & !is_patch(v); // which yield one block each
        for (; branch(any(m)); m = clear_first(m)) {
            sint item = extract(v.item, first(m));
            total = total + (yield_of(c, item) - 1);
        }
    }
    List l = make_list(c, total, old.depth, old.most, old.low, old.high);
    note_list_level_of(l, old);
    sint at = 0;
    for (sint from = 0; branch(from < old.count); from += isa::width) {
        vmask valid = first_lanes(old.count - from);
        Items v = load_items(old, from, valid);
        vmask m = valid & wanted(v);
        at = append(l, at, v, valid & !m);
        for (; branch(any(m)); m = clear_first(m)) {
            sint item = extract(v.item, first(m));
            at = open_item(c, l, at, item);
        }
    }
    l.count = at;
    return l;
}

} // namespace build_kernel
} // namespace razor::ISA_TARGET
