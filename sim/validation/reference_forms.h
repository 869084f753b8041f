// Programs in the reference mode whose cycles follow from the machine's own numbers: tests and
// `razor-sim validate` compare them.
#pragma once

#include "sim/validation/core_forms.h"

namespace sim {

/// plain_core() in the reference mode, memory clocks being cycles; without refreshes, but for what asks for
/// them.
Config plain_reference();
/// Reads of memory end to end, and of an L2 that several cores ask; each in exact cycles.
std::vector<CoreForm> reference_forms();

} // namespace sim
