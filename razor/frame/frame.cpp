#include "razor/frame/frame.h"

#include "razor/frame/page_store.h"
#include "razor/frame/phases.h"
#include "razor/frame/scene_geometry.h"
#include "razor/frame/scratch.h"
#include "razor/frame/view.h"
#include "razor/scene/error.h"
#include "razor/scene/graph/records.h"
#include "razor/surface/topology.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace razor {

namespace {

constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;
// Gathers index grids by signed 32-bit words; nodes and lists are numbered by signed 32 bits.
constexpr std::uint64_t all_grids = 8 * gibibyte;
constexpr std::uint64_t all_nodes = 16 * gibibyte;
constexpr std::uint64_t all_lists = 64 * gibibyte;

std::uint64_t share_of(std::uint64_t all, int workers) {
    std::uint64_t granule = isa::address_space::granule;
    return all / static_cast<std::uint64_t>(workers) / granule * granule;
}

/// Fills in the table if there is none.
int count_trees(FrameOptions& options) {
    std::vector<int>& of = options.tree_of_worker;
    if (of.empty())
        of.assign(static_cast<std::size_t>(options.workers), 0);
    if (of.size() != static_cast<std::size_t>(options.workers))
        throw std::invalid_argument("a frame's tree_of_worker must have one entry a worker");
    const std::set<int> used(of.begin(), of.end());
    if (*used.begin() != 0 || *used.rbegin() != static_cast<int>(used.size()) - 1)
        throw std::invalid_argument("a frame's trees must be numbered from 0 without gaps");
    return static_cast<int>(used.size());
}

/// Owners' regions begin at multiples of 64 KiB. If what they use did as well, the busiest lines of all
/// workers would fall into the same few sets of a cache and into one bank of memory. So each owner begins
/// some lines further on, each kind of region elsewhere: these many lines, fewer than fit into 64 KiB.
constexpr int coloured_lines = static_cast<int>(isa::address_space::granule / line_bytes);
constexpr int nodes_a_line = line_bytes / static_cast<int>(sizeof(KdNode));
enum Coloured : int {
    colour_stack,
    colour_packets,
    colour_blends,
    colour_grids,
    colour_nodes,
    colour_lists,
    colour_patches
};
int colour(int owner, Coloured kind) {
    return (owner * 97 + kind * 411) % coloured_lines;
}

void put(float (&to)[3], const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        to[i] = static_cast<float>(v[i]);
}

constexpr const char* film_names[film_planes] = {"R",        "G",       "B",        "normal.X", "normal.Y",
                                                 "normal.Z", "depth.Z", "albedo.R", "albedo.G", "albedo.B"};

} // namespace

struct Frame::Impl {
    Impl(const Scene& scene, const FrameOptions& options);

    std::vector<Mesh> meshes;
    std::vector<Topology> topologies;
    FrameOptions options;
    SceneGeometry geometry;
    std::unique_ptr<PageStore> pages;
    std::unique_ptr<isa::address_space> memory;
    FrameHeader* header = nullptr;
    std::vector<CountersByKind> counters; // one a worker
    int trees = 1;
    int nodes_each = 0, grid_lines_each = 0, list_lines_each = 0; // arena sizes of a worker
    Plan plan = plan_flat;
    std::int64_t undrawn = 0;
    struct {
        std::size_t clusters = 0, faces = 0, controls = 0, face_curves = 0, points = 0, curves = 0;
    } total;                                            // over the meshes
    std::vector<std::size_t> first_cluster;             // of each mesh
    std::int64_t patches = 0, clusters = 0;             // over the instances
    std::vector<std::unique_ptr<isa::mark_set>> opened; // one a tree: graph nodes, then instances' clusters
    isa::stopwatch watch{moment_count};

    const Topology& topology_of(const Instance& instance) const {
        return topologies[static_cast<std::size_t>(instance.mesh)];
    }
    std::size_t clusters_of(std::size_t mesh) const {
        return (topologies[mesh].patches.size() + refit_patches - 1) >> refit_log2;
    }

