// What a frame consists of, and where it lies in the frame's address space.
#pragma once

#include "razor/frame/emitters.h"
#include "razor/frame/frame.h"
#include "razor/frame/material_records.h"
#include "razor/frame/page_store.h"
#include "razor/frame/phases.h"
#include "razor/frame/scene_geometry.h"
#include "razor/surface/topology.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace razor {

inline constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;
// Gathers index grids by signed 32-bit words; nodes and lists are numbered by signed 32 bits.
inline constexpr std::uint64_t all_grids = 8 * gibibyte;
inline constexpr std::uint64_t all_nodes = 16 * gibibyte;
inline constexpr std::uint64_t all_lists = 64 * gibibyte;

/// Owners' regions begin at multiples of 64 KiB. If what they use did as well, the busiest lines of all
/// workers would fall into the same few sets of a cache and into one bank of memory. So each owner begins
/// some lines further on, each kind of region elsewhere: these many lines, fewer than fit into 64 KiB.
inline constexpr int coloured_lines = static_cast<int>(isa::address_space::granule / line_bytes);
inline constexpr int nodes_a_line = line_bytes / static_cast<int>(sizeof(KdNode));
enum Coloured : int {
    colour_stack,
    colour_packets,
    colour_blends,
    colour_grids,
    colour_nodes,
    colour_lists,
    colour_patches,
    colour_curve_lengths,
    colour_cuts
};
inline int colour(int owner, Coloured kind) {
    return (owner * 97 + kind * 411) % coloured_lines;
}

/// How many of a pixel's samples packets of camera rays take together: so many that packets divide them, and
/// a lane is left for each of two pixels.
int packet_samples_log2(int samples);

struct Frame::Impl {
    /// Of valid meshes, in the frame's unit.
    Impl(const Scene& scene, const FrameOptions& options);

    Crop part;     // of the picture: what is rendered
    Camera camera; // in the frame's unit
    Settings settings;
    double unit = 1;          // see frame_unit()
    double topology_unit = 1; // that of `meshes`
    /// Those of the scene, then the texture cages (razor/surface/texture_cage.h) of those that need them.
    std::vector<Mesh> meshes;
    std::vector<Topology> topologies;
    std::size_t scene_meshes = 0;
    std::vector<int> face_map_bits;   // of each mesh of the scene whose faces have materials: of all of them
    std::vector<int> texture_cage_of; // of each mesh of the scene, -1: none
    std::vector<bool> shades_by_texture; // likewise; else its cage is for displacement alone
    std::vector<bool> shades_by_rest;    // likewise, patterns of objects, and it changes its shape
    /// Meshes whose blocks keep places at rest.
    std::int64_t meshes_at_rest() const {
        return std::count(shades_by_rest.begin(), shades_by_rest.end(), true);
    }
    MaterialTables materials;
    std::vector<bool> drawn; // of the meshes: whether there is anything to see of one
    FrameOptions options;
    SceneGeometry geometry;
    std::optional<FlatIndex> index; // of the geometry's graph, once something is followed
    bool followed = true;           // else geometry and records are those of no moment
    Touched touched;                // by the last pose
    std::unique_ptr<PageStore> pages;
    std::unique_ptr<isa::address_space> memory;
    FrameHeader* header = nullptr;
    std::vector<CountersByKind> counters; // one a worker
    int trees = 1;
    int nodes_each = 0, grid_lines_each = 0, list_lines_each = 0; // arena sizes of a worker
    std::uint64_t grid_bytes = 0, node_bytes = 0, list_bytes = 0; // the same
    std::vector<int> grains;                                      // with a budget: of each tree's arena
    std::unique_ptr<BudgetLog> log;                               // likewise
    Plan plan;
    std::int64_t undrawn = 0;
    struct {
        std::size_t clusters = 0, faces = 0, controls = 0, face_curves = 0, points = 0, curves = 0;
    } total;                                                         // over the meshes
    std::vector<std::size_t> first_cluster, first_point, first_face; // of each mesh
    std::int64_t patches = 0, clusters = 0;                          // over the instances
    std::vector<std::unique_ptr<isa::mark_set>> opened; // one a tree: graph nodes, then instances' clusters
    isa::stopwatch watch{moment_count};
    std::vector<isa::lap_timer> tiles;   // one a worker
    std::vector<isa::lap_timer> waits;   // likewise
    std::vector<TileLog> tile_logs;      // likewise, where they are asked for
    std::atomic<std::int64_t> dealt = 0; // strides
    TilePass* tile_passes = nullptr;     // of each screen tile, where that is asked for
    std::vector<int> tile_samples;       // that each has or is taking; empty: all the same
    std::vector<TilePlace> tiles_placed; // with them

