#include "sim/replay/replay_machine.h"

#include "sim/config/error.h"
#include "sim/machine/frame_end.h"
#include "sim/machine/windows.h"
#include "sim/replay/addresses.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace sim {
namespace {

bool uses_strides(const Config& config) {
    for (unsigned level = 0; level < config.cache_levels(); ++level)
        if (config.cache(level).prefetcher == "stride")
            return true;
    return false;
}

/// The first level that a trace of this one drives.
unsigned level_of(const traces::Description& about, const Config& config) {
    if (about.level.empty() || about.level == "core")
        return 0;
    if (about.level == "dram")
        return config.cache_levels();
    for (unsigned level = 1; level <= config.cache_levels(); ++level)
        if (about.level == fmt::format("l{}", level))
            return level;
    throw traces::Error(
        fmt::format("the trace is of what passes level {}, which this machine does not have; give one that "
                    "has more levels than {}, or a trace of level core, l1 to l{}, or dram",
                    about.level, config.cache_levels(), config.cache_levels()));
}

/// The most memory that regions may take, which tables are made for.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 40U;

} // namespace

ReplayMachine::ReplayMachine(const Config& config, const traces::Description& about, Labels labels)
    : config_(config), labels_(std::move(labels)), regions_(about.regions), by_reference_(regions_.empty()),
      strides_(uses_strides(config)),
      line_shift_(static_cast<unsigned>(std::countr_zero(wide(config.l1.line_bytes)))),
      tile_levels_(config.tile_levels()), window_cycles_(sim::window_cycles(config)),
      reach_(reach_cycles(config)), shortest_answer_(shortest_answer(config)),
      shortest_line_(shortest_line(config)), l1_latency_(wide(config.l1.latency)) {
    level_ = level_of(about, config);
    of_shared_level_ = level_ > tile_levels_ && about.level != "dram";
    memory_ = of_shared_level_ || about.level == "dram";
    passing_latency_ = level_ == 0 ? 0 : wide(config.cache(level_ - 1).latency);
    if (is_memory())
        line_shift_ = static_cast<unsigned>(std::countr_zero(wide(config.last_cache().line_bytes)));
    std::vector<std::string> names = about.structures;
    std::vector<LineMap::Extent> extents;
    std::uint64_t end = CompactAddresses::end;
    if (by_reference_) {
        names.resize(std::max(names.size(), most_replayed_structures));
    } else {
        // The last structure's is not of the frame's memory.
        const bool spill = regions_.back().structure + 1U == names.size();
        end = spill ? regions_.back().begin : regions_.back().end;
        if (end > most_bytes)
            throw ConfigError("the trace's regions take more than a TiB; record the trace again");
        for (const traces::Description::Region& r : regions_)
            if (r.begin < end)
                extents.push_back({r.end, r.structure});
    }
    lines_.emplace(extents, std::move(names), end, line_shift_);
    beyond_ = Beyond::make(config, [this](std::uint32_t tile, cycle ticket, const Answer& answer) {
        tiles_[tile].tickets.answer(ticket, answer.ready, answer.from);
    });
    for (integer t = 0; t < config.chip.tiles; ++t) {
        Tile& tile = tiles_.emplace_back(config, static_cast<std::uint32_t>(t), window_cycles_, *lines_,
                                         labels_.columns());
        for (integer c = 0; c < config.chip.cores; ++c) {
            Core& core = tile.add_core(config, 0);
            if (level_ == 0)
                for (integer i = 0; i < config.chip.threads; ++i)
                    seats_.push_back({&tile, &core, static_cast<std::size_t>(c), &core.l1});
        }
        if (tile.events)
            tile.events->tell([](cycle, const Cache*) {});
        if (is_memory())
            seats_.push_back({&tile, nullptr, 0, nullptr});
        if (level_ == 0 || is_memory())
            continue;
        const std::size_t sharing = level_ == 1 ? 1 : tile.sharing[level_ - 1];
        for (std::size_t c = 0; c < tile.cores.size(); c += sharing)
            seats_.push_back(
                {&tile, &tile.cores[c], c, level_ == 1 ? &tile.cores[c].l1 : &tile.cache_of(level_ - 1, c)});
    }
    sites_.resize(tiles_.size());
    beyond_->connect(tiles_);
    if (is_memory())
        window_end_ = latest_cycle; // there is nobody who would have to wait for one
    else
        open_window(window_cycles_, 0);
}

