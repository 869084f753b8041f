#include "razor/frame/frame_memory.h"

#include "razor/frame/blend_table.h"
#include "razor/frame/budget.h"
#include "razor/frame/scratch.h"
#include "razor/frame/unit.h"
#include "razor/frame/view.h"
#include "razor/scene/error.h"
#include "razor/scene/graph/records.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace razor {
namespace {

std::uint64_t share_of(std::uint64_t all, int workers) {
    std::uint64_t granule = isa::address_space::granule;
    return all / static_cast<std::uint64_t>(workers) / granule * granule;
}

/// Numbers of pixels so far apart that pictures of different seeds share no samples (MurmurHash3's
/// finalizer); 0 stays 0.
std::int32_t hashed(int seed) {
    auto h = static_cast<std::uint32_t>(seed);
    h = (h ^ (h >> 16)) * 0x85ebca6bU;
    h = (h ^ (h >> 13)) * 0xc2b2ae35U;
    return static_cast<std::int32_t>(h ^ (h >> 16));
}

/// So many that packets divide the samples, and a lane is left for each of two pixels.
int packet_samples_log2(int samples) {
    int log2 = 0;
    while ((2 << log2) < ISA_WIDTH && samples % (2 << log2) == 0)
        ++log2;
    return log2;
}

constexpr double pi = 3.14159265358979323846;

/// Side of the square that each sample of a domain has to itself, times edge_pixels: all that a pixel takes
/// share the domain.
float sample_spacing(const Settings& s, double domain, int samples) {
    return static_cast<float>(s.edge_pixels * std::sqrt(domain / std::max(samples, 1) / s.samples));
}

void put(float (&to)[3], const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        to[i] = static_cast<float>(v[i]);
}

} // namespace

void Frame::Impl::count_records(const Scene& scene) {
    for (std::size_t m = 0; m < topologies.size(); ++m) {
        const Topology& t = topologies[m];
        first_cluster.push_back(total.clusters);
        total.clusters += clusters_of(m);
        total.faces += t.faces.size();
        total.controls += t.controls.size();
        total.face_curves += t.face_curves.size();
        total.points += t.points.size();
        total.curves += t.curves.size();
    }
    for (const Instance& i : geometry.instances) {
        const Topology& t = topology_of(i);
        patches += static_cast<std::int64_t>(t.patches.size());
        clusters += static_cast<std::int64_t>(clusters_of(static_cast<std::size_t>(i.mesh)));
        undrawn += t.undrawn_faces;
    }
    if (patches == 0)
        throw UserError(fmt::format(
            "{}: no face of the scene is drawn; remove hole tags or boundary interpolation `none`",
            scene.name));
    constexpr std::int64_t most_clusters = most_patches >> refit_log2;
    if (clusters > most_clusters)
        throw UserError(fmt::format("{}: {} patches of {} instances are too many; at most 2^30", scene.name,
                                    patches, geometry.instances.size()));
    // Gathers index coordinates and patch records by signed 32-bit words; all else is counted in records.
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (std::max({total.clusters * refit_patches * (sizeof(PatchRecord) / 4), total.faces * 5, total.controls,
                  total.face_curves, total.points * 3, total.curves}) > most)
        throw UserError(
            fmt::format("{}: the meshes have more faces than can be numbered; leave some out", scene.name));
}

void Frame::Impl::size_bounded_arenas() {
    const std::uint64_t budget = std::min(options.memory_bytes, all_grids);
    for (int t = 0; t < trees; ++t) {
        const std::uint64_t share =
            budget * static_cast<std::uint64_t>(workers_of(t)) / static_cast<std::uint64_t>(options.workers);
        grains.push_back(static_cast<int>(share / (grain_lines * line_bytes + sizeof(std::int32_t))));
    }
}

std::uint64_t Frame::Impl::arena_bytes() const {
    if (options.memory_bytes != 0)
        return 4 * std::min(options.memory_bytes, all_grids) +
               static_cast<std::uint64_t>(trees) * 8 * isa::address_space::granule;
    return static_cast<std::uint64_t>(options.workers) * (grid_bytes + node_bytes + list_bytes);
}

