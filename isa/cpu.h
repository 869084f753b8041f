// Which kernel targets this processor runs.
#pragma once

#include <string_view>

namespace isa {

/// Native targets from the most to the least able: "avx512", "avx2", "sse4", "plain".
inline constexpr std::string_view native_targets[] = {"avx512", "avx2", "sse4", "plain"};

/// Whether this processor and system run code compiled for the target of this name. `simulated` takes its values from a
/// native target chosen when the build was configured (ISA_SIMULATED_VALUES): it runs where that one does.
bool cpu_runs(std::string_view target);

} // namespace isa
