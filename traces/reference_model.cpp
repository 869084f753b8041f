#include "traces/reference_model.h"

#include "traces/block_layout.h"

namespace traces {
namespace {

/// Room to tell contexts from each other: of small blocks a little is enough.
unsigned line_bits_for(std::size_t references) {
    return std::clamp(static_cast<unsigned>(std::bit_width(references)), 10U, 17U) - 5;
}

} // namespace

void ReferenceModel::begin(const std::vector<Class>& table, std::size_t references, std::size_t streams,
                           unsigned set_bits, std::uint64_t first_time, bool tiled, bool checked) {
    const unsigned line_bits = line_bits_for(references);
    for (Predictor<5>* p : {&step_, &what_, &head_, &time_})
        p->begin(line_bits, checked);
    for (Predictor<4>* p : {&turn_, &near_, &far_, &leaving_})
        p->begin(line_bits, checked);
    for (Predictor<3>* p : {&stream_number_, &left_what_})
        p->begin(line_bits, checked);
    tiled_ = tiled;
    if (tiled) {
        which_tile_.begin(line_bits, checked);
        far_tile_.begin(line_bits, checked);
    }
    table_ = &table;
    moves_.emplace(table, true);
    place_ = without_parts(table.size(), [&](std::uint32_t c) -> const Class& { return table[c]; });
    class_bits_ = std::max(1U, static_cast<unsigned>(std::bit_width(table.size() - 1)));
    stream_bits_ = std::max(1U, static_cast<unsigned>(std::bit_width(streams - 1)));
    set_bits_ = set_bits;
    streams_.assign(streams, Stream{});
    for (Stream& s : streams_)
        s.time = first_time;
    heads_.clear();
    last_.clear();
    recent_.begin(set_bits);
    stream_ = stream_before_ = last_step_ = step_before_ = in_window_ = 0;
    until_ = first_time;
    length_ = gap_ = 0;
}

} // namespace traces
