// Runs whose figures are estimated: how is said, and what comes of it, for people and for programs.
#pragma once

#include "sim/machine/machine.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// By phase of a frame, whether work in it builds what rays meet.
std::vector<bool> building_phases();

/// `sample:0.1` as a fraction. `option` names it in messages. Throws razor::UserError.
Sampling parse_sampling(std::string_view option, std::string_view text);

/// A figure of a run, by its name in reports and studies.
struct EstimatedFigure {
    const char *name, *label;
    Estimated value;
};

/// What a sampled run says: its cycles, and what was counted.
std::vector<EstimatedFigure> sampled_figures(const Report& report, const Estimate& estimate);
/// Report::cycles is the estimate.
std::string sampled_text(const Report& report, const Estimate& estimate, const Sampling& sampling);
/// As of a run, but for what a sampled one does not know, with the object "estimate".
nlohmann::ordered_json sampled_json(const Report& report, const Estimate& estimate, const Sampling& sampling);

} // namespace sim
