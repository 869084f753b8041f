#include "sim/program/frame_run.h"

#include "razor/frame/phases.h"
#include "razor/frame/ray_kinds.h"
#include "sim/config/placement.h"

#include <cmath>
#include <iterator>

namespace sim {

FrameRun run_frame(const Config& config, const razor::Scene& scene, int workers, int first, int end,
                   const std::atomic<bool>& interrupted, const Sampling* sampling) {
    const Machine machine(config);
    const Placement placement(config.chip);
    FrameRun out;
    out.trees = placement.trees(workers, config.kdtree.share);
    razor::Frame frame(scene, {.workers = workers,
                               .tree_of_worker = out.trees,
                               .place_of_worker = placement.places(workers),
                               .apart = true,
                               .discards = config.renderer.discard == "on"});
    frame.take_tiles(first, end);
    const Labels labels{{std::begin(razor::phase_names), std::end(razor::phase_names)},
                        {std::begin(razor::kind_names), std::end(razor::kind_names)}};
    RunOptions options;
    options.stop = &interrupted;
    if (sampling != nullptr) {
        options.sampling = sampling;
        options.estimate = &out.estimate;
    }
    out.report = machine.run(
        frame.memory(), workers, labels, [&](int worker) { frame.render(razor::simulated::kernels, worker); },
        1, options);
    // Edges of 2^level, of the frame's units until here.
    for (TrafficRow& row : out.report.traffic)
        if (row.level)
            *row.level += std::ilogb(frame.unit());
    if (sampling != nullptr && sampling->fraction < 1)
        out.report.cycles = static_cast<cycle>(std::llround(out.estimate.cycles.value));
    out.statistics = frame.statistics();
    out.duplicates = frame.duplicates();
    out.budget = frame.budget();
    out.plan = frame.plan();
    return out;
}

} // namespace sim
