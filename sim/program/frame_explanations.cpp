// What figures of a report mean that are of the rendered frame, of the command, or of the host beside the
// machine: all that runs of the program say and machines do not.
#include "razor/frame/counters.h"
#include "sim/program/frame_report.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace sim {
namespace {

struct CounterMeaning {
    std::string_view name, meaning;
};

/// Of razor::Counters.
constexpr CounterMeaning counter_meanings[] = {
    {"rays", "that were traced"},
    {"camera_hits", "of camera rays, which are shaded once each"},
    {"bounce_hits", "likewise, of rays that surfaces reflect and let through"},
    {"packets", "of rays that were traced together; rays over packets times lanes is their utilisation"},
    {"groups", "of a packet's rays alike in direction, traversed one after the other"},
    {"node_visits", "visits of nodes of kd-trees, each by a group"},
    {"box_tests", "of groups against boxes of blocks in leaves"},
    {"block_tests", "of groups against the cells of a block whose box some of the rays meet"},
    {"cell_tests", "of groups against boxes of cells, of a few quads of a block each"},
    {"quad_tests", "of groups against quads of two triangles"},
    {"graph_openings", "of nodes of the scene graph, once for each kd node that needs it"},
    {"cluster_openings", "of clusters of patches, likewise"},
    {"patches_opened", "patches of which blocks were wanted"},
    {"blocks_made", "blocks of the surface whose vertices were made"},
    {"vertices_made", "of these blocks"},
    {"triangles_made", "of these blocks"},
    {"plain_tests", "of the block tests, those of some ray at the block's own vertices"},
    {"blended_tests",
     "of the block tests, those of rays whose level lies between two, with the block blended"},
    {"blended_blocks", "blocks that were blended between two levels, for tests and for shading"},
    {"finest_blocks", "of the blocks made, those of level 0"},
    {"normal_blocks", "blocks whose normals were made"},
    {"textured_hits", "of the hits shaded, those where textures make something of the surface"},
    {"shading_evaluations", "of all of a surface's textures, at hits or at vertices"},
    {"grid_evaluations", "of these, evaluations at vertices (phase one)"},
    {"grid_lanes", "lanes that evaluations at vertices took, those at rest too"},
    {"pages_requested", "topology pages that were asked for and not there yet"},
    {"waits", "for what another worker was building"},
    {"steals", "of other workers' stretches of the screen"},
    {"stolen_strides", "strides of the screen that steals took, together"},
    {"meanwhile_runs", "screen tiles rendered in place of a wait"},
    {"lost_races", "takes and steals tried again, as another worker was faster"}};

void add_counters(std::vector<Explanation>& out) {
    for (const char* object : {"renderer.counters.", "renderer.counters_by_kind.*."})
        razor::for_each_counter({}, [&](const std::string& name, std::int64_t) {
            for (const CounterMeaning& m : counter_meanings)
                if (m.name == name) {
                    out.push_back({object + name, "", std::string(m.meaning)});
                    return;
                }
            throw std::logic_error(fmt::format("the counter {} has no meaning", name));
        });
}

std::vector<Explanation> make() {
    std::vector<Explanation> out{
        {"program", "", "that made the report"},
        {"version", "", "of that program"},
        {"options.workers", "", "workers asked for, or one a hardware thread"},
        {"options.share", "", "who shares a kd-tree (--share, or kdtree.share)"},
        {"options.frames", "", "times that the frame was rendered (--frames)"},
        {"options.memory_bytes", "bytes", "that the frame may build at a time (--memory); 0: no bound"},
        {"options.tiles[]", "", "the first and the last screen tile that count (--tiles)"},
        {"scene", "", "a scene file with all that was rendered, defaults too"},
        {"machine_provenance.*.*.from", "", "where this parameter's value was given: a file's line, or -g"},
        {"machine_provenance.*.*.mark", "", "known, or assumed, as the comment there says"},
        {"machine_provenance.*.*.source", "", "of a known value"},
        {"machine_provenance.*.*.remark", "", "what else the comment there says"},
        {"calibration.file", "", "that the machine's file names; all of calibration is absent without one"},
        {"calibration.target", "", "native target whose counts are beside the machine's"},
        {"calibration.frame", "", "that both were counted of"},
        {"calibration.build", "", "who compiled the native target"},
        {"calibration.differs", "", "the first setting that this machine has otherwise; empty: none"},
        {"calibration.kernels[].kernel", "", "of the renderer"},
        {"calibration.kernels[].share", "", "of the frame's instructions, those of the kernel"},
        {"calibration.kernels[].instructions.ratio", "", "of the machine's instructions to native ones"},
        {"calibration.kernels[].references.ratio", "", "of the machine's memory references to native ones"}};
    for (const char* of : {"instructions", "references"}) {
        const std::string object = fmt::format("calibration.kernels[].{}.", of);
        out.push_back({object + "within", "", "whether it is as near to 1 as it should be"});
        out.push_back({object + "fitted", "", "false: valgrind does not count it as the processor does"});
    }
    const auto add = [&out](const char* path, const char* unit, const char* meaning) {
        out.push_back({path, unit, meaning});
    };
    add("renderer.plan", "", "which kernels the scene needs");
    add("renderer.trees", "", "kd-trees, each of workers that share it");
    add("renderer.tree_of_worker[]", "", "number of the kd-tree that each worker uses");
    add_counters(out);
    add("renderer.built.inner_nodes", "",
        "of kd-trees that were split; with --memory, that are there at the end");
    add("renderer.built.leaves", "", "of kd-trees, likewise");
    add("renderer.built.grid_bytes", "bytes", "of grids that were built");
    add("renderer.built.node_bytes", "bytes", "of nodes of kd-trees that were built");
    add("renderer.built.list_bytes", "bytes", "of item lists, of what leaves and nodes not split hold");
    add("renderer.duplicates.kd_nodes", "", "nodes that a tree has which another one has, too");
    add("renderer.duplicates.patches", "", "likewise, patches that were opened");
    add("renderer.duplicates.blocks", "", "likewise, blocks whose vertices were made");
    add("renderer.duplicates.normals", "", "likewise, blocks whose normals were made");
    add("renderer.topology_page_bytes", "bytes", "of topology pages made so far; they outlive the frame");
    add("renderer.screen_tiles", "", "that count");
    add("renderer.memory.budget_bytes", "bytes",
        "that were to suffice; all of memory is absent without --memory");
    add("renderer.memory.peak_bytes", "bytes", "that were taken at most, trees at their own peaks summed");
    add("renderer.memory.drops", "", "times that memory was dropped");
    add("renderer.memory.dropped.bytes", "bytes", "that were dropped in all");
    add("renderer.memory.made.grid_bytes", "bytes", "of grids, as often as they were made");
    add("renderer.memory.made.node_bytes", "bytes", "of kd nodes, likewise");
    add("renderer.memory.made.list_bytes", "bytes", "of item lists, likewise");
    for (const auto& [name, what] :
         {std::pair{"nodes", "kd nodes"}, {"patches", "patches"}, {"blocks", "blocks"}}) {
        out.push_back(
            {fmt::format("renderer.memory.dropped.{}", name), "", fmt::format("{} that were dropped", what)});
        out.push_back({fmt::format("renderer.memory.made.{}", name), "",
                       fmt::format("{}, as often as they were made", what)});
        out.push_back({fmt::format("renderer.memory.regenerated.{}", name), "",
                       fmt::format("{} that were made once more after they were dropped", what)});
        out.push_back({fmt::format("renderer.memory.regenerated_share.{}", name), "",
                       fmt::format("of the {} made, those made once more", what)});
    }
    add("renderer.memory.waits", "", "of a worker for others, before it could render");
    add("renderer.memory.restarted_tiles", "", "screen tiles begun again, as no memory was left");
    add("renderer.memory.tiles_alone", "", "screen tiles rendered while others waited, with all memory");
    add("host.topology_page_seconds", "s", "of the host, for topology pages");
    add("host.native.isa", "",
        "of the kernels that render the same natively; native is absent with --no-native");
    add("host.native.seconds", "s", "that they took on one thread");
    add("host.native.slowdown", "", "of the simulation: its seconds over theirs");
    add("host.native.picture_equal", "", "whether both pictures are the same, bit for bit");
    add("host.code_bytes.*.*", "bytes", "of a native target's machine code, by phase; common: of several");
    add("host.fidelity.processor_seconds", "s", "of processor time, of all that --fidelity auto ran");
    add("host.fidelity.by_way[]", "s", "of these, those of each of fidelity.ways");
    add("host.fidelity.reference_pilots", "s", "of these, those of parts of the frame in mode reference");
    return out;
}

} // namespace

const std::vector<Explanation>& frame_explanations() {
    static const std::vector<Explanation> all = make();
    return all;
}

} // namespace sim
