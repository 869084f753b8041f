// Which of many lines are in a sample: few are, and of the others nothing else is to be known.
#pragma once

#include <cstddef>
#include <cstdint>

namespace analysis {

constexpr std::size_t filtered_lines = 64;

/// Of so many lines: bit i is set if the hash of lines[i] + offset (traces/sample.h) is below the limit,
/// which is 2^53 at most.
std::uint64_t lines_below(const std::uint64_t* lines, std::uint64_t offset, std::uint64_t limit);

} // namespace analysis
