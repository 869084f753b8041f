// A run's frames, one after the other, and the part of it that counts.
#include "sim/machine/engine.h"
#include "sim/machine/frame_end.h"
#include "sim/machine/warm_up.h"
#include "sim/trace/recorder.h"

#include <algorithm>

namespace sim {

/// All workers begin at cycle `t`, before which everything is at rest.
void Engine::begin_part(cycle t) {
    for (Hart& h : harts_) {
        h.account(h.accounted, t, Cause::idle);
        h.accounted = h.now = t;
        h.bound = Due(t, Cause::idle);
        enter(h, 0);
        if (h.worker < 0)
            continue;
        h.finished = false;
        const auto work = [this, &h] {
            running_hart = &h;
            worker_(h.worker);
            if (warming_) {
                h.now = passing(h);
                h.accounted = std::max(h.accounted, h.now);
            }
            h.finished = true;
        };
        h.tile->scheduler.add(h.number, t, work, [&h] { h.prefetch(); });
    }
    cycles_ = t;
}

/// Intervals, and lines that count as touched, begin here.
void Engine::begin_counting() {
    lines_.forget_touched();
    if (recorder_ != nullptr)
        recorder_->start(cycles_);
    begin_owners();
    intervals_.begin(cycles_, sums());
    if (intervals_.wanted())
        for (Hart& h : harts_)
            h.begin_intervals(cycles_, intervals_.length());
}

Report Engine::run() {
    Report warm;
    const int parts = options_.frames + (options_.next_part ? 1 : 0);
    begin_part(0);
    for (int part = 0;; ++part) {
        const bool last = part + 1 == parts;
        if (last)
            begin_counting();
        run_workers();
        const cycle served = window_end_;
        finish_part();
        if (recorder_ != nullptr && last)
            recorder_->end(cycles_, served);
        if (part + 1 >= options_.frames && !last)
            judge_prefetches();
        else
            finish_frame();
        if (last)
            break;
        cycle quiet = std::max({cycles_, window_end_, beyond_->drain()});
        for (const Tile& tile : tiles_)
            for (unsigned level = 1; level < tile_levels_; ++level)
                for (const Cache& cache : tile.caches[level])
                    quiet = std::max(quiet, cache.quiet());
        for (const SharedCache& shared : beyond_->caches())
            quiet = std::max(quiet, shared.cache.quiet());
        begin_part((quiet + window_cycles_ - 1) / window_cycles_ * window_cycles_);
        if (part + 2 == parts) {
            beyond_->count_from(cycles_);
            warm = report();
        }
        if (part + 1 >= options_.frames)
            options_.next_part();
        else if (options_.next_frame)
            options_.next_frame(part + 1);
    }
    beyond_->finish();
    Report r = report();
    finish_owners(r);
    r.all_vops = r.core.vops;
    r.all_instructions = r.core.instructions;
    if (parts > 1)
        take_away(r, warm);
    add_intervals(r);
    return r;
}

void Engine::serve_all() {
    settle_tiles();
    for (Tile& tile : tiles_)
        beyond_->accept(tile.leaving.requests);
    beyond_->serve(Beyond::everything);
}

/// The workers have returned: what they began is completed.
void Engine::finish_part() {
    serve_all();
    for (unsigned level = 1; level < tile_levels_; ++level)
        for (const Tile& tile : tiles_)
            for (const Cache& cache : tile.caches[level])
                misplaced_lines_ += cache.misplaced();
    misplaced_lines_ += beyond_->misplaced();
    if (const Coherence* coherence = beyond_->coherence())
        incoherent_lines_ += coherence->incoherent();
    for (Hart& h : harts_) {
        settle_loads(h);
        await_stores(h);
        if (h.complete.at() > h.accounted) {
            h.account(h.accounted, h.complete.at(), h.complete.why());
            h.accounted = h.complete.at();
        }
        h.finish = h.accounted;
        cycles_ = std::max(cycles_, h.accounted);
    }
    for (Hart& h : harts_) {
        h.account(h.accounted, cycles_, Cause::idle);
        h.accounted = cycles_;
        if (h.interval != 0)
            h.close_interval();
    }
    at_end_ = sums();
}

void Engine::judge_prefetches() {
    for (Tile& tile : tiles_) {
        for (Core& core : tile.cores)
            core.l1.judge_prefetches();
        for (unsigned level = 1; level < tile_levels_; ++level)
            for (Cache& cache : tile.caches[level])
                cache.judge_prefetches();
    }
    beyond_->judge_prefetches();
}

/// Dirty lines of data that outlives the frame are written back; those of transient data as sim.frame_end
/// says.
void Engine::finish_frame() {
    const bool all = config_.sim.frame_end == "write";
    const auto lasting = [this, all](std::uint64_t address) {
        const isa::region* r = space_.find(address);
        return all || (r != nullptr && !r->transient);
    };
    std::size_t frame_end = labels_.phases.size() - 1; // of the first kind
    write_back_all(tiles_, *beyond_, cycles_, frame_end, lasting, [this] {
        serve_all();
        if (recorder_ != nullptr)
            recorder_->settled();
    });
}

} // namespace sim
