// Counts as numbers of a model.
#pragma once

namespace sim {

constexpr double real(auto count) {
    return static_cast<double>(count);
}

} // namespace sim
