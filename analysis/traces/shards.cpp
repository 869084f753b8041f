#include "analysis/traces/shards.h"

#include "analysis/traces/line_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace analysis {
namespace {

/// In the sample, a cache of n lines has n * rate; what is less than one still holds the line at hand. At
/// most more than any cache has, however small the rate.
std::uint64_t scaled(std::uint64_t distance, double rate) {
    if (distance == StackDistance::first)
        return distance;
    return static_cast<std::uint64_t>(std::min(std::ceil(static_cast<double>(distance - 1) / rate), 0x1p62)) +
           1;
}

/// Of hashes, which have 53 bits.
std::uint64_t limit_of(double rate) {
    return static_cast<std::uint64_t>(std::ceil(rate * 0x1p53));
}

/// What is known of small samples stays in fast memory, of their parts, which have few lines, above all.
std::size_t slots_of(std::size_t parts) {
    return parts == 1 ? 2048 : 512;
}

} // namespace

LineSample::LineSample(const std::vector<std::uint64_t>& sizes, double rate, std::size_t parts,
                       std::uint64_t most)
    : parts_(static_cast<double>(parts)), most_(most), stack_(slots_of(parts)), counts_(sizes) {
    limit_ = limit_of(rate);
    set_rate(rate / parts_);
}

void LineSample::set_rate(double rate) {
    rate_ = rate;
    weight_ = 1 / rate;
    for (std::size_t i = 0; i < near_.size(); ++i)
        near_[i] = counts_.column_of(scaled(i + 1, rate));
}

void LineSample::set_limit(std::uint64_t limit) {
    limit_ = limit;
    set_rate(static_cast<double>(limit) * 0x1p-53 / parts_);
}

void LineSample::touch(std::uint64_t line, std::size_t group, std::uint64_t hash) {
    const std::uint64_t distance = stack_.touch(line);
    const std::size_t column =
        distance <= near_.size() ? near_[distance - 1] : counts_.column_of(scaled(distance, rate_));
    counts_.add_at(group, column, weight_);
    if (most_ == 0 || distance != StackDistance::first)
        return;
    highest_.emplace(hash, line);
    if (highest_.size() <= most_)
        return;
    set_limit(highest_.top().first);
    while (!highest_.empty() && highest_.top().first >= limit_) {
        stack_.forget(highest_.top().second);
        highest_.pop();
    }
}

Shards::Shards(const std::vector<std::uint64_t>& sizes, double rate, double of, std::uint64_t most,
               std::uint64_t seed)
    : of_(of), offset_(seed * 0xD1B54A32D192ED03U), limit_(limit_of(rate)), sample_(sizes, rate, 1, most),
      part_samples_(parts, LineSample(sizes, rate, parts, most / parts)) {}

void Shards::take(std::uint64_t line, std::size_t group, std::uint64_t hash) {
    if (hash < sample_.limit()) {
        ++sampled_;
        sample_.touch(line, group, hash);
    }
    LineSample& part = part_samples_[hash % parts]; // the low bits, of which the limit knows nothing
    if (hash < part.limit())
        part.touch(line, group, hash);
    if (sample_.limit() < limit_) { // parts' limits lie about that of all
        limit_ = sample_.limit();
        for (const LineSample& p : part_samples_)
            limit_ = std::max(limit_, p.limit());
    }
}

void Shards::touch(std::span<const std::uint64_t> lines, std::size_t group) {
    if (group >= seen_.size())
        seen_.resize(group + 1, 0);
    seen_[group] += lines.size();
    std::size_t next = 0;
    bool last_is_in = false;                // the line looked at last is in the sample
    const auto look = [&](std::size_t at) { // at all that are below the limit, in order
        // A line touched again at once: hits of all caches, of which nothing but their number is to be known.
        if (at != 0 && lines[at] == lines[at - 1]) {
            sampled_ += last_is_in ? 1 : 0;
            return;
        }
        const std::uint64_t hash = traces::hash_bits_of_line(lines[at] + offset_);
        if (hash < limit_)
            take(lines[at], group, hash);
        last_is_in = hash < sample_.limit(); // by what this one has left of the limit
    };
    for (; next + filtered_lines <= lines.size(); next += filtered_lines)
        for (std::uint64_t in = lines_below(&lines[next], offset_, limit_); in != 0; in &= in - 1)
            look(next + static_cast<std::size_t>(std::countr_zero(in)));
    for (; next < lines.size(); ++next)
        if (traces::hash_bits_of_line(lines[next] + offset_) < limit_)
            look(next);
}

/// Misses of a sample for each reference that there is.
double Shards::ratio(const LineSample& sample, std::size_t group, std::size_t size) const {
    return sample.counts().misses(group, size) / (static_cast<double>(references(group)) / of_);
}

Shards::Estimate Shards::estimate(std::size_t group, std::size_t size) const {
    constexpr double student = 2.131; // 0.975 quantile, 15 degrees of freedom
    if (references(group) == 0)
        return {};
    double sum = 0, squares = 0;
    for (const LineSample& part : part_samples_) {
        const double r = ratio(part, group, size);
        sum += r;
        squares += r * r;
    }
    const double n = parts, variance = std::max(0.0, squares - sum * sum / n) / (n - 1);
    // A sample of all lines leaves nothing to chance.
    return {std::clamp(ratio(sample_, group, size), 0.0, 1.0),
            student * std::sqrt((1 - rate()) * variance / n)};
}

} // namespace analysis
