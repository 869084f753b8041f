// Figures of a run's report, as studies and sweeps tell them.
#pragma once

#include "analysis/study/collected_point.h"
#include "analysis/study/store.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace sim {

/// All that a report may have, with what they mean; none of them depends on the host.
const std::vector<analysis::Figure>& report_figures();

/// Adds a run's figures; of levels that the machine lacks there are none.
void add_figures(analysis::Samples& values, const nlohmann::ordered_json& report);

/// What limits a run, without the figures that noise moves: "issue slots", "waiting: memory".
std::string limiter_name(const nlohmann::ordered_json& report);

} // namespace sim
