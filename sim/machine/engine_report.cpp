// What a run has counted: sums while it lasts, and the report.
#include "sim/machine/engine.h"

#include <algorithm>

namespace sim {

/// What has been counted so far.
Interval Engine::sums() const {
    Interval s;
    for (const Hart& h : harts_)
        for (const Hart::Column& column : h.columns) {
            s.vops += column.vops;
            s.instructions += column.instructions;
        }
    for (const Tile& tile : tiles_) {
        for (const Core& core : tile.cores) {
            s.l1_accesses += core.l1.counters().reads + core.l1.counters().writes;
            s.l1_misses += core.l1.counters().misses;
        }
        for (const Cache& l2 : tile.caches[1]) {
            s.l2_accesses += l2.counters().reads + l2.counters().writes;
            s.l2_misses += l2.counters().misses;
        }
    }
    const MemoryCounters memory = beyond_->counters();
    s.memory_reads = memory.reads;
    s.memory_writes = memory.writes;
    s.network_bytes = beyond_->network().counters().bytes;
    return s;
}

Report Engine::report() const {
    Report r;
    r.config = config_;
    r.host_threads = host_threads_.count();
    r.labels = labels_;
    r.structures = lines_.structures();
    r.workers = workers_;
    r.cycles = cycles_;
    r.window = window_cycles_;
    std::vector<const Attribution*> attributions;
    for (const Tile& tile : tiles_)
        attributions.push_back(&tile.attribution);
    r.traffic = Attribution::traffic(attributions);
    r.touched = lines_.touched();
    r.touched_last = lines_.touched(static_cast<std::size_t>(
        std::max(config_.last_cache().line_bytes / config_.l1.line_bytes, integer{1})));
    r.network = beyond_->network().report();
    r.memory = beyond_->counters();
    r.memory_by_rank = beyond_->rank_counters();
    for (const Tile& tile : tiles_) {
        r.memory.reads += tile.leaving.reads_at_once;
        r.memory.writes += tile.leaving.writes_at_once;
    }
    r.work.resize(labels_.columns());
    for (const Tile& tile : tiles_) {
        for (const Jitter& jitter : tile.jitters) {
            r.jitter.lines += jitter.lines();
            r.jitter.cycles += jitter.cycles();
        }
        for (unsigned level = 1; level < tile_levels_; ++level)
            for (const Cache& cache : tile.caches[level])
                r.caches(level).push_back(cache.counters());
        for (const Core& core : tile.cores) {
            r.l1.push_back(core.l1.counters());
            r.port_instructions.push_back(core.port_instructions);
            if (core.mmu)
                r.tlb.push_back(core.mmu->counters);
        }
        for (const SharedUnit& unit : tile.shared_units)
            r.shared_unit_cycles.push_back(unit.busy_cycles);
    }
    auto threads = static_cast<int>(config_.chip.threads);
    for (const Hart& h : harts_) {
        for (const auto& row : core_counters)
            r.core.*row.count += h.counters.*row.count;
        for (std::size_t k = 0; k < issue_kinds; ++k)
            r.by_kind[k] += h.by_kind[k];
        int number = static_cast<int>(h.number);
        ThreadReport t;
        for (std::size_t i = 0; i < labels_.columns(); ++i) {
            const Hart::Column& column = h.columns[i];
            r.work[i].vops += column.vops;
            r.work[i].instructions += column.instructions;
            r.core.vops += column.vops;
            t.instructions += column.instructions;
            t.stacks.push_back(column.stack);
        }
        r.core.instructions += t.instructions;
        r.core.lane_slots += h.vector_instructions * piece_lanes_;
        t.worker = h.worker;
        t.tile = static_cast<int>(h.tile->number);
        t.core = number / threads;
        t.thread = number % threads;
        t.finish = h.finish;
        r.threads.push_back(std::move(t));
    }
    r.drained = std::max({r.cycles, to_core_cycles(config_, static_cast<integer>(r.memory.last_clock)),
                          beyond_->network().quiet()});
    for (const Tile& tile : tiles_)
        for (unsigned level = 1; level < tile_levels_; ++level)
            for (const Cache& cache : tile.caches[level])
                r.drained = std::max(r.drained, cache.quiet());
    r.misplaced_lines = misplaced_lines_;
    r.incoherent_lines = incoherent_lines_;
    if (const Coherence* coherence = beyond_->coherence())
        r.coherence = coherence->counters();
    for (const SharedCache& shared : beyond_->caches()) {
        r.caches(tile_levels_).push_back(shared.cache.counters());
        r.drained = std::max(r.drained, shared.cache.quiet());
    }
    return r;
}

void Engine::add_intervals(Report& r) {
    r.interval = intervals_.length();
    std::vector<const TileIntervals*> series;
    for (const Tile& tile : tiles_)
        series.push_back(&tile.intervals);
    r.intervals = intervals_.finish(r.cycles, at_end_, r.drained, sums(), series);
}

} // namespace sim
