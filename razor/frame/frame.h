// One frame's memory: the persistent part filled from a scene, room for what the kernels build, and what they
// leave.
#pragma once

#include "isa/address_space.h"
#include "isa/services.h"
#include "razor/frame/budget_log.h"
#include "razor/frame/counters.h"
#include "razor/frame/duplicates.h"
#include "razor/frame/kernel_table.h"
#include "razor/frame/layout.h"
#include "razor/frame/tile_costs.h"
#include "razor/frame/tile_place.h"
#include "razor/image/image.h"
#include "razor/scene/scene.h"
#include "razor/scene/scene_changes.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace razor {

struct FrameOptions {
    int workers = 1;
    /// The kd-tree (with its grids) that each worker uses, numbered from 0 without gaps; empty: all use one.
    std::vector<int> tree_of_worker = {};
    /// Where each worker is: workers of near places share caches. Empty: by their numbers.
    std::vector<int> place_of_worker = {};
    /// Tiles are taken row by row, to compare with the order along a curve.
    bool tiles_in_rows = false;
    /// Each worker's arenas; 0: as large as 32-bit references allow.
    std::uint64_t grid_bytes = 0, node_bytes = 0, list_bytes = 0;
    /// What grids, kd nodes and item lists may take in all, with tables that say what is in use, divided
    /// among the trees as the workers are; what was used longest ago is dropped and made again
    /// (razor/frame/budget.h). More than 8 GiB are 8 GiB. 0: no bound; else the sizes above are not used.
    std::uint64_t memory_bytes = 0;
    /// With a budget: grids, nodes and lists have addresses of their own, so that the machine can tell their
    /// traffic apart; a line that one leaves to another then costs the host memory twice.
    bool apart = false;
    /// The frame may be posed anew.
    bool moves = false;
    /// Samples may be taken in passes: take_samples().
    bool passes = false;
    /// ... of which each tile may take another number.
    bool tile_passes = false;
    /// Kernels say of memory that is done with that its contents are dead (razor/kernels/dead.h).
    bool discards = false;
    /// Keep what each screen tile costs: see Frame::tile_costs().
    bool tile_costs = false;
    /// Room for topology pages; 0: 64 GiB of addresses, which take memory as pages are made.
    std::uint64_t page_bytes = 0;
};

/// How much of what outlives a frame the last pose wrote anew, and its refit: of a new frame everything.
struct Touched {
    std::int64_t instances = 0, graph_nodes = 0, meshes = 0, clusters = 0;
};

/// What was built, and what laziness left unbuilt.
struct FrameStatistics {
    CountersByKind by_kind; // summed over workers
    Counters counters;      // summed over kinds as well
    std::int64_t trees = 0;
    std::int64_t meshes = 0, instances = 0; // analysed once each; drawn
    std::int64_t patches = 0;               // of all instances, times the trees; likewise:
    std::int64_t graph_nodes = 0, clusters = 0;
    std::int64_t graph_nodes_opened = 0, instances_opened = 0, clusters_opened = 0; // leaves are instances
    std::int64_t undrawn_faces = 0;                                                 // holes and the like
    // Of the tree; with a memory budget, what it holds now.
    std::int64_t inner_nodes = 0, leaves = 0;
    std::int64_t unsplit_nodes = 0; // nodes that no ray entered
    std::int64_t grid_bytes = 0, node_bytes = 0, list_bytes = 0;
    std::int64_t scene_graph_bytes = 0, topology_bytes = 0,
                 control_point_bytes = 0; // these outlive the frame
    std::int64_t patch_table_bytes = 0;   // of the tables that name opened patches, what was touched
    /// Host time from the frame's begin until all boxes were refitted, and until the first packet of camera
    /// rays was traced and shaded. 0: unknown.
    double refit_seconds = 0, first_packet_seconds = 0;
    /// Screen tiles rendered, the host time they took together, and the slowest (by its number along the
    /// curve; -1: unknown). How long it takes bounds a frame on many workers from below.
    std::int64_t tiles = 0;
    double tile_seconds = 0, slowest_tile_seconds = 0;
    int slowest_tile = -1;
    double wait_seconds = 0;     // of all workers, for what others were building (counters.waits times)
    std::int64_t page_bytes = 0; // topology pages made so far; they outlive the frame
    double page_seconds = 0;     // host time spent on them
    Touched touched;
    std::string plan; // which kernels the scene needs
    Grids grids = grids_flat;
    Look look = look_matte;
    bool patterns = false, bumps = false, displacement = false, one_sided = false, sheen = false,
         sheen_maps = false;
    bool mesh_lights = false, chosen_lights = false;
    std::int64_t material_records = 0, textured_meshes = 0, meshes_at_rest = 0,
                 texture_bytes = 0; // tables that they need
};

/// How many screen tiles the part of the picture has that is rendered; those on its rim are rendered whole.
int screen_tiles(const Settings& settings);

