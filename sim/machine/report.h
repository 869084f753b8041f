// What a run says: plain numbers, printed by text.cpp and json.cpp, checked by laws.cpp.
#pragma once

#include "sim/config/config.h"
#include "sim/core/pairing.h"
#include "sim/core/stalls.h"
#include "sim/memory/coherence_counters.h"
#include "sim/memory/counters.h"
#include "sim/memory/owner_costs.h"
#include "sim/memory/traffic.h"
#include "sim/network/counters.h"

#include <array>
#include <string>
#include <vector>

namespace sim {

struct CoreCounters {
    std::uint64_t vops = 0, vector_vops = 0, instructions = 0, lane_slots = 0, loads = 0, stores = 0,
                  gathers = 0;
    std::uint64_t scatters = 0, branches = 0, mispredicts = 0, atomics = 0, releases = 0, modifications = 0,
                  waits = 0, spins = 0, causality_waits = 0;
    std::uint64_t memory_operands = 0;
    std::uint64_t spill_stores = 0, spill_loads = 0, overhead_instructions = 0, switches = 0, pages = 0;
    std::uint64_t buffered_stores = 0, forwarded_loads = 0, blocked_loads = 0, folded = 0, unfolded = 0;
    std::uint64_t assembly_instructions = 0, assembly_references = 0, assembly_stores = 0;
};
inline constexpr std::array<CounterRow<CoreCounters>, 30> core_counters = {{
    {"vops", &CoreCounters::vops,
     "vocabulary operations: one operation of full logical width, or one scalar one"},
    {"vector_vops", &CoreCounters::vector_vops, "of these, vector operations"},
    {"instructions", &CoreCounters::instructions, "machine instructions: issue slots used"},
    {"lane_slots", &CoreCounters::lane_slots, "SIMD lanes of the vector instructions among them"},
    {"loads", &CoreCounters::loads, "load operations, gathers included"},
    {"stores", &CoreCounters::stores, "store operations, scatters included"},
    {"gathers", &CoreCounters::gathers, "gather operations"},
    {"scatters", &CoreCounters::scatters, "scatter operations"},
    {"branches", &CoreCounters::branches, "branches"},
    {"mispredicts", &CoreCounters::mispredicts, "branches that were predicted wrongly"},
    {"atomics", &CoreCounters::atomics, "operations on shared words"},
    {"releases", &CoreCounters::releases, "of these, releases: written to the L2"},
    {"modifications", &CoreCounters::modifications, "of these, read-modify-writes: act at the L2"},
    {"waits", &CoreCounters::waits, "waits for a shared word that parked the thread"},
    {"spins", &CoreCounters::spins, "looks at a shared word while waiting, two of the instructions each"},
    {"causality_waits", &CoreCounters::causality_waits,
     "reads of a shared word before the time at which it was written: 0 where threads are ordered exactly"},
    {"spill_stores", &CoreCounters::spill_stores, "vector values stored because registers ran out"},
    {"spill_loads", &CoreCounters::spill_loads, "vector values that came back"},
    {"memory_operands", &CoreCounters::memory_operands,
     "of these, operands from the stack, which take no load instruction (core.memory_operands)"},
    {"overhead_instructions", &CoreCounters::overhead_instructions,
     "instructions charged by core.scalar_overhead, core.scalar_moves and core.vector_moves"},
    {"switches", &CoreCounters::switches, "changes of the thread that holds a core (policy stall)"},
    {"pages", &CoreCounters::pages, "requests for topology pages"},
    {"buffered_stores", &CoreCounters::buffered_stores, "entries of store buffers that stores took"},
    {"forwarded_loads", &CoreCounters::forwarded_loads, "machine loads that a store buffer answered"},
    {"blocked_loads", &CoreCounters::blocked_loads,
     "machine loads, and gathers, that waited for stores to leave the buffer"},
    {"folded", &CoreCounters::folded, "address operations left to the loads and stores that use them"},
    {"unfolded", &CoreCounters::unfolded, "of these, issued after all: something else used them"},
    {"assembly_instructions", &CoreCounters::assembly_instructions,
     "instructions beside loads and stores of what went lane by lane or was gathered ([lanes])"},
    {"assembly_references", &CoreCounters::assembly_references,
     "of these, loads and stores of the thread's stack"},
    {"assembly_stores", &CoreCounters::assembly_stores, "of these, stores"},
}};

/// Machine instructions of each kind (pairing.h).
using KindCounts = std::array<std::uint64_t, issue_kinds>;

using Stack = std::array<std::uint64_t, cause_count>;

/// Names of what set_phase and set_kind are given. Work, time and traffic count under a column: a kind and a
/// phase.
struct Labels {
    std::vector<std::string> phases = {}, kinds = {};

