// How large the kernels' native code is, for reports: the simulated machine has no program counters, so it
// fetches no instructions. Read off the symbols of the object files by code_size.cmake when they are built.
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/frame/phases.h"

#include <cstdint>
#include <span>

namespace razor {

/// Machine code of one native target, in bytes. What the compiler put into a function counts for that
/// function's phase, so helpers that are inlined count wherever they are; no function that enters a phase is
/// inlined into another phase.
struct CodeSize {
    const char* target;
    std::int64_t phase[look_count][grids_count][phase_count]; // what a frame of a plan may run of each phase
    std::int64_t common[look_count]
                       [grids_count]; // functions that several phases call, and the workers' entry
};

/// One for each native target of this build, in the order plain, sse4, avx2, avx512.
std::span<const CodeSize> code_sizes();

} // namespace razor
