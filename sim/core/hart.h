// A hardware thread: what it owns besides its stack.
#pragma once

#include "sim/core/calendar.h"
#include "sim/core/machine_registers.h"
#include "sim/core/registers.h"
#include "sim/core/stalls.h"
#include "sim/core/store_buffer.h"
#include "sim/machine/report.h"
#include "sim/memory/prefetcher.h"

#include <optional>
#include <vector>

namespace sim {

struct Core;
struct Tile;

struct Hart {
    Hart(std::uint32_t number, Tile& tile, Core& core, const Config& config, std::size_t columns)
        : number(number), tile(&tile), core(&core), window(static_cast<std::size_t>(config.core.window)),
          registers(static_cast<std::size_t>(config.core.vector_registers)),
          store_buffer(static_cast<std::size_t>(config.core.store_buffer)), columns(columns) {}

    std::uint32_t number;
    Tile* tile;
    Core* core;
    int worker = -1;
    bool finished = false;

    // --- issue order (rule 2)
    Due bound;               // no later operation issues before
    std::vector<Due> window; // when the last operations issued, a ring
    std::size_t position = 0;
    Due complete;     // when everything begun so far is done, but for what open tickets stand for
    cycle stored = 0; // when all stores so far are in the L1, likewise
    std::vector<cycle> loading, storing; // tickets of loads and stores, some already answered
    cycle now = 0;                       // the latest cycle to which it let the other threads come
    cycle issued = 0;                    // the latest issue so far

    // --- the CPI stack: all cycles before `accounted` have a cause
    cycle accounted = 0;
    cycle boundary = ~cycle{0}; // the end of the interval (intervals.h) that these lie in ...
    std::uint64_t interval = 0; // ... its length, 0 before the first one ...
    cycle origin = 0;           // ... where that begins ...
    Stack marked{};             // ... and the sum of all columns' stacks when the one before it ended
    cycle finish = 0;           // when the worker's last result was there
    RegisterFile registers;
    std::optional<MachineRegisters> machine_registers; // instead, where broadcast values take one
    std::uint32_t memory_operands = 0;                 // that the operation at hand may still have
    std::uint64_t spill_base = 0;
    StoreBuffer store_buffer;
    /// Addresses that were computed because an instruction used them otherwise (core.address_folding).
    struct Unfolded {
        std::uint32_t number = 0;
        cycle ready = 0;
    };
    std::array<Unfolded, 64> unfolded; // by number, remembered that long
    std::uint32_t last_address = 0;
    std::uint32_t history = 0;  // of branches
    std::uint32_t overhead = 0; // 1/1024 instructions not yet charged

    SiteAtHand site;        // of the operation at hand, for prefetchers by stride
    std::size_t column = 0; // of its kind of work and phase
    struct Column {
        std::uint64_t vops = 0, instructions = 0;
        Stack stack{};
    };
    std::vector<Column> columns;
    Column* at = &columns[0]; // that column's
    CoreCounters counters;    // but for what the columns and `vector_instructions` sum to
    std::uint64_t vector_instructions = 0;
    KindCounts by_kind{};

    // --- operands of the operation at hand whose times are open
    struct Pending {
        cycle ticket;
        std::uint32_t span; // 0: a scalar
        bool spill;
    };
    std::array<Pending, 16> pending;
    std::size_t pending_count = 0;

    // --- between before_atomic and after_atomic
    Due acting;
    cycle asked = 0; // for the word's line
    // --- while it sleeps
    const std::int32_t* waits_for = nullptr;
    cycle next_look = 0;               // at the word, in issue slots taken in advance ...
    std::vector<Calendar::Slot> looks; // ... these, of the window at hand

    void account(cycle from, cycle to, Cause why) {
        if (to > boundary) [[unlikely]] {
            account_across(from, to, why);
            return;
        }
        at->stack[static_cast<std::size_t>(why)] += to - from;
    }
    void account_across(cycle from, cycle to, Cause why);
    void begin_intervals(cycle t, std::uint64_t length);
    void close_interval();
    Stack sum_of_stacks() const;
    Stack& stack_of_interval() const;
    /// What most operations touch comes to the host's caches.
    void prefetch() const {
        const auto* self = reinterpret_cast<const std::byte*>(this);
        for (std::size_t at = 0; at < 5 * 64; at += 64)
            __builtin_prefetch(self + at);
        for (const void* p : {static_cast<const void*>(&window[position]), static_cast<const void*>(at),
                              static_cast<const void*>(&at->stack[4]), static_cast<const void*>(&counters),
                              static_cast<const void*>(&by_kind)})
            __builtin_prefetch(p);
    }
    /// Work and time count under this column from now on.
    void enter(std::size_t next) {
        column = next;
        at = &columns[next];
    }
};

} // namespace sim
