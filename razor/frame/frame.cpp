#include "razor/frame/frame.h"

#include "razor/frame/frame_memory.h"
#include "razor/frame/scratch.h"
#include "razor/frame/unit.h"
#include "razor/frame/view.h"
#include "razor/scene/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <stdexcept>
#include <utility>

namespace razor {

namespace {

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

constexpr const char* film_names[film_planes] = {"R",        "G",       "B",        "normal.X", "normal.Y",
                                                 "normal.Z", "depth.Z", "albedo.R", "albedo.G", "albedo.B"};

} // namespace

Frame::Impl::Impl(const Scene& scene, const FrameOptions& o) : meshes(scene.meshes), options(o) {
    for (const Mesh& mesh : meshes)
        topologies.push_back(analyse_topology(mesh));
    trees = count_trees(options);
    if (!options.place_of_worker.empty() &&
        options.place_of_worker.size() != static_cast<std::size_t>(options.workers))
        throw std::invalid_argument("a frame's place_of_worker must have one entry a worker");
    for (const Topology& t : topologies)
        drawn.push_back(!t.patches.empty());
    geometry = locate_scene(scene, drawn);
    scene_meshes = meshes.size();
    take_materials(scene);
    count_records(scene);
    pages = std::make_unique<PageStore>(meshes, topologies, options.page_bytes);
    counters.resize(static_cast<std::size_t>(options.workers));
    for (std::size_t w = 0; options.tile_costs && w < counters.size(); ++w)
        tile_logs.emplace_back(counters[w]);
    size_arenas();
    // OpenPatch entries and curve lengths, tables a tree, take memory only where a patch is opened.
    const std::uint64_t scene_bytes =
        static_cast<std::uint64_t>(clusters) *
            (refit_patches * sizeof(OpenPatch) * static_cast<std::size_t>(trees) + 4) +
        total.curves * 4 * static_cast<std::size_t>(trees) +
        total.clusters * (refit_patches * sizeof(PatchRecord) + 64) + total.controls * 4 +
        (total.faces + total.points + total.curves + total.face_curves) * 64 +
        geometry.instances.size() * sizeof(InstanceRecord) + materials.texels * 4 +
        materials.materials.size() * 1024 + 2 * sizeof(FilterBin) * filter_bins +
        Hierarchy::node_limit(geometry.instances.size()) * sizeof(GraphNodeRecord);
    auto pixels =
        static_cast<std::uint64_t>(scene.settings.width) * static_cast<std::uint64_t>(scene.settings.height);
    memory = std::make_unique<isa::address_space>(
        pages->entry_count() * sizeof(PageEntry) + pages->line_count() * line_bytes + arena_bytes() +
        2 * scene_bytes + pixels * (options.passes ? 64 + 8 * weighted_sum_planes : 64) + 4 * gibibyte +
        static_cast<std::uint64_t>(options.workers + trees) * 64 * isa::address_space::granule);
    place_scene(scene);
    place_graph();
    place_points(scene);
    place_topology();
    place_blend_table();
    place_workers();
    place_view(scene);
    touched.instances = static_cast<std::int64_t>(geometry.instances.size());
    reset();
}

void Frame::Impl::reset() {
    *header->queues.get() = QueueRecord{};
    choose_samples(0, settings.samples);
    tile_samples.clear();
    header->tile_passes.set(nullptr);
    deal_tiles(0, header->tiles_x * header->tiles_y);
    for (int t = 0; t < trees; ++t) {
        TreeRecord& tree = header->trees.get()[t];
        tree.root_state.word = absent;
        tree.left.word = 0;
        // Reads as zero again, which is an absent patch, wherever something was written.
        memory->clear(*memory->find(memory->offset(tree.patches.get())));
        memory->clear(*memory->find(memory->offset(tree.curve_lengths.get())));
        opened[static_cast<std::size_t>(t)]->clear();
    }
    watch.restart();
    tiles.assign(static_cast<std::size_t>(options.workers), {});
    waits.assign(static_cast<std::size_t>(options.workers), {});
    for (std::size_t w = 0; w < tile_logs.size(); ++w) {
        tile_logs[w].clear();
        tiles[w].tell(&tile_logs[w]);
    }
    if (log)
        reset_budget();
    for (int w = 0; w < options.workers; ++w) {
        WorkerRecord& r = header->workers.get()[w];
        r.grid_next = log ? 0 : first_grid_line(w);
        r.grid_end = r.grid_next + grid_lines_each;
        r.node_next = log ? 0 : first_node(w);
        r.node_end = r.node_next + nodes_each;
        r.list_next = log ? 0 : first_list_line(w);
        r.list_end = r.list_next + list_lines_each;
        for (float* stack : {r.stack.get(), r.stack.get() + spare_stack})
            std::fill_n(reinterpret_cast<std::int32_t*>(stack + scratch_free_lists), list_sizes, -1);
        r.next_field = 1; // 0: the camera's
        counters[static_cast<std::size_t>(w)] = {};
    }
}

int screen_tiles(const Settings& settings) {
    const Crop part = shown_part(settings);
    const auto along = [](int first, int pixels) {
        return (first + pixels + tile_side - 1) / tile_side - first / tile_side;
    };
    return along(part.x, part.width) * along(part.y, part.height);
}

Frame::Frame(const Scene& scene, const FrameOptions& options) {
    if (scene.meshes.empty())
        throw UserError(fmt::format("{}: the scene has no mesh; add one", scene.name));
    for (const Mesh& mesh : scene.meshes)
        validate_mesh(mesh);
    try {
        const double unit = frame_unit(scene);
        impl_ = unit == 1 ? std::make_unique<Impl>(scene, options)
                          : std::make_unique<Impl>(scaled(scene, 1 / unit), options);
        impl_->unit = impl_->topology_unit = unit;
    } catch (const UserError&) {
        throw;
    } catch (const std::runtime_error& e) { // no address space
        throw UserError(fmt::format("{}: {}", scene.name, e.what()));
    }
}
Frame::~Frame() = default;

bool Frame::pose(const Scene& scene) {
    Impl& f = *impl_;
    if (!f.options.moves)
        throw std::invalid_argument("the frame was not made to move");
    f.followed = false;
    for (const Mesh& mesh : scene.meshes)
        validate_mesh(mesh);
    const double unit = frame_unit(scene);
    const auto own_end = f.meshes.begin() + static_cast<std::ptrdiff_t>(f.scene_meshes);
    if (!std::equal(f.meshes.begin(), own_end, scene.meshes.begin(), scene.meshes.end(),
                    [&f](const Mesh& mine, const Mesh& posed) {
                        return same_topology(posed, mine, 1 / f.topology_unit);
                    }))
        return false;
    f.unit = unit;
    return unit == 1 ? f.pose(scene) : f.pose(scaled(scene, 1 / unit));
}

bool Frame::pose(const Scene& scene, const SceneChanges& changes) {
    Impl& f = *impl_;
    if (!f.options.moves)
        throw std::invalid_argument("the frame was not made to move");
    const bool goes_on = std::exchange(f.followed, false);
    for (const int m : changes.meshes) {
        const auto mesh = static_cast<std::size_t>(m);
        validate_mesh(scene.meshes[mesh]);
        if (!same_topology(scene.meshes[mesh], f.meshes[mesh], 1 / f.topology_unit))
            return false;
    }
    return (goes_on && f.follow(scene, changes)) || pose(scene);
}

void Frame::reset() {
    impl_->reset();
}

namespace {

/// "3.5 MiB".
std::string bytes_text(std::uint64_t bytes) {
    return bytes < 1U << 20U ? fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024)
                             : fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1U << 20U));
}

