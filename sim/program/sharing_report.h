// The option of razor-sim run that looks at which lines cores share, and what is said of them.
#pragma once

#include "sim/machine/explain.h"
#include "sim/trace/line_sharing.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sim {

class SharingOptions {
public:
    void add_to(CLI::App& app);
    bool wanted() const { return wanted_; }
    /// Throws razor::UserError where an option is of no use, or out of its bounds.
    std::optional<LineSharing> begin() const;

private:
    bool wanted_ = false;
    std::string interval_;
};

std::string sharing_text(const LineSharing& sharing, const Report& report);
/// The object `sharing`.
nlohmann::ordered_json sharing_json(const LineSharing& sharing, const Report& report);
/// Of every figure of that object.
const std::vector<Explanation>& sharing_explanations();

} // namespace sim
