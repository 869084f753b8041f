#include "sim/memory/l2.h"

#include <algorithm>
#include <bit>

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}

} // namespace

L2::L2(const Config& config, std::uint64_t ring_cycles, Memory& memory, Attribution& attribution)
    : line_shift_(static_cast<unsigned>(std::countr_zero(wide(config.l2.line_bytes)))),
      latency_(wide(config.l2.latency)), bank_mask_(wide(config.l2.banks) - 1),
      occupancy_(static_cast<std::uint32_t>((config.l1.line_bytes + config.l2.bank_bytes - 1) /
                                            config.l2.bank_bytes)),
      whole_lines_(config.l1.line_bytes == config.l2.line_bytes),
      array_(wide(config.l2.size_bytes / (config.l2.ways * config.l2.line_bytes)), wide(config.l2.ways)),
      lines_(array_.entries()), banks_(wide(config.l2.banks), Calendar("L2 bank", ring_cycles)),
      mshrs_(wide(config.l2.mshrs)), write_backs_(wide(config.l2.write_back_buffer)), memory_(memory),
      attribution_(attribution) {}

/// Sends a dirty line on its way; returns when the entry is free.
cycle L2::evict(std::size_t entry, cycle t, std::size_t phase) {
    std::uint64_t address = array_.line(entry) << line_shift_;
    Traffic& owner = attribution_.cell(address, phase);
    ++counters_.write_backs;
    ++owner.l2_write_backs;
    ++owner.memory_writes;
    Pool::Grant buffer = write_backs_.take(std::max(t, lines_[entry].ready));
    write_backs_.hold(buffer.entry, memory_.write(address, buffer.at));
    return buffer.at;
}

Answer L2::access(std::uint64_t address, cycle t, std::size_t phase, bool write, bool needs_data) {
    std::uint64_t line = address >> line_shift_;
    Traffic& cell = attribution_.cell(address, phase);
    ++(write ? counters_.writes : counters_.reads);
    ++(write ? cell.l2_writes : cell.l2_reads);
    counters_.busy_cycles += occupancy_;
    cycle start = banks_[line & bank_mask_].take_run(t, occupancy_);
    cycle done = start + latency_;
    std::size_t entry = array_.find(line);
    if (entry != CacheArray::none) {
        ++counters_.hits;
        array_.touch(entry);
        Line& l = lines_[entry];
        l.dirty |= write;
        if (l.ready <= done)
            return {done, Cause::l2};
        ++counters_.hits_in_flight;
        return {l.ready, Cause::memory};
    }
    ++counters_.misses;
    ++cell.l2_misses;
    entry = array_.victim(line);
    if (array_.line(entry) != CacheArray::no_line && lines_[entry].dirty)
        done = std::max(done, evict(entry, done, phase));
    array_.fill(entry, line);
    if (!needs_data && whole_lines_) {
        lines_[entry] = {done, write};
        return {done, Cause::l2};
    }
    Pool::Grant mshr = mshrs_.take(done);
    ++counters_.fills;
    ++cell.memory_reads;
    cycle ready = memory_.read(line << line_shift_, mshr.at);
    mshrs_.hold(mshr.entry, ready);
    lines_[entry] = {ready, write};
    return {ready, Cause::memory};
}

void L2::discard(std::uint64_t address) {
    std::size_t entry = array_.find(address >> line_shift_);
    if (entry != CacheArray::none && lines_[entry].dirty) {
        lines_[entry].dirty = false;
        ++counters_.discarded;
    }
}

} // namespace sim
