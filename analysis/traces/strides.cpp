#include "analysis/traces/strides.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>

namespace analysis {
namespace {

std::uint64_t size_of(std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    return value < 0 ? 0 - bits : bits;
}

} // namespace

/// One of each of room_ values, and the one at hand, go together.
void FrequentValues::cut() {
    ++cuts_;
    for (auto at = counts_.begin(); at != counts_.end();)
        at = --at->second == 0 ? counts_.erase(at) : std::next(at);
}

std::vector<FrequentValues::Counted> FrequentValues::most(std::size_t count) const {
    std::vector<Counted> out;
    for (const auto& [value, n] : counts_)
        out.push_back({value, n});
    std::sort(out.begin(), out.end(), [](const Counted& a, const Counted& b) {
        if (a.count != b.count)
            return a.count > b.count;
        const std::uint64_t sa = size_of(a.value), sb = size_of(b.value);
        return sa != sb ? sa < sb : a.value > b.value;
    });
    out.resize(std::min(count, out.size()));
    return out;
}

std::uint64_t Strides::Group::references() const {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

void Strides::add(const Access& access) {
    if (access.group >= groups_.size())
        groups_.resize(std::size_t{access.group} + 1);
    Group& g = groups_[access.group];
    const auto [found, fresh] = last_.try_emplace(std::uint64_t{access.group} << 32U | access.stream);
    Last& last = found->second;
    if (fresh) {
        ++g.counts[first];
    } else {
        const auto stride = static_cast<std::int64_t>(access.address - last.address);
        ++g.counts[stride == 0                                      ? same
                   : access.address - last.address == last.more + 1 ? sequential
                   : stride == last.stride                          ? strided
                                                                    : irregular];
        const auto bucket = static_cast<std::size_t>(std::bit_width(size_of(stride)));
        ++(stride < 0 ? g.backwards : g.forwards)[bucket];
        g.values.add(stride);
        last.stride = stride;
    }
    last.address = access.address;
    last.more = access.more;
}

} // namespace analysis
