// A hardware thread: what it owns besides its stack.
#pragma once

#include "sim/core/core.h"
#include "sim/core/host_lines.h"
#include "sim/core/machine_registers.h"
#include "sim/core/registers.h"
#include "sim/core/stalls.h"
#include "sim/core/store_buffer.h"
#include "sim/machine/report.h"
#include "sim/memory/owner_costs.h"
#include "sim/memory/prefetcher.h"

#include <memory>
#include <vector>

namespace sim {

struct Tile;

struct alignas(64) Hart {
    Hart(std::uint32_t number, Tile& tile, Core& core, const Config& config, std::size_t columns)
        : tile(&tile), core(&core), number(number), window(static_cast<std::size_t>(config.core.window)),
          oldest(window.data()), window_end(window.data() + window.size()),
          registers(static_cast<std::size_t>(config.core.vector_registers)), columns(columns),
          store_buffer(static_cast<std::size_t>(config.core.store_buffer)) {
        enter(0);
    }

    // --- what nearly every operation touches, in adjacent lines of the host's memory
    Tile* tile;
    Core* core;
    std::uint32_t number;
    std::uint32_t memory_operands = 0; // that the operation at hand may still have
    std::int64_t ahead =
        0; // while caches are only warmed: up to the window's end, by costs, in 1/256 cycles ...
    std::uint32_t pace = 256; // ... of which an instruction takes so many
    // Issue order (rule 2).
    Due bound;                // no later operation issues before
    std::vector<Due> window;  // when the last operations issued, a ring
    Due *oldest, *window_end; // in it: the one that issued longest ago, to be written over next; its end
    Due complete;             // when everything begun so far is done, but for what open tickets stand for
    cycle now = 0;            // the latest cycle to which it let the other threads come
    cycle issued = 0;         // the latest issue so far
    // The CPI stack: all cycles before `accounted` have a cause.
    cycle accounted = 0;
    cycle boundary = ~cycle{0}; // the end of the interval (intervals.h) that these lie in
    struct Column {
        std::uint64_t vops = 0, instructions = 0;
        Stack stack{};
    };
    Column* at = nullptr;   // of columns ...
    std::size_t column = 0; // ... this one, of its kind of work and phase; above them its party
    std::size_t pending_count = 0;
    cycle stored = 0; // when all stores so far are in the L1, but for what open tickets stand for
    std::uint64_t spill_base = 0;
    std::uint64_t vector_instructions = 0;
    std::uint32_t overhead = 0; // 1/1024 instructions not yet charged
    std::uint32_t history = 0;  // of branches
    std::uint32_t last_address = 0;
    SiteAtHand site;              // of the operation at hand, for prefetchers by stride ...
    isa::timing::site place{};    // ... and where it stands
    std::uint32_t trace_site = 0; // likewise, for a trace
    RegisterFile registers;
    CoreCounters counters; // but for what the columns and `vector_instructions` sum to
    KindCounts by_kind{};
    std::vector<cycle> loading, storing; // tickets of loads and stores, some already answered
    /// Operands of the operation at hand whose times are open.
    struct Pending {
        cycle ticket;
        std::uint32_t span; // 0: a scalar
        bool spill;
    };
    std::array<Pending, 16> pending;

    // --- what few do
    int worker = -1;
    bool finished = false;
    std::vector<Column> columns;
    std::uint64_t interval = 0; // the length of intervals, 0 before the first one, ...
    cycle origin = 0;           // ... where the one at hand begins ...
    Stack marked{};             // ... and the sum of all columns' stacks when the one before it ended
    cycle finish = 0;           // when the worker's last result was there
    std::unique_ptr<MachineRegisters> machine_registers; // instead, where broadcast values take one
    StoreBuffer store_buffer;
    /// Addresses that were computed because an instruction used them otherwise (core.address_folding).
    struct Unfolded {
        std::uint32_t number = 0;
        cycle ready = 0;
    };
    std::array<Unfolded, 64> unfolded; // by number, remembered that long
    // Between before_atomic and after_atomic.
    Due acting;
    cycle asked = 0; // for the word's line
    // If costs are shared among owners (memory/owner_costs.h): whom it works for, and what its column had
    // when it entered it or was charged for it.
    std::size_t party = 0;
    ThreadCost charged;
    // While it sleeps.
    const std::int32_t* waits_for = nullptr;
    std::uint64_t slept = 0;           // cycles, so far
    cycle next_look = 0;               // at the word, in issue slots taken in advance ...
    std::vector<Calendar::Slot> looks; // ... these, of the window at hand
    std::uint64_t missed_looks = 0;    // others had all slots

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
        prefetch_lines(this, &pending);
        prefetch_lines(oldest, oldest + 1);
        prefetch_lines(at, at + 1);
        core->prefetch(issued);
    }
    /// Work and time count under this column from now on.
    void enter(std::size_t next) {
        column = next;
        at = &columns[next];
    }
    ThreadCost cost_of_column() const;
};

} // namespace sim
