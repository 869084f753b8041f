#include "analysis/traces/shards.h"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

/// In the sample, a cache of n lines has n * rate; what is less than one still holds the line at hand.
std::uint64_t scaled(std::uint64_t distance, double rate) {
    if (distance == StackDistance::first)
        return distance;
    return static_cast<std::uint64_t>(std::ceil(static_cast<double>(distance - 1) / rate)) + 1;
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
      part_samples_(parts, LineSample(sizes, rate, parts, most / parts)), known_out_(out_lines) {
    for (std::size_t i = 0; i < out_lines; ++i)
        known_out_[i] = ~std::uint64_t{i}; // no line of this place
}

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

/// The first of these, which is in the sample, and those that follow and are of the same line: hits of all
/// caches, of which nothing but their number is to be known. How many.
std::size_t Shards::take_run(std::span<const std::uint64_t> lines, std::size_t group, std::uint64_t hash) {
    take(lines.front(), group, hash);
    std::size_t n = 1;
    while (n < lines.size() && lines[n] == lines.front())
        ++n;
    sampled_ += hash < sample_.limit() ? n - 1 : 0; // by what the first has left of the limit
    return n;
}

// Most touches are of lines that were met not long ago and are not in the sample, where no line ever comes
// into it: what there is to do for these is one comparison that a processor guesses right. (To hash them all
// takes more than twice as long.)
void Shards::touch(std::span<const std::uint64_t> lines, std::size_t group) {
    if (group >= seen_.size())
        seen_.resize(group + 1, 0);
    seen_[group] += lines.size();
    const std::uint64_t* const line = lines.data();
    std::uint64_t* const out = known_out_.data();
    const std::size_t n = lines.size();
    for (std::size_t i = 0; i < n;) {
        const std::uint64_t at = line[i];
        if (out[at % out_lines] == at) [[likely]] {
            ++i;
            continue;
        }
        const std::uint64_t hash = traces::hash_bits_of_line(at + offset_);
        if (hash < limit_) [[unlikely]] {
            i += take_run(lines.subspan(i), group, hash);
        } else {
            out[at % out_lines] = at;
            ++i;
        }
    }
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
