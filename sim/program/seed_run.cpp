#include "sim/program/seed_run.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/program/progress.h"
#include "sim/program/frame_run.h"
#include "sim/program/screen_work.h"

#include <algorithm>

namespace sim {
KeptSeed make_seed(const Config& machine, const razor::Scene& scene, const std::string& scene_text,
                   bool quiet, const std::atomic<bool>& interrupted) {
    KeptSeed out;
    out.machine = machine;
    out.machine.chip.tiles = 1;
    out.scene = scene_text;
    const int threads = static_cast<int>(out.machine.all_threads());
    const int tiles = razor::screen_tiles(scene.settings);
    razor::Progress progress(!quiet);
    const FrameRun crowded = run_frame(out.machine, scene, threads, 0, tiles, interrupted);
    progress.show(0.8);
    // The middle of the curve shows more than its ends; an eighth says what instructions take.
    const int some = std::max(1, tiles / 8), first = (tiles - some) / 2;
    const FrameRun lone = run_frame(out.machine, scene, 1, first, first + some, interrupted);
    out.seed = seed_of(crowded.report, lone.report, uses_of_phases(), std::min(threads, tiles));
    out.drivers = drivers(crowded.statistics.counters, static_cast<double>(crowded.statistics.inner_nodes));
    out.needs = count_needs(scene, interrupted);
    out.processor_seconds = crowded.report.processor_seconds + lone.report.processor_seconds;
    return out;
}

} // namespace sim
