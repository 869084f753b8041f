// Miss ratios of caches of all sizes from a part of a trace: a sample of lines, of windows of time, or of
// sets; and from all of it, which is what the others are held to. (On sampling in time and in sets: Laha,
// Patel and Iyer, IEEE Transactions on Computers 1988; Puzak, PhD thesis, University of Massachusetts 1985;
// Kessler, Hill and Wood, IEEE Transactions on Computers 1994.)
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace analysis {

/// What is looked at.
enum class SamplingMethod { exact, lines, windows, sets };
inline constexpr std::array<const char*, 4> sampling_method_names = {"exact", "lines", "windows", "sets"};

struct Sampling {
    SamplingMethod method = SamplingMethod::exact;
    double share = 1;              // of lines, of windows, of each cache's sets; in (0, 1]
    std::uint64_t most_lines = 0;  // of a sample of lines, whose share falls when there are more; 0: any
    std::uint64_t window = 100000; // touches
    bool keep = true;   // caches hold in a window what they held at the end of the one before; else nothing
    double warm_up = 0; // of a window this part, at its beginning, is not counted; in [0, 1)
    std::uint64_t seed = 0; // of what is chosen; 0: as razor-trace curve does
};

class MissEstimator {
public:
    MissEstimator() = default;
    MissEstimator(const MissEstimator&) = delete;
    MissEstimator& operator=(const MissEstimator&) = delete;
    virtual ~MissEstimator() = default;

    /// The next touches of the trace.
    virtual void touch(std::span<const std::uint64_t> lines) = 0;
    /// Misses a touch of the cache sizes[size], in [0, 1]; not-a-number: nothing was looked at.
    virtual double ratio(std::size_t size) const = 0;
    /// Touches that caches, or stacks of lines, were asked for.
    virtual std::uint64_t looked_at() const = 0;
};

/// Of LRU caches of so many lines (ascending), of so many ways, which divide these; 0: fully associative.
/// Samples of lines are of fully associative caches alone, those of sets of the others: throws
/// std::invalid_argument.
std::unique_ptr<MissEstimator> make_estimator(const std::vector<std::uint64_t>& sizes, std::uint64_t ways,
                                              const Sampling& sampling);

} // namespace analysis
