#include "traces/block_builder.h"

#include <algorithm>

namespace traces {
namespace {

/// The streams of turns, ascending, each once.
std::vector<std::uint32_t> streams_of(const std::vector<Turn>& turns) {
    constexpr std::uint32_t few = 1U << 16U;
    std::vector<std::uint32_t> out;
    std::vector<bool> seen;
    for (const Turn& t : turns) {
        if (t.what != Turn::What::references)
            continue;
        if (t.segment < few) {
            if (t.segment >= seen.size())
                seen.resize(t.segment + 1);
            if (seen[t.segment])
                continue;
            seen[t.segment] = true;
        }
        out.push_back(t.segment);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

} // namespace

/// The segments of all streams, which turns then say by their numbers.
std::vector<Segment> BlockBuilder::make_segments() {
    const std::vector<std::uint32_t> streams = streams_of(turns_);
    std::vector<Segment> out(streams.size());
    for (Turn& turn : turns_) {
        if (turn.what != Turn::What::references)
            continue;
        const auto found = std::lower_bound(streams.begin(), streams.end(), turn.segment);
        turn.segment = static_cast<std::uint32_t>(found - streams.begin());
        out[turn.segment].end += turn.count;
    }
    std::size_t begin = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {streams[i], begin, begin + out[i].end};
        begin = out[i].end;
    }
    return out;
}

/// What came in turns, those of a segment side by side.
template <class T>
void BlockBuilder::place(std::vector<T>& column, const std::vector<Segment>& segments,
                         std::vector<T>& out) const {
    if (segments.size() <= 1) {
        out.swap(column);
        return;
    }
    std::vector<std::size_t> next; // where each segment's next one goes
    for (const Segment& s : segments)
        next.push_back(s.begin);
    out.resize(column.size());
    const T* from = column.data();
    for (const Turn& turn : turns_) {
        if (turn.what != Turn::What::references)
            continue;
        std::size_t& to = next[turn.segment];
        std::copy(from, from + turn.count, out.data() + to);
        from += turn.count;
        to += turn.count;
    }
}

void BlockBuilder::take(Block& block) {
    block.clear();
    block.segments = make_segments();
    place(times_, block.segments, block.times);
    place(addresses_, block.segments, block.addresses);
    place(classes_, block.segments, block.classes);
    if (any_tile_ != 0)
        place(tiles_, block.segments, block.tiles);
    block.order.swap(turns_);
    table_.take(block.table);
    times_.clear();
    addresses_.clear();
    classes_.clear();
    tiles_.clear();
    any_tile_ = 0;
    marks_ = 0;
    turns_.clear();
}

} // namespace traces
