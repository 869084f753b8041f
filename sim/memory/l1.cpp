#include "sim/memory/l1.h"

#include <algorithm>

namespace sim {

/// Sends a dirty line on its way; returns when its entry is free.
cycle L1::write_back(std::size_t entry, cycle t, std::size_t phase) {
    std::uint64_t address = array_.line(entry) << line_shift_;
    ++counters_.write_backs;
    ++attribution_.cell(address, phase).l1_write_backs;
    Pool::Grant buffer = write_backs_.take(std::max(t, lines_[entry].ready));
    write_backs_.hold(buffer.entry, l2_.write(address, buffer.at, phase, true).ready);
    return buffer.at;
}

Answer L1::fill(std::uint64_t line, bool write, cycle t, std::size_t phase) {
    Pool::Grant mshr = mshrs_.take(t);
    cycle request = mshr.at + latency_;
    std::size_t entry = array_.victim(line);
    if (array_.line(entry) != CacheArray::no_line && lines_[entry].dirty)
        request = std::max(request, write_back(entry, request, phase));
    ++counters_.fills;
    Answer below = l2_.read(line << line_shift_, request, phase);
    mshrs_.hold(mshr.entry, below.ready);
    array_.fill(entry, line);
    lines_[entry] = {below.ready, below.from, write};
    return {below.ready, below.from, mshr.at};
}

void L1::prefetch(std::uint64_t line, cycle t, std::size_t phase) {
    if (array_.find(line) != CacheArray::none)
        return;
    if (mshrs_.full(t)) {
        ++counters_.prefetches_dropped;
        return;
    }
    ++counters_.prefetches;
    fill(line, false, t, phase);
}

void L1::invalidate(std::uint64_t line, cycle t, std::size_t phase) {
    std::size_t entry = array_.find(line);
    if (entry == CacheArray::none)
        return;
    ++counters_.invalidations;
    if (lines_[entry].dirty)
        write_back(entry, t, phase);
    lines_[entry] = {};
    array_.drop(entry);
}

void L1::discard(std::uint64_t line) {
    std::size_t entry = array_.find(line);
    if (entry != CacheArray::none && lines_[entry].dirty) {
        lines_[entry].dirty = false;
        ++counters_.discarded;
    }
}

} // namespace sim