void ReplayMachine::set_floors(cycle served) {
    const Floors floors{served + shortest_answer_, served + shortest_line_}; // what follows comes later
    for (Tile& tile : tiles_)
        if (tile.events)
            tile.events->set_floors(floors);
        else
            tile.tickets.set_floors(floors);
}

void ReplayMachine::open_window(cycle until, cycle served) {
    if (tiles_.front().events)
        finish_windows(served);
    else if (served != 0)
        serve(served);
    settle_stand_ins();
    window_end_ = until;
    const cycle begin = until - std::min(until, window_cycles_);
    earliest_ = begin > reach_ ? begin - reach_ : 0;
    set_floors(served);
    for (Tile& tile : tiles_) {
        if (tile.events)
            tile.events->try_again();
        tile.earliest = earliest_;
        if (tile.tickets.size() >= 4096)
            tile.tickets.forget(earliest_);
    }
}

/// What levels below have not asked for by the end of a window: in the reference mode they may do so later;
/// else this is another machine than the trace's, which did not ask, and what was changed goes down.
void ReplayMachine::settle_stand_ins() {
    std::vector<std::pair<Cache*, std::uint64_t>> changed;
    each_stand_in([&](const Seat& s, std::uint64_t address, bool dirty) {
        if (dirty)
            changed.emplace_back(s.cache, address);
    });
    for (const auto& [cache, address] : changed)
        if (tiles_.front().events)
            cache->stand_in(address, true, true);
        else
            cache->send_back(address, earliest_, 0);
}

void ReplayMachine::come_to(cycle t) {
    const cycle until = (t / window_cycles_ + 1) * window_cycles_, begin = until - window_cycles_;
    open_window(until, begin);
}

/// What left the tiles is answered, as far as it can be by then.
void ReplayMachine::serve(cycle end) {
    for (Tile& tile : tiles_)
        if (!tile.leaving.requests.empty())
            beyond_->accept(tile.leaving.requests);
    beyond_->serve(end);
}

void ReplayMachine::serve_all() {
    if (tiles_.front().events)
        settle_tiles();
    serve(Beyond::everything);
}

/// The site of the access at hand, for prefetchers; numbered by its first one in the tile that took place.
void ReplayMachine::note_site(Tile& tile, const ReplayAction& a) {
    tile.site = {};
    if (a.part == traces::Part::aside || a.site == 0)
        return;
    SiteNumbers& numbers = sites_[tile.number];
    const auto next = static_cast<std::uint32_t>(numbers.size());
    if (a.refused) {
        const auto found = numbers.find(a.site);
        tile.site.number = found != numbers.end() ? found->second : next;
    } else {
        tile.site.number = numbers.try_emplace(a.site, next).first->second;
    }
    tile.site.first = a.part == traces::Part::operation;
}

Answer ReplayMachine::perform_other(const ReplayAction& a, const Seat& s, std::uint64_t address,
                                    std::uint32_t bytes, cycle t) {
    using What = ReplayAction::What;
    if (a.what == What::pass)
        return pass(a, s, address, bytes, t);
    const Asker who{*s.tile, s.number, a.column};
    const auto line_bytes = static_cast<std::uint32_t>(config_.l1.line_bytes);
    switch (a.what) {
    case What::change: {
        s.tile->site = {};
        Access change{address, line_bytes, t + l1_latency_, a.column};
        change.modify = change.owned = true;
        change.asker = s.core->l1.number();
        return s.core->words.read(change);
    }
    case What::release: {
        Access release{address, line_bytes, t + l1_latency_, a.column};
        release.forced = release.owned = true;
        release.asker = s.core->l1.number();
        s.core->words.write(release);
        claim_line(config_, who, address, t);
        break;
    }
    case What::prefetch:
        ++s.core->l1.counters().busy_cycles;
        s.tile->site = {};
        s.core->l1.prefetch(address, t, a.column);
        break;
    case What::discard:
        discard(a, s, address, bytes, t);
        break;
    case What::invalidate:
    case What::invalidate_all:
        drop_copies(config_, tiles_, who, address, t, a.what == What::invalidate_all);
        if (a.part == traces::Part::access) // of a change; a release follows otherwise
            claim_line(config_, who, address, t);
        break;
    default:
        break;
    }
    return {t, Cause::l1};
}

