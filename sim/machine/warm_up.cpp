#include "sim/machine/warm_up.h"

#include "sim/machine/windows.h"

#include <algorithm>

namespace sim {
namespace {

template <class Counters, class Rows> void reduce(Counters& all, const Counters& warm, const Rows& rows) {
    for (const auto& row : rows)
        all.*row.count -= warm.*row.count;
}
template <class Counters, class Rows>
void reduce(std::vector<Counters>& all, const std::vector<Counters>& warm, const Rows& rows) {
    for (std::size_t i = 0; i < all.size(); ++i)
        reduce(all[i], warm[i], rows);
}

void reduce_traffic(std::vector<TrafficRow>& all, const std::vector<TrafficRow>& warm) {
    for (TrafficRow& row : all)
        for (const TrafficRow& w : warm)
            if (w.structure == row.structure && w.level == row.level && w.column == row.column)
                reduce(row.traffic, w.traffic, traffic_columns);
    std::erase_if(all, [](const TrafficRow& row) { return is_empty(row.traffic); });
}

/// Clocks count from the beginning of what counts, too.
void shift(MemoryCounters& m, std::uint64_t begin) {
    m.last_clock -= std::min(m.last_clock, begin);
}

} // namespace

void take_away(Report& r, const Report& warm) {
    r.warm_up = warm.cycles;
    r.cycles -= warm.cycles;
    r.drained -= warm.cycles;
    reduce(r.core, warm.core, core_counters);
    for (std::size_t k = 0; k < issue_kinds; ++k)
        r.by_kind[k] -= warm.by_kind[k];
    for (std::size_t i = 0; i < r.work.size(); ++i) {
        r.work[i].vops -= warm.work[i].vops;
        r.work[i].instructions -= warm.work[i].instructions;
    }
    for (std::size_t i = 0; i < r.threads.size(); ++i) {
        ThreadReport& t = r.threads[i];
        t.finish -= std::min(t.finish, warm.cycles);
        t.instructions -= warm.threads[i].instructions;
        for (std::size_t c = 0; c < t.stacks.size(); ++c)
            for (std::size_t cause = 0; cause < cause_count; ++cause)
                t.stacks[c][cause] -= warm.threads[i].stacks[c][cause];
    }
    for (std::size_t core = 0; core < r.port_instructions.size(); ++core)
        for (std::size_t port = 0; port < r.port_instructions[core].size(); ++port)
            r.port_instructions[core][port] -= warm.port_instructions[core][port];
    for (std::size_t i = 0; i < r.shared_unit_cycles.size(); ++i)
        r.shared_unit_cycles[i] -= warm.shared_unit_cycles[i];
    for (unsigned level = 0; level < r.config.cache_levels(); ++level)
        reduce(r.caches(level), warm.caches(level), cache_counters);
    reduce(r.tlb, warm.tlb, tlb_counters);
    reduce(r.coherence, warm.coherence, coherence_counters);
    r.jitter.lines -= warm.jitter.lines;
    r.jitter.cycles -= warm.jitter.cycles;
    reduce(r.network.counters, warm.network.counters, network_counters);
    for (std::size_t i = 0; i < r.network.links.size(); ++i)
        r.network.links[i].flits -= warm.network.links[i].flits;
    reduce(r.memory, warm.memory, memory_counters);
    reduce(r.memory_by_rank, warm.memory_by_rank, memory_counters);
    const std::uint64_t begin = to_memory_clocks(r.config, warm.cycles);
    shift(r.memory, begin);
    for (MemoryCounters& m : r.memory_by_rank)
        shift(m, begin);
    reduce_traffic(r.traffic, warm.traffic);
}

} // namespace sim
