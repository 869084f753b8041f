#include "sim/validation/reference_forms.h"

#include "sim/machine/machine.h"

#include <algorithm>

namespace sim {
namespace {

using namespace isa::timing;

constexpr site here{"reference form", 1};
constexpr int n = 48;

/// Cycles from an instruction's beginning to a line from a row that is not open, with nobody in the way.
integer cold(const Config& c) {
    const MemoryConfig& m = c.memory;
    return c.l1.latency + c.l2.latency + m.controller_cycles + m.tRCD + m.tCL + m.burst_clocks();
}

CoreForm form(const std::string& name, const Config& c, integer cycles, int loads, integer stride) {
    return {name, static_cast<cycle>(cycles), static_cast<std::uint64_t>(loads), [=] {
                isa::address_space space{std::uint64_t{1} << 26};
                std::byte* base = space.add("data", -1, std::uint64_t{1} << 24, true);
                return Machine(c).run(space, 1, {{"work"}}, [&](int) {
                    for (int i = 0; i < loads; ++i)
                        load(here, base + i * stride, 4, stamp{});
                });
            }};
}

} // namespace

Config plain_reference() {
    Config c = plain_core();
    c.sim.mode = "reference";
    c.sim.quantum = 0;
    c.memory.controller = "queued";
    c.memory.clock_ps = c.chip.clock_ps;
    c.memory.tREFI = 0;
    return c;
}

std::vector<CoreForm> reference_forms() {
    const Config idle = plain_reference();
    Config hits = idle;
    hits.l1.mshrs = hits.l2.mshrs = hits.memory.read_queue = n;
    hits.l2.banks = 64;
    // One place in the queue: a burst comes in the clock after the column command of the one before.
    Config full = hits;
    full.memory.read_queue = 1;
    const integer bank = full.memory.row_bytes, one = full.memory.tRCD + 1;
    Config refreshed = idle;
    const integer arrives =
        refreshed.l1.latency + refreshed.l2.latency + refreshed.memory.controller_cycles / 2;
    refreshed.memory.tREFI = 5000;
    const integer issued = 5000 - arrives + 1; // so that the read comes in the clock after the refresh
    std::vector<CoreForm> forms = {
        form("a read of an idle memory", idle, cold(idle), 1, 64),
        form("48 reads of a row at the rate of the bus", hits,
             cold(hits) + (n - 1) * hits.memory.burst_clocks(), n, 64),
        form("8 reads of 8 banks through a queue of one", full, cold(full) + 7 * one, 8, bank),
    };
    CoreForm late = form("a read that meets a refresh", refreshed, 0, 1, 64);
    late.cycles = static_cast<cycle>(issued + cold(refreshed) + refreshed.memory.tRFC - 1);
    late.instructions = static_cast<std::uint64_t>(issued) + 1;
    late.run = [refreshed, issued] {
        isa::address_space space{std::uint64_t{1} << 26};
        std::byte* base = space.add("data", -1, std::uint64_t{1} << 24, true);
        return Machine(refreshed).run(space, 1, {{"work"}}, [&](int) {
            for (integer i = 0; i < issued; ++i) // one a cycle
                scalar_op(operation::integer, stamp{});
            load(here, base, 4, stamp{});
        });
    };
    forms.push_back(late);
    return forms;
}

} // namespace sim