void Frame::Impl::size_arenas() {
    if (options.memory_bytes != 0)
        return size_bounded_arenas();
    const auto size = [&](std::uint64_t wanted, std::uint64_t all) {
        const std::uint64_t granule = isa::address_space::granule;
        const std::uint64_t most = share_of(all, options.workers) - granule; // room for colours
        return wanted == 0 ? most : std::min((wanted + granule - 1) / granule * granule, most);
    };
    grid_bytes = size(options.grid_bytes, all_grids);
    node_bytes = size(options.node_bytes, all_nodes);
    list_bytes = size(options.list_bytes, all_lists);
    grid_lines_each = static_cast<int>(grid_bytes / line_bytes);
    nodes_each = static_cast<int>(node_bytes / sizeof(KdNode));
    list_lines_each = static_cast<int>(list_bytes / line_bytes);
}

void Frame::Impl::place_scene(const Scene& scene) {
    header = region<FrameHeader>("scene graph", -1, 1);
    new (header) FrameHeader{};
    header->instances.set(region<InstanceRecord>("scene graph", -1, geometry.instances.size()));
    header->cluster_instance.set(region<std::int32_t>("scene graph", -1, static_cast<std::size_t>(clusters)));
    fill_instances(scene);
}

void Frame::Impl::fill_instances(const Scene& scene) {
    std::int32_t* cluster_instance = header->cluster_instance.get();
    std::int32_t first_patch = 0;
    for (std::size_t n = 0; n < geometry.instances.size(); ++n) {
        const Topology& t = topology_of(geometry.instances[n]);
        InstanceRecord& r = header->instances.get()[n];
        r.first_patch = first_patch;
        fill_instance(scene, n);
        cluster_instance = std::fill_n(cluster_instance, r.cluster_count, static_cast<std::int32_t>(n));
        header->patch_count = std::max(header->patch_count, first_patch + r.patch_count);
        first_patch += r.cluster_count << refit_log2;
        for (const PatchRecord& p : t.patches)
            if (p.kind == PatchKind::catmull_clark || p.kind == PatchKind::bilinear)
                plan = plan_hanging;
    }
}

/// All but which patches are the instance's.
void Frame::Impl::fill_instance(const Scene& scene, std::size_t n) {
    const Instance& i = geometry.instances[n];
    const Topology& t = topology_of(i);
    const auto mesh = static_cast<std::size_t>(i.mesh);
    InstanceRecord& r = header->instances.get()[n];
    for (int k = 0; k < 3; ++k) {
        r.origin[k] = i.origin[k];
        r.offset[k] = i.offset[k];
        for (int column = 0; column < 3; ++column)
            r.linear[3 * k + column] = static_cast<float>(i.linear[column][k]);
    }
    r.moved = i.moved() ? 1 : 0;
    r.edge_length = static_cast<float>(i.edge_length);
    r.mesh_edge_length = static_cast<float>(i.mesh_edge_length);
    r.first_level = static_cast<std::int32_t>(std::lround(std::log2(i.edge_length)));
    r.max_exponent = t.max_exponent;
    r.mesh = i.mesh;
    r.patch_count = static_cast<std::int32_t>(t.patches.size());
    r.first_cluster = static_cast<std::int32_t>(first_cluster[mesh]);
    r.first_record = r.first_cluster << refit_log2;
    r.cluster_count = static_cast<std::int32_t>(clusters_of(mesh));
    glm::vec3 albedo(0.7F);
    const auto material = static_cast<std::size_t>(i.material);
    if (material < scene.materials.size())
        albedo = scene.materials[material].albedo;
    for (int k = 0; k < 3; ++k)
        r.albedo[k] = albedo[k];
}