class Frame {
public:
    /// Analyses the scene's topology and lays out frame memory. Throws UserError for cages that cannot be
    /// rendered.
    Frame(const Scene& scene, const FrameOptions& options);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    /// Empties everything a frame builds, so that it can be rendered again. Topology pages stay.
    void reset();
    /// reset(), for the same meshes in other shapes and places (also other instances, if one after the other
    /// is of the mesh that was there), before another camera or under another light; settings stay. What is
    /// rendered then is, bit for bit, what a new frame would. False where meshes or instances are others, and
    /// then, as where it throws UserError as the constructor does, nothing may be rendered.
    bool pose(const Scene& scene);
    /// The same, where only these changes, camera and lights make the scene another one than that of the last
    /// pose, or of the constructor: nothing else is looked at. After an exception or false the next pose may
    /// be of any scene.
    bool pose(const Scene& scene, const SceneChanges& changes);
    /// Until the next reset() workers take the screen tiles from `first` up to, not including, `end` alone.
    /// They are numbered along the screen's curve (razor/kernels/screen_curve.h). After the workers have
    /// returned they may run again on other tiles, and find what is built; the statistics go on.
    void take_tiles(int first, int end);
    /// Until the next reset() workers take so many camera samples of each pixel, from number `first` on:
    /// where the last ones ended, or 0. The film is then of all samples so far. Of the samples that they take
    /// in one go, its values differ by roundings and, with Lod::recursive, by which rays that leave the
    /// surfaces of a tile share what they ask for (razor/kernels/leave.h): those come in the order of samples
    /// then. Else as take_tiles(), of all tiles. Only with FrameOptions::passes.
    void take_samples(int first, int count);
    /// Of each screen tile, by its number, up to so many of each pixel's camera samples in all, from those
    /// that it has; none where it has as many. Else as take_samples() of all; until the next reset() this
    /// one alone may be called. The film has a plane `samples` then. Only with FrameOptions::tile_passes.
    void take_samples(const KernelTable& kernels, std::span<const int> ends);
    /// Where each screen tile is, by its number.
    std::vector<TilePlace> tile_places(const KernelTable& kernels);
    /// Runs one worker's share; every worker of options.workers must run, each in its own thread or fibre.
    /// Throws UserError if an arena is exhausted, or a memory budget too small for one screen tile.
    void render(const KernelTable& kernels, int worker);
    /// Traces rays given in frame memory (worker 0 alone; call reset() before a render).
    void trace(const KernelTable& kernels, const TraceArguments& arguments);
    /// What rays through the centres of pixels see, as the frame's own camera rays do (worker 0 alone).
    /// Whether or not the frame was rendered before; films stay as they are.
    void see(const KernelTable& kernels, const SeeArguments& arguments);
    /// Builds the whole tree, so that traces find nothing left to build (worker 0 alone).
    void build_all(const KernelTable& kernels);
    /// Makes all blocks that camera rays may ask for, seen or not (worker 0 alone).
    void dice_all(const KernelTable& kernels);
    /// Room in frame memory for tests and benchmarks that trace rays of their own. Call before anything is
    /// rendered.
    template <class T> T* extra(const std::string& structure, std::size_t count) {
        return reinterpret_cast<T*>(memory_bytes(structure, count * sizeof(T)));
    }
    /// Rays may start or end so much further from the scene's centre (in the frame's unit).
    void set_reach(double distance);

    /// Lets the workers end early: no tile is begun any more.
    void stop();
    isa::page_service& pages();
    isa::address_space& memory();
    FrameHeader& header();
    /// Counters and plan are those of the render so far.
    FrameStatistics statistics() const;
    /// Of the trees so far; call it when no worker runs.
    Duplicates duplicates() const;
    /// Of the render so far; call it when no worker runs.
    BudgetStatistics budget() const;
    Plan plan() const;
    /// One worker's so far.
    const CountersByKind& counters(int worker) const;
    /// Of the screen tiles rendered so far, in the order of their numbers, if FrameOptions::tile_costs asked
    /// for it and the kernels are native ones; call it when no worker runs.
    std::vector<TileCost> tile_costs(const KernelTable& kernels);
    /// The number, among PatchRecord::face, of a mesh's first face.
    int first_face(int mesh) const;
    int workers() const;
    /// How many: header().instances.
    int instances() const;
    /// Fraction of the tiles that workers have taken.
    double progress() const;
    /// The film as it stands, of the part of the picture that the settings crop it to; depth and camera are
    /// in world units.
    Film film() const;
    /// What lies in frame memory is in a unit of its own, so many world units long (razor/frame/unit.h), and
    /// scene coordinates begin here in the world: world = origin + unit * scene.
    double unit() const;
    glm::dvec3 origin() const;

private:
    std::byte* memory_bytes(const std::string& structure, std::size_t bytes);
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor
