// What razor compare says, for people and for programs.
#pragma once

#include "analysis/metrics/compare.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace razor {

std::string comparison_text(const analysis::Comparison& comparison, const analysis::FlipOptions& options);

/// Means of no pixel, and other values that are no numbers, are null.
nlohmann::ordered_json comparison_json(const analysis::Comparison& comparison,
                                       const analysis::FlipOptions& options);

/// One line a channel that differs, or "identical: W x H, n planes".
std::string identity_text(const analysis::ImageFile& a, const analysis::ImageFile& b,
                          const analysis::Differences& differences);

} // namespace razor