void Frame::Impl::place_graph() {
    const std::size_t most =
        options.moves ? Hierarchy::node_limit(geometry.instances.size()) : geometry.graph.nodes().size();
    header->graph.set(region<GraphNodeRecord>("scene graph", -1, most));
    fill_graph();
    for (int t = 0; t < trees; ++t)
        opened.push_back(std::make_unique<isa::mark_set>(static_cast<std::int64_t>(most) + clusters));
    // Boxes of clusters: a frame's refit writes them.
    header->cluster_count = static_cast<std::int32_t>(total.clusters);
    header->clusters_stride = (header->cluster_count + 15) & -16;
    header->cluster_boxes.set(
        region<float>("scene graph", -1, static_cast<std::size_t>(header->clusters_stride) * 6));
    header->refit_list.set(region<std::int32_t>("scene graph", -1, total.clusters));
    auto* counts = region<std::int32_t>("scene graph", -1, total.clusters);
    header->cluster_patches.set(counts);
    for (const Topology& t : topologies)
        for (std::size_t left = t.patches.size(); left > 0;) {
            const std::size_t here = std::min<std::size_t>(left, refit_patches);
            *counts++ = static_cast<std::int32_t>(here);
            left -= here;
        }
}

void Frame::Impl::fill_graph() {
    const std::vector<HierarchyNode>& nodes = geometry.graph.nodes();
    const std::vector<std::int32_t> others = geometry.graph.take_touched();
    for (const std::int32_t n : others) {
        GraphNodeRecord& record = header->graph.get()[n];
        record = pack(nodes[static_cast<std::size_t>(n)], geometry.origin);
        if (record.instance >= 0)
            record.child_count = header->instances.get()[record.instance].cluster_count;
    }
    header->graph_count = static_cast<std::int32_t>(nodes.size());
    touched.graph_nodes = static_cast<std::int64_t>(others.size());
}

void Frame::Impl::place_points(const Scene& scene) {
    std::size_t first = 0;
    for (const Topology& t : topologies) {
        first_point.push_back(first);
        first += t.points.size();
    }
    header->points.set(region<float>("control points", -1, total.points * 3));
    fill_meshes(scene);
}

void Frame::Impl::fill_points(const Scene& scene, std::size_t mesh) {
    float* xyz = header->points.get() + 3 * first_point[mesh];
    for (const glm::dvec3& point : scene.meshes[mesh].points) {
        const glm::dvec3 p = point - geometry.mesh_origins[mesh];
        for (int k = 0; k < 3; ++k)
            *xyz++ = static_cast<float>(p[k]);
    }
}

void Frame::Impl::fill_meshes(const Scene& scene) {
    std::vector<int> all;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        fill_points(scene, m);
        all.push_back(static_cast<int>(m));
    }
    list_clusters(all);
    touched.meshes = static_cast<std::int64_t>(all.size());
}

void Frame::Impl::list_clusters(const std::vector<int>& of_meshes) {
    std::int32_t* list = header->refit_list.get();
    std::vector<std::int32_t> wanted;
    // A frame that was given up has left some undone, and does not say which.
    if (header->queues.get() != nullptr && header->queues.get()->refitted.word != header->refit_count)
        wanted.assign(list, list + header->refit_count);
    for (const int mesh : of_meshes)
        for (std::size_t k = 0; k < clusters_of(static_cast<std::size_t>(mesh)); ++k)
            wanted.push_back(static_cast<std::int32_t>(first_cluster[static_cast<std::size_t>(mesh)] + k));
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::copy(wanted.begin(), wanted.end(), list);
    header->refit_count = static_cast<std::int32_t>(wanted.size());
    touched.clusters = header->refit_count;
}

