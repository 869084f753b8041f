// What was counted before the part of a run that counts, taken away.
#pragma once

#include "sim/machine/report.h"

namespace sim {

/// `warm` is the run up to a moment at which nothing was under way and memory was quiet, from which on `r`
/// counts alone. Lines touched are those since (LineMap::forget_touched).
void take_away(Report& r, const Report& warm);

} // namespace sim
