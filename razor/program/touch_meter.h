// What tracing touches of a frame's memory, where this build can tell.
#pragma once

#include "razor/survey/survey.h"

namespace razor {

/// Whether the simulated kernels are built in, which tell.
bool can_measure_touch();
/// Empty where they are not.
TouchMeter touch_meter();

} // namespace razor
