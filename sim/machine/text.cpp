// The report for people.
#include "sim/machine/derived.h"
#include "sim/machine/energy.h"
#include "sim/machine/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>

namespace sim {
namespace {

void overview(std::string& out, const Report& r) {
    auto cores = static_cast<std::uint64_t>(r.config.all_cores());
    out += fmt::format("cycles                {:>14}   ({:.6f} s at {:.3f} GHz)\n", r.cycles, r.seconds(),
                       1e3 / static_cast<double>(r.config.chip.clock_ps));
    if (r.warm_up != 0)
        out += fmt::format(
            "warm-up               {:>14}   cycles before these, in no figure but the host's\n", r.warm_up);
    out += fmt::format("mode                  {:>14}   memory {}\n", r.config.sim.mode,
                       r.config.memory.controller == "queued" ? "has queues and decides in order of time"
                                                              : "answers each request when it comes");
    out += fmt::format("workers               {:>14}   on {} tiles x {} cores x {} threads\n", r.workers,
                       r.config.chip.tiles, r.config.chip.cores, r.config.chip.threads);
    out += fmt::format("order of threads      {:>14}   {}\n",
                       std::min(static_cast<std::uint64_t>(r.config.sim.quantum), r.window),
                       r.config.sim.quantum <= 1
                           ? "exact, operation by operation within a tile"
                           : "cycles by which those of a tile may run ahead of each other");
    out +=
        fmt::format("windows               {:>14}   cycles, after which tiles and memory meet\n", r.window);
    if (r.config.sim.jitter != 0)
        out += fmt::format(
            "jitter                {:>14}   is the seed: 0 or 1 cycle more for {} lines that L1s asked "
            "for, {} in all\n",
            r.config.sim.jitter, r.jitter.lines, r.jitter.cycles);
    out += fmt::format("instructions          {:>14}   {:.3f} a cycle and core\n", r.core.instructions,
                       ratio(r.core.instructions, r.cycles * cores));
    for (const auto& row : core_counters)
        if (r.core.*row.count != 0 && row.count != &CoreCounters::instructions)
            out += fmt::format("{:<21} {:>14}\n", row.name, r.core.*row.count);
    out += r.config.coherence.snoops() ? "plain data are kept coherent as caches see requests on buses, "
                                         "shared words by invalidation as well\n"
           : r.config.coherence.kept()
               ? "plain data are kept coherent by a directory, shared words by invalidation as well\n"
               : "coherence of plain data is not modelled; shared words are kept coherent by invalidation\n";
}

/// A row for each of few cores or threads, or the least, median and most of many, in per cent of their
/// cycles.
void stacks_of(std::string& out, const char* what, const std::vector<Stack>& stacks, std::uint64_t cycles) {
    constexpr std::size_t few = 16;
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < cause_count; ++i)
        if (std::any_of(stacks.begin(), stacks.end(), [i](const Stack& s) { return s[i] != 0; }))
            used.push_back(i);
    out += fmt::format("\n% of cycles by {:<7}", what);
    for (std::size_t i : used)
        out += fmt::format(" {:>11}", causes[i].name);
    out += '\n';
    auto row = [&](const std::string& name, auto value) {
        out += fmt::format("  {:<20}", name);
        for (std::size_t i : used)
            out += fmt::format(" {:>11.1f}", 100 * ratio(value(i), cycles));
        out += '\n';
    };
    if (stacks.size() <= few) {
        for (std::size_t n = 0; n < stacks.size(); ++n)
            row(fmt::format("{} {}", what, n), [&](std::size_t i) { return stacks[n][i]; });
        return;
    }
    std::vector<std::vector<std::uint64_t>> sorted(cause_count);
    for (std::size_t i : used) {
        for (const Stack& s : stacks)
            sorted[i].push_back(s[i]);
        std::sort(sorted[i].begin(), sorted[i].end());
    }
    const std::array<std::pair<const char*, std::size_t>, 3> places = {
        {{"least", 0}, {"median", stacks.size() / 2}, {"most", stacks.size() - 1}}};
    for (const auto& p : places)
        row(fmt::format("{} of {}", p.first, stacks.size()),
            [&](std::size_t i) { return sorted[i][p.second]; });
}

void stack(std::string& out, const Report& r) {
    Stack s = r.stack();
    std::uint64_t all = r.cycles * r.threads.size();
    out += "\nwhere the threads' cycles went\n";
    for (std::size_t i = 0; i < cause_count; ++i)
        if (s[i] != 0)
            out += fmt::format("  {:<12} {:>14} {:>6.1f} %   {}\n", causes[i].name, s[i],
                               100 * ratio(s[i], all), causes[i].meaning);
    std::vector<Stack> threads;
    for (const ThreadReport& t : r.threads)
        threads.push_back(t.stack());
    stacks_of(out, "core", r.core_stacks(), r.cycles * static_cast<std::uint64_t>(r.config.chip.threads));
    stacks_of(out, "thread", threads, r.cycles);
}

void level(std::string& out, const char* name, const CacheCounters& c) {
    out += fmt::format("  {:<8} {:>12} {:>12} {:>12} {:>12} {:>8.2f} % {:>12}\n", name, c.reads, c.writes,
                       c.hits, c.misses, 100 * ratio(c.misses, c.reads + c.writes), c.write_backs);
    if (c.compulsory + c.capacity + c.conflict + c.coherence != 0)
        out += fmt::format("           misses: {} compulsory, {} capacity, {} conflict, {} coherence\n",
                           c.compulsory, c.capacity, c.conflict, c.coherence);
    if (c.written_through != 0)
        out += fmt::format("           written through: {}, of which {} missed and brought no line\n",
                           c.written_through, c.written_around);
    if (c.back_invalidations + c.clean_victims + c.moved_up != 0)
        out +=
            fmt::format("           {} back-invalidations, {} clean victims sent down, {} lines moved up\n",
                        c.back_invalidations, c.clean_victims, c.moved_up);
    if (c.upgrades + c.downgrades != 0)
        out += fmt::format("           {} rights to write asked for, {} changed lines sent down for others "
                           "to read, {} lines lost to others\n",
                           c.upgrades, c.downgrades, c.invalidations);
    if (c.hardware_prefetches + c.prefetches_dropped != 0)
        out +=
            fmt::format("           hardware prefetches: {}, of which {} useful ({} late), {} useless\n",
                        c.hardware_prefetches, c.prefetches_useful, c.prefetches_late, c.prefetches_useless);
}

void memory(std::string& out, const Report& r) {
    const MemoryCounters& m = r.memory;
    out += fmt::format("memory   {:>12} {:>12}  lines of {} bytes, {}\n", m.reads, m.writes,
                       r.config.last_cache().line_bytes, r.config.memory.preset);
    out += fmt::format(
        "         bursts: {} rows open, {} empty, {} in conflict; {} from the write queue, {} merged\n",
        m.row_hits, m.row_empties, m.row_conflicts, m.forwarded, m.merged);
    double ns = static_cast<double>(r.config.memory.clock_ps) * 1e-3;
    out += fmt::format("         read bursts: {:.1f} ns in the memory, of which {:.1f} ns queued\n",
                       ns * ratio(m.read_clocks, m.read_bursts), ns * ratio(m.queue_clocks, m.read_bursts));
    out += fmt::format("         {} write batches, {} turnarounds, {} rank switches, {} refreshes\n",
                       m.batches, m.turnarounds, m.rank_switches, m.refreshes);
}

/// Nothing where there is none.
void tlb(std::string& out, const Report& r) {
    if (r.tlb.empty())
        return;
    const TlbCounters t = r.tlb_total();
    out +=
        fmt::format("TLB      {} pages looked up, {} missed ({:.3f} %): {} in the second, {} in walks of "
                    "others, {} walked\n",
                    t.lookups, t.misses, 100 * ratio(t.misses, t.lookups), t.second_hits, t.merged, t.walks);
    out += fmt::format("         a miss waits {:.1f} cycles; a walk takes {:.1f} and reads {:.2f} entries\n",
                       ratio(t.wait_cycles, t.misses), ratio(t.walk_cycles, t.walks),
                       ratio(t.walk_reads, t.walks));
}

/// Nothing where there is none.
void coherence(std::string& out, const Report& r) {
    if (!r.config.coherence.kept())
        return;
    const CoherenceCounters& d = r.coherence;
    out += fmt::format(
        "coherence {} reads ({} exclusive, {} shared), {} writes, {} upgrades ({} had lost the line; {} "
        "more got the right with it)\n",
        d.reads, d.exclusive, d.shared, d.writes, d.upgrades, d.lost_upgrades, d.silent_upgrades);
    out += fmt::format("         forwards: {} lines brought changed, {} unchanged, {} not there any more; {} "
                       "written back\n",
                       d.forwards_dirty, d.forwards_clean, d.forwards_stale, d.written_back);
    out += fmt::format("         invalidations: {} sent, {} to caches that had the line, {} to others\n",
                       d.invalidations, d.invalidations_received, d.invalidations_stale);
    if (r.config.coherence.directory_entries != 0 && !r.config.coherence.snoops())
        out += fmt::format("         recalls: {} lines, from {} caches that had them and {} that had not; {} "
                           "requests found no room\n",
                           d.recalled_lines, d.recalls_received, d.recalls_stale, d.crowded);
    if (r.config.coherence.snoops())
        out += fmt::format("         {} look-ups of others' tags; {} requests passed on to other buses\n",
                           d.snoops, d.passed_on);
}

/// Nothing where it is ideal.
void network(std::string& out, const Report& r) {
    if (r.network.ideal())
        return;
    const NetworkCounters& n = r.network.counters;
    out += fmt::format(
        "network  {} messages ({} requests, {} replies, {} writes, {} words) of {} bytes, {}\n", n.messages(),
        n.requests, n.replies, n.writes, n.words, n.bytes, r.config.network.topology);
    out += fmt::format("         a message: {:.2f} hops, {:.1f} cycles, of which {:.1f} queued\n",
                       ratio(n.hops, n.messages()), ratio(n.latency_cycles, n.messages()),
                       ratio(n.queue_cycles, n.messages()));
    const LinkUse& most = r.network.busiest();
    out += fmt::format("         links in use: {:.1f} % of the time, the busiest ({}) {:.1f} %\n",
                       100 * ratio(n.link_flits, r.network.links.size() * r.drained), most.link,
                       100 * ratio(most.flits, r.drained));
}

void levels(std::string& out, const Report& r) {
    out += "\ncaches          reads       writes         hits       misses  miss rate  write-backs\n";
    level(out, "L1", r.l1_total());
    for (unsigned i = 1; i < r.config.cache_levels(); ++i)
        level(out, fmt::format("L{}", i + 1).c_str(), r.cache_total(i));
    tlb(out, r);
    coherence(out, r);
    network(out, r);
    memory(out, r);
    out += "\nbandwidth      GB/s achieved   GB/s peak   utilisation\n";
    for (const Bandwidth& b : bandwidths(r))
        out += fmt::format("  {:<12} {:>13.3f} {:>11.3f} {:>11.1f} %\n", b.level, b.achieved, b.peak,
                           100 * b.utilisation());
    out += "\nleast cycles, were all else free\n";
    for (const Limit& l : limits(r))
        out += fmt::format("  {:<14} {:>12} {:>6.1f} % of the run   {}\n", l.resource, l.cycles,
                           100 * ratio(l.cycles, r.drained), l.meaning);
    out += fmt::format("limited by {}\n", limiter(r));
}

void instructions(std::string& out, const Report& r) {
    out += "\nmachine instructions        scalar         vector   % of all\n";
    for (std::size_t k = 0; k < form_kinds; ++k)
        if (const std::uint64_t all = r.by_kind[k] + r.by_kind[vector_kind(k)]; all != 0)
            out += fmt::format("  {:<18} {:>14} {:>14} {:>10.1f}\n", bare_name(k), r.by_kind[k],
                               r.by_kind[vector_kind(k)], 100 * ratio(all, r.core.instructions));
}

/// Nothing where the machine states no energy.
void energy(std::string& out, const Report& r) {
    const std::vector<EnergyPart> parts = energy_parts(r);
    const EnergyTotal all = total(r, parts);
    if (all.joules == 0)
        return;
    out += fmt::format("\nenergy: {:.4g} mJ, {:.4g} W on average, {:.4g} J s of energy times delay\n",
                       all.joules * 1e3, all.watts(), all.joule_seconds());
    for (const EnergyPart& p : parts)
        if (p.joules > 0)
            out += fmt::format("  {:<16} {:>14} {:>12.4g} mJ {:>6.1f} %   {}\n", p.part, p.events,
                               p.joules * 1e3, 100 * p.joules / all.joules, p.meaning);
}

template <class Name>
void table(std::string& out, const Report& r, const char* what, std::size_t rows, Name name_and_sum) {
    out += fmt::format("\n{:<16}", what);
    for (const char* head :
         {"L1 accesses", "L1 misses", "L1 w-backs", "L2 misses", "DRAM reads", "DRAM writes", "KiB DRAM"})
        out += fmt::format(" {:>12}", head);
    out += '\n';
    for (std::size_t i = 0; i < rows; ++i) {
        auto [name, t] = name_and_sum(i);
        if (t.l1_reads + t.l1_writes + t.l2_reads + t.l2_writes == 0)
            continue;
        std::uint64_t lines = t.memory_reads + t.memory_writes;
        out += fmt::format("{:<16} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12} {:>12}\n", name,
                           t.l1_reads + t.l1_writes, t.l1_misses, t.l1_write_backs, t.l2_misses,
                           t.memory_reads, t.memory_writes,
                           lines * static_cast<std::uint64_t>(r.config.last_cache().line_bytes) / 1024);
    }
}

void add(Traffic& sum, const Traffic& t) {
    for (const auto& column : traffic_columns)
        sum.*column.count += t.*column.count;
}

template <class Wanted> Traffic sum_where(const Report& r, Wanted wanted) {
    Traffic sum;
    for (const TrafficRow& row : r.traffic)
        if (wanted(row))
            add(sum, row.traffic);
    return sum;
}

/// One number for each of the first structures and each of `names`.
template <class Number>
void grid(std::string& out, const Report& r, const char* title, const std::vector<std::string>& names,
          std::size_t structures, Number number) {
    out += fmt::format("\n{}\n                ", title);
    for (const std::string& name : names)
        out += fmt::format(" {:>10}", name);
    out += '\n';
    for (std::size_t s = 0; s < structures; ++s) {
        out += fmt::format("{:<16}", r.structures[s]);
        for (std::size_t i = 0; i < names.size(); ++i)
            out += fmt::format(" {:>10}", number(s, i));
        out += '\n';
    }
}

void traffic(std::string& out, const Report& r) {
    const Labels& labels = r.labels;
    const std::size_t all = r.structures.size(); // the last is `spill`
    table(out, r, "by structure", r.structures.size(), [&](std::size_t s) {
        return std::pair(r.structures[s],
                         sum_where(r, [&](const TrafficRow& t) { return t.structure == s; }));
    });
    table(out, r, "by phase", labels.phases.size(), [&](std::size_t p) {
        return std::pair(labels.phases[p],
                         sum_where(r, [&](const TrafficRow& t) { return labels.phase(t.column) == p; }));
    });
    if (labels.kinds.size() > 1)
        table(out, r, "by kind", labels.kinds.size(), [&](std::size_t k) {
            return std::pair(labels.kinds[k],
                             sum_where(r, [&](const TrafficRow& t) { return labels.kind(t.column) == k; }));
        });
    std::set<std::pair<std::size_t, std::optional<int>>> levels;
    for (const TrafficRow& t : r.traffic)
        if (t.level)
            levels.insert({{t.structure, std::nullopt}, {t.structure, t.level}});
    const std::vector<std::pair<std::size_t, std::optional<int>>> rows(levels.begin(), levels.end());
    if (!rows.empty())
        table(out, r, "by level", rows.size(), [&](std::size_t i) {
            const auto& [s, level] = rows[i];
            return std::pair(r.structures[s] + (level ? fmt::format(" {}", *level) : " -"),
                             sum_where(r, [&](const TrafficRow& t) {
                                 return t.structure == rows[i].first && t.level == rows[i].second;
                             }));
        });
    auto kib = [&](const Traffic& t) {
        return (t.memory_reads + t.memory_writes) *
               static_cast<std::uint64_t>(r.config.last_cache().line_bytes) / 1024;
    };
    grid(out, r, "KiB to and from memory, structure by phase", labels.phases, all,
         [&](std::size_t s, std::size_t p) {
             return kib(sum_where(
                 r, [&](const TrafficRow& t) { return t.structure == s && labels.phase(t.column) == p; }));
         });
    if (labels.kinds.size() == 1)
        return;
    grid(out, r, "KiB to and from memory, structure by kind", labels.kinds, all,
         [&](std::size_t s, std::size_t k) {
             return kib(sum_where(
                 r, [&](const TrafficRow& t) { return t.structure == s && labels.kind(t.column) == k; }));
         });
    grid(out, r, "different lines accessed, structure by kind", labels.kinds, all - 1,
         [&](std::size_t s, std::size_t k) {
             std::uint64_t lines = 0;
             for (const TouchedLines& t : r.touched)
                 for (std::size_t p = 0; p < labels.phases.size(); ++p)
                     if (t.structure == s && (t.columns >> (k * labels.phases.size() + p) & 1U) != 0) {
                         lines += t.lines;
                         break;
                     }
             return lines;
         });
}

} // namespace

std::string print_text(const Report& r) {
    std::string out;
    overview(out, r);
    instructions(out, r);
    stack(out, r);
    levels(out, r);
    energy(out, r);
    traffic(out, r);
    double worked = r.processor_seconds;
    out += fmt::format(
        "\nhost: {:.3f} s on {} thread{}, {:.3f} s of processor time: {:.2f} million operations and {:.2f} "
        "million instructions a second of it\n",
        r.host_seconds, r.host_threads, r.host_threads == 1 ? "" : "s", worked,
        static_cast<double>(r.all_vops) / worked * 1e-6,
        static_cast<double>(r.all_instructions) / worked * 1e-6);
    return out;
}

} // namespace sim