    const Topology& topology_of(const Instance& instance) const {
        return topologies[static_cast<std::size_t>(instance.mesh)];
    }
    std::size_t most_lights = 0;        // that there is room for
    bool chooses_lights = false;        // there is room for a tree of them
    std::unique_ptr<Emitters> emitters; // null: no surface is a light
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
    /// Which materials are used, and what for that.
    void take_materials(const Scene& scene);
    void fill_solid(std::size_t n);           // of an instance: its SolidRecord, where there are some
    int map_bits_of(const Instance& i) const; // of all its materials
    std::int32_t shading_of(const Scene& scene, const Instance& i) const; // InstanceRecord::shading
    void count_records(const Scene& scene);
    void size_arenas();
    void size_bounded_arenas();
    // Each takes room, and has what a pose changes filled in.
    void place_scene(const Scene& scene);
    void place_materials(const Scene& scene);
    void place_sky(const Scene& scene);
    void place_displacement();
    /// Of a mesh that is displaced, by its points as they are now.
    void fill_density(const Mesh& mesh, std::size_t number);
    void place_graph();
    void place_points(const Scene& scene);
    void place_topology();
    void place_blend_table();
    void place_workers();
    void order_workers();
    void place_arenas();
    void place_bounded_arenas();
    void reset_budget();
    int workers_of(int tree) const {
        return static_cast<int>(
            std::count(options.tree_of_worker.begin(), options.tree_of_worker.end(), tree));
    }
    std::uint64_t arena_bytes() const;
    void place_view(const Scene& scene);
    void fill_instances(const Scene& scene);
    void fill_instance(const Scene& scene, std::size_t n);
    void fill_graph();
    void fill_points(const Scene& scene, std::size_t mesh);
    void fill_meshes(const Scene& scene);
    /// Which clusters the next refit makes boxes of: those of these meshes, and what the last one was to make
    /// and did not.
    void list_clusters(const std::vector<int>& of_meshes);
    void fill_view(const Scene& scene);
    void fill_lights(const Scene& scene);
    /// Makes a tree of those that are to be chosen from, if any: says which of all.
    std::vector<bool> choose_lights(const Scene& scene);
    /// Room for lights.
    void place_lights(const Scene& scene);
    /// Surfaces that are lights.
    void place_emitters(const Scene& scene);
    void fill_emitters(const Scene& scene);
    void place_filter(const Scene& scene);
    /// Which of a pixel's camera samples workers take.
    void choose_samples(int first, int count);
    /// In the frame's unit, which `unit` is to be. False: with another number of instances, or more lights.
    bool pose(const Scene& scene);
    /// Of a scene in units of 1, as is the frame. False: everything is to be posed.
    bool follow(const Scene& scene, const SceneChanges& changes);
    void reset();
    /// Divides the tiles from `first` up to `end` among the workers, in stretches that follow each other as
    /// their places do.
    void deal_tiles(int first, int end);
    /// The fraction of what was dealt that somebody has taken.
    double taken() const;
    WorkerArguments arguments(int worker) {
        const auto w = static_cast<std::size_t>(worker);
        const auto tree = static_cast<std::size_t>(options.tree_of_worker[w]);
        return {header, worker,    pages.get(), counters[w].kind, opened[tree].get(),
                &watch, &tiles[w], &waits[w],   log.get()};
    }
};

} // namespace razor
