// What would go wrong with a scene as a whole: how exactly single precision can tell its parts apart where
// they lie, levels of detail that cannot be given, lights and materials that do nothing or too much, and what
// a frame will take.
#pragma once

#include "razor/frame/frame.h"
#include "razor/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace razor::check {

enum class Severity : std::uint8_t { note, warning };

struct SceneFinding {
    Severity severity = Severity::warning;
    std::string kind;   // one word of findings_of() for scripts: "precision"
    std::string object; // "mesh 'cube'", "light 2 (disk)"
    std::string what, means, mend;
};

/// Of one mesh, the worst of its instances. Hits are points in scene coordinates
/// (razor/frame/scene_geometry.h), whose spacing in single precision grows with the distance from the scene's
/// centre, at a distance from the camera that single precision tells likewise: half of the larger of both
/// spacings is what a hit is off by at most, before what computing it adds.
struct PrecisionBudget {
    int mesh = 0;
    std::int64_t instances = 0;
    double from_centre = 0;  // world units: of the furthest corner of its box
    double error = 0;        // of hits, world units
    double error_pixels = 0; // the same over a pixel's size where the camera is nearest; 0: unknown
    double edge_length = 0;  // the finest target, world units
    double bits = 0;         // log2 of edge_length over twice the error
};
std::vector<PrecisionBudget> precision_of(const Scene& scene);

/// All there is to say, by kind: precision, levels, zero_area_light, dark_light, light_turned_away,
/// light_range, no_light, albedo_one, unused_material. The meshes must be valid.
std::vector<SceneFinding> findings_of(const Scene& scene);

/// What a frame of the whole picture will take, in bytes.
struct MemoryEstimate {
    std::int64_t lasting = 0; // topology, control points, scene graph: as analysed
    std::int64_t textures = 0, film = 0;
    std::int64_t built_least = 0, built_most = 0; // grids, kd nodes and lists of one tree: estimated
    std::vector<std::pair<std::int64_t, std::int64_t>> from; // pixels rendered and bytes built
    FrameStatistics frame;                                   // of the larger

    std::int64_t total() const { return lasting + textures + film + built_most; }
};
/// Renders two small pictures, half and a quarter as wide and high with a sample a pixel, so that edges are
/// as many pixels long. What is built grows with the pixels by a power, the same as between those, where all
/// that is seen is of one kind, and at most as a constant and so much a pixel: least and most are these two.
/// Throws UserError.
MemoryEstimate estimate_memory(const Scene& scene, const KernelTable& kernels);

std::string text_of(const std::vector<SceneFinding>& findings);
std::string text_of(const Scene& scene, const std::vector<PrecisionBudget>& budgets);
std::string text_of(const MemoryEstimate& estimate);
nlohmann::ordered_json json_of(const std::vector<SceneFinding>& findings);
nlohmann::ordered_json json_of(const Scene& scene, const std::vector<PrecisionBudget>& budgets);
nlohmann::ordered_json json_of(const MemoryEstimate& estimate);

} // namespace razor::check
