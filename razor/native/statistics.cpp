#include "razor/native/render.h"

#include <nlohmann/json.hpp>

#include <string>

namespace razor {

namespace {

double share(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

} // namespace

void to_json(nlohmann::ordered_json& json, const Counters& counters) {
    for_each_counter(counters, [&](const char* name, std::int64_t value) { json[name] = value; });
}

void to_json(nlohmann::ordered_json& json, const CountersByKind& counters) {
    for (int k = 0; k < kind_count; ++k)
        json[kind_names[k]] = counters.kind[k];
}

void to_json(nlohmann::ordered_json& json, const BudgetStatistics& s) {
    json = {{"budget_bytes", s.budget_bytes},
            {"peak_bytes", s.peak_bytes},
            {"drops", s.drops},
            {"dropped",
             {{"nodes", s.dropped_nodes},
              {"patches", s.dropped_patches},
              {"blocks", s.dropped_blocks},
              {"bytes", s.dropped_bytes}}},
            {"made",
             {{"nodes", s.made_nodes},
              {"patches", s.made_patches},
              {"blocks", s.made_blocks},
              {"grid_bytes", s.made_grid_bytes},
              {"node_bytes", s.made_node_bytes},
              {"list_bytes", s.made_list_bytes}}},
            {"regenerated",
             {{"nodes", s.regenerated_nodes},
              {"patches", s.regenerated_patches},
              {"blocks", s.regenerated_blocks}}},
            {"regenerated_share",
             {{"nodes", share(s.regenerated_nodes, s.made_nodes)},
              {"patches", share(s.regenerated_patches, s.made_patches)},
              {"blocks", share(s.regenerated_blocks, s.made_blocks)}}},
            {"waits", s.waits},
            {"restarted_tiles", s.restarted_tiles},
            {"tiles_alone", s.tiles_alone}};
}

void to_json(nlohmann::ordered_json& json, const RenderStatistics& s) {
    const FrameStatistics& f = s.frame;
    const Counters& c = f.counters;
    json["target"] = {{"isa", s.isa}, {"width", s.width_lanes}, {"threads", s.threads}};
    json["plan"] = f.plan;
    json["scene"] = {{"meshes", f.meshes}, {"instances", f.instances}};
    json["counters"] = c;
    json["counters_by_kind"] = f.by_kind;
    for (int k = kind_none + 1; k < kind_count; ++k) {
        const Counters& kind = f.by_kind.kind[k];
        json["utilisation"][kind_names[k] + std::string("_packets")] =
            share(kind.rays, kind.packets * s.width_lanes);
    }
    if (c.grid_lanes > 0)
        json["utilisation"]["phase_one"] = share(c.grid_evaluations, c.grid_lanes);
    json["built"] = {{"trees", f.trees},
                     {"inner_nodes", f.inner_nodes},
                     {"leaves", f.leaves},
                     {"grid_bytes", f.grid_bytes},
                     {"node_bytes", f.node_bytes},
                     {"list_bytes", f.list_bytes},
                     {"patch_table_bytes", f.patch_table_bytes},
                     {"topology_page_bytes", f.page_bytes}};
    json["duplicates"] = {{"kd_nodes", s.duplicates.nodes},
                          {"patches", s.duplicates.patches},
                          {"blocks", s.duplicates.blocks},
                          {"normals", s.duplicates.normals}};
    json["scene_bytes"] = {{"scene_graph", f.scene_graph_bytes},
                           {"topology", f.topology_bytes},
                           {"control_points", f.control_point_bytes}};
    const auto opened = [&](std::int64_t part, std::int64_t whole) {
        return nlohmann::ordered_json{{"count", part}, {"of", whole}, {"share", share(part, whole)}};
    };
    const BudgetStatistics& budget = s.budget;
    if (budget.budget_bytes != 0)
        json["memory"] = budget;
    const std::int64_t nodes = f.inner_nodes + f.leaves + f.unsplit_nodes;
    const std::int64_t patches_opened = c.patches_opened - budget.regenerated_patches;
    json["opened"] = {{"graph_nodes", opened(f.graph_nodes_opened, f.graph_nodes)},
                      {"instances", opened(f.instances_opened, f.instances * f.trees)},
                      {"clusters", opened(f.clusters_opened, f.clusters)},
                      {"patches", opened(patches_opened, f.patches)},
                      {"kd_nodes", opened(f.inner_nodes + f.leaves, nodes)}};
    json["touched"] = {{"instances", f.touched.instances},
                       {"graph_nodes", f.touched.graph_nodes},
                       {"meshes", f.touched.meshes},
                       {"clusters_refitted", f.touched.clusters}};
    json["left_out"] = {{"patches_never_opened", f.patches - patches_opened},
                        {"of_patches", f.patches},
                        {"nodes_never_split", f.unsplit_nodes},
                        {"blocks_without_normals", c.blocks_made - c.normal_blocks},
                        {"undrawn_faces", f.undrawn_faces}};
    json["visible"] = {{"pixels", s.visible.pixels}, {"squares", s.visible.squares}};
    json["host"] = {{"load_seconds", s.load_seconds},
                    {"refit_seconds", f.refit_seconds},
                    {"first_packet_seconds", f.first_packet_seconds},
                    {"tiles",
                     {{"count", f.tiles},
                      {"seconds", f.tile_seconds},
                      {"slowest_seconds", f.slowest_tile_seconds},
                      {"slowest", f.slowest_tile}}},
                    {"wait_seconds", f.wait_seconds}};
    if (s.survey_seconds > 0)
        json["host"]["survey_seconds"] = s.survey_seconds;
    for (const FrameTime& t : s.times)
        json["host"]["frames"].push_back({{"render_seconds", t.render_seconds},
                                          {"render_processor_seconds", t.render_processor_seconds},
                                          {"eager_seconds", t.eager_seconds},
                                          {"topology_page_seconds", t.topology_page_seconds}});
    if (const PassFigures passes = s.times.empty() ? PassFigures{} : s.times.back().passes; passes.passes > 0)
        json["passes"] = {{"count", passes.passes},
                          {"samples", passes.samples},
                          {"mean_samples", passes.mean_samples},
                          {"error", passes.error},
                          {"relative_error", passes.relative_error},
                          {"noise_threshold", passes.threshold},
                          {"within_threshold", passes.within_threshold},
                          {"target_error", passes.target},
                          {"reached_error", passes.target_error},
                          {"reached_error_uncertainty", passes.target_error_uncertainty}};
}

} // namespace razor
