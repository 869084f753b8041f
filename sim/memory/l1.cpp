#include "sim/memory/l1.h"

#include <algorithm>

namespace sim {

/// An access that found its line on its way there.
Answer L1::in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present) {
    Pool::Hold* hold = mshrs_.find(line);
    if (hold == nullptr) {
        array_.set_in_flight(entry, false);
        return present;
    }
    if (is_ticket(hold->until)) { // the line may be there before the access
        ++counters_.hits_in_flight;
        return {tickets_.no_earlier(hold->until, present.ready, present.from), hold->cause};
    }
    if (hold->until > present.ready) {
        ++counters_.hits_in_flight;
        return {hold->until, hold->cause};
    }
    array_.set_in_flight(entry, false);
    return present;
}

/// Sends a dirty line on its way. The buffer has room at `t`.
void L1::write_back(CacheArray::Entry entry, cycle t, std::size_t column) {
    std::uint64_t line = array_.line(entry);
    std::uint64_t address = line << line_shift_;
    ++counters_.write_backs;
    ++attribution_.cell(address, column).l1_write_backs;
    Answer accepted = l2_.write(address, t, column, true);
    write_backs_.hold({line, t, accepted.ready, Cause::mshrs});
}

Answer L1::fill(std::uint64_t line, bool write, cycle t, std::size_t column) {
    CacheArray::Entry entry = array_.oldest(line);
    cycle retry = 0;
    if (retry = mshrs_.take(t); retry != t)
        return Answer::later(retry);
    if (array_.dirty(entry)) {
        if (retry = write_backs_.take(t); retry != t)
            return Answer::later(retry);
        write_back(entry, t + latency_, column);
    }
    ++counters_.fills;
    Answer below = l2_.read(line << line_shift_, t + latency_, column);
    mshrs_.hold({line, t, below.ready, below.from});
    array_.fill(entry, line);
    array_.set_dirty(entry, write);
    array_.set_in_flight(entry, true);
    return below;
}

void L1::prefetch(std::uint64_t line, cycle t, std::size_t column) {
    if (array_.find(line) != CacheArray::none)
        return;
    if (fill(line, false, t, column).retry != 0)
        ++counters_.prefetches_dropped;
    else
        ++counters_.prefetches;
}

void L1::invalidate(std::uint64_t line, cycle t, std::size_t column) {
    CacheArray::Entry entry = array_.find(line);
    if (entry == CacheArray::none)
        return;
    ++counters_.invalidations;
    if (array_.dirty(entry))
        write_back(entry, t, column);
    array_.drop(entry);
}

void L1::discard(std::uint64_t line) {
    CacheArray::Entry entry = array_.find(line);
    if (entry != CacheArray::none && array_.dirty(entry)) {
        array_.set_dirty(entry, false);
        ++counters_.discarded;
    }
}

} // namespace sim
