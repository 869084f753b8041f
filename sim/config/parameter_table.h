// The table that parameters.h reads, made once.
#pragma once

#include "sim/config/parameters.h"

namespace sim {

std::vector<Parameter> make_parameter_table();

} // namespace sim