[[noreturn]] void explain(const isa::trapped& trap, const FrameOptions& options, int trees) {
    if (trap.code == trap_memory_spent || trap.code == trap_budget_too_small)
        throw UserError(
            fmt::format("a memory budget of {} is too small: one screen tile alone needs more than {}; raise "
                        "--memory{} or "
                        "use a larger target edge (--edge-pixels)",
                        bytes_text(options.memory_bytes),
                        trees == 1 ? "that" : fmt::format("what each of {} kd-trees has of it", trees),
                        trees == 1 ? "" : ", share kd-trees between more workers (--share)"));
    const char* what = trap.code == trap_grids_full   ? "tessellated grids"
                       : trap.code == trap_nodes_full ? "kd-tree nodes"
                       : trap.code == trap_pages_full ? "limit weights"
                                                      : "kd-tree item lists";
    throw UserError(fmt::format(
        "frame memory for {} is full; use a larger target edge (--edge-pixels), or share kd-trees "
        "between more workers",
        what));
}

} // namespace

void Frame::render(const KernelTable& kernels, int worker) {
    try {
        kernels.render[impl_->plan.look][impl_->plan.grids](impl_->arguments(worker));
    } catch (const isa::trapped& trap) {
        explain(trap, impl_->options, impl_->trees);
    }
}