void Frame::Impl::place_topology() {
    auto* patch = region<PatchRecord>("scene graph", -1, total.clusters * refit_patches);
    auto* face = region<FaceRecord>("topology", -1, total.faces);
    auto* control = region<std::int32_t>("topology", -1, total.controls);
    auto* face_curve = region<std::int32_t>("topology", -1, total.face_curves);
    auto* point = region<VertexRecord>("topology", -1, total.points);
    auto* curve = region<CurveRecord>("topology", -1, total.curves);
    auto* classes = region<ClassRecord>("topology", -1, pages->class_count());
    header->patches.set(patch);
    header->faces.set(face);
    header->controls.set(control);
    header->face_curves.set(face_curve);
    header->vertices.set(point);
    header->curves.set(curve);
    header->classes.set(classes);
    // Each mesh numbers from 0: move its numbers behind those of the meshes before.
    int base_face = 0, base_control = 0, base_face_curve = 0, base_point = 0, base_curve = 0, base_class = 0;
    for (std::size_t m = 0; m < topologies.size(); ++m) {
        const Topology& t = topologies[m];
        patch = header->patches.get() + (first_cluster[m] << refit_log2);
        for (PatchRecord p : t.patches) {
            p.mesh = static_cast<int>(m);
            p.face += base_face;
            bool part = (p.side_flags[0] & side_half) != 0;
            for (int& c : p.side_curve)
                c += c >= 0 ? base_curve : 0;
            p.corner[0] += base_point;
            p.corner[1] += part ? base_curve : base_point;
            p.corner[2] += part ? base_face : base_point;
            p.corner[3] += part ? base_curve : base_point;
            *patch++ = p;
        }
        for (FaceRecord f : t.faces) {
            f.face_class += f.face_class >= 0 ? base_class : 0;
            f.control_first += base_control;
            f.curve_first += base_face_curve;
            *face++ = f;
        }
        for (int c : t.controls)
            *control++ = c + base_point;
        for (int c : t.face_curves)
            *face_curve++ = c + base_curve;
        for (VertexRecord v : t.points) {
            v.owner_face += v.owner_face >= 0 ? base_face : 0;
            *point++ = v;
        }
        for (CurveRecord c : t.curves) {
            bool spoke = (c.flags & curve_spoke) != 0;
            c.owner_face += c.owner_face >= 0 ? base_face : 0;
            c.end0 += spoke ? base_curve : base_point;
            c.end1 += spoke ? base_face : base_point;
            *curve++ = c;
        }
        base_face += static_cast<int>(t.faces.size());
        base_control += static_cast<int>(t.controls.size());
        base_face_curve += static_cast<int>(t.face_curves.size());
        base_point += static_cast<int>(t.points.size());
        base_curve += static_cast<int>(t.curves.size());
        base_class += static_cast<int>(t.classes.size());
    }
    auto* entries = region<PageEntry>("topology pages", -1, pages->entry_count());
    pages->lay_out(entries, region<Line>("topology pages", -1, pages->line_count()), classes);
}

void Frame::Impl::place_blend_table() {
    auto* table = region<std::int32_t>("blend table", -1, blend_table_words);
    header->blend_table.set(table);
    fill_blend_table(table);
}

void Frame::Impl::place_workers() {
    // All of it lives for one frame.
    auto n = static_cast<std::size_t>(options.workers);
    header->queues.set(region<QueueRecord>("queues", -1, 1, true));
    header->stretches.set(region<StretchRecord>("queues", -1, n, true));
    header->trees.set(region<TreeRecord>("kd nodes", -1, static_cast<std::size_t>(trees), true));
    header->workers.set(region<WorkerRecord>("stack", -1, n, true));
    for (int t = 0; t < trees; ++t) {
        TreeRecord& tree = header->trees.get()[t];
        tree.patches.set(
            coloured<OpenPatch>("grids", t, static_cast<std::size_t>(header->patch_count), colour_patches));
        tree.curve_lengths.set(
            coloured<isa::shared<std::int32_t>>("grids", t, total.curves, colour_curve_lengths));
    }
    if (options.memory_bytes != 0)
        place_bounded_arenas();
    else
        place_arenas();
    for (int w = 0; w < options.workers; ++w) {
        WorkerRecord& r = header->workers.get()[w];
        r.stack.set(coloured<float>("stack", w, 2 * spare_stack, colour_stack));
        r.packets.set(coloured<float>("packets", w, 2 * spare_packets, colour_packets));
        r.blends.set(coloured<float>("blended blocks", w, blends_floats, colour_blends));
        r.tree = options.tree_of_worker[static_cast<std::size_t>(w)];
        ++header->trees.get()[r.tree].sharers;
    }
    header->discards = options.discards ? 1 : 0;
    header->grid_lines = grid_lines_each;
    header->node_count = nodes_each;
    header->list_lines = list_lines_each;
    order_workers();
}

