// The least misses that any cache of a size can have: Belady's MIN (Belady 1966), which evicts what is needed
// last.
#pragma once

#include "analysis/traces/line_map.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace analysis {

/// Fully associative; every miss takes the place of a line. Keeps 8 bytes a reference, as MIN knows the
/// future.
class Optimum {
public:
    void touch(std::uint64_t line, std::uint32_t group);
    /// By group, of a cache of so many lines, at least one. `look` is called now and then, and may throw.
    std::vector<std::uint64_t> misses(
        std::uint64_t lines, std::size_t groups, const std::function<void()>& look = [] {}) const;
    std::uint64_t lines() const { return numbers_.size(); }

private:
    struct Touched {
        std::uint32_t line, group; // the line's number, in order of first touches
    };
    LineMap numbers_;
    std::vector<Touched> touched_;
};

} // namespace analysis
