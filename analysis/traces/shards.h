// LRU curves from a sample of all lines: SHARDS at a fixed rate (Waldspurger, Park, Garthwaite, Ahmad:
// Efficient MRC construction with SHARDS, FAST 2015), and how far off they may be.
#pragma once

#include "analysis/traces/lru_curve.h"
#include "traces/sample.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace analysis {

/// A line is in the sample if its hash is below the rate; distances among those are scaled by 1 / rate. What
/// the sample has too few or too many references of, against what it should, counts as hits of the smallest
/// cache (SHARDS-adj). The lines of the sample are dealt to `parts` samples of their own, of rate / parts,
/// whose spread says the error: groups of lines of one sample would not, as what they have in common, which
/// popular lines are in it, shifts all distances.
class Shards {
public:
    static constexpr std::size_t parts = 16;

    /// `rate` of all lines, of which the trace holds the part `of` (1: all), in (0, of].
    explicit Shards(const std::vector<std::uint64_t>& sizes, double rate, double of = 1);

    void touch(std::uint64_t line, std::size_t group) {
        if (group >= seen_.size())
            seen_.resize(group + 1, 0);
        ++seen_[group];
        const std::uint64_t hash = traces::hash_bits_of_line(line);
        if (hash < limit_)
            take(line, group, hash);
    }

    std::uint64_t references(std::size_t group) const { return group < seen_.size() ? seen_[group] : 0; }
    std::uint64_t sampled() const { return sampled_; }
    /// In the sample.
    std::uint64_t lines() const { return stack_.lines(); }
    /// Misses per reference of a group, of a cache of sizes[size] lines, in [0, 1], and half of the interval
    /// that has it in 19 of 20 samples (Student's t).
    struct Estimate {
        double ratio = 0, error = 0;
    };
    Estimate estimate(std::size_t group, std::size_t size) const;

private:
    void take(std::uint64_t line, std::size_t group, std::uint64_t hash);
    double ratio(const ReuseCounts& counts, double rate, std::size_t group, std::size_t size) const;

    double rate_, of_;
    std::uint64_t limit_;             // of hashes in the sample
    std::vector<std::uint64_t> seen_; // by group
    std::uint64_t sampled_ = 0;
    StackDistance stack_;
    ReuseCounts counts_;
    std::vector<StackDistance> part_stacks_;
    std::vector<ReuseCounts> part_counts_;
};

} // namespace analysis