    template <class T>
    T* region(const char* structure, int owner, std::size_t count, bool transient = false) {
        return reinterpret_cast<T*>(
            memory->add(structure, owner, std::max<std::size_t>(count, 1) * sizeof(T), transient));
    }
    /// Begins at a line of the owner's colour.
    template <class T> T* coloured(const char* structure, int owner, std::size_t count, Coloured kind) {
        auto* bytes = reinterpret_cast<std::byte*>(
            region<T>(structure, owner, count + isa::address_space::granule / sizeof(T), true));
        return reinterpret_cast<T*>(bytes + colour(owner, kind) * line_bytes);
    }
    /// The first line or node of a worker's arena, counted from the base of its family.
    int first_grid_line(int w) const {
        return w * (grid_lines_each + coloured_lines) + colour(w, colour_grids);
    }
    int first_list_line(int w) const {
        return w * (list_lines_each + coloured_lines) + colour(w, colour_lists);
    }
    int first_node(int w) const {
        return w * (nodes_each + coloured_lines * nodes_a_line) + colour(w, colour_nodes) * nodes_a_line;
    }
    void count_records(const Scene& scene);
    void place_scene(const Scene& scene);
    void place_graph();
    void place_points();
    void place_topology();
    void place_blend_table();
    void place_workers();
    void place_view(const Scene& scene);
    void reset();
    WorkerArguments arguments(int worker) {
        const auto w = static_cast<std::size_t>(worker);
        const auto tree = static_cast<std::size_t>(options.tree_of_worker[w]);
        return {header, worker, pages.get(), counters[w].kind, opened[tree].get(), &watch};
    }
};

Frame::Impl::Impl(const Scene& scene, const FrameOptions& o) : meshes(scene.meshes), options(o) {
    if (meshes.empty())
        throw UserError(fmt::format("{}: the scene has no mesh; add one", scene.name));
    for (const Mesh& mesh : meshes) {
        validate_mesh(mesh);
        topologies.push_back(analyse_topology(mesh));
    }
    trees = count_trees(options);
    std::vector<bool> drawn;
    for (const Topology& t : topologies)
        drawn.push_back(!t.patches.empty());
    geometry = locate_scene(scene, drawn);
    count_records(scene);
    pages = std::make_unique<PageStore>(meshes, topologies);
    counters.resize(static_cast<std::size_t>(options.workers));
    // OpenPatch entries, a table a tree, take memory only where a patch is opened.
    const std::uint64_t scene_bytes =
        static_cast<std::uint64_t>(clusters) *
            (refit_patches * sizeof(OpenPatch) * static_cast<std::size_t>(trees) + 4) +
        total.clusters * (refit_patches * sizeof(PatchRecord) + 64) + total.controls * 4 +
        (total.faces + total.points + total.curves + total.face_curves) * 64 +
        geometry.instances.size() * sizeof(InstanceRecord) + geometry.graph.size() * sizeof(GraphNodeRecord);
    auto pixels =
        static_cast<std::uint64_t>(scene.settings.width) * static_cast<std::uint64_t>(scene.settings.height);
    memory = std::make_unique<isa::address_space>(pages->span_bytes() + all_grids + all_nodes + all_lists +
                                                  2 * scene_bytes + pixels * 64 + 4 * gibibyte +
                                                  static_cast<std::uint64_t>(options.workers + trees) * 64 *
                                                      isa::address_space::granule);
    place_scene(scene);
    place_graph();
    place_points();
    place_topology();
    place_blend_table();
    place_workers();
    place_view(scene);
    reset();
}

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

void Frame::Impl::place_scene(const Scene& scene) {
    header = region<FrameHeader>("scene graph", -1, 1);
    new (header) FrameHeader{};
    auto* record = region<InstanceRecord>("scene graph", -1, geometry.instances.size());
    auto* cluster_instance = region<std::int32_t>("scene graph", -1, static_cast<std::size_t>(clusters));
    header->instances.set(record);
    header->cluster_instance.set(cluster_instance);
    std::int32_t first_patch = 0;
    for (std::size_t n = 0; n < geometry.instances.size(); ++n) {
        const Instance& i = geometry.instances[n];
        const Topology& t = topology_of(i);
        const auto mesh = static_cast<std::size_t>(i.mesh);
        InstanceRecord& r = *record++;
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
        r.first_patch = first_patch;
        r.patch_count = static_cast<std::int32_t>(t.patches.size());
        r.first_cluster = static_cast<std::int32_t>(first_cluster[mesh]);
        r.first_record = r.first_cluster << refit_log2;
        r.cluster_count = static_cast<std::int32_t>(clusters_of(mesh));
        glm::vec3 albedo(0.7F);
        auto material = static_cast<std::size_t>(i.material);
        if (material < scene.materials.size())
            albedo = scene.materials[material].albedo;
        for (int k = 0; k < 3; ++k)
            r.albedo[k] = albedo[k];
        cluster_instance = std::fill_n(cluster_instance, r.cluster_count, static_cast<std::int32_t>(n));
        header->patch_count = std::max(header->patch_count, first_patch + r.patch_count);
        first_patch += r.cluster_count << refit_log2;
        for (const PatchRecord& p : t.patches)
            if (p.kind == PatchKind::catmull_clark || p.kind == PatchKind::bilinear)
                plan = plan_hanging;
    }
}

