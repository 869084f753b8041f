// Where a thread's cycles go: the terms of the CPI stack.
#pragma once

#include "isa/simulated/port.h"

#include <array>
#include <cstdint>

namespace sim {

using cycle = isa::timing::cycle;

enum class Cause : std::uint8_t {
    busy,
    slots,
    compute,
    l1,
    l2,
    l3,
    l4,
    l5,
    memory,
    coherence,
    mshrs,
    tlb,
    stores,
    branch,
    spill,
    synchronise,
    idle,
};
inline constexpr std::size_t cause_count = 17;
struct CauseName {
    const char *name, *meaning;
};
inline constexpr std::array<CauseName, cause_count> causes = {{
    {"busy", "issuing its own instructions"},
    {"slots", "ready, but issue slots or units were taken, or the core was another thread's"},
    {"compute", "waiting for the result of an operation"},
    {"l1", "waiting for data that the L1 or a store buffer held"},
    {"l2", "waiting for data that came from the L2"},
    {"l3", "waiting for data that came from the L3"},
    {"l4", "waiting for data that came from the L4"},
    {"l5", "waiting for data that came from the L5"},
    {"memory", "waiting for data that came from memory"},
    {"coherence", "waiting for a line, or the right to write it, that other caches gave up"},
    {"mshrs", "a miss waited for a free MSHR or write-back entry"},
    {"tlb", "waiting for an address's page: the second TLB, or a walk through the page tables"},
    {"stores", "a store waited for a free entry of the store buffer"},
    {"branch", "restarting after a mispredicted (or waiting on an unpredicted) branch"},
    {"spill", "waiting for a spilled register"},
    {"synchronise", "waiting for a shared word"},
    {"idle", "without work: no worker, or the worker had returned"},
}};

/// Whether a thread waits for caches, memory or translation then, or for room on the way there.
inline bool is_of_memory(Cause c) {
    return (c >= Cause::l1 && c <= Cause::mshrs) || c == Cause::tlb || c == Cause::stores;
}

/// Whether a machine with so many levels of caches, with TLBs or none, coherent or not, has the cause.
inline bool has_cause(std::size_t cause, unsigned cache_levels, bool tlb, bool coherent) {
    if (cause == static_cast<std::size_t>(Cause::tlb))
        return tlb;
    if (cause == static_cast<std::size_t>(Cause::coherence))
        return coherent;
    const auto l1 = static_cast<std::size_t>(Cause::l1), memory = static_cast<std::size_t>(Cause::memory);
    return cause < l1 + cache_levels || cause >= memory;
}

/// A cycle and why it is not earlier. Ordered by cycle.
class Due {
public:
    Due() = default;
    Due(cycle at, Cause why) : packed_(at << cause_bits | static_cast<std::uint64_t>(why)) {}
    cycle at() const { return packed_ >> cause_bits; }
    Cause why() const { return static_cast<Cause>(packed_ & ((1U << cause_bits) - 1)); }
    void later(Due other) { packed_ = other.packed_ > packed_ ? other.packed_ : packed_; }

private:
    static constexpr unsigned cause_bits = 5;
    static_assert(cause_count <= 1U << cause_bits);
    std::uint64_t packed_ = 0;
};

} // namespace sim