void Frame::trace(const KernelTable& kernels, const TraceArguments& arguments) {
    try {
        kernels.trace[impl_->plan.grids](impl_->arguments(0), arguments);
    } catch (const isa::trapped& trap) {
        explain(trap, impl_->options, impl_->trees);
    }
}

void Frame::see(const KernelTable& kernels, const SeeArguments& arguments) {
    try {
        kernels.see[impl_->plan.grids](impl_->arguments(0), arguments);
    } catch (const isa::trapped& trap) {
        explain(trap, impl_->options, impl_->trees);
    }
}

void Frame::build_all(const KernelTable& kernels) {
    try {
        kernels.build_all(impl_->arguments(0));
    } catch (const isa::trapped& trap) {
        explain(trap, impl_->options, impl_->trees);
    }
}

void Frame::dice_all(const KernelTable& kernels) {
    try {
        kernels.dice_all(impl_->arguments(0));
    } catch (const isa::trapped& trap) {
        explain(trap, impl_->options, impl_->trees);
    }
}

void Frame::set_reach(double distance) {
    impl_->header->reach = static_cast<float>(impl_->geometry.reach + distance);
}

void Frame::take_tiles(int first, int end) {
    impl_->deal_tiles(first, end);
}

void Frame::take_samples(int first, int count) {
    Impl& f = *impl_;
    if (!f.options.passes || !f.tile_samples.empty() ||
        (first != 0 && first != f.header->first_sample + f.header->samples))
        throw std::invalid_argument("a frame's passes must follow each other");
    f.choose_samples(first, count);
    f.deal_tiles(0, f.header->tiles_x * f.header->tiles_y);
}

void Frame::take_samples(const KernelTable& kernels, std::span<const int> ends) {
    Impl& f = *impl_;
    const auto tiles = static_cast<std::size_t>(f.header->tiles);
    if (!f.options.tile_passes || ends.size() != tiles)
        throw std::invalid_argument("a frame's passes by tile need tile_passes, and a number for each tile");
    if (f.tile_samples.empty()) {
        f.tile_samples.assign(tiles, 0);
        f.tiles_placed = tile_places(kernels);
        std::fill_n(f.tile_passes, tiles, TilePass{});
        f.header->tile_passes.set(f.tile_passes);
    }
    for (std::size_t t = 0; t < tiles; ++t) {
        TilePass& pass = f.tile_passes[t];
        if (ends[t] < f.tile_samples[t])
            throw std::invalid_argument("a tile's passes must follow each other");
        // What it added last is what it goes on from.
        pass.swapped = pass.swapped != (pass.end > pass.first ? 1 : 0) ? 1 : 0;
        pass.first = f.tile_samples[t];
        pass.end = f.tile_samples[t] = ends[t];
        pass.packet_samples_log2 = packet_samples_log2(pass.end - pass.first);
    }
    f.deal_tiles(0, f.header->tiles_x * f.header->tiles_y);
}

