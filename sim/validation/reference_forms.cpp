#include "sim/validation/reference_forms.h"

#include "sim/machine/machine.h"

#include <algorithm>
#include <array>

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

// --- within a tile: lines that the L2 has got, all from one bank

constexpr int lines = 16;    // that a third core has brought into the L2 ...
constexpr int since = 3000;  // ... by then
constexpr int follow = 1000; // operations that depend on the last line of a form

/// Three cores that issue in order.
Config three_cores(integer bank_bytes, integer mshrs) {
    Config c = plain_reference();
    c.chip.cores = 3;
    c.core.window = 1;
    c.l1.ports = 1;
    c.l1.mshrs = mshrs;
    c.l2.banks = 1;
    c.l2.bank_bytes = bank_bytes;
    return c;
}

void pass(int cycles) {
    for (int i = 0; i < cycles; ++i)
        scalar_op(operation::integer, stamp{});
}

/// work(base) of the first two cores at any time after `since`.
CoreForm in_tile(const std::string& name, const Config& c, integer cycles, int instructions,
                 const std::function<void(std::byte*)>& first,
                 const std::function<void(std::byte*)>& second) {
    return {name, static_cast<cycle>(cycles), static_cast<std::uint64_t>(instructions + lines), [=] {
                isa::address_space space{std::uint64_t{1} << 26};
                std::byte* base = space.add("data", -1, std::uint64_t{1} << 24, true);
                return Machine(c).run(space, 3, {{"work"}}, [&](int w) {
                    for (int i = 0; w == 2 && i < lines; ++i)
                        load(here, base + i * 64, 4, stamp{});
                    if (w != 2)
                        (w == 0 ? first : second)(base);
                });
            }};
}

/// One core gathers 15 lines, which its port asks for in as many cycles; the other one's line, four cycles
/// later, waits for none of the gather's later ones, and at most for one of the same cycle. Then it works on.
CoreForm gathered(const std::string& name, bool by_first) {
    const Config c = three_cores(64, lines);
    const auto gathers = [](std::byte* base) {
        pass(since);
        std::array<std::int32_t, ISA_WIDTH> index{};
        for (int i = 0; i < lines - 1; ++i)
            index[static_cast<std::size_t>(i)] = i * 16;
        gather(here, base, index.data(), (std::uint64_t{1} << (lines - 1)) - 1, stamp{}, stamp{}, stamp{});
    };
    const auto loads = [](std::byte* base) {
        pass(since + 4);
        stamp s = load(here, base + (lines - 1) * 64, 4, stamp{});
        for (int i = 0; i < follow; ++i)
            s = scalar_op(operation::integer, s);
    };
    const integer latency = c.latency[static_cast<std::size_t>(operation::integer)];
    const integer ready = since + 4 + c.l1.latency + (by_first ? 1 : 0) + c.l2.latency;
    return by_first ? in_tile(name, c, ready + follow * latency, 2 * since + 4 + 2 + follow, gathers, loads)
                    : in_tile(name, c, ready + follow * latency, 2 * since + 4 + 2 + follow, loads, gathers);
}

void add_tile_forms(std::vector<CoreForm>& forms) {
    constexpr int loads = 8;
    const auto load_all = [](std::byte* base) {
        pass(since);
        for (int i = 0; i < loads; ++i)
            load(here, base + i * 64, 4, stamp{});
    };
    const auto nothing = [](std::byte*) {};
    const Config slow = three_cores(16, lines); // four cycles a line
    const integer way = slow.l1.latency + slow.l2.latency;
    forms.push_back(in_tile("8 lines of the L2 from a bank that moves one in four cycles", slow,
                            since + way + 4 * (loads - 1), since + loads, load_all, nothing));
    const Config one = three_cores(64, 1);
    forms.push_back(in_tile("8 lines of the L2 through one MSHR of the L1", one, since + loads * way,
                            since + loads, load_all, nothing));
    forms.push_back(gathered("a line of the L2 amid another core's gather, whose core goes first", true));
    forms.push_back(gathered("a line of the L2 amid another core's gather, whose core goes last", false));
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
    add_tile_forms(forms);
    return forms;
}

} // namespace sim
