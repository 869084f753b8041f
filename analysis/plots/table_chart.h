// Charts of tables, as SVG elements.
#pragma once

#include "analysis/plots/chart.h"
#include "analysis/traces/table.h"

#include <cstddef>
#include <string>
#include <vector>

namespace analysis {

/// A line for each that the first `names` columns say (none: one for all) and each of the columns `ys`, over
/// column `x`; what is no number is left out. Columns must be there.
std::string lines_of(const Table& table, std::size_t names, const std::string& x,
                     const std::vector<std::string>& ys, const Axis& x_axis, const Axis& y_axis);

/// A bar for each row, named by its first columns, of the columns `parts` behind each other.
std::string bars_of(const Table& table, std::size_t names, const std::vector<std::string>& parts,
                    const Axis& axis);

} // namespace analysis
