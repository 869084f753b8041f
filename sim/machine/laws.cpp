// What must hold of every run's numbers.
#include "sim/machine/limits.h"
#include "sim/machine/report.h"
#include "sim/machine/windows.h"
#include "sim/memory/line_map.h"
#include "sim/network/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace sim {
namespace {

void equal(const char* law, std::uint64_t left, std::uint64_t right) {
    if (left != right)
        throw std::logic_error(
            fmt::format("a law of the machine is broken: {}: {} is not {}", law, left, right));
}
void at_most(const char* law, std::uint64_t left, std::uint64_t right) {
    if (left > right)
        throw std::logic_error(
            fmt::format("a law of the machine is broken: {}: {} exceeds {}", law, left, right));
}

std::uint64_t total(const Report& r, std::uint64_t Traffic::*count) {
    return std::accumulate(
        r.traffic.begin(), r.traffic.end(), std::uint64_t{0},
        [count](std::uint64_t sum, const TrafficRow& row) { return sum + row.traffic.*count; });
}

void check_traffic(const Report& r) {
    for (unsigned level = 0; level < r.config.cache_levels(); ++level) {
        const CacheCounters c = r.cache_total(level);
        const TrafficOfLevel& t = traffic_of_level[level];
        equal("reads of a level = sum over structures, kinds and phases", c.reads, total(r, t.reads));
        equal("writes of a level = sum over structures, kinds and phases", c.writes, total(r, t.writes));
        equal("misses of a level = sum over structures, kinds and phases", c.misses, total(r, t.misses));
        equal("write-backs of a level = sum over structures, kinds and phases", c.write_backs,
              total(r, t.write_backs));
    }
    equal("memory reads = sum over structures, kinds and phases", r.memory.reads,
          total(r, &Traffic::memory_reads));
    equal("memory writes = sum over structures, kinds and phases", r.memory.writes,
          total(r, &Traffic::memory_writes));
}

/// Lines were touched where there were accesses, one each at the least, and each came from the L2, or was
/// written around the L1.
void check_touched(const Report& r) {
    const bool around = r.config.l1.write_miss == "around";
    for (std::size_t s = 0; s + 1 < r.structures.size(); ++s) {
        std::vector<std::uint64_t> accesses(r.labels.columns()), lines(r.labels.columns());
        std::uint64_t fetched = 0, all = 0;
        for (const TrafficRow& row : r.traffic)
            if (row.structure == s) {
                accesses[row.column] += row.traffic.l1_reads + row.traffic.l1_writes;
                fetched += row.traffic.l2_reads + (around ? row.traffic.l2_writes : 0);
            }
        for (const TouchedLines& t : r.touched)
            if (t.structure == s) {
                all += t.lines;
                for (std::size_t c = 0; c < lines.size(); ++c)
                    lines[c] += (t.columns >> c & 1U) != 0 ? t.lines : 0;
            }
        if (r.warm_up == 0) // else some were there
            at_most("lines touched <= lines asked of the L2", all, fetched);
        for (std::size_t c = 0; c < lines.size(); ++c) {
            at_most("lines touched by a kind and phase <= its accesses", lines[c], accesses[c]);
            equal("lines are touched by who accesses any", lines[c] != 0 ? 1 : 0, accesses[c] != 0 ? 1 : 0);
        }
    }
}

/// What one rank, or all, did on commands and data.
void check_commands(const MemoryConfig& c, const MemoryCounters& m, std::uint64_t ranks, bool cold) {
    auto wide = [](integer x) { return static_cast<std::uint64_t>(x); };
    std::uint64_t bursts = m.read_bursts + m.write_bursts;
    equal("row hits + empties + conflicts = bursts", m.row_hits + m.row_empties + m.row_conflicts, bursts);
    equal("bus clocks = bursts x clocks of one", m.busy_clocks, bursts * wide(c.burst_clocks()));
    equal("activates = row empties + conflicts + reopened", m.activates,
          m.row_empties + m.row_conflicts + m.reopened);
    at_most("row conflicts <= precharges", m.row_conflicts, m.precharges);
    std::uint64_t open = cold ? 0 : ranks * wide(c.bank_groups * c.banks); // before what counts
    at_most("precharges <= activates and rows open before", m.precharges, m.activates + open);
    at_most("activates <= 4 a rank and tFAW", m.activates, 4 * ranks * (m.last_clock / wide(c.tFAW) + 1));
    at_most("clocks queued <= clocks of reads", m.queue_clocks, m.read_clocks);
    at_most("read bursts take tCL and their transfer at least",
            m.read_bursts * wide(c.tCL + c.burst_clocks()), m.read_clocks);
}

/// Ranks take turns; each is refreshed every tREFI until the channel's last burst.
std::uint64_t refreshes(const MemoryConfig& c, std::uint64_t end) {
    std::uint64_t count = 0;
    for (integer rank = 0; c.tREFI != 0 && rank < c.ranks; ++rank) {
        auto first = static_cast<std::uint64_t>(c.tREFI + c.tREFI * rank / c.ranks);
        count += end <= first ? 0 : (end - 1 - first) / static_cast<std::uint64_t>(c.tREFI) + 1;
    }
    return count;
}

/// Those of a channel that were issued in order of time. They are put off, or wait for rows to close, and go
/// on while other channels are busy: `due` until its last burst at the least, `all` until the run's end at
/// the most.
void check_refreshes(const MemoryConfig& c, std::uint64_t issued, std::uint64_t due, std::uint64_t all) {
    const auto turns = static_cast<std::uint64_t>(c.refresh == "per-bank" ? c.bank_groups * c.banks : 1);
    const std::uint64_t apart =
        static_cast<std::uint64_t>(c.ranks) * (turns + 1 + static_cast<std::uint64_t>(c.refresh_postponed));
    at_most("refreshes <= those due until the end, and few more", issued, all * turns + apart);
    at_most("refreshes due <= those issued, and those put off", due * turns, issued + apart);
}

/// Little's law: what waited in a queue, on average, is no more than there are places.
void check_queue(const MemoryConfig& c, const MemoryCounters& channel) {
    const std::uint64_t moved = channel.read_bursts * static_cast<std::uint64_t>(c.tCL + c.burst_clocks());
    at_most("clocks in the read queue <= places x clocks", channel.read_clocks - moved,
            static_cast<std::uint64_t>(c.read_queue) * channel.last_clock);
}

void check_memory(const Report& r) {
    const MemoryConfig& c = r.config.memory;
    auto ranks = static_cast<std::size_t>(c.ranks);
    const bool queued = c.controller == "queued";
    const std::uint64_t begin = to_memory_clocks(r.config, r.warm_up);
    MemoryCounters sum;
    for (std::size_t channel = 0; channel < r.memory_by_rank.size(); channel += ranks) {
        MemoryCounters all;
        for (std::size_t rank = 0; rank < ranks; ++rank) {
            check_commands(c, r.memory_by_rank[channel + rank], 1, r.warm_up == 0);
            all += r.memory_by_rank[channel + rank];
        }
        check_commands(c, all, ranks, r.warm_up == 0);
        const std::uint64_t due =
            all.last_clock == 0 ? 0 : refreshes(c, begin + all.last_clock) - refreshes(c, begin);
        if (queued) {
            const std::uint64_t end = begin + to_memory_clocks(r.config, r.drained);
            check_refreshes(c, all.refreshes, due, refreshes(c, end) - refreshes(c, begin));
            check_queue(c, all);
        } else {
            equal("refreshes = clocks / tREFI", all.refreshes, due);
            equal("reads wait for no queue", all.read_wait_clocks, 0);
        }
        at_most("bus clocks of a channel <= clocks", all.busy_clocks, all.last_clock);
        at_most("turnarounds < bursts", all.turnarounds, all.read_bursts + all.write_bursts);
        at_most("turnarounds <= 2 x the lesser of read and written bursts, and one from those before",
                all.turnarounds, 2 * std::min(all.read_bursts, all.write_bursts) + (r.warm_up == 0 ? 0 : 1));
        at_most("rank switches < bursts", all.rank_switches, all.read_bursts + all.write_bursts);
        sum += all;
    }
    for (const auto& row : memory_counters)
        equal("memory = sum over ranks", r.memory.*row.count, sum.*row.count);
    equal("memory's last clock = that of a rank", r.memory.last_clock, sum.last_clock);
    auto parts =
        static_cast<std::uint64_t>(r.config.last_cache().line_bytes / (c.bus_bytes * c.burst_length));
    equal("read bursts + forwarded = lines read x bursts of a line", sum.read_bursts + sum.forwarded,
          sum.reads * parts);
    equal("written bursts + merged = lines written x bursts of a line", sum.write_bursts + sum.merged,
          sum.writes * parts);
}

/// What a level sends down arrives, and nothing else but what shared words do at the L2. Beyond the tiles,
/// other tiles bring some of the lines.
void check_below(const Report& r, const CacheCounters& above, const CacheCounters& c, bool l2, bool beyond) {
    equal("reads of a level + lines that owners brought = fills of the one above + upgrades without their "
          "line (L2: + read-modify-writes)",
          c.reads + (beyond ? r.coherence.supplied() : 0),
          above.fills + (beyond ? r.coherence.lost_upgrades : c.lost_upgrades) +
              (l2 ? r.core.modifications : 0));
    equal(
        "writes of a level = write-backs + clean victims + writes through of the one above (L2: + releases)",
        c.writes,
        above.write_backs + above.clean_victims + above.written_through + (l2 ? r.core.releases : 0));
    at_most("fills <= misses + prefetches", c.fills + c.written_around, c.misses + c.hardware_prefetches);
}

void check_levels(const Report& r) {
    const unsigned levels = r.config.cache_levels();
    for (unsigned level = 0; level < levels; ++level) {
        const CacheCounters c = r.cache_total(level);
        equal("hits + misses = accesses", c.hits + c.misses, c.reads + c.writes);
        at_most("hits in flight <= hits", c.hits_in_flight, c.hits);
        at_most("writes around <= writes through", c.written_around, c.written_through);
        equal("hardware prefetches = useful + useless", c.hardware_prefetches,
              c.prefetches_useful + c.prefetches_useless);
        at_most("late prefetches <= useful", c.prefetches_late, c.prefetches_useful);
        equal("misses = sum over causes", r.config.sim.miss_causes == "on" ? c.misses : 0,
              c.compulsory + c.capacity + c.conflict + c.coherence);
        const bool exclusive = r.config.cache(level).inclusion == "exclusive";
        at_most("lines moved up <= hits of an exclusive level", c.moved_up, exclusive ? c.hits : 0);
        if (level != 0)
            check_below(r, r.cache_total(level - 1), c, level == 1, r.config.beyond_tiles(level));
    }
    const CacheCounters l1 = r.l1_total(), last = r.cache_total(levels - 1);
    equal("L1 fills + writes around = misses + prefetches", l1.fills + l1.written_around,
          l1.misses + l1.prefetches + l1.hardware_prefetches);
    const bool to_memory = r.config.tile_levels() == levels; // else this is true of tiles' last levels
    equal("memory reads + lines that owners brought = fills of the last level + upgrades without their line",
          r.memory.reads + (to_memory ? r.coherence.supplied() : 0),
          last.fills + (to_memory ? r.coherence.lost_upgrades : 0));
    equal("memory writes = write-backs + writes through of the last level", r.memory.writes,
          last.write_backs + last.written_through);
    equal("inclusive levels have all lines above them, exclusive ones none", r.misplaced_lines, 0);
    check_memory(r);
}

/// Every line that leaves a tile, or a cache beyond the tiles, is a message, and every message is on its
/// links.
void check_network(const Report& r) {
    const NetworkCounters& n = r.network.counters;
    equal("an ideal network has no links", r.config.network.ideal() ? 1 : 0, r.network.ideal() ? 1 : 0);
    if (r.network.ideal())
        return equal("messages of an ideal network", n.messages(), 0);
    const NetworkConfig& c = r.config.network;
    const auto wide = [](integer x) { return static_cast<std::uint64_t>(x); };
    const unsigned last = r.config.tile_levels() - 1, levels = r.config.cache_levels();
    const CacheCounters sent = r.cache_total(last);
    const bool beyond = last + 1 != levels;
    const std::uint64_t from_memory = beyond ? r.memory.reads : 0, to_memory = beyond ? r.memory.writes : 0;
    const CoherenceCounters& d = r.coherence;
    equal("requests = lines that tiles and caches beyond them read + upgrades", n.requests,
          sent.fills + from_memory + d.upgrades);
    equal("replies = requests, but for upgrades that had their line", n.replies + d.upgrades,
          n.requests + d.lost_upgrades);
    const bool snoops = r.config.coherence.snoops();
    const std::uint64_t words =
        d.claims + (snoops ? d.passed_on
                           : d.forwards + d.forwards_stale + d.invalidations + d.acknowledgements +
                                 2 * d.recalls + d.upgrades - d.lost_upgrades);
    at_most("words for coherence <= words", words, n.words);
    if (!beyond)
        equal("other words are for caches beyond the tiles", n.words, words);
    equal("messages that write = write-backs + writes through of tiles and caches beyond them", n.writes,
          sent.write_backs + sent.written_through + to_memory - (snoops ? d.written_back : 0));
    equal("bytes = data + headers", n.bytes,
          n.data_bytes + (n.requests + n.words) * wide(c.request_bytes) + n.replies * wide(c.reply_bytes) +
              n.writes * wide(c.write_bytes));
    const std::uint64_t read = (sent.fills + d.lost_upgrades) * wide(r.config.cache(last).line_bytes) +
                               from_memory * wide(r.config.last_cache().line_bytes);
    at_most("lines read <= data", read, n.data_bytes);
    at_most("data <= lines read and written", n.data_bytes,
            read + n.writes * wide(r.config.last_cache().line_bytes));
    at_most("bytes <= flits x width", n.bytes, n.flits * wide(c.link_bytes));
    at_most("flits are full but for a message's last", n.flits * wide(c.link_bytes),
            n.bytes + n.messages() * wide(c.link_bytes - 1));
    equal("cycles of messages = queued + hops + flits", n.latency_cycles,
          n.queue_cycles + n.hops * wide(c.hop_cycles) + n.flits);
    const std::size_t units = Topology(r.config).units();
    std::uint64_t left = 0, arrived = 0, all = 0;
    for (std::size_t i = 0; i < r.network.links.size(); ++i) {
        const std::uint64_t flits = r.network.links[i].flits;
        (i < units ? left : i < 2 * units ? arrived : all) += flits;
        at_most("flits of a link <= cycles", flits, r.drained);
    }
    equal("flits leave a unit", left, n.flits);
    equal("flits arrive at a unit", arrived, n.flits);
    equal("flits of all links = sum over messages", left + arrived + all, n.link_flits);
    const bool crossbar = c.topology == "crossbar";
    equal("ways through a crossbar = messages", crossbar ? n.hops : 0, crossbar ? n.messages() : 0);
    const std::uint64_t crossed = (crossbar ? n.flits : all) * wide(c.link_bytes);
    at_most("bytes x hops <= flits of links between routers x width", n.byte_hops, crossed);
    at_most("these are full but for a message's last", crossed,
            n.byte_hops + n.hops * wide(c.link_bytes - 1));
}

/// What tiles ask for, the directory looks up, or all other caches; every message of it is answered.
void check_coherence(const Report& r) {
    const CoherenceCounters& d = r.coherence;
    const CacheCounters last = r.cache_total(r.config.tile_levels() - 1);
    if (!r.config.coherence.kept()) {
        for (const auto& row : coherence_counters)
            equal("without coherence nobody asks others", d.*row.count, 0);
        for (unsigned level = 0; level < r.config.cache_levels(); ++level) {
            const CacheCounters c = r.cache_total(level);
            equal("without coherence nobody asks to write or share",
                  c.upgrades + c.lost_upgrades + c.downgrades, 0);
        }
        return;
    }
    equal("lines that others are asked for = lines that tiles read", d.reads + d.writes, last.fills);
    equal("upgrades that others know of and silent ones = those of tiles", d.upgrades + d.silent_upgrades,
          last.upgrades);
    at_most("upgrades without their line <= upgrades", d.lost_upgrades, d.upgrades);
    equal("reads are exclusive or shared", d.exclusive + d.shared, d.reads);
    equal("forwards = lines that owners brought + stale", d.forwards, d.supplied() + d.forwards_stale);
    equal("invalidations sent = received + stale", d.invalidations,
          d.invalidations_received + d.invalidations_stale);
    const bool snoops = r.config.coherence.snoops();
    equal("invalidations sent = acknowledgements", snoops ? 0 : d.invalidations, d.acknowledgements);
    const std::uint64_t seen = snoops ? d.reads + d.writes + d.upgrades + d.claims : 0;
    const auto others = [](std::size_t all) { return static_cast<std::uint64_t>(all) - 1; };
    equal("every other cache looks up what one asks for", d.snoops,
          seen * others(r.caches(r.config.tile_levels() - 1).size()));
    equal("every other bus is told", d.passed_on, seen * others(snoops ? Topology(r.config).buses() : 1));
    at_most("invalidations and recalls received <= lines that tiles lost",
            d.invalidations_received + d.recalls_received, last.invalidations);
    equal("recalls = received + stale", d.recalls, d.recalls_received + d.recalls_stale);
    at_most("recalled lines <= recalls", d.recalled_lines, d.recalls);
    if (snoops || r.config.coherence.directory_entries == 0)
        equal("who has room for all recalls nothing", d.recalls + d.crowded, 0);
    equal("lines written back for others = those that tiles sent down", d.written_back, last.downgrades);
    equal("who has a line is known, and one alone may write it", r.incoherent_lines, 0);
}

/// Every miss is answered by the second TLB, another's walk or its own; walks read what the walk cache lacks.
void check_tlb(const Report& r) {
    const TlbConfig& c = r.config.tlb;
    const auto wide = [](integer x) { return static_cast<std::uint64_t>(x); };
    const TlbCounters t = r.tlb_total();
    const std::uint64_t stalled = r.stack()[static_cast<std::size_t>(Cause::tlb)];
    equal("TLBs = cores, or none", r.tlb.size(), c.any() ? wide(r.config.all_cores()) : 0);
    equal("TLB hits + misses = lookups", t.hits + t.misses, t.lookups);
    equal("TLB misses = second hits + merged + walks", t.misses, t.second_hits + t.merged + t.walks);
    at_most("hits of a second TLB, if there is one", t.second_hits, c.second_entries != 0 ? t.misses : 0);
    at_most("cycles of walks <= walkers x cycles", t.walk_cycles,
            wide(r.config.all_cores() * c.walkers) * r.drained);
    at_most("cycles waited for other walks <= cycles waited for pages", t.walker_cycles, t.wait_cycles);
    if (!c.any() || c.misses == "stall")
        at_most("cycles held up by TLBs <= cycles waited for pages", stalled, t.wait_cycles);
    const auto tables = std::find(r.structures.begin(), r.structures.end(), LineMap::page_tables);
    equal("page tables are a structure where walks read them", tables != r.structures.end() ? 1 : 0,
          c.tables() ? 1 : 0);
    if (!c.tables()) {
        equal("cycles of walks = walks x cycles of one", t.walk_cycles,
              t.walks * wide(c.any() ? c.walk_cycles : 0));
        equal("entries read and spared where walks read none", t.walk_reads + t.walk_spared, 0);
        return;
    }
    Traffic moved;
    for (const TrafficRow& row : r.traffic)
        if (r.structures[row.structure] == LineMap::page_tables)
            for (const TrafficColumn& column : traffic_columns)
                moved.*column.count += row.traffic.*column.count;
    equal("entries read and spared = walks x levels", t.walk_reads + t.walk_spared,
          t.walks * wide(c.table_levels()));
    equal("entries read = L1 reads of page tables", t.walk_reads, moved.l1_reads);
    equal("nobody writes page tables", moved.l1_writes, 0);
    at_most("walks read an entry at the least", t.walks, t.walk_reads);
    at_most("entries are read one after the other", t.walk_reads * wide(r.config.l1.latency), t.walk_cycles);
}

/// Noise: 0 or 1 cycle for each line that an L1 asks for.
void check_jitter(const Report& r, const CacheCounters& l1) {
    equal("lines that may be delayed = L1 fills", r.jitter.lines, r.config.sim.jitter != 0 ? l1.fills : 0);
    at_most("cycles of delay <= lines", r.jitter.cycles, r.jitter.lines);
}

/// What store buffers did, where there are any.
void check_buffers(const Report& r, const CacheCounters& l1) {
    equal("entries of store buffers = L1 writes, but for lanes put together on the stack",
          r.core.buffered_stores, r.config.core.store_buffer > 0 ? l1.writes - r.core.assembly_stores : 0);
}

/// What instruction sets without gathers, scatters and masks take.
void check_assembly(const Report& r) {
    const CoreCounters& c = r.core;
    at_most("instructions beside lanes' own <= instructions", c.assembly_instructions, c.instructions);
    at_most("references among them <= they", c.assembly_references, c.assembly_instructions);
    at_most("stores among these <= they", c.assembly_stores, c.assembly_references);
    const LanesConfig& lanes = r.config.lanes;
    if (r.config.core.gather != "lane" && lanes.scatter == "off" && lanes.shuffle == "off" &&
        lanes.gather_instructions == 0)
        equal("instructions beside lanes' own where nothing goes lane by lane", c.assembly_instructions, 0);
}

void check_use(const Report& r, const CacheCounters& l1) {
    for (const Limit& l : limits(r))
        at_most(l.resource, l.cycles, r.drained);
    auto cores = static_cast<std::uint64_t>(r.config.all_cores());
    at_most("issue slots used <= slots", r.core.instructions,
            r.cycles * cores * static_cast<std::uint64_t>(r.config.core.issue_width));
    for (const auto& ports : r.port_instructions)
        for (std::uint64_t instructions : ports)
            at_most("instructions of an issue port <= cycles", instructions, r.cycles);
    for (std::uint64_t cycles : r.shared_unit_cycles)
        at_most("cycles of a shared unit <= cycles", cycles, r.drained);
    at_most("L1 port cycles used <= port cycles", l1.busy_cycles,
            r.drained * cores * static_cast<std::uint64_t>(r.config.l1.ports));
}

void check_stacks(const Report& r) {
    auto sum_of = [](const Stack& s) { return std::accumulate(s.begin(), s.end(), std::uint64_t{0}); };
    for (const ThreadReport& t : r.threads)
        equal("a thread's CPI stack = cycles", sum_of(t.stack()), r.cycles);
    auto threads = static_cast<std::uint64_t>(r.config.chip.threads);
    std::vector<Stack> cores = r.core_stacks();
    for (const Stack& s : cores)
        equal("a core's CPI stack = threads x cycles", sum_of(s), threads * r.cycles);
    equal("the chip's CPI stack = cores x threads x cycles", sum_of(r.stack()),
          cores.size() * threads * r.cycles);
    Work sum;
    for (const Work& w : r.work) {
        sum.vops += w.vops;
        sum.instructions += w.instructions;
    }
    std::uint64_t through_ports = 0;
    for (const auto& ports : r.port_instructions)
        through_ports = std::accumulate(ports.begin(), ports.end(), through_ports);
    if (r.config.core.pairing != "any") // looks of waiting threads take slots alone
        equal("instructions = sum over issue ports", r.core.instructions, through_ports + 2 * r.core.spins);
    equal("instructions = sum over classes + looks", r.core.instructions,
          std::accumulate(r.by_kind.begin(), r.by_kind.end(), 2 * r.core.spins));
    equal("operations = sum over kinds and phases", r.core.vops, sum.vops);
    equal("instructions = sum over kinds and phases", r.core.instructions, sum.instructions);
}

/// Intervals follow each other without gaps, sum to the run, and each holds all threads' cycles.
void check_intervals(const Report& r, const CacheCounters& l1, const CacheCounters& l2) {
    if (r.interval == 0) {
        equal("no intervals", r.intervals.size(), 0);
        return;
    }
    auto threads = static_cast<std::uint64_t>(r.config.all_threads());
    Interval sum;
    for (const Interval& i : r.intervals) {
        const bool last = &i == &r.intervals.back();
        equal("an interval begins where the one before it ends", i.begin, sum.end);
        sum.end = i.end;
        at_most("an interval is as long as was asked", last ? 0 : i.end - i.begin, r.interval);
        equal("an interval's CPI stack = threads x cycles",
              std::accumulate(i.stack.begin(), i.stack.end(), std::uint64_t{0}),
              last ? 0 : threads * (i.end - i.begin));
        for (const auto& c : interval_counters)
            sum.*c.count += i.*c.count;
        for (std::size_t cause = 0; cause < cause_count; ++cause)
            sum.stack[cause] += i.stack[cause];
    }
    equal("the last interval begins when the workers have returned", r.intervals.back().begin, r.cycles);
    equal("intervals end when memory is quiet", sum.end, r.drained);
    equal("operations = sum over intervals", r.core.vops, sum.vops);
    equal("instructions = sum over intervals", r.core.instructions, sum.instructions);
    equal("L1 accesses = sum over intervals", l1.reads + l1.writes, sum.l1_accesses);
    equal("L1 misses = sum over intervals", l1.misses, sum.l1_misses);
    equal("L2 accesses = sum over intervals", l2.reads + l2.writes, sum.l2_accesses);
    equal("L2 misses = sum over intervals", l2.misses, sum.l2_misses);
    equal("memory reads = sum over intervals", r.memory.reads, sum.memory_reads);
    equal("memory writes = sum over intervals", r.memory.writes, sum.memory_writes);
    equal("bytes on the network = sum over intervals", r.network.counters.bytes, sum.network_bytes);
    const Stack stack = r.stack();
    for (std::size_t cause = 0; cause < cause_count; ++cause)
        equal("the CPI stack = sum over intervals", stack[cause], sum.stack[cause]);
}

/// What is charged to owners, and what is nobody's, is all that there is.
void check_owners(const Report& r) {
    if (r.owners.empty())
        return;
    ThreadCost all;
    const Stack stack = r.stack();
    for (std::size_t cause = 0; cause < cause_count; ++cause) {
        all.cycles += stack[cause];
        all.stalled += is_of_memory(static_cast<Cause>(cause)) ? stack[cause] : 0;
    }
    all.waiting = stack[static_cast<std::size_t>(Cause::synchronise)];
    all.instructions = r.core.instructions;
    const std::vector<OwnerFigure> figures = owner_figures(r.config.cache_levels());
    equal("a sum over owners for each figure", r.owners.size(), figures.size());
    for (std::size_t i = 0; i < figures.size(); ++i) {
        const OwnerFigure& f = figures[i];
        const OwnerSum& sum = r.owners[i];
        const std::uint64_t expected = f.of_thread != nullptr ? all.*f.of_thread : total(r, f.of_traffic);
        equal(fmt::format("{} = sum over owners + nobody's", f.name).c_str(), expected,
              sum.owners + sum.nobody);
        at_most("builds for owners <= all for owners", sum.builds, sum.owners);
    }
}

/// Whether all threads are ordered operation by operation: tiles are not, and neither are those that come
/// back from memory in the middle of a window that has been run.
bool exact(Config c) {
    cycle window = window_cycles(c);
    c.sim.window = 0;
    return c.sim.quantum <= 1 && c.chip.tiles == 1 && window <= window_cycles(c);
}

} // namespace

void check_laws(const Report& r) {
    CacheCounters l1 = r.l1_total();
    check_levels(r);
    check_traffic(r);
    check_touched(r);
    check_use(r, l1);
    check_stacks(r);
    check_buffers(r, l1);
    check_tlb(r);
    check_coherence(r);
    check_assembly(r);
    check_network(r);
    check_jitter(r, l1);
    check_intervals(r, l1, r.l2_total());
    check_owners(r);
    if (exact(r.config))
        equal("no read of the future where threads are ordered exactly", r.core.causality_waits, 0);
}

} // namespace sim