/// Whole lines of these bytes.
void ReplayMachine::discard(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes,
                            cycle t) {
    const std::uint64_t end = address + bytes, first = (address + (1U << line_shift_) - 1) >> line_shift_;
    for (std::uint64_t line = first; line < end >> line_shift_; ++line) {
        s.core->l1.discard(line << line_shift_);
        discard_below(config_, {*s.tile, s.number, a.column}, line << line_shift_, address, end, t);
    }
}

void ReplayMachine::settle(cycle served) {
    if (is_memory()) {
        end_ = beyond_->drain();
        return;
    }
    if (tiles_.front().events)
        finish_windows(served);
    else
        serve(served);
    serve_all();
    end_ = std::max(end_, served);
    for (unsigned level = 1; level < tile_levels_; ++level)
        for (const Tile& tile : tiles_)
            for (const Cache& cache : tile.caches[level])
                misplaced_ += cache.misplaced();
    misplaced_ += beyond_->misplaced();
    if (const Coherence* coherence = beyond_->coherence())
        incoherent_ += coherence->incoherent();
}

bool ReplayMachine::lasts(std::uint64_t address) const {
    const auto after =
        std::upper_bound(regions_.begin(), regions_.end(), address,
                         [](std::uint64_t at, const traces::Description::Region& r) { return at < r.begin; });
    return after != regions_.begin() && address < (after - 1)->end && (after - 1)->lasts;
}

void ReplayMachine::end_frame(cycle t) {
    end_ = t;
    const bool all = config_.sim.frame_end == "write";
    each_stand_in([](const Seat&, std::uint64_t, bool) {});
    write_back_all(
        tiles_, *beyond_, t, labels_.phases.size() - 1,
        [this, all](std::uint64_t address) { return all || lasts(address); }, [this] { serve_all(); });
}

void ReplayMachine::settle_level() {
    serve_all();
}

Report ReplayMachine::finish() {
    beyond_->finish();
    Report r;
    r.config = config_;
    r.labels = labels_;
    r.structures = lines_->structures();
    r.cycles = end_;
    r.window = window_cycles_;
    std::vector<const Attribution*> attributions;
    for (const Tile& tile : tiles_)
        attributions.push_back(&tile.attribution);
    r.traffic = Attribution::traffic(attributions);
    r.network = beyond_->network().report();
    r.memory = beyond_->counters();
    r.memory_by_rank = beyond_->rank_counters();
    for (const Tile& tile : tiles_) {
        for (const Core& core : tile.cores)
            r.l1.push_back(level_ == 0 ? core.l1.counters() : CacheCounters{});
        for (unsigned level = 1; level < tile_levels_; ++level)
            for (const Cache& cache : tile.caches[level])
                r.caches(level).push_back(cache.counters());
        for (const Jitter& jitter : tile.jitters) {
            r.jitter.lines += jitter.lines();
            r.jitter.cycles += jitter.cycles();
        }
    }
    for (const SharedCache& shared : beyond_->caches())
        r.caches(tile_levels_).push_back(shared.cache.counters());
    if (const Coherence* coherence = beyond_->coherence())
        r.coherence = coherence->counters();
    r.misplaced_lines = misplaced_;
    r.incoherent_lines = incoherent_;
    return r;
}

} // namespace sim