void Frame::Impl::place_graph() {
    const std::vector<GraphNodeRecord> nodes = pack(geometry.graph, geometry.origin);
    auto* graph = region<GraphNodeRecord>("scene graph", -1, nodes.size());
    std::copy(nodes.begin(), nodes.end(), graph);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (graph[n].instance >= 0)
            graph[n].child_count = header->instances.get()[graph[n].instance].cluster_count;
    header->graph.set(graph);
    header->graph_count = static_cast<std::int32_t>(nodes.size());
    for (int t = 0; t < trees; ++t)
        opened.push_back(std::make_unique<isa::mark_set>(static_cast<std::int64_t>(nodes.size()) + clusters));
    // Boxes of clusters: a frame's refit writes them.
    header->cluster_count = static_cast<std::int32_t>(total.clusters);
    header->clusters_stride = (header->cluster_count + 15) & -16;
    header->cluster_boxes.set(
        region<float>("scene graph", -1, static_cast<std::size_t>(header->clusters_stride) * 6));
    auto* counts = region<std::int32_t>("scene graph", -1, total.clusters);
    header->cluster_patches.set(counts);
    for (const Topology& t : topologies)
        for (std::size_t left = t.patches.size(); left > 0;) {
            const std::size_t here = std::min<std::size_t>(left, refit_patches);
            *counts++ = static_cast<std::int32_t>(here);
            left -= here;
        }
}

void Frame::Impl::place_points() {
    auto* xyz = region<float>("control points", -1, total.points * 3);
    header->points.set(xyz);
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (const glm::dvec3& point : meshes[m].points) {
            const glm::dvec3 p = point - geometry.mesh_origins[m];
            for (int k = 0; k < 3; ++k)
                *xyz++ = static_cast<float>(p[k]);
        }
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
    pages->lay_out(region<Line>("topology pages", -1, pages->span_bytes() / line_bytes), classes);
}

/// Which vertices of a block of 2^a x 2^b quads a pass blends (layout.h).
void fill_pass(int a, int b, int pass, std::int32_t* out) {
    const int quads_u = 1 << a, quads_v = 1 << b, width = quads_u + 1;
    const int step = 1 << (block_log2 - 1 - pass);
    auto inside = [](int i, int quads) { return i != 0 && i != quads; };
    std::int32_t count = 0;
    std::int32_t* list = out + line_bytes / 4;
    for (int j = 0; j <= quads_v; ++j)
        for (int i = 0; i <= quads_u; ++i) {
            // Ends of rows and columns belong to every level.
            const bool at_u = !inside(i, quads_u) || i % step == 0,
                       at_v = !inside(j, quads_v) || j % step == 0;
            const bool odd_u = inside(i, quads_u) && i / step % 2 != 0;
            const bool odd_v = inside(j, quads_v) && j / step % 2 != 0;
            if (!at_u || !at_v || (!odd_u && !odd_v))
                continue;
            const int along = (odd_u ? step : 0) + (odd_v ? step * width : 0);
            const int vertex = j * width + i;
            list[count] = vertex;
            list[pass_vertices + count] = vertex - along;
            list[2 * pass_vertices + count] = vertex + along;
            list[3 * pass_vertices + count] = j == 0         ? 0
                                              : j == quads_v ? 2
                                              : i == quads_u ? 1
                                              : i == 0       ? 3
                                                             : -1;
            ++count;
        }
    *out = count;
}

