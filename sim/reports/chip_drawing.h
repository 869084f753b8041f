// A chip as a drawing: its parts where chip_plan puts them, and beneath them what the colours mean.
#pragma once

#include "analysis/plots/svg.h"
#include "sim/config/config.h"

#include <string_view>

namespace sim {

/// Every part and link has a title, which browsers show where a pointer rests: "core 3: 4 threads, 4 lanes".
/// Tiles, cores, caches, banks, routers, channels and links are numbered as in reports.
analysis::Svg draw_chip(const Config& config, std::string_view title);

} // namespace sim
