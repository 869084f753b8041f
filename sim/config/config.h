// A machine, as its file describes it: plain values, in the units that the parameter table
// (parameter_table.cpp) states.
#pragma once

#include "isa/simulated/port.h"

#include <array>
#include <cstdint>
#include <string>

namespace sim {

using integer = std::int64_t;

/// Of a number that is none below zero.
inline std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}
/// Of a count, for a model or a figure.
constexpr double real(auto count) {
    return static_cast<double>(count);
}

struct ChipConfig {
    integer clock_ps = 0, tiles = 0, cores = 0, threads = 0; // cores of a tile, threads of a core
    std::string placement;
};

struct CoreConfig {
    integer issue_width = 0, lanes = 0, window = 0;
    std::string pairing, shared_classes;
    integer shared_cores = 0;
    integer vector_registers = 0, interleaved_values = 0, spill_slots = 0, memory_operands = 0;
    double scalar_overhead = 0, scalar_moves = 0, vector_moves = 0;
    std::string predictor;
    integer predictor_history = 0, predictor_entries = 0, mispredict_cycles = 0;
    std::string switch_policy;
    integer switch_cycles = 0;
    std::string broadcasts, gather, skip_idle, address_folding;
    integer store_buffer = 0;
    integer spin_period = 0;
};

/// Memory operations that go lane by lane, and what that takes beside their loads and stores.
struct LanesConfig {
    std::string masked, scatter, shuffle, idle;
    integer piece_instructions = 0, piece_references = 0, gather_instructions = 0;
    integer load_instructions = 0, load_references = 0;
    integer store_instructions = 0, store_references = 0;
};

/// Per operation class, indexed by isa::timing::operation; the last entry is the branch.
inline constexpr int class_count = isa::timing::operation_kinds + 1;
inline constexpr int branch_class = isa::timing::operation_kinds;
/// It and the branch have no vectors.
inline constexpr int address_class = static_cast<int>(isa::timing::operation::address);
extern const std::array<const char*, class_count> class_names;

inline constexpr unsigned most_levels = 5; // of caches
struct CacheConfig {
    integer size_bytes = 0, ways = 0, line_bytes = 0, latency = 0, mshrs = 0, write_back_buffer = 0;
    integer banks = 0, bank_bytes = 0; // but of an L1
    std::string share, inclusion;      // likewise
    std::string replacement, write_policy, write_miss, prefetcher;
    integer prefetch_degree = 0, prefetch_sites = 0;
};
struct L1Config : CacheConfig {
    integer ports = 0, port_bytes = 0;
};

/// Translation of addresses. Without entries: none.
struct TlbConfig {
    integer entries = 0, ways = 0, page_bytes = 0;
    integer second_entries = 0, second_ways = 0, second_latency = 0;
    std::string second_share, misses, walk;
    integer walk_cycles = 0, walk_cache = 0, walkers = 0, address_bits = 0;

    bool any() const { return entries != 0; }
    /// Whether walks read tables in memory.
    bool tables() const { return any() && walk == "tables"; }
    /// Levels of these tables.
    integer table_levels() const;
};

struct CoherenceConfig {
    std::string plain;
    integer directory_cycles = 0, directory_entries = 0, directory_ways = 0, snoop_cycles = 0;
    integer visibility_cycles = 0, atomic_cycles = 0, remote_cycles = 0;
    /// Whether plain data are kept coherent.
    bool kept() const { return plain != "none"; }
    bool snoops() const { return plain == "snoop"; }
};

struct MemoryConfig {
    std::string preset, controller;
    integer clock_ps = 0, channels = 0, ranks = 0, bank_groups = 0, banks = 0, rows = 0, row_bytes = 0;
    integer bus_bytes = 0, burst_length = 0, transfers_per_clock = 0, command_buses = 0;
    integer tRCD = 0, tRP = 0, tRAS = 0, tRC = 0, tCL = 0, tCWL = 0, tCCD_S = 0, tCCD_L = 0, tRRD_S = 0;
    integer tRRD_L = 0, tFAW = 0, tRTP = 0, tWR = 0, tWTR_S = 0, tWTR_L = 0, tRTW = 0, tRTRS = 0;
    integer tREFI = 0, tRFC = 0, tRFCpb = 0, tRREFD = 0, refresh_postponed = 0;
    integer read_queue = 0, write_queue = 0, write_high = 0, write_low = 0, age_cap = 0, page_timeout = 0;
    integer controller_cycles = 0;
    std::string scheduler, refresh, page_policy, mapping, bank_xor;
    double activate_pj = 0, read_pj = 0, write_pj = 0, refresh_pj = 0, background_mw = 0;

    /// Of the data bus, for one burst.
    integer burst_clocks() const { return burst_length / transfers_per_clock; }
};

/// Between the tiles and what lies beyond them.
struct NetworkConfig {
    std::string topology;
    integer link_bytes = 0, hop_cycles = 0, columns = 0, buses = 0;
    integer request_bytes = 0, reply_bytes = 0, write_bytes = 0; // besides the line

    bool ideal() const { return topology == "ideal"; }
    bool bus() const { return topology == "bus"; }
};

/// How the renderer uses the machine.
struct KdTreeConfig {
    std::string share;
};
struct RendererConfig {
    std::string discard;
};

/// Energies of events, in pJ, and powers that flow whatever happens, in mW; those of memory are with it.
struct EnergyConfig {
    double instruction_pj = 0;
    double logic_pj = 0, add_pj = 0, multiply_pj = 0, fused_pj = 0, divide_pj = 0; // of a lane
    double l1_access_pj = 0, l1_line_pj = 0, l2_line_pj = 0;
    double network_pj = 0; // of a byte and hop
    double directory_pj = 0, snoop_pj = 0;
    double core_mw = 0, tile_mw = 0;
};

struct SimulationConfig {
    std::string mode, miss_causes, frame_end;
    integer quantum = 0, window = 0, jitter = 0, stack_kib = 0;
};

struct Config {
    ChipConfig chip;
    CoreConfig core;
    LanesConfig lanes;
    std::array<integer, class_count> latency{}, interval{}, instructions{};
    L1Config l1;
    CacheConfig l2, l3, l4, l5; // without bytes: no such level
    TlbConfig tlb;
    CoherenceConfig coherence;
    NetworkConfig network;
    MemoryConfig memory;
    KdTreeConfig kdtree;
    RendererConfig renderer;
    EnergyConfig energy;
    SimulationConfig sim;

    /// Every parameter at its default.
    Config();

    integer all_cores() const { return chip.tiles * chip.cores; }
    integer all_threads() const { return all_cores() * chip.threads; }

    /// Levels count from 0, the L1.
    const CacheConfig& cache(unsigned level) const {
        const std::array<const CacheConfig*, most_levels> all = {&l1, &l2, &l3, &l4, &l5};
        return *all[level];
    }
    unsigned cache_levels() const;
    /// Its lines are those of the memory.
    const CacheConfig& last_cache() const { return cache(cache_levels() - 1); }
    /// Cores that share a cache of the level.
    integer cores_sharing(unsigned level) const;
    /// Cores that share a second TLB.
    integer cores_sharing_tlb() const;
    /// Whether the level lies beyond the tiles: only the last one may.
    bool beyond_tiles(unsigned level) const;
    /// Levels that lie within a tile.
    unsigned tile_levels() const { return cache_levels() - (beyond_tiles(cache_levels() - 1) ? 1 : 0); }
};

/// Throws ConfigError where parameters do not fit each other; `what` names the machine in the message.
void check_consistency(const Config& config, const std::string& what);

} // namespace sim
