#include "sim/memory/memory.h"

#include <algorithm>
#include <bit>

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}

} // namespace

Memory::Memory(const Config& config, std::uint64_t disorder)
    : core_ps_(wide(config.chip.clock_ps)), memory_ps_(wide(config.memory.clock_ps)),
      there_(wide(config.memory.controller_cycles) / 2),
      back_(wide(config.memory.controller_cycles) - there_),
      burst_shift_(static_cast<unsigned>(
          std::countr_zero(wide(config.memory.bus_bytes * config.memory.burst_length)))),
      parts_(static_cast<std::uint32_t>(config.last_cache().line_bytes >> burst_shift_)),
      mapping_(config.memory), timing_(config.memory), shortest_(shortest_read(config)),
      lines_(wide(config.memory.channels * config.memory.ranks)) {
    channels_.reserve(wide(config.memory.channels));
    for (std::uint32_t i = 0; i < wide(config.memory.channels); ++i)
        channels_.emplace_back(i, config.memory, timing_, disorder);
}

cycle Memory::read(std::uint64_t address, cycle t) {
    Clock from = arrival(t);
    latest_ = std::max(latest_, from);
    Clock done = 0;
    std::uint64_t burst = address >> burst_shift_ & ~std::uint64_t{parts_ - 1};
    for (std::uint32_t i = 0; i < parts_; ++i) {
        DramPlace p = mapping_.locate((burst + i) << burst_shift_);
        if (i == 0)
            ++lines_[p.channel * lines_.size() / channels_.size() + p.rank].reads;
        done = std::max(done, channels_[p.channel].read(p, burst + i, from, i + 1 == parts_));
    }
    return std::max(leave(done) + back_, t + shortest_);
}

cycle Memory::write(std::uint64_t address, cycle t) {
    Clock from = arrival(t);
    latest_ = std::max(latest_, from);
    Clock taken = 0;
    std::uint64_t burst = address >> burst_shift_ & ~std::uint64_t{parts_ - 1};
    for (std::uint32_t i = 0; i < parts_; ++i) {
        DramPlace p = mapping_.locate((burst + i) << burst_shift_);
        if (i == 0)
            ++lines_[p.channel * lines_.size() / channels_.size() + p.rank].writes;
        taken = std::max(taken, channels_[p.channel].write(p, burst + i, from));
    }
    return leave(taken);
}

cycle Memory::drain() {
    Clock end = 0;
    for (DramChannel& c : channels_) {
        c.drain(latest_);
        end = std::max(end, c.quiet());
    }
    return leave(end);
}

void Memory::count_refreshes(Clock clocks) {
    for (DramChannel& c : channels_)
        c.count_refreshes(clocks);
}

void Memory::finish() {
    drain();
    for (DramChannel& c : channels_)
        c.count_refreshes(c.quiet());
}

std::vector<MemoryCounters> Memory::rank_counters() const {
    std::vector<MemoryCounters> out = lines_;
    auto to = out.begin();
    for (const DramChannel& c : channels_)
        for (const MemoryCounters& rank : c.counters())
            *to++ += rank;
    return out;
}

MemoryCounters Memory::counters() const {
    MemoryCounters sum;
    for (const MemoryCounters& rank : rank_counters())
        sum += rank;
    return sum;
}

void Memory::set_log(std::vector<DramCommand>* log) {
    for (DramChannel& c : channels_)
        c.set_log(log);
}

std::uint64_t Memory::shortest_read(const Config& config) {
    const MemoryConfig& c = config.memory;
    integer clocks = c.tCL + c.burst_clocks();
    return wide(c.controller_cycles + clocks * c.clock_ps / config.chip.clock_ps);
}

std::uint64_t Memory::longest_service(const Config& config, std::uint64_t requests) {
    const MemoryConfig& c = config.memory;
    DramTiming t(c);
    std::uint64_t bursts = wide(config.last_cache().line_bytes / (c.bus_bytes * c.burst_length));
    // Each burst on its own: opened, turned around, closed; in between, refreshes of every rank.
    Clock each = t.tRC + t.tRCD + t.precharge[1] + t.column[0][1][at(Near::channel)] +
                 t.column[1][0][at(Near::group)] + t.data[0] + t.burst + t.tFAW;
    Clock busy = each * (requests * bursts + wide(c.write_queue + 1));
    return t.tREFI == 0 ? busy : (busy / (t.tREFI - t.blocked_by_refresh()) + 2) * t.tREFI;
}

} // namespace sim
