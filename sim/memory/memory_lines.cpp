#include "sim/memory/memory_lines.h"

#include <bit>

namespace sim {

MemoryLines::MemoryLines(const Config& config)
    : core_ps_(wide(config.chip.clock_ps)), memory_ps_(wide(config.memory.clock_ps)),
      there_(wide(config.memory.controller_cycles) / 2),
      back_(wide(config.memory.controller_cycles) - there_),
      burst_shift_(static_cast<unsigned>(
          std::countr_zero(wide(config.memory.bus_bytes * config.memory.burst_length)))),
      parts_(static_cast<std::uint32_t>(config.last_cache().line_bytes >> burst_shift_)),
      ranks_(wide(config.memory.ranks)), mapping_(config.memory), timing_(config.memory),
      lines_(wide(config.memory.channels * config.memory.ranks)) {}

std::uint64_t MemoryLines::shortest_read(const Config& config) {
    const MemoryConfig& c = config.memory;
    integer clocks = c.tCL + c.burst_clocks();
    return wide(c.controller_cycles + clocks * c.clock_ps / config.chip.clock_ps);
}

} // namespace sim
