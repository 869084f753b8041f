// Random valid machines.
#pragma once

#include "sim/config/config.h"

#include <algorithm>
#include <array>
#include <bit>
#include <random>

namespace sim::test {

/// The queued controller, in either mode.
inline void add_queues(Config& c, std::mt19937& random) {
    auto pick = [&](integer low, integer high) {
        return low + static_cast<integer>(random() % static_cast<std::uint64_t>(high - low + 1));
    };
    MemoryConfig& m = c.memory;
    m.controller = "queued";
    const integer bursts = c.last_cache().line_bytes / (m.bus_bytes * m.burst_length);
    m.read_queue = bursts + pick(0, 40);
    m.write_queue = std::max(m.write_queue, m.write_low + bursts);
    m.scheduler = pick(0, 1) == 0 ? "fr-fcfs" : "fcfs";
    m.age_cap = pick(0, 1) == 0 ? 0 : pick(1, 3000);
    m.page_policy = std::array{"open", "closed", "timeout"}[random() % 3];
    m.page_timeout = pick(1, 500);
    m.refresh_postponed = pick(0, 8);
    if (const integer turns = m.ranks * m.bank_groups * m.banks;
        pick(0, 1) == 0 && m.tREFI >= std::max<integer>(40 * turns, 2000)) {
        m.refresh = "per-bank";
        m.refresh_postponed = 0;
    }
    if (pick(0, 1) == 0) {
        c.sim.mode = "reference";
        c.sim.quantum = c.sim.window = 0;
    }
}

inline void add_tlbs(Config& c, std::mt19937& random) {
    auto pick = [&](integer low, integer high) {
        return low + static_cast<integer>(random() % static_cast<std::uint64_t>(high - low + 1));
    };
    TlbConfig& t = c.tlb;
    t.ways = pick(0, 4);
    t.entries = t.ways == 0 ? pick(1, 20) : t.ways << pick(0, 3);
    t.page_bytes = integer{4096} << pick(0, 9);
    t.second_ways = pick(0, 4);
    t.second_entries = pick(0, 1) == 0 ? 0 : t.second_ways == 0 ? pick(1, 40) : t.second_ways << pick(0, 4);
    t.second_latency = pick(0, 20);
    t.second_share = pick(0, 1) == 0 ? "core" : "tile";
    t.misses = pick(0, 1) == 0 ? "stall" : "overlap";
    t.walk = pick(0, 1) == 0 ? "tables" : "fixed";
    t.walk_cycles = pick(0, 300);
    t.walk_cache = pick(0, 6);
    t.walkers = pick(1, 3);
    t.address_bits = pick(40, 57);
}

/// Coherence of plain data, with what it needs.
inline void add_coherence(Config& c, std::mt19937& random) {
    const bool snoops = c.network.bus() && random() % 4 != 0;
    c.coherence.plain = snoops ? "snoop" : "directory";
    c.coherence.directory_cycles = c.coherence.snoop_cycles = 1 + static_cast<integer>(random() % 40);
    c.coherence.directory_ways = 1 + static_cast<integer>(random() % 8);
    c.coherence.directory_entries =
        static_cast<integer>(random() % 3 * (random() % 40)) * c.coherence.directory_ways;
    const std::array<CacheConfig*, 5> all = {&c.l1, &c.l2, &c.l3, &c.l4, &c.l5};
    const unsigned levels = c.tile_levels();
    for (unsigned level = 1; level < levels; ++level) {
        all[level]->inclusion = "inclusive";
        all[level]->prefetcher = "none";
    }
    all[levels - 1]->write_policy = "back";
    all[levels - 1]->write_miss = "allocate";
    if (random() % 2 == 0) { // so small that lines leave in between
        c.l1.size_bytes = c.l1.line_bytes * c.l1.ways;
        c.l2.size_bytes = c.l2.line_bytes * c.l2.ways;
    }
}

inline Config random_machine(std::mt19937& random) {
    auto pick = [&](integer low, integer high) {
        return low + static_cast<integer>(random() % static_cast<std::uint64_t>(high - low + 1));
    };
    auto power = [&](integer low, integer high) { return integer{1} << pick(low, high); };
    Config c;
    c.chip.clock_ps = pick(100, 3000);
    c.chip.cores = pick(1, 6);
    c.chip.threads = pick(1, 4);
    c.core.issue_width = pick(1, 6);
    c.core.lanes = power(0, 6);
    c.core.window = pick(0, 1) == 0 ? 1 : pick(2, 200);
    c.core.vector_registers = pick(0, 8);
    c.core.broadcasts = pick(0, 1) == 0 ? "value" : "register";
    c.core.interleaved_values = c.core.broadcasts == "value" ? 0 : pick(0, 6);
    c.core.memory_operands = pick(0, 3);
    c.core.scalar_overhead = static_cast<double>(pick(0, 30)) / 10;
    c.core.scalar_moves = pick(0, 1) == 0 ? 0 : static_cast<double>(pick(1, 30)) / 10;
    c.core.vector_moves = pick(0, 1) == 0 ? 0 : static_cast<double>(pick(1, 10)) / 10;
    c.core.predictor =
        std::array{"counters", "bimodal", "gshare", "taken", "not_taken", "none", "perfect"}[random() % 7];
    c.core.predictor_history = pick(0, 6);
    c.core.predictor_entries = power(6, 10);
    c.core.address_folding = pick(0, 1) == 0 ? "off" : "on";
    c.core.store_buffer = pick(0, 1) == 0 ? 0 : pick(1, 40);
    c.core.skip_idle = pick(0, 1) == 0 ? "off" : "on";
    c.core.pairing =
        std::array{"any", "any", "any | scalar.integer load store branch",
                   "vector.multiply vector.divide scalar | vector scalar | scalar branch | load | "
                   "store"}[random() % 4];
    c.core.shared_classes =
        std::array{"none", "add multiply fused divide square_root", "integer"}[random() % 3];
    c.core.shared_cores = c.chip.cores % 2 == 0 ? pick(1, 2) : 1;
    c.core.switch_policy = pick(0, 3) == 0 ? "stall" : "fine";
    c.core.switch_cycles = pick(0, 8);
    c.core.gather = pick(0, 1) == 0 ? "line" : "lane";
    c.lanes.masked = c.core.gather == "lane" && pick(0, 1) == 0 ? "on" : "off";
    c.lanes.scatter = pick(0, 1) == 0 ? "on" : "off";
    c.lanes.shuffle = pick(0, 2) == 0 ? "on" : "off";
    c.lanes.idle = pick(0, 1) == 0 ? "test" : "skip";
    c.lanes.gather_instructions = pick(0, 2) == 0 ? pick(1, 8) : 0;
    c.lanes.piece_instructions = pick(0, 5);
    c.lanes.piece_references = pick(0, c.lanes.piece_instructions);
    c.lanes.load_instructions = pick(0, 12);
    c.lanes.load_references = pick(0, c.lanes.load_instructions);
    c.lanes.store_instructions = pick(0, 12);
    c.lanes.store_references = pick(0, c.lanes.store_instructions);
    for (auto& i : c.instructions)
        i = pick(0, 3) == 0 ? pick(1, 15) : 1;
    for (auto& l : c.latency)
        l = pick(0, 12);
    for (auto& i : c.interval)
        i = pick(0, 2) == 0 ? pick(1, 9) : 1;
    c.l1.line_bytes = power(4, 7);
    c.l1.ways = pick(1, 8);
    c.l1.size_bytes = c.l1.line_bytes * c.l1.ways * power(0, 6);
    c.l1.ports = pick(1, 3);
    c.l1.port_bytes = power(2, 7);
    c.l1.mshrs = pick(1, 12);
    c.l1.write_back_buffer = pick(1, 6);
    auto replacement = [&](integer ways) {
        return std::array{"lru", "srrip", "random",
                          std::has_single_bit(static_cast<std::uint64_t>(ways)) ? "plru"
                                                                                : "lru"}[random() % 4];
    };
    auto policies = [&](CacheConfig& cache) {
        cache.replacement = replacement(cache.ways);
        cache.write_policy = pick(0, 1) == 0 ? "back" : "through";
        cache.write_miss = pick(0, 1) == 0 ? "allocate" : "around";
        cache.prefetcher = std::array{"none", "next", "stride"}[random() % 3];
        cache.prefetch_degree = pick(1, 5);
        cache.prefetch_sites = pick(1, 9);
    };
    policies(c.l1);
    c.l2.line_bytes = c.l1.line_bytes * power(0, 2);
    c.l2.ways = pick(1, 16);
    policies(c.l2);
    c.sim.miss_causes = pick(0, 1) == 0 ? "on" : "off";
    c.l2.size_bytes = c.l2.line_bytes * c.l2.ways * power(0, 9);
    c.l2.banks = power(0, 4);
    c.l2.bank_bytes = power(0, 7);
    c.l2.mshrs = pick(1, 32);
    c.l2.write_back_buffer = pick(1, 8);
    c.chip.tiles = pick(0, 2) == 0 ? pick(4, 9) : pick(1, 3);
    if (pick(0, 2) == 0 && c.chip.cores % 2 == 0)
        c.l2.share = pick(0, 1) == 0 ? "core" : "2";
    unsigned levels = 2;
    for (CacheConfig* level : {&c.l3, &c.l4, &c.l5}) {
        if (pick(0, 1) == 0)
            break;
        const CacheConfig& above = c.cache(levels - 1);
        ++levels;
        level->line_bytes = std::min<integer>(1024, above.line_bytes * power(0, 1));
        level->ways = pick(1, 16);
        policies(*level);
        level->size_bytes = level->line_bytes * level->ways * power(0, 9);
        level->latency = pick(10, 60);
        level->banks = power(0, 4);
        level->bank_bytes = power(0, 7);
        level->mshrs = pick(1, 32);
        level->write_back_buffer = pick(1, 8);
        level->share = "tile";
        level->inclusion = std::array{"none", "inclusive"}[random() % 2];
    }
    if (CacheConfig* last = std::array{&c.l2, &c.l3, &c.l4, &c.l5}[levels - 2];
        levels > 2 && pick(0, 1) == 0) {
        last->share = "chip";
        last->prefetcher = pick(0, 1) == 0 ? "none" : "next";
    }
    c.l2.inclusion = std::array{"none", "inclusive"}[random() % 2];
    if (pick(0, 3) == 0) { // each evicts into the next
        c.l1.write_policy = c.l2.write_policy = "back";
        c.l1.write_miss = c.l2.write_miss = "allocate";
        c.l2.prefetcher = "none";
        c.l2.inclusion = "exclusive";
        c.l2.size_bytes = c.l2.size_bytes / c.l2.line_bytes * c.l1.line_bytes;
        c.l2.line_bytes = c.l1.line_bytes;
    }
    for (unsigned level = 1, upper = 1; level < c.tile_levels(); ++level)
        if (c.cache(level).inclusion == "inclusive")
            for (; upper <= level; ++upper)
                std::array<CacheConfig*, 5>{&c.l1, &c.l2, &c.l3, &c.l4, &c.l5}[upper]->prefetcher = "none";
    const integer line_bytes = c.last_cache().line_bytes;
    c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh", "bus"}[random() % 5];
    c.network.buses = c.network.bus() && c.chip.tiles % 2 == 0 ? pick(1, 2) : 1;
    c.network.link_bytes = pick(1, 100);
    c.network.hop_cycles = pick(0, 20);
    c.network.request_bytes = pick(1, 40);
    c.network.reply_bytes = pick(0, 40);
    c.network.write_bytes = pick(0, 40);
    c.memory.clock_ps = pick(200, 3000);
    c.memory.channels = power(0, 3);
    c.memory.ranks = power(0, 2);
    c.memory.bank_groups = power(0, 2);
    c.memory.banks = power(0, 3);
    c.memory.row_bytes = std::max(line_bytes, power(9, 13));
    c.memory.bus_bytes = power(0, 3);
    c.memory.burst_length = power(1, 3);
    while (c.memory.bus_bytes * c.memory.burst_length > line_bytes)
        c.memory.burst_length /= 2;
    if (c.memory.burst_length < 2)
        c.memory.bus_bytes = 2, c.memory.burst_length = 2;
    c.memory.tREFI = pick(0, 1) == 0 ? 0 : c.memory.ranks * pick(1000, 9000);
    c.memory.tRFC = pick(1, 300);
    c.memory.tFAW = pick(1, 60);
    c.memory.tRTRS = pick(0, 4);
    c.memory.page_policy = pick(0, 1) == 0 ? "open" : "closed";
    c.memory.bank_xor = pick(0, 1) == 0 ? "on" : "off";
    c.memory.command_buses = pick(1, 2);
    c.memory.write_queue = pick(1, 40);
    c.memory.write_high = pick(1, c.memory.write_queue);
    c.memory.write_low = pick(0, c.memory.write_high - 1);
    c.sim.quantum = std::array<integer, 5>{0, 1, 10, 100, 5000}[random() % 5];
    c.sim.window = pick(0, 2) == 0 ? power(0, 12) : 0;
    c.core.spin_period = pick(4, 300);
    c.coherence.visibility_cycles = power(0, 14);
    c.coherence.atomic_cycles = pick(0, 1000);
    c.coherence.remote_cycles = pick(0, 5000);
    if (pick(0, 1) == 0)
        add_coherence(c, random);
    if (pick(0, 1) == 0)
        add_queues(c, random);
    if (pick(0, 1) == 0)
        add_tlbs(c, random);
    return c;
}

} // namespace sim::test
