#include "sim/machine/intervals.h"

#include "sim/machine/derived.h"
#include "sim/machine/tile.h"

#include <fmt/format.h>

#include <iterator>

namespace sim {

Intervals::Intervals(std::uint64_t length, std::uint64_t window)
    : length_((length + window - 1) / window * window) {}

void Intervals::begin(cycle t, const Interval& sums) {
    if (!wanted())
        return;
    origin_ = t;
    next_ = t + length_;
    counted_ = sums;
}

void Intervals::add(cycle end, const Interval& sums) {
    Interval row;
    row.begin = rows_.empty() ? 0 : rows_.back().end;
    row.end = end;
    for (const auto& c : interval_counters)
        row.*c.count = sums.*c.count - counted_.*c.count;
    counted_ = sums;
    rows_.push_back(row);
}

void Intervals::close(cycle t, const Interval& sums) {
    for (; next_ <= t; next_ += length_)
        add(next_ - origin_, sums);
}

std::vector<Interval> Intervals::finish(cycle cycles, const Interval& sums, cycle drained,
                                        const Interval& all, const std::vector<const TileIntervals*>& tiles) {
    if (!wanted())
        return {};
    for (; next_ - origin_ < cycles; next_ += length_)
        add(next_ - origin_, sums);
    add(cycles, sums);
    // A window may have begun after the last result was there.
    while (rows_.size() > 1 && rows_[rows_.size() - 2].end >= cycles) {
        Interval last = rows_.back();
        rows_.pop_back();
        for (const auto& c : interval_counters)
            rows_.back().*c.count += last.*c.count;
        rows_.back().end = cycles;
    }
    for (const TileIntervals* tile : tiles) {
        for (std::size_t i = 0; i < tile->stacks.size(); ++i)
            for (std::size_t cause = 0; cause < cause_count; ++cause)
                rows_[i].stack[cause] += tile->stacks[i][cause];
        for (std::size_t i = 0; i < tile->looks.size(); ++i)
            rows_[std::min(i, rows_.size() - 1)].instructions += static_cast<std::uint64_t>(tile->looks[i]);
    }
    add(drained, all);
    return std::move(rows_);
}

void Hart::begin_intervals(cycle t, std::uint64_t length) {
    interval = length;
    origin = t;
    boundary = t + length;
    marked = sum_of_stacks();
}

Stack Hart::sum_of_stacks() const {
    Stack sum{};
    for (const Column& column : columns)
        for (std::size_t i = 0; i < cause_count; ++i)
            sum[i] += column.stack[i];
    return sum;
}

/// The cycles from `from` on reach beyond the interval's end.
void Hart::account_across(cycle from, cycle to, Cause why) {
    const auto cause = static_cast<std::size_t>(why);
    at->stack[cause] += boundary - from;
    close_interval();
    for (from = boundary, boundary += interval; boundary < to; boundary += interval) {
        at->stack[cause] += interval;
        marked[cause] += interval;
        stack_of_interval()[cause] += interval;
        from = boundary;
    }
    at->stack[cause] += to - from;
}

/// That which ends at `boundary`.
Stack& Hart::stack_of_interval() const {
    std::vector<Stack>& all = tile->intervals.stacks;
    const std::size_t number = (boundary - origin) / interval - 1;
    if (all.size() <= number)
        all.resize(number + 1, Stack{});
    return all[number];
}

/// What has been accounted for since the last time counts for the interval at hand.
void Hart::close_interval() {
    const Stack sum = sum_of_stacks();
    Stack& row = stack_of_interval();
    for (std::size_t i = 0; i < cause_count; ++i)
        row[i] += sum[i] - marked[i];
    marked = sum;
}

std::string print_intervals(const Report& r) {
    std::string out = "interval,begin,end";
    for (const auto& c : interval_counters)
        out += fmt::format(",{}", c.name);
    out += ",ipc,memory_bytes";
    const auto shown = [&r](std::size_t cause) { // levels of caches that are not there are columns too
        return has_cause(cause, most_levels, r.config.tlb.any(), r.config.coherence.kept());
    };
    for (std::size_t i = 0; i < cause_count; ++i)
        if (shown(i))
            out += fmt::format(",stack_{}", causes[i].name);
    out += '\n';
    const auto cores = static_cast<std::uint64_t>(r.config.all_cores());
    for (std::size_t i = 0; i < r.intervals.size(); ++i) {
        const Interval& row = r.intervals[i];
        fmt::format_to(std::back_inserter(out), "{},{},{}", i, row.begin, row.end);
        for (const auto& c : interval_counters)
            fmt::format_to(std::back_inserter(out), ",{}", row.*c.count);
        fmt::format_to(std::back_inserter(out), ",{:.6f},{}",
                       ratio(row.instructions, (row.end - row.begin) * cores),
                       (row.memory_reads + row.memory_writes) *
                           static_cast<std::uint64_t>(r.config.last_cache().line_bytes));
        for (std::size_t cause = 0; cause < cause_count; ++cause)
            if (shown(cause))
                fmt::format_to(std::back_inserter(out), ",{}", row.stack[cause]);
        out += '\n';
    }
    return out;
}

} // namespace sim
