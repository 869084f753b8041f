// LRU curves from a sample of all lines: SHARDS (Waldspurger, Park, Garthwaite, Ahmad: Efficient MRC
// construction with SHARDS, FAST 2015), at a fixed rate or of a fixed size, and how far off they may be.
#pragma once

#include "analysis/traces/lru_curve.h"
#include "analysis/traces/recent_stack.h"
#include "traces/sample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace analysis {

/// Lines whose hash is below a limit, which falls so that at most so many are in.
class LineSample {
public:
    /// One of `parts` equal samples; `most`: lines, 0: any number.
    LineSample(const std::vector<std::uint64_t>& sizes, double rate, std::size_t parts, std::uint64_t most);

    /// A line that is below the limit.
    void touch(std::uint64_t line, std::size_t group, std::uint64_t hash);
    std::uint64_t limit() const { return limit_; }
    /// Of all lines, this fraction is in.
    double rate() const { return rate_; }
    std::uint64_t lines() const { return stack_.lines(); }
    /// Each reference counts 1 / rate() as it was then, so that sums are those of all lines.
    const BasicReuseCounts<double>& counts() const { return counts_; }

private:
    void set_limit(std::uint64_t limit);
    void set_rate(double rate);

    double parts_, rate_ = 1, weight_ = 1;
    std::uint64_t limit_ = 0, most_; // of hashes; of lines
    RecentStack stack_;
    BasicReuseCounts<double> counts_;
    std::array<std::size_t, RecentStack::most> near_{}; // columns of counts: of distances 1, 2, ...
    std::priority_queue<std::pair<std::uint64_t, std::uint64_t>>
        highest_; // hashes and lines, if there is a most
};

/// A line is in the sample if its hash is below the rate; distances among those are scaled by 1 / rate. What
/// the sample has too few or too many references of, against what it should, counts as hits of the smallest
/// cache (SHARDS-adj). The lines of the sample are dealt to `parts` samples of their own, of rate / parts,
/// whose spread says the error: groups of lines of one sample would not, as what they have in common, which
/// popular lines are in it, shifts all distances.
/// A sample knows little of caches of few more lines than 1 / rate, as hardly any line of it comes between
/// two touches: see ShortReuse.
class Shards {
public:
    static constexpr std::size_t parts = 16;

    /// `rate` of all lines, of which the trace holds the part `of` (1: all), in (0, of]. `most` lines, at
    /// least `parts`: the rate falls when there are more (SHARDS of a fixed size, s_max); 0: any number.
    /// `seed`: another sample; that of a recorder (traces/sample.h) is 0.
    explicit Shards(const std::vector<std::uint64_t>& sizes, double rate, double of = 1,
                    std::uint64_t most = 0, std::uint64_t seed = 0);

    void touch(std::uint64_t line, std::size_t group) {
        if (group >= seen_.size())
            seen_.resize(group + 1, 0);
        ++seen_[group];
        const std::uint64_t hash = traces::hash_bits_of_line(line + offset_);
        if (hash < limit_)
            take(line, group, hash);
    }

    /// All of these, one after the other, as touch() of each: several times as fast if they are many.
    void touch(std::span<const std::uint64_t> lines, std::size_t group);

    std::uint64_t references(std::size_t group) const { return group < seen_.size() ? seen_[group] : 0; }
    std::uint64_t sampled() const { return sampled_; }
    /// Whether any touch of the group is in the sample.
    bool knows(std::size_t group) const { return sample_.counts().references(group) > 0; }
    /// In the sample.
    std::uint64_t lines() const { return sample_.lines(); }
    /// Of all lines, now.
    double rate() const { return sample_.rate(); }
    /// Misses per reference of a group, of a cache of sizes[size] lines, in [0, 1], and half of the interval
    /// that has it in 19 of 20 samples (Student's t).
    struct Estimate {
        double ratio = 0, error = 0;
    };
    Estimate estimate(std::size_t group, std::size_t size) const;

private:
    void take(std::uint64_t line, std::size_t group, std::uint64_t hash);
    double ratio(const LineSample& sample, std::size_t group, std::size_t size) const;

    double of_;
    std::uint64_t offset_;            // of lines before they are hashed: which are in the sample
    std::uint64_t limit_;             // of hashes in the sample or a part
    std::vector<std::uint64_t> seen_; // by group
    std::uint64_t sampled_ = 0;
    LineSample sample_;
    std::vector<LineSample> part_samples_;
};

} // namespace analysis