std::vector<TilePlace> Frame::tile_places(const KernelTable& kernels) {
    const FrameHeader& h = *impl_->header;
    std::vector<std::int32_t> places(2 * static_cast<std::size_t>(h.tiles));
    kernels.place_tiles(impl_->arguments(0), places.data());
    std::vector<TilePlace> tiles;
    for (auto place = places.begin(); place != places.end(); place += 2)
        tiles.push_back({h.first_column + place[0], h.first_row + place[1]});
    return tiles;
}

void Frame::stop() {
    std::atomic_ref(impl_->header->queues.get()->stopped.word).store(1, std::memory_order_relaxed);
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
const CountersByKind& Frame::counters(int worker) const {
    return impl_->counters[static_cast<std::size_t>(worker)];
}
int Frame::first_face(int mesh) const {
    return static_cast<int>(impl_->first_face[static_cast<std::size_t>(mesh)]);
}
int Frame::workers() const {
    return impl_->options.workers;
}
int Frame::instances() const {
    return static_cast<int>(impl_->geometry.instances.size());
}
glm::dvec3 Frame::origin() const {
    return impl_->geometry.origin * impl_->unit;
}
double Frame::unit() const {
    return impl_->unit;
}

std::byte* Frame::memory_bytes(const std::string& structure, std::size_t bytes) {
    return impl_->memory->add(structure, -1, bytes);
}

double Frame::progress() const {
    return impl_->taken();
}

namespace {

constexpr const char* look_names[look_count] = {
    "matte surfaces", "matte surfaces with textures or materials of faces", "reflecting surfaces",
    "reflecting surfaces with textures or materials of faces"};

std::string plan_text(const Plan& plan) {
    return fmt::format("{}; {}",
                       plan.grids == grids_flat ? "flat patches only: no hanging vertices"
                                                : "grids with hanging vertices",
                       look_names[plan.look]);
}

} // namespace

FrameStatistics Frame::statistics() const {
    FrameStatistics s;
    for (const CountersByKind& c : impl_->counters)
        s.by_kind += c;
    s.counters = s.by_kind.sum();
    s.trees = impl_->trees;
    s.meshes = static_cast<std::int64_t>(impl_->meshes.size());
    s.instances = static_cast<std::int64_t>(impl_->geometry.instances.size());
    s.patches = impl_->patches * impl_->trees;
    const std::vector<HierarchyNode>& graph = impl_->geometry.graph.nodes();
    for (const HierarchyNode& node : graph)
        s.graph_nodes += node.instance >= 0 || node.child_count > 0 ? impl_->trees : 0;
    s.touched = impl_->touched;
    s.clusters = impl_->clusters * impl_->trees;
    for (const std::unique_ptr<isa::mark_set>& opened : impl_->opened) {
        const auto nodes = static_cast<std::int64_t>(graph.size());
        for (std::int64_t n = 0; n < nodes; ++n) {
            const bool leaf = graph[static_cast<std::size_t>(n)].instance >= 0;
            s.graph_nodes_opened += opened->is_marked(n) ? 1 : 0;
            s.instances_opened += leaf && opened->is_marked(n) ? 1 : 0;
        }
        for (std::int64_t k = 0; k < impl_->clusters; ++k)
            s.clusters_opened += opened->is_marked(nodes + k) ? 1 : 0;
    }
    s.refit_seconds = impl_->watch.seconds(moment_refitted);
    s.first_packet_seconds = impl_->watch.seconds(moment_first_packet);
    for (const isa::lap_timer& worker : impl_->tiles) {
        const isa::lap_timer::figures& laps = worker.laps();
        s.tiles += laps.count;
        s.tile_seconds += laps.seconds;
        if (laps.slowest_seconds > s.slowest_tile_seconds) {
            s.slowest_tile_seconds = laps.slowest_seconds;
            s.slowest_tile = static_cast<int>(laps.slowest);
        }
    }
    for (const isa::lap_timer& worker : impl_->waits)
        s.wait_seconds += worker.laps().seconds;
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
    for (int t = 0; impl_->log && t < impl_->trees; ++t) {
        const Inventory now = take_inventory(*impl_->header, t, before_all).used;
        s.inner_nodes += now.inner_nodes;
        s.leaves += now.leaves;
        s.unsplit_nodes += now.unsplit_nodes;
        s.grid_bytes += now.grid_bytes;
        s.node_bytes += now.node_bytes;
        s.list_bytes += now.list_bytes;
    }
    for (int w = 0; !impl_->log && w < impl_->options.workers; ++w) {
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
    s.plan = plan_text(impl_->plan);
    s.grids = impl_->plan.grids;
    s.look = impl_->plan.look;
    const MaterialTables& materials = impl_->materials;
    s.patterns = std::any_of(materials.textures.begin(), materials.textures.end(),
                             [](const TextureRecord& t) { return t.kind != texture_image; });
    s.bumps = std::any_of(materials.map_bits.begin(), materials.map_bits.end(),
                          [](int bits) { return (bits >> map_bump & 1) != 0; });
    s.displacement = !materials.displacements.empty();
    s.one_sided = materials.one_sided;
    s.sheen = materials.sheens != sheen_none;
    s.sheen_maps = materials.sheens >= sheen_mapped;
    s.mesh_lights = impl_->header->emitter_count > 0;
    s.chosen_lights = impl_->header->light_choices > 0;
    if (s.look != look_matte)
        s.material_records = static_cast<std::int64_t>(impl_->materials.materials.size());
    s.textured_meshes = static_cast<std::int64_t>(impl_->meshes.size() - impl_->scene_meshes);
    s.meshes_at_rest = impl_->meshes_at_rest();
    s.texture_bytes = static_cast<std::int64_t>(impl_->materials.texels) * 4;
    return s;
}

std::vector<TileCost> Frame::tile_costs(const KernelTable& kernels) {
    const std::vector<TilePlace> places = tile_places(kernels);
    std::map<std::int64_t, TileLog::Cost> all;
    for (const TileLog& worker : impl_->tile_logs)
        for (const auto& [tile, cost] : worker.costs()) {
            all[tile].counters += cost.counters;
            all[tile].seconds += cost.seconds;
        }
    std::vector<TileCost> costs;
    for (const auto& [tile, cost] : all) {
        const TilePlace& place = places[static_cast<std::size_t>(tile)];
        costs.push_back({place.column, place.row, cost.counters, cost.seconds});
    }
    return costs;
}

BudgetStatistics Frame::budget() const {
    return impl_->log ? impl_->log->statistics() : BudgetStatistics{};
}

Film Frame::film() const {
    const FrameHeader& h = *impl_->header;
    const Crop& part = impl_->part;
    Film film(part.width, part.height);
    if (part != Crop{0, 0, h.width, h.height})
        film.window = PictureWindow{part.x, part.y, h.width, h.height};
    film.camera = picture_camera(scaled(impl_->camera, impl_->unit), impl_->settings);
    const float* values = h.film.get();
    for (const char* name : film_names) {
        float* to = film.add(name).values.data();
        const float* row = values + static_cast<std::ptrdiff_t>(part.y) * h.width + part.x;
        for (int y = 0; y < part.height; ++y, row += h.width)
            to = std::copy_n(row, part.width, to);
        values += static_cast<std::ptrdiff_t>(h.width) * h.height;
    }
    if (!impl_->tile_samples.empty()) {
        float* const samples = film.add("samples").values.data();
        for (std::size_t t = 0; t < impl_->tile_samples.size(); ++t)
            each_pixel(impl_->tiles_placed[t], part, [&](std::size_t pixel) {
                samples[pixel] = static_cast<float>(impl_->tile_samples[t]);
            });
    }
    if (impl_->unit != 1)
        for (float& depth : film.find("depth.Z")->values)
            depth = static_cast<float>(depth * impl_->unit);
    return film;
}

} // namespace razor