/// What the last pass, as filled, does to vertices as they lie (layout.h).
void fill_rows(int a, const std::int32_t* pass, std::int32_t* out) {
    const int width = (1 << a) + 1;
    std::fill_n(out, row_vertices, blend_none);
    std::fill_n(out + row_vertices, row_vertices, -1);
    const std::int32_t* list = pass + line_bytes / 4;
    for (int n = 0; n < *pass; ++n) {
        const int vertex = list[n];
        const int along = vertex - list[pass_vertices + n];
        out[vertex] = along == 1 ? blend_along_u : along == width ? blend_along_v : blend_diagonal;
        out[row_vertices + vertex] = list[3 * pass_vertices + n];
    }
}

void Frame::Impl::place_blend_table() {
    auto* table = region<std::int32_t>("blend table", -1, blend_table_words);
    header->blend_table.set(table);
    for (int a = 0; a <= block_log2; ++a)
        for (int b = 0; b <= block_log2; ++b) {
            for (int pass = 0; pass < blend_passes; ++pass)
                fill_pass(a, b, pass, table + blend_pass(a, b, pass));
            fill_rows(a, table + blend_pass(a, b, blend_passes - 1), table + blend_rows(a, b));
        }
}

void Frame::Impl::place_workers() {
    // All of it lives for one frame.
    auto n = static_cast<std::size_t>(options.workers);
    header->queues.set(region<QueueRecord>("queues", -1, 1, true));
    header->trees.set(region<TreeRecord>("kd nodes", -1, static_cast<std::size_t>(trees), true));
    header->workers.set(region<WorkerRecord>("stack", -1, n, true));
    for (int t = 0; t < trees; ++t)
        header->trees.get()[t].patches.set(
            coloured<OpenPatch>("grids", t, static_cast<std::size_t>(header->patch_count), colour_patches));
    // The regions of one family lie side by side, so that one base and 32 bits name anything in it.
    auto size = [&](std::uint64_t wanted, std::uint64_t all) {
        std::uint64_t granule = isa::address_space::granule;
        std::uint64_t most = share_of(all, options.workers) - granule; // room for colours
        return wanted == 0 ? most : std::min((wanted + granule - 1) / granule * granule, most);
    };
    std::uint64_t grid_bytes = size(options.grid_bytes, all_grids);
    std::uint64_t node_bytes = size(options.node_bytes, all_nodes);
    std::uint64_t list_bytes = size(options.list_bytes, all_lists);
    grid_lines_each = static_cast<int>(grid_bytes / line_bytes);
    nodes_each = static_cast<int>(node_bytes / sizeof(KdNode));
    list_lines_each = static_cast<int>(list_bytes / line_bytes);
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
    for (int w = 0; w < options.workers; ++w) {
        WorkerRecord& r = header->workers.get()[w];
        r.stack.set(coloured<float>("stack", w, stack_floats, colour_stack));
        r.packets.set(coloured<float>("packets", w, packet_floats, colour_packets));
        r.blends.set(coloured<float>("blended blocks", w, blends_floats, colour_blends));
        r.tree = options.tree_of_worker[static_cast<std::size_t>(w)];
    }
}

void Frame::Impl::place_view(const Scene& scene) {
    const Settings& s = scene.settings;
    FrameHeader& h = *header;
    h.width = s.width;
    h.height = s.height;
    h.samples = s.samples;
    h.tiles_x = (s.width + tile_side - 1) / tile_side;
    h.tiles = h.tiles_x * ((s.height + tile_side - 1) / tile_side);
    const View v = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, s);
    const double pixel = 2 * film.half_height / s.height;
    put(h.camera, scene.camera.position - geometry.origin);
    put(h.film_corner, v.forward - v.right * film.half_width + v.up * film.half_height);
    put(h.film_x, v.right * pixel);
    put(h.film_y, -v.up * pixel);
    put(h.background, glm::dvec3(scene.sky));
    // All samples that a pixel takes share the domain.
    const auto spacing = [&](double domain, int samples) {
        return static_cast<float>(s.edge_pixels * std::sqrt(domain / std::max(samples, 1) / s.samples));
    };
    if (!scene.lights.empty()) {
        const RectangleLight& light = scene.lights.front();
        glm::dvec3 normal = glm::cross(light.edge_u, light.edge_v);
        double area = glm::length(normal);
        if (area > 0 && std::max({light.radiance.x, light.radiance.y, light.radiance.z}) > 0) {
            h.light_samples = s.light_samples;
            put(h.light_corner, light.corner - geometry.origin);
            put(h.light_u, light.edge_u);
            put(h.light_v, light.edge_v);
            h.light_spacing = spacing(area, s.light_samples);
            put(h.light_normal, normal / area);
            put(h.light_radiance, glm::dvec3(light.radiance) *
                                      (area / (3.14159265358979323846 * std::max(s.light_samples, 1))));
        }
    }
    if (std::max({scene.sky.x, scene.sky.y, scene.sky.z}) > 0) {
        h.sky_samples = s.sky_samples;
        put(h.sky, glm::dvec3(scene.sky) / static_cast<double>(std::max(s.sky_samples, 1)));
    }
    h.fixed_target = s.lod == Lod::fixed ? least_target_edge : 0.0F;
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
    h.sky_spacing = spacing(3.14159265358979323846, s.sky_samples);
    h.reach = static_cast<float>(geometry.reach);
    auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
    h.film.set(region<float>("frame buffer", -1, pixels * film_planes));
}