    std::size_t columns() const { return phases.size() * kinds.size(); }
    std::size_t kind(std::size_t column) const { return column / phases.size(); }
    std::size_t phase(std::size_t column) const { return column % phases.size(); }
};

struct Work {
    std::uint64_t vops = 0, instructions = 0;
};

/// What sim.jitter did: lines that it may have delayed, and the cycles added.
struct JitterReport {
    std::uint64_t lines = 0, cycles = 0;
};

struct ThreadReport {
    int worker = -1;                    // -1: none ran here
    int tile = 0, core = 0, thread = 0; // cores are numbered through all tiles
    cycle finish = 0;
    std::uint64_t instructions = 0;
    std::vector<Stack> stacks; // by column; sums to the run's cycles
    Stack stack() const;       // of all columns
};

/// What the chip did from one cycle to another.
struct Interval {
    cycle begin = 0, end = 0;
    std::uint64_t vops = 0, instructions = 0, l1_accesses = 0, l1_misses = 0, l2_accesses = 0, l2_misses = 0,
                  memory_reads = 0, memory_writes = 0, network_bytes = 0;
    Stack stack{}; // of all threads
};
inline constexpr std::array<CounterRow<Interval>, 9> interval_counters = {{
    {"vops", &Interval::vops, "vocabulary operations"},
    {"instructions", &Interval::instructions, "machine instructions"},
    {"l1_accesses", &Interval::l1_accesses, "L1 accesses, reads and writes"},
    {"l1_misses", &Interval::l1_misses, "of these, misses"},
    {"l2_accesses", &Interval::l2_accesses, "L2 accesses, reads and writes"},
    {"l2_misses", &Interval::l2_misses, "of these, misses"},
    {"memory_reads", &Interval::memory_reads, "lines read from memory"},
    {"memory_writes", &Interval::memory_writes, "lines written to memory"},
    {"network_bytes", &Interval::network_bytes, "of messages on the network"},
}};

struct Report {
    Config config;
    Labels labels;
    std::vector<std::string> structures;
    int workers = 0;
    cycle warm_up = 0; // cycles before what counts: all that follows is from then on
    cycle cycles = 0;  // until the last worker has returned and its last result is there
    cycle drained = 0; // until memory is quiet as well
    cycle window = 0;  // in which tiles ran by themselves
    CoreCounters core;
    KindCounts by_kind{};   // looks of waiting threads are of none
    std::vector<Work> work; // by column
    std::vector<ThreadReport> threads;
    std::vector<std::vector<std::uint64_t>> port_instructions; // by core and port of core.pairing
    std::vector<std::uint64_t> shared_unit_cycles;             // by unit of core.shared_classes, taken
    std::vector<CacheCounters> l1;                             // by core
    std::vector<CacheCounters> l2, l3, l4, l5;                 // by cache, tile after tile
    std::vector<TlbCounters> tlb;                              // by core; none without TLBs
    std::uint64_t misplaced_lines = 0;  // against inclusive and exclusive levels, before the frame's end
    std::uint64_t incoherent_lines = 0; // that a cache has and the directory, or a cache, does not know of
    CoherenceCounters coherence;        // of plain data, between tiles
    JitterReport jitter;
    NetworkReport network;
    MemoryCounters memory;
    std::vector<MemoryCounters> memory_by_rank; // rank r of channel c at c x ranks + r
    std::vector<TrafficRow> traffic;            // where there was any
    std::vector<TouchedLines> touched;          // lines of the L1s, of the structures but `spill`
    std::vector<TouchedLines> touched_last;     // ... of the last caches
    std::vector<OwnerSum> owners;               // none without RunOptions::owners
    cycle interval = 0;                         // cycles of an interval; 0: none were kept
    std::vector<Interval> intervals; // of the run, the last one from its end until memory was quiet
    std::uint64_t all_vops = 0, all_instructions = 0; // warm-up included
    double host_seconds = 0;                          // apart from everything else in JSON
    double processor_seconds = 0;                     // what the host's processor worked, all its threads
    int host_threads = 1;

    double seconds() const;
    /// From level 0, the L1.
    std::vector<CacheCounters>& caches(unsigned level) {
        const std::array<std::vector<CacheCounters>*, most_levels> all = {&l1, &l2, &l3, &l4, &l5};
        return *all[level];
    }
    const std::vector<CacheCounters>& caches(unsigned level) const {
        return const_cast<Report*>(this)->caches(level);
    }
    CacheCounters cache_total(unsigned level) const;
    TlbCounters tlb_total() const;
    CacheCounters l1_total() const { return cache_total(0); }
    CacheCounters l2_total() const { return cache_total(1); }
    Stack stack() const;                    // of all threads and columns
    std::vector<Stack> core_stacks() const; // of a core's threads, by core
};

/// Throws std::logic_error naming the first law that the numbers break.
void check_laws(const Report& report);
/// For people.
std::string print_text(const Report& report);
/// Two runs of one machine on one input give the same text, apart from the object "host", which comes last.
std::string print_json(const Report& report, bool with_host = true);

} // namespace sim
