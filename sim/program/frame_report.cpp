#include "sim/program/frame_report.h"

#include "razor/frame/phases.h"
#include "razor/frame/ray_kinds.h"
#include "razor/kernels/code_size.h"
#include "razor/native/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

/// A line on the memory budget, if there is one.
std::string memory_text(const razor::BudgetStatistics& b) {
    if (b.budget_bytes == 0)
        return "";
    return fmt::format(
        "memory budget          {:.1f} of {:.1f} KiB at most; {} of {} blocks and {} of {} kd nodes were "
        "made again; {} tiles begun again\n",
        static_cast<double>(b.peak_bytes) / 1024, static_cast<double>(b.budget_bytes) / 1024,
        b.regenerated_blocks, b.made_blocks, b.regenerated_nodes, b.made_nodes, b.restarted_tiles);
}

} // namespace

json renderer_json(const razor::FrameStatistics& s, const razor::CountersByKind& counted,
                   const razor::Duplicates& twice, const std::vector<int>& tree_of_worker) {
    json out;
    out["plan"] = s.plan;
    out["trees"] = s.trees;
    out["tree_of_worker"] = tree_of_worker;
    out["counters"] = counted.sum();
    out["counters_by_kind"] = counted;
    out["built"] = {{"inner_nodes", s.inner_nodes},
                    {"leaves", s.leaves},
                    {"grid_bytes", s.grid_bytes},
                    {"node_bytes", s.node_bytes},
                    {"list_bytes", s.list_bytes}};
    out["duplicates"] = {{"kd_nodes", twice.nodes},
                         {"patches", twice.patches},
                         {"blocks", twice.blocks},
                         {"normals", twice.normals}};
    out["topology_page_bytes"] = s.page_bytes;
    return out;
}

std::string frame_text(const razor::Settings& s, int workers, const Counted& counted,
                       const razor::FrameStatistics& f, const razor::BudgetStatistics& b, const Report& r) {
    const std::int64_t opened = f.counters.patches_opened - b.regenerated_patches;
    const int screen_tiles = counted.tiles();
    // With few screen tiles a worker, the last one to end decides the time: that says little of the machine.
    const char* few =
        screen_tiles < 4 * workers ? ": few, so workers will be idle; a larger picture says more" : "";
    const std::string& share = r.config.kdtree.share;
    const razor::CountersByKind c = counted.of(f);
    auto rays = [&](razor::RayKind kind) { return c.kind[kind].rays; };
    const std::string bounces =
        rays(razor::kind_bounce) > 0 ? fmt::format(", {} bounce", rays(razor::kind_bounce)) : "";
    return fmt::format(
               "frame                  {} x {} pixels, {} samples each; {} workers, {} kd-tree{} ({})\n"
               "screen tiles           {} ({} to {}), {:.1f} a worker{}\n"
               "rays                   {} camera, {} light, {} sky{}; {:.3f} million a second of simulated "
               "time\n"
               "built                  {} of {} patches opened, {} triangles, {} kd nodes split, {} leaves\n"
               "never needed           {} patches, {} kd nodes, normals of {} of {} blocks\n",
               s.width, s.height, s.samples, workers, f.trees, f.trees == 1 ? "" : "s",
               "kdtree.share = " + share, screen_tiles, counted.first_tile, counted.last_tile,
               static_cast<double>(screen_tiles) / workers, few, rays(razor::kind_camera),
               rays(razor::kind_light), rays(razor::kind_sky), bounces,
               static_cast<double>(c.sum().rays) / r.seconds() * 1e-6, opened, f.patches,
               f.counters.triangles_made, f.inner_nodes, f.leaves, f.patches - opened, f.unsplit_nodes,
               f.counters.blocks_made - f.counters.normal_blocks, f.counters.blocks_made) +
           memory_text(b);
}

json code_json(const razor::Plan& plan) {
    json out = json::object();
    for (const razor::CodeSize& size : razor::code_sizes()) {
        json& row = out[size.target];
        for (int phase = 0; phase < razor::phase_count; ++phase)
            row[razor::phase_names[phase]] = size.phase[plan.look][plan.grids][phase];
        row["common"] = size.common[plan.look][plan.grids];
    }
    return out;
}

std::string code_text(const razor::Plan& plan) {
    const auto sizes = razor::code_sizes();
    std::string out = fmt::format("\n{:<16}", "native code");
    for (const razor::CodeSize& size : sizes)
        out += fmt::format(" {:>10}", size.target);
    out += "   bytes by kernel; the machine fetches no instructions\n";
    const auto row = [&](const char* name, auto bytes) {
        out += fmt::format("{:<16}", name);
        for (const razor::CodeSize& size : sizes)
            out += fmt::format(" {:>10}", bytes(size));
        out += '\n';
    };
    for (int phase = 0; phase < razor::phase_count; ++phase)
        row(razor::phase_names[phase],
            [&](const razor::CodeSize& size) { return size.phase[plan.look][plan.grids][phase]; });
    row("common", [&](const razor::CodeSize& size) { return size.common[plan.look][plan.grids]; });
    row("all", [&](const razor::CodeSize& size) {
        const auto& phases = size.phase[plan.look][plan.grids];
        return std::accumulate(std::begin(phases), std::end(phases), size.common[plan.look][plan.grids]);
    });
    return out;
}

} // namespace sim
