// Cases that try every pair of values of any two factors.
#pragma once

#include <vector>

namespace razor::test {

/// Each case has the number of a value for each factor; `values`: how many each factor has. Every pair of
/// values of two factors is in some case. Deterministic; greedy, so not the fewest cases possible.
std::vector<std::vector<int>> pairwise_cases(const std::vector<int>& values);

} // namespace razor::test
