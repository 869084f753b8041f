// A frame, or a part of it, on a machine, without anything to be written.
#pragma once

#include "razor/frame/frame.h"
#include "razor/scene/scene.h"
#include "sim/machine/machine.h"

#include <atomic>
#include <optional>
#include <vector>

namespace sim {

struct FrameRun {
    Report report; // cycles of a sampled run: estimated
    razor::FrameStatistics statistics;
    razor::Duplicates duplicates;
    razor::BudgetStatistics budget;
    razor::Plan plan;
    std::vector<int> trees; // of workers
    Estimate estimate;      // of a sampled run
};

/// `workers` of the machine render the screen tiles from `first` to, not including, `end`, with caches cold.
/// Sampled, if that is given. Throws Stopped once `interrupted` is set.
FrameRun run_frame(const Config& config, const razor::Scene& scene, int workers, int first, int end,
                   const std::atomic<bool>& interrupted, const Sampling* sampling = nullptr);

} // namespace sim
