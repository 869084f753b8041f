// How much work a frame is, by what the native kernels count in a moment: the closed form's other half.
#pragma once

#include "razor/frame/counters.h"
#include "razor/scene/scene.h"
#include "sim/estimate/closed_form.h"

#include <atomic>
#include <vector>

namespace sim {

/// Of each phase the count that its instructions go with; `nodes`: inner nodes of the kd-tree that were made.
std::vector<double> drivers(const razor::Counters& counters, double nodes);

/// Of phases, but for the end of the frame.
std::vector<PhaseUse> uses_of_phases();

/// What a screen tile needs of a tree: what its builds go with, as drivers() counts it.
struct ScreenNeed {
    double nodes = 0, surfaces = 0;
};
/// Of each screen tile, rendered natively, alone and with nothing built before. Throws razor::Cancelled.
std::vector<ScreenNeed> count_needs(const razor::Scene& scene, const std::atomic<bool>& cancel);

struct CountedScreen {
    ScreenWork work;
    double rays = 0, grid_bytes = 0, node_bytes = 0, list_bytes = 0;
    double seconds = 0; // of the host
};

/// Renders natively what each tree's workers find in their stretches of the screen, tree by tree, each anew.
/// `seed`, `seed_drivers`: of the crowded run, instructions by phase and drivers(). `needs`: count_needs().
/// Throws razor::Cancelled.
CountedScreen count_screen(const razor::Scene& scene, const std::vector<Seat>& seats, const Seed& seed,
                           const std::vector<double>& seed_drivers, const std::vector<ScreenNeed>& needs,
                           const std::atomic<bool>& cancel);

} // namespace sim
