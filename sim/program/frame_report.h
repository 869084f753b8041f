// What a run's report says of the frame that was rendered, beside what the machine says.
#pragma once

#include "razor/frame/frame.h"
#include "razor/scene/scene.h"
#include "sim/machine/explain.h"
#include "sim/machine/report.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace sim {

/// The part of a frame that counts.
struct Counted {
    int first_tile = 0, last_tile = 0;
    razor::CountersByKind before; // what the frame's tiles before them took

    int tiles() const { return last_tile - first_tile + 1; }
    razor::CountersByKind of(const razor::FrameStatistics& f) const {
        razor::CountersByKind c = f.by_kind;
        c -= before;
        return c;
    }
};

/// The object `renderer`.
nlohmann::ordered_json renderer_json(const razor::FrameStatistics& statistics,
                                     const razor::CountersByKind& counted, const razor::Duplicates& twice,
                                     const std::vector<int>& tree_of_worker);
/// Of every figure of that object, and of all others that a run says beside the machine's.
const std::vector<Explanation>& frame_explanations();
/// What was rendered and what it took, above the machine's own report.
std::string frame_text(const razor::Settings& settings, int workers, const Counted& counted,
                       const razor::FrameStatistics& statistics, const razor::BudgetStatistics& budget,
                       const Report& report);
/// Machine code of the kernels that this plan may run, in bytes: by native target, then by phase.
nlohmann::ordered_json code_json(const razor::Plan& plan);
/// The same as a table, with a sum.
std::string code_text(const razor::Plan& plan);

} // namespace sim
