// Who renders which screen tile when, if each worker's pace is known: a fluid model of the frame's end, which
// a closed network in equilibrium knows nothing of. Workers take tiles from their own stretch of the screen
// and then half of another's, as the renderer's do (razor/kernels/stretches.h), here at once and for nothing.
#pragma once

#include <functional>
#include <vector>

namespace sim {

struct ScreenWorker {
    int core = 0, tree = 0;
    double delay = 0; // cycles before its first screen tile, if it gets one, during which it needs no core
};

struct ScreenSchedule {
    double cycles = 0;            // until the last tile is done
    double busy = 0;              // workers' cycles at work, summed
    double waiting = 0;           // ... in delays, summed
    int stolen_from_others = 0;   // tiles rendered with another tree than the one whose stretch they lay in
    std::vector<double> finish{}; // by worker: when it found nothing any more
};

/// Paces of a core's workers: work done a cycle by each, given how many are at work on each core.
using Paces = std::function<const std::vector<double>&(const std::vector<int>& at_work)>;

/// The first screen tile of each worker's stretch, by worker, and the end of the last one's.
std::vector<int> stretches(int tiles, int workers);

/// `work`: of each screen tile, in cycles of a worker alone. `workers`: by place. `cores`: how many.
ScreenSchedule schedule_screen(const std::vector<double>& work, const std::vector<ScreenWorker>& workers,
                               int cores, const Paces& paces);

} // namespace sim
