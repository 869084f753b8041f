// The references of a block's streams, merged by time.
#pragma once

#include "traces/io/interrupt.h"
#include "traces/reference.h"

#include <cstdint>
#include <vector>

namespace traces {

/// Merges streams two by two, without branches that a processor would guess wrong; keeps its room from block
/// to block.
class TimeOrder {
public:
    /// Visits the references of a block, visit(segment, number), in order of time as far as the order within
    /// streams allows: always the earliest of the streams' next ones (of equals, that of the first stream),
    /// where none counts as earlier than those before it in its stream. Visits may be long: throws
    /// Interrupted between two of them.
    template <class Visit> void each(const Block& block, Visit visit) {
        if (block.segments.size() == 1) {
            const Segment& only = block.segments.front();
            for (std::size_t i = only.begin; i < only.end; ++i) {
                check_interrupts(i - only.begin);
                visit(only, i);
            }
            return;
        }
        sort(block);
        for (std::size_t place = 0; place < numbers_.size(); ++place) {
            check_interrupts(place);
            const std::size_t i = numbers_[place];
            visit(block.segments[segment_of_[i]], i);
        }
    }

private:
    void sort(const Block& block);
    void merge(std::size_t begin, std::size_t middle, std::size_t end);

    // By place: times, and numbers of references; and where merged ones go.
    std::vector<std::uint64_t> times_, merged_times_;
    std::vector<std::uint32_t> numbers_, merged_numbers_;
    std::vector<std::uint32_t> segment_of_; // references
    std::vector<std::size_t> runs_;         // where each begins, and the end
};

/// The same of one block.
template <class Visit> void each_in_time(const Block& block, Visit visit) {
    TimeOrder().each(block, visit);
}

} // namespace traces
