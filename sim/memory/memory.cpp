#include "sim/memory/memory.h"

#include <algorithm>

namespace sim {

Memory::Memory(const Config& config, std::uint64_t disorder)
    : MemoryLines(config), shortest_(shortest_read(config)) {
    channels_.reserve(wide(config.memory.channels));
    for (std::uint32_t i = 0; i < wide(config.memory.channels); ++i)
        channels_.emplace_back(i, config.memory, timing_, disorder);
}

cycle Memory::read(std::uint64_t address, cycle t) {
    Clock from = arrival(t);
    latest_ = std::max(latest_, from);
    Clock done = 0;
    std::uint64_t burst = first_burst(address);
    for (std::uint32_t i = 0; i < parts_; ++i) {
        DramPlace p = place(burst + i);
        if (i == 0)
            ++counters_of(p).reads;
        done = std::max(done, channels_[p.channel].read(p, burst + i, from, i + 1 == parts_));
    }
    return std::max(leave(done) + back_, t + shortest_);
}

cycle Memory::write(std::uint64_t address, cycle t) {
    Clock from = arrival(t);
    latest_ = std::max(latest_, from);
    Clock taken = 0;
    std::uint64_t burst = first_burst(address);
    for (std::uint32_t i = 0; i < parts_; ++i) {
        DramPlace p = place(burst + i);
        if (i == 0)
            ++counters_of(p).writes;
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

void Memory::set_log(std::vector<DramCommand>* log) {
    for (DramChannel& c : channels_)
        c.set_log(log);
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
