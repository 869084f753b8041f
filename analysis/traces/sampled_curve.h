// LRU curves from samples: of lines for large caches, of stretches of the trace for small ones.
#pragma once

#include "analysis/traces/shards.h"
#include "analysis/traces/short_reuse.h"

#include <cstdint>
#include <span>
#include <vector>

namespace analysis {

class SampledCurve {
public:
    /// Lines: as of Shards. The same part of the trace is looked at for small caches, and half as much in
    /// stretches of an eighth of the length, of which there are enough in short traces; or a hundredth of it
    /// in short ones and in long ones where the sample is of so many lines; nothing of it if the
    /// trace is a sample itself (`of` below 1). `seed`: of which lines and stretches; of the lines of a trace
    /// that is a sample 0.
    SampledCurve(const std::vector<std::uint64_t>& sizes, double rate, double of = 1, std::uint64_t most = 0,
                 std::uint64_t seed = 0);

    void touch(std::uint64_t line, std::size_t group) {
        shards_.touch(line, group);
        for (ShortReuse& s : stretches_)
            s.touch(line, group);
    }

    /// All of these, as touch() of each.
    void touch(std::span<const std::uint64_t> lines, std::size_t group) {
        shards_.touch(lines, group);
        for (ShortReuse& s : stretches_)
            s.touch(lines, group);
    }

    const Shards& lines() const { return shards_; }
    struct Estimate {
        double ratio = 0;
        double error = 0; // not-a-number: it is not known
        bool of_lines = true;
    };
    /// Of the sample of lines where the cache has at least `fewest` lines of it; else of stretches, if at
    /// least eight know something of the cache, in an eighth of their touches; else of lines without an
    /// error.
    Estimate estimate(std::size_t group, std::size_t size) const;
    static constexpr double fewest = 8;

private:
    std::vector<std::uint64_t> sizes_;
    Shards shards_;
    std::vector<ShortReuse> stretches_; // the first that knows is asked
};

} // namespace analysis
