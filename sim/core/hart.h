// A hardware thread: what it owns besides its stack.
#pragma once

#include "sim/core/registers.h"
#include "sim/core/stalls.h"
#include "sim/machine/report.h"

#include <vector>

namespace sim {

struct Core;

struct Hart {
    Hart(std::uint32_t number, Core& core, const Config& config, std::size_t phases)
        : number(number), core(&core), window(static_cast<std::size_t>(config.core.window)),
          registers(static_cast<std::size_t>(config.core.vector_registers)), stacks(phases, Stack{}),
          phase_vops(phases, 0), phase_instructions(phases, 0) {}

    std::uint32_t number;
    Core* core;
    int worker = -1;

    // --- issue order (rule 2)
    Due bound;               // no later operation issues before
    std::vector<Due> window; // when the last operations issued, a ring
    std::size_t position = 0;
    Due complete;     // when everything begun so far is done
    cycle stored = 0; // when all stores so far are in the L1
    cycle now = 0;    // the latest cycle to which it let the other threads come

    // --- the CPI stack: all cycles before `accounted` have a cause
    cycle accounted = 0;
    RegisterFile registers;
    std::uint64_t spill_base = 0;
    std::uint32_t history = 0;  // of branches
    std::uint32_t overhead = 0; // 1/1024 instructions not yet charged

    std::size_t phase = 0;
    std::vector<Stack> stacks;
    std::vector<std::uint64_t> phase_vops, phase_instructions;
    CoreCounters counters;

    // --- between before_atomic and after_atomic
    Due acting;
    // --- while it sleeps
    const std::int32_t* waits_for = nullptr;

    void account(cycle from, cycle to, Cause why) {
        stacks[phase][static_cast<std::size_t>(why)] += to - from;
    }
};

} // namespace sim
