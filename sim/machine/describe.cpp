#include "sim/machine/describe.h"

#include "sim/core/pairing.h"
#include "sim/machine/windows.h"
#include "sim/network/topology.h"

#include <fmt/core.h>

#include <algorithm>

namespace sim {
namespace {

double real(integer x) {
    return static_cast<double>(x);
}

std::string rate(double per_second, const char* what) {
    const double giga = per_second * 1e-9;
    return giga < 1e4 ? fmt::format("{:.4g} {}", giga, what) : fmt::format("{:.0f} {}", giga, what);
}

/// What TLBs reach, and what a miss takes.
std::string tlb_text(const Config& c) {
    const auto of = [&c](integer entries, integer ways) {
        return fmt::format("{} pages of {}, {}: {}", entries, size_text(real(c.tlb.page_bytes)),
                           ways == 0 || ways == entries ? std::string("fully associative")
                                                        : fmt::format("{} ways", ways),
                           size_text(real(entries * c.tlb.page_bytes)));
    };
    std::string out = fmt::format("{} a core", of(c.tlb.entries, c.tlb.ways));
    if (c.tlb.second_entries != 0)
        out += fmt::format("; behind it {} for {} core{}, {:.3g} ns",
                           of(c.tlb.second_entries, c.tlb.second_ways), c.cores_sharing_tlb(),
                           c.cores_sharing_tlb() == 1 ? "" : "s",
                           real(c.tlb.second_latency * c.chip.clock_ps) * 1e-3);
    const double cycle_ns = real(c.chip.clock_ps) * 1e-3;
    if (!c.tlb.tables())
        return out + fmt::format("; a walk takes {:.3g} ns", real(c.tlb.walk_cycles) * cycle_ns);
    const integer levels = c.tlb.table_levels(), least = c.tlb.walk_cache == 0 ? levels : 1;
    const std::string reads = least == levels ? fmt::format("{}", levels) : fmt::format("1 to {}", levels);
    return out + fmt::format("; a walk reads {} entries of tables, at the least {:.3g} ns", reads,
                             real(least * c.l1.latency) * cycle_ns);
}

} // namespace

std::string size_text(double bytes) {
    const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    std::size_t unit = 0;
    for (; bytes >= 1024 && unit + 1 < std::size(units); ++unit)
        bytes /= 1024;
    return fmt::format("{:.4g} {}", bytes, units[unit]);
}

ChipFigures chip_figures(const Config& c) {
    ChipFigures f;
    const double cycle_ns = real(c.chip.clock_ps) * 1e-3;
    const double cycles_per_second = 1e9 / cycle_ns;
    const double cores = real(c.all_cores());
    f.instructions_per_second = cores * real(c.core.issue_width) * cycles_per_second;
    const auto fused = static_cast<std::size_t>(isa::timing::operation::fused);
    // A class whose unit is not pipelined has one unit; others have as many as ports take them.
    const Pairing pairing(c.core.pairing);
    const auto ports = static_cast<integer>(pairing.of(vector_kind(fused)).size());
    const integer slots = pairing.ports() == 0 ? c.core.issue_width : std::min(c.core.issue_width, ports);
    double fused_a_cycle = c.interval[fused] > 1 ? 1 / real(c.interval[fused]) : real(slots);
    if (shared_classes(c.core.shared_classes)[fused])
        fused_a_cycle = std::min(fused_a_cycle, 1 / real(c.interval[fused] * c.core.shared_cores));
    f.flops_per_second = cores * fused_a_cycle * 2 * real(c.core.lanes) * cycles_per_second;
    f.l1_bytes = cores * real(c.l1.size_bytes);
    f.l1_bytes_per_second = cores * real(c.l1.ports * c.l1.port_bytes) * cycles_per_second;
    f.memory_bytes_per_second = real(c.memory.channels * c.memory.bus_bytes * c.memory.transfers_per_clock) *
                                1e12 / real(c.memory.clock_ps);
    f.l1_ns = real(c.l1.latency) * cycle_ns;
    f.network = network_figures(c);
    double ns = f.l1_ns;
    for (unsigned level = 1; level < c.cache_levels(); ++level) {
        const CacheConfig& cache = c.cache(level);
        const integer line = c.cache(level - 1).line_bytes, caches = c.all_cores() / c.cores_sharing(level);
        const integer bank_cycles = (line + cache.bank_bytes - 1) / cache.bank_bytes;
        ns += (real(cache.latency) + (c.beyond_tiles(level) ? f.network.cycles : 0)) * cycle_ns;
        f.below.push_back({real(caches * cache.size_bytes),
                           real(caches * cache.banks * line) / real(bank_cycles) * cycles_per_second, ns,
                           caches});
    }
    f.l2_bytes = f.below.front().bytes;
    f.l2_bytes_per_second = f.below.front().bytes_per_second;
    f.l2_ns = f.below.front().ns;
    const integer bursts =
        std::max<integer>(1, c.last_cache().line_bytes / (c.memory.bus_bytes * c.memory.burst_length));
    const integer data = c.memory.tCL + bursts * c.memory.burst_clocks();
    const bool beyond = c.beyond_tiles(c.cache_levels() - 1);
    const double over = beyond ? f.network.memory_cycles : f.network.cycles;
    const double there = ns + (over + real(c.memory.controller_cycles)) * cycle_ns;
    f.memory_open_ns = there + real(data * c.memory.clock_ps) * 1e-3;
    f.memory_closed_ns = there + real((c.memory.tRCD + data) * c.memory.clock_ps) * 1e-3;
    f.miss_bytes_per_second = real(f.below.back().caches * c.last_cache().mshrs * c.last_cache().line_bytes) /
                              ((f.memory_closed_ns - ns) * 1e-9);
    return f;
}

std::string chip_text(const Config& c) {
    const ChipFigures f = chip_figures(c);
    std::string out;
    const auto line = [&out](const char* what, const std::string& text) {
        out += fmt::format("{:<23}{}\n", what, text);
    };
    line("chip", fmt::format("{} tile{} of {} core{} of {} thread{}: {} cores, {} threads at {:.4g} GHz",
                             c.chip.tiles, c.chip.tiles == 1 ? "" : "s", c.chip.cores,
                             c.chip.cores == 1 ? "" : "s", c.chip.threads, c.chip.threads == 1 ? "" : "s",
                             c.all_cores(), c.all_threads(), 1e3 / real(c.chip.clock_ps)));
    line("a core", fmt::format("{} instruction{} a cycle ({}), {} lanes, issue window {}, {} predictor",
                               c.core.issue_width, c.core.issue_width == 1 ? "" : "s", c.core.pairing,
                               c.core.lanes, c.core.window, c.core.predictor));
    line("instructions", rate(f.instructions_per_second, "G/s at most"));
    line("arithmetic", rate(f.flops_per_second, "GFLOP/s at most, fused"));
    line("L1", fmt::format("{} a core, {} ways, lines of {} bytes; {} in all; {}; {:.3g} ns",
                           size_text(real(c.l1.size_bytes)), c.l1.ways, c.l1.line_bytes,
                           size_text(f.l1_bytes), rate(f.l1_bytes_per_second, "GB/s"), f.l1_ns));
    for (unsigned level = 1; level < c.cache_levels(); ++level) {
        const CacheConfig& cache = c.cache(level);
        const ChipFigures::Level& l = f.below[level - 1];
        const integer cores = c.cores_sharing(level);
        const std::string whose = cores == 1               ? "a core"
                                  : cores == c.chip.cores  ? "a tile"
                                  : cores == c.all_cores() ? "for all"
                                                           : fmt::format("for {} cores", cores);
        line(fmt::format("L{}", level + 1).c_str(),
             fmt::format("{} {}, {} ways, lines of {} bytes{}; {} in all; {}; {:.3g} ns",
                         size_text(real(cache.size_bytes)), whose, cache.ways, cache.line_bytes,
                         cache.inclusion == "none" ? "" : ", " + cache.inclusion, size_text(l.bytes),
                         rate(l.bytes_per_second, "GB/s"), l.ns));
    }
    if (c.tlb.any())
        line("TLB", tlb_text(c));
    if (!c.network.ideal()) {
        const Topology t(c);
        line("network",
             fmt::format(
                 "{}{} of {} bytes a cycle, {} cycles a hop; {} a link, {} across the middle, one way; a "
                 "tile is {:.3g} hops from what answers it: {:.3g} ns there and back with a line",
                 c.network.bus() && t.buses() > 1 ? fmt::format("{} buses", t.buses()) : c.network.topology,
                 c.network.topology == "mesh" ? fmt::format(", {} x {},", t.columns(), t.rows()) : "",
                 c.network.link_bytes, c.network.hop_cycles, rate(f.network.link_bytes_per_second, "GB/s"),
                 rate(f.network.bisection_bytes_per_second, "GB/s"), f.network.hops,
                 f.network.cycles * real(c.chip.clock_ps) * 1e-3));
    }
    line("memory",
         fmt::format(
             "{} ({} channels of {} bytes at {:.4g} MT/s, {} rank{} each); {}; a read {:.3g} ns from an open "
             "row, {:.3g} ns from none",
             c.memory.preset, c.memory.channels, c.memory.bus_bytes,
             1e6 * real(c.memory.transfers_per_clock) / real(c.memory.clock_ps), c.memory.ranks,
             c.memory.ranks == 1 ? "" : "s", rate(f.memory_bytes_per_second, "GB/s"), f.memory_open_ns,
             f.memory_closed_ns));
    line("misses under way",
         fmt::format("{} lines: {} from closed rows, {:.3g} of what memory moves",
                     f.below.back().caches * c.last_cache().mshrs, rate(f.miss_bytes_per_second, "GB/s"),
                     f.miss_bytes_per_second / f.memory_bytes_per_second));
    line("balance",
         fmt::format("{:.3g} bytes of memory, {:.3g} of L2 and {:.3g} of L1 a FLOP",
                     f.memory_bytes_per_second / f.flops_per_second,
                     f.l2_bytes_per_second / f.flops_per_second, f.l1_bytes_per_second / f.flops_per_second));
    line("simulated", fmt::format("in windows of {} cycles; threads of a tile run ahead by {} at most",
                                  window_cycles(c), c.sim.quantum));
    return out;
}

} // namespace sim
