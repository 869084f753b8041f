#include "traces/block_builder.h"

#include <algorithm>
#include <numeric>

namespace traces {
namespace {

/// Numbers of references, those of a stream side by side, each stream's in order.
std::vector<std::uint32_t> by_stream(const std::vector<std::uint32_t>& streams) {
    std::vector<std::uint32_t> order(streams.size());
    const std::uint32_t most = *std::max_element(streams.begin(), streams.end());
    if (most > 1U << 16U) {
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return streams[a] < streams[b]; });
        return order;
    }
    std::vector<std::uint32_t> next(std::size_t{most} + 2, 0); // where each stream's next one goes
    for (const std::uint32_t s : streams)
        ++next[s + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::uint32_t i = 0; i < streams.size(); ++i)
        order[next[streams[i]]++] = i;
    return order;
}

} // namespace

/// More than a block has classes, mostly: to find() one takes as long as all else.
BlockBuilder::BlockBuilder() : recent_(4096) {}

std::uint32_t BlockBuilder::find(const Class& c) {
    const auto [found, made] = numbers_.try_emplace(c, static_cast<std::uint32_t>(table_.size()));
    if (made)
        table_.push_back(c);
    return found->second;
}

/// Turns say segments, by the streams of what they hold.
void BlockBuilder::name_segments(Block& block) {
    std::size_t at = 0;
    for (Turn& turn : turns_) {
        if (turn.what != Turn::What::references)
            continue;
        const auto found =
            std::lower_bound(block.segments.begin(), block.segments.end(), streams_[at],
                             [](const Segment& s, std::uint32_t stream) { return s.stream < stream; });
        turn.segment = static_cast<std::uint32_t>(found - block.segments.begin());
        at += turn.count;
    }
    block.order.swap(turns_);
    turns_.clear();
}

void BlockBuilder::take(Block& block) {
    block.clear();
    const std::size_t n = size();
    const bool sorted = std::is_sorted(streams_.begin(), streams_.end());
    const std::vector<std::uint32_t> order = sorted ? std::vector<std::uint32_t>() : by_stream(streams_);
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t stream = streams_[sorted ? i : order[i]];
        if (block.segments.empty() || block.segments.back().stream != stream)
            block.segments.push_back({stream, i, i});
        block.segments.back().end = i + 1;
    }
    name_segments(block);
    if (sorted) {
        block.times.swap(times_);
        block.addresses.swap(addresses_);
        block.classes.swap(classes_);
        if (any_tile_ != 0)
            block.tiles.swap(tiles_);
    } else {
        block.times.resize(n);
        block.addresses.resize(n);
        block.classes.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            block.times[i] = times_[order[i]];
            block.addresses[i] = addresses_[order[i]];
            block.classes[i] = classes_[order[i]];
        }
        if (any_tile_ != 0)
            for (const std::uint32_t i : order)
                block.tiles.push_back(tiles_[i]);
    }
    block.table.swap(table_);
    times_.clear();
    addresses_.clear();
    classes_.clear();
    streams_.clear();
    tiles_.clear();
    any_tile_ = 0;
    table_.clear();
    numbers_.clear();
    std::fill(recent_.begin(), recent_.end(), Recent{});
}

} // namespace traces