void Frame::Impl::order_workers() {
    const auto key = [this](int worker) {
        const auto w = static_cast<std::size_t>(worker);
        return std::tuple(options.tree_of_worker[w],
                          options.place_of_worker.empty() ? worker : options.place_of_worker[w], worker);
    };
    std::vector<int> order(static_cast<std::size_t>(options.workers));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&key](int a, int b) { return key(a) < key(b); });
    header->worker_count = options.workers;
    header->tile_rows = options.tiles_in_rows ? 1 : 0;
    header->place_span = static_cast<std::int32_t>(std::bit_ceil(static_cast<unsigned>(options.workers)));
    for (int place = options.workers - 1; place >= 0; --place) {
        WorkerRecord& r = header->workers.get()[order[static_cast<std::size_t>(place)]];
        r.place = place;
        TreeRecord& tree = header->trees.get()[r.tree];
        tree.first_place = place;
        if (tree.end_place == 0)
            tree.end_place = place + 1;
    }
}

void Frame::Impl::place_arenas() {
    // The regions of one family lie side by side, so that one base and 32 bits name anything in it.
    for (int w = 0; w < options.workers; ++w) {
        auto* p =
            reinterpret_cast<Line*>(memory->add("grids", w, grid_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->grids.set(p);
    }
    for (int w = 0; w < options.workers; ++w) {
        auto* p = reinterpret_cast<KdNode*>(
            memory->add("kd nodes", w, node_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->nodes.set(p);
    }
    for (int w = 0; w < options.workers; ++w) {
        auto* p = reinterpret_cast<Line*>(
            memory->add("item lists", w, list_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->lists.set(p);
    }
}

void Frame::Impl::place_bounded_arenas() {
    std::uint64_t lines = 0;
    std::vector<int> first;
    for (int t = 0; t < trees; ++t) {
        lines += static_cast<std::uint64_t>(colour(t, colour_grids) / grain_lines * grain_lines);
        first.push_back(static_cast<int>(lines));
        lines += static_cast<std::uint64_t>(grains[static_cast<std::size_t>(t)]) * grain_lines;
    }
    std::byte* const p = memory->add(options.apart ? "grids" : "bounded", -1, lines * line_bytes, true);
    header->grids.set(reinterpret_cast<Line*>(p));
    header->nodes.set(
        reinterpret_cast<KdNode*>(options.apart ? memory->add("kd nodes", -1, lines * line_bytes, true) : p));
    header->lists.set(
        reinterpret_cast<Line*>(options.apart ? memory->add("item lists", -1, lines * line_bytes, true) : p));
    auto* tree = region<TreeBudget>("budget", -1, static_cast<std::size_t>(trees), true);
    auto* worker = region<WorkerBudget>("budget", -1, static_cast<std::size_t>(options.workers), true);
    std::vector<const TreeBudget*> records;
    for (int t = 0; t < trees; ++t) {
        TreeBudget& r = tree[t];
        r.first_line = first[static_cast<std::size_t>(t)];
        r.grains = grains[static_cast<std::size_t>(t)];
        r.workers = workers_of(t);
        r.frame_workers = options.workers;
        r.tree = t;
        r.piece = std::clamp(r.grains / (64 * r.workers), 2, 64);
        while (r.grains >> r.epoch_log2 >= 2 << epochs_log2)
            ++r.epoch_log2;
        r.marks.set(region<std::int32_t>("budget", -1, static_cast<std::size_t>(r.grains), true));
        records.push_back(&r);
    }
    for (int w = 0; w < options.workers; ++w) {
        worker[w].tree.set(tree + options.tree_of_worker[static_cast<std::size_t>(w)]);
        header->workers.get()[w].budget.set(worker + w);
    }
    log = std::make_unique<BudgetLog>(*header, std::move(records), options.memory_bytes);
}

void Frame::Impl::reset_budget() {
    for (int w = 0; w < options.workers; ++w) {
        WorkerBudget& r = *header->workers.get()[w].budget.get();
        r.awake = r.groups = r.holes = -1;
        r.epoch = 0;
        r.era = 1;
        r.tile_grains = 0;
        TreeBudget& tree = *r.tree.get();
        memory->clear(*memory->find(memory->offset(tree.marks.get())));
        tree.gate.word = tree.cursor.word = 0;
        tree.era = tree.epoch = 1;
        tree.free_share = 1;
    }
    log->clear();
}

void Frame::Impl::deal_tiles(int first, int end) {
    // Who shows progress looks at them.
    const auto put = [](std::int32_t& word, std::int32_t value) {
        std::atomic_ref(word).store(value, std::memory_order_relaxed);
    };
    const std::int64_t tiles = std::max(end - first, 0);
    const std::int64_t strides =
        (tiles + (std::int64_t{1} << header->stride_log2) - 1) >> header->stride_log2;
    const std::int64_t workers = options.workers;
    // Whole multiples of a power of two, few enough that all lengths can be written; what is beyond the last
    // tile is nothing.
    std::int64_t grain = 1;
    const auto grains = [&] { return (strides + grain - 1) / grain; };
    while (grains() > workers * ((2 << stretch_mantissa) - 1))
        grain *= 2;
    put(header->tiles_first, first);
    put(header->tiles_end, end);
    put(header->queues.get()->stopped.word, 0);
    const auto begin = [&](std::int64_t place) { return grains() * place / workers * grain; };
    for (std::int64_t place = 0; place < workers; ++place)
        put(header->stretches.get()[place].left.word,
            pack_stretch(static_cast<std::int32_t>(begin(place)),
                         static_cast<std::int32_t>(begin(place + 1) - begin(place))));
    dealt.store(grains() * grain, std::memory_order_relaxed);
}

double Frame::Impl::taken() const {
    std::int64_t left = 0;
    for (int place = 0; place < options.workers; ++place) {
        std::int32_t& word = header->stretches.get()[place].left.word;
        left += stretch_length(std::atomic_ref(word).load(std::memory_order_relaxed));
    }
    const std::int64_t all = dealt.load(std::memory_order_relaxed);
    return all > 0 ? 1 - static_cast<double>(left) / static_cast<double>(all) : 1;
}

void Frame::Impl::place_view(const Scene& scene) {
    const Settings& s = scene.settings;
    const auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
    header->film.set(region<float>("frame buffer", -1, pixels * film_planes));
    most_lights = scene.lights.size();
    header->lights.set(region<LightRecord>("scene graph", -1, most_lights));
    fill_view(scene);
}

void Frame::Impl::fill_view(const Scene& scene) {
    const Settings& s = scene.settings;
    FrameHeader& h = *header;
    h.sky_samples = 0;
    h.focus = 0;
    put(h.lens_x, glm::dvec3(0));
    put(h.lens_y, glm::dvec3(0));
    h.width = s.width;
    h.height = s.height;
    h.samples = s.samples;
    h.packet_samples_log2 = packet_samples_log2(s.samples);
    part = shown_part(s);
    h.first_column = part.x / tile_side;
    h.first_row = part.y / tile_side;
    h.tiles_x = (part.x + part.width + tile_side - 1) / tile_side - h.first_column;
    h.tiles_y = (part.y + part.height + tile_side - 1) / tile_side - h.first_row;
    h.tiles = screen_tiles(s);
    h.stride_log2 = 0;
    while ((h.tiles - 1) >> h.stride_log2 >= most_strides)
        ++h.stride_log2;
    const View v = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, s);
    const double pixel = 2 * film.half_height / s.height;
    put(h.camera, scene.camera.position - geometry.origin);
    put(h.film_corner, v.forward - v.right * film.half_width + v.up * film.half_height);
    put(h.film_x, v.right * pixel);
    put(h.film_y, -v.up * pixel);
    put(h.background, glm::dvec3(scene.sky));
    fill_lights(scene);
    if (std::max({scene.sky.x, scene.sky.y, scene.sky.z}) > 0) {
        h.sky_samples = s.sky_samples;
        put(h.sky, glm::dvec3(scene.sky) / static_cast<double>(std::max(s.sky_samples, 1)));
    }
    h.sample_seed = hashed(s.seed);
    h.fixed_target = one_level(s.lod.lod) ? least_target_edge : 0.0F;
    h.morphs = s.lod == Lod::recursive || s.lod == Lod::camera || s.lod == Lod::paper ? 1 : 0;
    h.one_field = s.lod == Lod::camera ? 1 : 0;
    h.level_choice = s.lod == Lod::patch ? by_patch : s.lod == Lod::paper ? by_stretch : by_leaf;
    const Camera& dicing = dicing_camera(scene);
    const CameraField asked = camera_field(dicing, s);
    put(h.field_origin, dicing.position - geometry.origin);
    h.camera_base = static_cast<float>(asked.base);
    h.camera_growth = static_cast<float>(asked.growth);
    put(h.camera_slope, view_of(dicing).forward * asked.slope);
    if (scene.camera.aperture_radius > 0) {
        h.focus = static_cast<float>(focus_distance(scene.camera));
        put(h.lens_x, v.right * scene.camera.aperture_radius);
        put(h.lens_y, v.up * scene.camera.aperture_radius);
    }
    h.sky_spacing = sample_spacing(s, pi, s.sky_samples);
    h.reach = static_cast<float>(geometry.reach);
}

void Frame::Impl::fill_lights(const Scene& scene) {
    const Settings& s = scene.settings;
    header->light_count = 0;
    if (s.light_samples == 0)
        return;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const RectangleLight& light = scene.lights[l];
        const glm::dvec3 normal = glm::cross(light.edge_u, light.edge_v);
        const double area = glm::length(normal);
        if (!(area > 0 && std::max({light.radiance.x, light.radiance.y, light.radiance.z}) > 0))
            continue;
        LightRecord& r = header->lights.get()[header->light_count++];
        put(r.corner, light.corner - geometry.origin);
        put(r.edge_u, light.edge_u);
        put(r.edge_v, light.edge_v);
        put(r.normal, normal / area);
        put(r.radiance, glm::dvec3(light.radiance) * (area / (pi * s.light_samples)));
        r.spacing = sample_spacing(s, area, s.light_samples);
        r.samples = s.light_samples;
        r.dimension = light_dimension(static_cast<int>(l));
    }
}

bool Frame::Impl::pose(const Scene& scene) {
    index.reset();
    SceneGeometry posed = locate_scene(scene, drawn);
    if (posed.instances.size() != geometry.instances.size() || scene.lights.size() > most_lights)
        return false;
    geometry = std::move(posed);
    fill_instances(scene);
    fill_graph();
    fill_meshes(scene);
    fill_view(scene);
    touched.instances = static_cast<std::int64_t>(geometry.instances.size());
    reset();
    followed = true;
    return true;
}

bool Frame::Impl::follow(const Scene& scene, const SceneChanges& changes) {
    // The unit follows from all instances, and the box that is kept is of those that are drawn.
    if (unit != 1 || scene.lights.size() > most_lights ||
        std::find(drawn.begin(), drawn.end(), false) != drawn.end())
        return false;
    if (!index)
        index.emplace(geometry.flat, drawn_graph(scene.graph, scene.meshes.size()), scene.meshes.size());
    const std::optional<GeometryChanges> others = razor::follow(geometry, *index, scene, changes);
    if (!others || frame_unit(scene, geometry.graph.bounds()) != 1)
        return false;
    for (const std::int32_t n : others->instances)
        fill_instance(scene, static_cast<std::size_t>(n));
    fill_graph();
    for (const int mesh : others->meshes)
        fill_points(scene, static_cast<std::size_t>(mesh));
    list_clusters(others->meshes);
    touched.instances = static_cast<std::int64_t>(others->instances.size());
    touched.meshes = static_cast<std::int64_t>(others->meshes.size());
    fill_view(scene);
    reset();
    followed = true;
    return true;
}

} // namespace razor
