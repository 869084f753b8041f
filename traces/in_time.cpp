#include "traces/in_time.h"

#include <algorithm>
#include <numeric>

namespace traces {

/// Two runs side by side; of equals those of the first come first. From both ends at once: each step waits
/// for the one before it, and so two go side by side.
void TimeOrder::merge(std::size_t begin, std::size_t middle, std::size_t end) {
    const std::uint64_t* const times = times_.data();
    const std::uint32_t* const numbers = numbers_.data();
    std::uint64_t* const to_times = merged_times_.data();
    std::uint32_t* const to_numbers = merged_numbers_.data();
    std::size_t a = begin, b = middle, to = begin;         // what is left: from these on
    std::size_t a_end = middle, b_end = end, to_end = end; // until before these
    const auto put_first = [&] {
        const std::size_t second = times[b] < times[a] ? 1 : 0, from = a + (b - a) * second;
        to_times[to] = times[from];
        to_numbers[to++] = numbers[from];
        b += second;
        a += 1 - second;
    };
    const auto put_last = [&] {
        const std::size_t second = times[b_end - 1] >= times[a_end - 1] ? 1 : 0,
                          from = a_end + (b_end - a_end) * second - 1;
        to_times[--to_end] = times[from];
        to_numbers[to_end] = numbers[from];
        b_end -= second;
        a_end -= 1 - second;
    };
    while (a_end - a >= 2 && b_end - b >= 2)
        for (std::size_t steps = std::min(a_end - a, b_end - b) / 2; steps != 0; --steps) {
            put_first();
            put_last();
        }
    while (a != a_end && b != b_end)
        put_first();
    const auto copy_rest = [&](std::size_t from, std::size_t until) {
        std::copy(times + from, times + until, to_times + to);
        std::copy(numbers + from, numbers + until, to_numbers + to);
        to += until - from;
    };
    copy_rest(a, a_end);
    copy_rest(b, b_end);
}

void TimeOrder::sort(const Block& block) {
    const std::size_t n = block.size();
    times_.resize(n);
    merged_times_.resize(n);
    numbers_.resize(n);
    merged_numbers_.resize(n);
    segment_of_.resize(n);
    runs_.clear();
    for (std::size_t s = 0; s < block.segments.size(); ++s) {
        const Segment& segment = block.segments[s];
        runs_.push_back(segment.begin);
        std::uint64_t latest = 0;
        for (std::size_t i = segment.begin; i < segment.end; ++i) {
            latest = std::max(latest, block.times[i]);
            times_[i] = latest;
            segment_of_[i] = static_cast<std::uint32_t>(s);
        }
    }
    runs_.push_back(n);
    std::iota(numbers_.begin(), numbers_.end(), 0U);
    while (runs_.size() > 2) {
        std::size_t left = 0; // runs
        for (std::size_t run = 0; run + 1 < runs_.size(); run += 2) {
            const std::size_t begin = runs_[run], middle = runs_[run + 1];
            merge(begin, middle, run + 2 < runs_.size() ? runs_[run + 2] : middle);
            runs_[left++] = begin;
        }
        runs_[left++] = n;
        runs_.resize(left);
        times_.swap(merged_times_);
        numbers_.swap(merged_numbers_);
    }
}

} // namespace traces