void Frame::Impl::reset() {
    *header->queues.get() = QueueRecord{};
    for (int t = 0; t < trees; ++t) {
        TreeRecord& tree = header->trees.get()[t];
        tree.root_state.word = absent;
        // Reads as zero again, which is an absent patch, wherever something was written.
        memory->clear(*memory->find(memory->offset(tree.patches.get())));
        opened[static_cast<std::size_t>(t)]->clear();
    }
    watch.restart();
    for (int w = 0; w < options.workers; ++w) {
        WorkerRecord& r = header->workers.get()[w];
        r.grid_next = first_grid_line(w);
        r.grid_end = r.grid_next + grid_lines_each;
        r.node_next = first_node(w);
        r.node_end = r.node_next + nodes_each;
        r.list_next = first_list_line(w);
        r.list_end = r.list_next + list_lines_each;
        std::fill_n(reinterpret_cast<std::int32_t*>(r.stack.get() + scratch_free_lists), list_sizes, -1);
        r.next_field = 1; // 0: the camera's
        counters[static_cast<std::size_t>(w)] = {};
    }
}

Frame::Frame(const Scene& scene, const FrameOptions& options) {
    try {
        impl_ = std::make_unique<Impl>(scene, options);
    } catch (const UserError&) {
        throw;
    } catch (const std::runtime_error& e) { // no address space
        throw UserError(fmt::format("{}: {}", scene.name, e.what()));
    }
}
Frame::~Frame() = default;

void Frame::reset() {
    impl_->reset();
}

namespace {

[[noreturn]] void explain(const isa::trapped& trap) {
    const char* what = trap.code == trap_grids_full   ? "tessellated grids"
                       : trap.code == trap_nodes_full ? "kd-tree nodes"
                                                      : "kd-tree item lists";
    throw UserError(fmt::format(
        "frame memory for {} is full; use a larger target edge (--edge-pixels), or share kd-trees "
        "between more workers",
        what));
}

} // namespace

void Frame::render(const KernelTable& kernels, int worker) {
    try {
        kernels.render[impl_->plan](impl_->arguments(worker));
    } catch (const isa::trapped& trap) {
        explain(trap);
    }
}

void Frame::trace(const KernelTable& kernels, const TraceArguments& arguments) {
    try {
        kernels.trace[impl_->plan](impl_->arguments(0), arguments);
    } catch (const isa::trapped& trap) {
        explain(trap);
    }
}

void Frame::build_all(const KernelTable& kernels) {
    try {
        kernels.build_all(impl_->arguments(0));
    } catch (const isa::trapped& trap) {
        explain(trap);
    }
}

void Frame::dice_all(const KernelTable& kernels) {
    try {
        kernels.dice_all(impl_->arguments(0));
    } catch (const isa::trapped& trap) {
        explain(trap);
    }
}

void Frame::set_reach(double distance) {
    impl_->header->reach = static_cast<float>(impl_->geometry.reach + distance);
}

void Frame::stop() {
    auto& word = impl_->header->queues.get()->next_tile.word;
    std::atomic_ref(word).fetch_or(1 << 30, std::memory_order_relaxed);
}

isa::page_service& Frame::pages() {
    return *impl_->pages;
}
isa::address_space& Frame::memory() {
    return *impl_->memory;
}
FrameHeader& Frame::header() {
    return *impl_->header;
}
Plan Frame::plan() const {
    return impl_->plan;
}
int Frame::workers() const {
    return impl_->options.workers;
}
int Frame::instances() const {
    return static_cast<int>(impl_->geometry.instances.size());
}
glm::dvec3 Frame::origin() const {
    return impl_->geometry.origin;
}

