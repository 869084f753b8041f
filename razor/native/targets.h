// Native targets of this build and of this machine.
#pragma once

#include "razor/frame/kernel_table.h"

#include <string>
#include <vector>

namespace razor {

/// Targets compiled in that this processor can run, best last.
std::vector<const KernelTable*> native_targets();

/// The kernels of `name`, or the best for "auto". Throws UserError naming the choices.
const KernelTable& native_target(const std::string& name);

} // namespace razor
