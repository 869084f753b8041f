// A sampled run's way between the units that are simulated in detail: values are real, every reference goes
// through TLBs and caches, predictors learn and words pass from thread to thread, but nothing is busy and
// memory answers at once. What a thread does takes what the sampler says of its kind of work, so that threads
// meet about as they would. Deviates from the detailed mode in that threads run by turns of some hundred
// cycles, that rows of memory stay as they are and that stores pass by the store buffer. Traffic is not told
// apart by what it is of.
#include "sim/machine/issue.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

/// Cycles, at the least, for which one thread after the other runs by itself.
constexpr cycle turn_cycles = 400;

std::uint32_t in_256ths(double cycles) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(cycles, 0.0, 1e6) * 256));
}

} // namespace

/// Where a thread's time has come.
cycle Engine::passing(const Hart& h) const {
    const std::int64_t left = h.ahead / h.core->passed_a_cycle;
    return static_cast<cycle>(
        std::max(static_cast<std::int64_t>(window_end_) - left, static_cast<std::int64_t>(h.now)));
}

/// The thread has come to the end of the window: others run.
void Engine::pause(Hart& h) {
    h.now = passing(h);
    {
        Away away(h);
        h.tile->scheduler.yield(Scheduler::key(h.now, h.number));
    }
    if (warming_)
        come_to(h);
}

/// A shared word is acted on at once.
void Engine::begin_passing(Hart& h, bool writes, bool modifies, std::uint64_t address) {
    pass(h, writes ? store_kind : load_kind, 1);
    h.ahead -= static_cast<std::int64_t>(word_pace_);
    h.now = passing(h);
    translated(h, address, address + 3, h.now);
    count(h, 1, false);
    ++h.counters.atomics;
    h.acting = Due(h.now, Cause::synchronise);
    h.asked = h.now;
    if (modifies && writes) {
        ++h.counters.modifications;
        h.tile->site = {};
        Access change{address, line_bytes_, h.now, h.column};
        change.modify = change.owned = true;
        change.asker = h.core->l1.number();
        h.core->words.read(change);
    }
    homes_.note(address, h.tile->number, writes ? Homes::Use::writes : Homes::Use::looks);
}

void Engine::begin_warming() {
    warming_ = true;
    notes_accesses_ = true; // by way of warm_line()
    buffered_ = false;
    for (Tile& tile : tiles_) {
        tile.tickets.set_at_once(true);
        tile.attribution.set_idle(true);
    }
}

/// Threads go on in detail from where they have come.
void Engine::end_warming() {
    warming_ = false;
    notes_accesses_ = notes_sites_;
    buffered_ = config_.core.store_buffer > 0;
    for (Tile& tile : tiles_) {
        tile.tickets.set_at_once(false);
        tile.attribution.set_idle(false);
    }
    for (Hart& h : harts_) {
        if (h.worker < 0 || h.finished || h.waits_for != nullptr)
            continue;
        h.bound.later(Due(h.now, Cause::busy));
        h.issued = std::max(h.issued, h.now);
        h.accounted = std::max(h.accounted, h.now);
    }
}

/// As run_window(), but longer.
bool Engine::warm_window() {
    find_active_tiles();
    const cycle next = next_event();
    if (next == ~cycle{0})
        return false;
    const cycle windows = (turn_cycles + window_cycles_ - 1) / window_cycles_;
    const cycle begin = std::max(window_end_, next / window_cycles_ * window_cycles_);
    window_end_ = begin + windows * window_cycles_;
    set_floors(next);
    forget_before(begin);
    for (Hart& h : harts_)
        come_to(h);
    run_tiles();
    end_window();
    return true;
}

/// The next window, in the way that the sampler wants.
bool Engine::run_sampled_window() {
    if (!(warming_ ? warm_window() : run_window()))
        return false;
    if (window_end_ < sampler_->next())
        return true;
    sampler_->come_to(window_end_, work_so_far());
    if (sampler_->warms() != warming_)
        warming_ ? end_warming() : begin_warming();
    set_paces();
    return true;
}

/// What work takes, from what the sampler knows by now.
void Engine::set_paces() {
    const SampledCosts& costs = sampler_->costs();
    const std::size_t phases = labels_.phases.size();
    paces_.resize(labels_.columns());
    for (std::size_t column = 0; column < paces_.size(); ++column)
        paces_[column] =
            in_256ths(costs[sampler_->builds(column % phases) ? SampledWork::builds : SampledWork::others]);
    miss_paces_.fill(in_256ths(costs[SampledWork::misses]));
    miss_paces_[static_cast<std::size_t>(Cause::memory)] =
        in_256ths(costs[SampledWork::misses] + costs[SampledWork::lines]);
    word_pace_ = in_256ths(costs[SampledWork::words]);
    std::size_t number = 0;
    for (Tile& tile : tiles_)
        for (Core& core : tile.cores)
            core.passed_a_cycle = std::max<std::int64_t>(1, std::llround(256 / sampler_->pace(number++)));
    for (Hart& h : harts_)
        h.pace = paces_[h.column];
}

/// But for misses and lines, of which nobody counts by thread.
void Engine::add_work(const Hart& h, SampledWork& done) const {
    const std::size_t phases = labels_.phases.size();
    cycle without = 0;
    for (std::size_t i = 0; i < h.columns.size(); ++i) {
        const Hart::Column& column = h.columns[i];
        done.of[sampler_->builds(i % phases) ? SampledWork::builds : SampledWork::others] +=
            static_cast<double>(column.instructions);
        for (std::size_t c = 0; c < cause_count; ++c)
            if (c != static_cast<std::size_t>(Cause::idle))
                without += column.stack[c];
    }
    done.spent += static_cast<double>(without - h.slept);
    done.of[SampledWork::words] += static_cast<double>(h.counters.atomics);
}

WorkByCore Engine::work_so_far() const {
    WorkByCore w;
    for (const Tile& tile : tiles_) {
        for (const Core& core : tile.cores) {
            SampledWork& done = w.cores.emplace_back();
            done.of[SampledWork::misses] = static_cast<double>(core.l1.counters().misses);
            for (const Hart* h : tile.harts)
                if (h->core == &core)
                    add_work(*h, done);
        }
        for (const Cache& cache : tile.caches[tile_levels_ - 1])
            w.lines += static_cast<double>(cache.counters().misses);
    }
    return w;
}

Estimate Engine::estimate() const {
    return sampler_->estimate(cycles_, work_so_far());
}

} // namespace sim