std::byte* Frame::memory_bytes(const std::string& structure, std::size_t bytes) {
    return impl_->memory->add(structure, -1, bytes);
}

double Frame::progress() const {
    auto& word = impl_->header->queues.get()->next_tile.word;
    int taken = std::atomic_ref(word).load(std::memory_order_relaxed);
    return std::min(1.0, static_cast<double>(taken) / impl_->header->tiles);
}

FrameStatistics Frame::statistics() const {
    FrameStatistics s;
    for (const CountersByKind& c : impl_->counters)
        s.by_kind += c;
    s.counters = s.by_kind.sum();
    s.trees = impl_->trees;
    s.meshes = static_cast<std::int64_t>(impl_->meshes.size());
    s.instances = static_cast<std::int64_t>(impl_->geometry.instances.size());
    s.patches = impl_->patches * impl_->trees;
    s.graph_nodes = static_cast<std::int64_t>(impl_->geometry.graph.size()) * impl_->trees;
    s.clusters = impl_->clusters * impl_->trees;
    for (const std::unique_ptr<isa::mark_set>& opened : impl_->opened) {
        const auto nodes = static_cast<std::int64_t>(impl_->geometry.graph.size());
        for (std::int64_t n = 0; n < nodes; ++n) {
            const bool leaf = impl_->geometry.graph[static_cast<std::size_t>(n)].instance >= 0;
            s.graph_nodes_opened += opened->is_marked(n) ? 1 : 0;
            s.instances_opened += leaf && opened->is_marked(n) ? 1 : 0;
        }
        for (std::int64_t k = 0; k < impl_->clusters; ++k)
            s.clusters_opened += opened->is_marked(nodes + k) ? 1 : 0;
    }
    s.refit_seconds = impl_->watch.seconds(moment_refitted);
    s.first_packet_seconds = impl_->watch.seconds(moment_first_packet);
    for (const isa::region& r : impl_->memory->regions()) {
        const auto bytes = static_cast<std::int64_t>(r.end - r.begin);
        s.scene_graph_bytes += r.structure == "scene graph" ? bytes : 0;
        s.topology_bytes += r.structure == "topology" ? bytes : 0;
        s.control_point_bytes += r.structure == "control points" ? bytes : 0;
    }
    for (int t = 0; t < impl_->trees; ++t) {
        const isa::address_space& memory = *impl_->memory;
        const OpenPatch* table = impl_->header->trees.get()[t].patches.get();
        s.patch_table_bytes +=
            static_cast<std::int64_t>(memory.resident_bytes(*memory.find(memory.offset(table))));
    }
    s.undrawn_faces = impl_->undrawn;
    for (int w = 0; w < impl_->options.workers; ++w) {
        const WorkerRecord& r = impl_->header->workers.get()[w];
        for (int i = impl_->first_node(w); i < r.node_next; ++i) {
            int state = impl_->header->nodes.get()[i].state.word;
            s.inner_nodes += state == node_inner ? 1 : 0;
            s.leaves += state == node_leaf ? 1 : 0;
            s.unsplit_nodes += state == node_unsplit ? 1 : 0;
        }
        s.grid_bytes += static_cast<std::int64_t>(r.grid_next - impl_->first_grid_line(w)) * line_bytes;
        s.node_bytes += static_cast<std::int64_t>(r.node_next - impl_->first_node(w)) *
                        static_cast<std::int64_t>(sizeof(KdNode));
        s.list_bytes += static_cast<std::int64_t>(r.list_next - impl_->first_list_line(w)) * line_bytes;
    }
    s.page_bytes = impl_->pages->made_bytes();
    s.page_seconds = impl_->pages->seconds();
    s.plan =
        impl_->plan == plan_flat ? "flat patches only: no hanging vertices" : "grids with hanging vertices";
    return s;
}

Film Frame::film() const {
    const FrameHeader& h = *impl_->header;
    Film film(h.width, h.height);
    std::size_t pixels = film.pixel_count();
    const float* values = h.film.get();
    for (const char* name : film_names) {
        film.add(name).values.assign(values, values + pixels);
        values += pixels;
    }
    return film;
}

} // namespace razor
