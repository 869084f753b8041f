#include "sim/machine/engine.h"

#include "sim/config/placement.h"
#include "sim/trace/line_sharing.h"
#include "sim/trace/recorder.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>

namespace sim {

Engine* running_engine = nullptr;
constinit thread_local Hart* running_hart = nullptr;

void come_back_as(Hart* h) {
    running_hart = h;
}

void Engine::outside(const void* p) {
    fmt::print(stderr, "razor-sim: broken invariant: a kernel touched {}, which is not in frame memory\n", p);
    std::abort();
}

namespace {

unsigned log2(integer x) {
    return static_cast<unsigned>(std::countr_zero(wide(x)));
}

/// Of a thread.
std::uint32_t in_1024ths(double instructions) {
    return static_cast<std::uint32_t>(instructions * 1024.0 + 0.5);
}

std::uint64_t spill_bytes_of(const Config& config) {
    return (wide(config.core.spill_slots) * width * 4 + 4095) / 4096 * 4096;
}

/// Of the L1s, where all lanes are one or two lines whose slots of the ports one word of a calendar can hold.
std::uint32_t lines_of_all_lanes(const Config& config) {
    const std::uint32_t bytes = width * 4, line = narrow(config.l1.line_bytes);
    const std::uint32_t piece = bytes / std::max(1U, width / narrow(config.core.lanes));
    const std::uint32_t slots = bytes / piece * std::max(1U, piece / narrow(config.l1.port_bytes));
    const bool whole = bytes == line || bytes == 2 * line;
    return whole && piece <= line && slots <= 64 ? bytes / line : 0;
}

bool uses_strides(const Config& config) {
    for (unsigned level = 0; level < config.cache_levels(); ++level)
        if (config.cache(level).prefetcher == "stride")
            return true;
    return false;
}

Labels with_frame_end(Labels labels) {
    if (labels.phases.empty())
        labels.phases.emplace_back("all");
    labels.phases.emplace_back("frame end");
    if (labels.kinds.empty())
        labels.kinds.emplace_back("all");
    return labels;
}

} // namespace

Engine::Engine(const Config& config, const isa::address_space& space, int workers, const Labels& labels,
               int host_threads, const RunOptions& options, const std::function<void(int)>& worker)
    : config_(config), pieces_(std::max(1U, width / narrow(config.core.lanes))),
      piece_lanes_(width / pieces_), piece_shift_(log2(piece_lanes_ * 4)),
      issue_shift_(Calendar::log2_group(narrow(config.core.issue_width))),
      port_shift_(Calendar::log2_group(narrow(config.l1.ports))),
      spin_cycles_(
          wide(std::max(config.core.spin_period,
                        (2 * config.chip.threads + config.core.issue_width - 1) / config.core.issue_width))),
      issue_width_(narrow(config.core.issue_width)), line_bytes_(narrow(config.l1.line_bytes)),
      whole_lines_(lines_of_all_lanes(config)), line_shift_(log2(config.l1.line_bytes)),
      port_byte_shift_(log2(config.l1.port_bytes)), l1_latency_(wide(config.l1.latency)),
      tile_levels_(config.tile_levels()), cache_levels_(config.cache_levels()), pairing_(config.core.pairing),
      overhead_(in_1024ths(config.core.scalar_overhead)), scalar_moves_(in_1024ths(config.core.scalar_moves)),
      vector_moves_(in_1024ths(config.core.vector_moves)),
      memory_operands_(narrow(config.core.memory_operands)), registers_(config.core.vector_registers > 0),
      by_register_(registers_ && config.core.broadcasts == "register"), strides_(uses_strides(config)),
      notes_sites_(strides_ || options.recorder != nullptr), notes_accesses_(notes_sites_),
      lane_gather_(config.core.gather == "lane"), lane_scatter_(lane_gather_ || config.lanes.scatter == "on"),
      lane_shuffle_(config.lanes.shuffle == "on"), skip_idle_(config.core.skip_idle == "on"),
      folding_(config.core.address_folding == "on"), buffered_(config.core.store_buffer > 0),
      masked_by_lane_(config.lanes.masked == "on"), idle_lanes_(config.lanes.idle == "test"),
      lane_path_{narrow(config.lanes.piece_instructions),  narrow(config.lanes.piece_references),
                 narrow(config.lanes.gather_instructions), narrow(config.lanes.load_instructions),
                 narrow(config.lanes.load_references),     narrow(config.lanes.store_instructions),
                 narrow(config.lanes.store_references)},
      hold_policy_(config.core.switch_policy == "stall"), tlb_(config.tlb.any()),
      holds_misses_(config.tlb.misses == "stall"), page_shift_(log2(config.tlb.page_bytes)),
      recorder_(options.recorder), in_order_(config.core.window == 1 || hold_policy_),
      prediction_(config.core.predictor == "none"        ? Prediction::none
                  : config.core.predictor == "perfect"   ? Prediction::perfect
                  : config.core.predictor == "taken"     ? Prediction::taken
                  : config.core.predictor == "not_taken" ? Prediction::not_taken
                                                         : Prediction::counters),
      base_(space.base()), window_cycles_(window_cycles(config)), shortest_answer_(shortest_answer(config)),
      shortest_line_(shortest_line(config)), reach_(reach_cycles(config)), space_(space),
      labels_(with_frame_end(labels)),
      tables_(config.tlb.tables()
                  ? std::optional(PageTables(config.tlb, LineMap::end_of(space),
                                             wide(config.all_threads()) * spill_bytes_of(config) +
                                                 isa::address_space::granule))
                  : std::nullopt),
      lines_(space, line_shift_, tables_ ? tables_->bytes() : 0), homes_(space, config.chip.tiles),
      moves_(static_cast<cycle>(config.coherence.remote_cycles),
             static_cast<cycle>(config.coherence.visibility_cycles)),
      beyond_(Beyond::make(config,
                           [this](std::uint32_t tile, cycle ticket, const Answer& answer) {
                               tiles_[tile].tickets.answer(ticket, answer.ready, answer.from);
                           })),
      shuffled_(options.host_order),
      host_threads_(std::min(host_threads, static_cast<int>(config.chip.tiles))), options_(options),
      worker_(worker), intervals_(options.interval, window_cycles_), workers_(workers) {
    describe_kinds();
    if (options.sampling != nullptr) {
        const double instruction =
            static_cast<double>(config.chip.threads) / static_cast<double>(config.core.issue_width);
        const auto line = static_cast<double>(shortest_line_);
        sampler_.emplace(*options.sampling,
                         SampledCosts{instruction, instruction, static_cast<double>(config.l2.latency), line,
                                      static_cast<double>(config.l2.latency)});
        set_paces();
    }
    const std::uint64_t spill_bytes = spill_bytes_of(config);
    bool shares = config.core.shared_classes != "none";
    for (integer t = 0; t < config.chip.tiles; ++t) {
        Tile& tile = tiles_.emplace_back(config, narrow(t), window_cycles_, lines_, labels_.columns());
        for (integer c = 0; c < config.chip.cores; ++c) {
            Core& core = tile.add_core(config, pairing_.ports());
            if (tlb_) {
                if (c % config.cores_sharing_tlb() == 0)
                    tile.second_tlbs.emplace_back(wide(config.tlb.second_entries),
                                                  wide(config.tlb.second_ways));
                core.mmu = std::make_unique<Mmu>(config.tlb, tile.second_tlbs.back());
            }
            if (shares && c % config.core.shared_cores == 0)
                tile.shared_units.emplace_back(tile.earliest);
            core.shared = shares ? &tile.shared_units.back() : nullptr;
            for (integer i = 0; i < config.chip.threads; ++i) {
                auto number = static_cast<std::uint32_t>(harts_.size());
                Hart& h = harts_.emplace_back(number, tile, core, config, labels_.columns());
                if (by_register_)
                    h.machine_registers =
                        std::make_unique<MachineRegisters>(wide(config.core.vector_registers) * pieces_,
                                                           pieces_, wide(config.core.interleaved_values));
                h.spill_base = lines_.spill_begin() + number * spill_bytes;
                tile.harts.push_back(&h);
            }
        }
    }
    trace();
    if (options.owners != nullptr) {
        options.owners->begin(tiles_.size(), width, labels_.phases.size());
        for (Tile& tile : tiles_)
            tile.attribution.charge(*options.owners);
    }
    for (Tile& tile : tiles_) {
        order_.push_back(&tile);
        follow_events(tile);
    }
    beyond_->note_messages(options.messages);
    beyond_->connect(tiles_);
    const Placement placement(config.chip);
    for (int w = 0; w < workers; ++w)
        harts_[wide(placement.number(placement.of(w)))].worker = w;
}

/// What lies where, for who has no frame memory.
std::vector<traces::Description::Region> Engine::regions() const {
    const std::vector<std::string>& names = lines_.structures();
    std::vector<traces::Description::Region> out;
    const auto add = [&](const std::string& name, std::uint64_t begin, std::uint64_t end, bool lasts) {
        const auto number = std::find(names.begin(), names.end(), name) - names.begin();
        out.push_back({begin, end, static_cast<std::uint16_t>(number), lasts});
    };
    for (const isa::region& r : space_.regions())
        if (r.end > r.begin)
            add(r.structure, r.begin, r.end, !r.transient);
    if (tables_)
        add(LineMap::page_tables, LineMap::end_of(space_), lines_.spill_begin(), false);
    add(names.back(), lines_.spill_begin(),
        lines_.spill_begin() + wide(config_.all_threads()) * spill_bytes_of(config_), false);
    return out;
}

/// Tiles, caches and the way to memory note for the recorder what they do.
void Engine::trace() {
    if (recorder_ == nullptr)
        return;
    recorder_->begin(labels_, lines_.structures(), regions());
    for (Tile& tile : tiles_) {
        tile.tap = &recorder_->tap(tile.number);
        tile.attribution.trace(*tile.tap);
        const auto number_all = [&tile](auto& all, auto cache) {
            for (std::size_t i = 0; i < all.size(); ++i)
                cache(all[i]).trace_as(static_cast<std::uint32_t>(tile.number * all.size() + i));
        };
        number_all(tile.cores, [](Core& core) -> Cache& { return core.l1; });
        for (unsigned level = 1; level < tile_levels_; ++level)
            number_all(tile.caches[level], [](Cache& cache) -> Cache& { return cache; });
    }
}

/// In how many cycles so many instructions of a kind issue at the least.
std::uint32_t Engine::span_of(std::size_t kind, std::uint32_t instructions) const {
    auto ports = static_cast<std::uint32_t>(pairing_.of(kind).size());
    std::uint32_t rate = shared_[kind] ? 1 : ports != 0 ? std::min(issue_width_, ports) : issue_width_;
    return (instructions + rate - 1) / rate;
}

/// What an instruction of each kind takes, and for how long.
void Engine::describe_kinds() {
    std::array<bool, class_count> shared = shared_classes(config_.core.shared_classes);
    for (std::size_t kind = 0; kind < issue_kinds; ++kind) {
        std::size_t c = class_of(kind);
        latency_[kind] = narrow(config_.latency[c]);
        interval_[kind] = narrow(config_.interval[c]);
        shared_[kind] = shared[c] && kind % form_kinds == c; // a load takes its own core's adder
        takes_[kind] =
            vector_kind(c) == kind && kind < vector_kind(address_class) ? narrow(config_.instructions[c]) : 1;
        spans_[kind] = span_of(kind, pieces_ * takes_[kind]);
        needs_[kind] = pairing_.ports() != 0 || shared_[kind] ? Needs::several
                       : interval_[kind] > 1                  ? Needs::own_unit
                                                              : Needs::slot;
    }
}

// --- windows

/// Tiles in which something may happen by itself. In the others only what comes from outside does.
void Engine::find_active_tiles() {
    active_.clear();
    for (Tile* tile : order_)
        if (tile->scheduler.unfinished() != 0 || (tile->events && tile->events->busy()))
            active_.push_back(tile);
}

/// The earliest cycle at which anything wants to happen; ~0: never.
cycle Engine::next_event() const {
    cycle next = beyond_->next();
    for (const Tile* tile : active_) {
        next = std::min(next, tile->scheduler.next());
        for (const Tile::Deed& d : tile->deeds)
            next = std::min(next, d.at);
    }
    return next;
}

void Engine::fail(const std::exception_ptr& why) {
    if (!failure_)
        failure_ = why;
}

void Engine::run_tile(Tile& tile) {
    if (!warming_) {
        for (Hart* sleeper : tile.sleepers)
            pass_looks(*sleeper);
        for (Hart* sleeper : tile.sleepers)
            look(*sleeper, window_end_);
    }
    if (tile.scheduler.next() < window_end_)
        tile.scheduler.run(window_end_);
    if (tile.events)
        tile.events->come_to(window_end_);
}

/// What this of so many host threads does of a window: every so many-th tile, then what the others have not
/// begun, from the end.
void Engine::run_shared(std::size_t number, std::size_t threads) {
    const auto run_unclaimed = [this](Tile& tile) {
        if (tile.claimed.load(std::memory_order_relaxed) != window_end_ &&
            tile.claimed.exchange(window_end_, std::memory_order_relaxed) != window_end_)
            run_tile(tile);
    };
    for (std::size_t i = number; i < active_.size(); i += threads)
        run_unclaimed(*active_[i]);
    for (std::size_t i = active_.size(); i-- > 0;)
        run_unclaimed(*active_[i]);
}

void Engine::run_tiles() {
    const auto threads = std::min(static_cast<std::size_t>(host_threads_.count()), active_.size());
    if (threads <= 1) {
        for (Tile* tile : active_)
            run_tile(*tile);
    } else {
        host_threads_.first(static_cast<int>(threads), [this, threads](int number) {
            run_shared(static_cast<std::size_t>(number), threads);
        });
    }
    for (const Tile* tile : active_)
        if (tile->scheduler.failure())
            fail(tile->scheduler.failure());
}

/// Words that several tiles may reach, and pages: in order of (cycle, thread).
void Engine::perform_deeds() {
    std::vector<Tile::Deed> due;
    for (Tile* tile : active_) {
        std::vector<Tile::Deed>& all = tile->deeds;
        if (all.empty())
            continue;
        auto later = std::stable_partition(all.begin(), all.end(),
                                           [&](const Tile::Deed& d) { return d.at < window_end_; });
        due.insert(due.end(), std::make_move_iterator(all.begin()), std::make_move_iterator(later));
        all.erase(all.begin(), later);
    }
    std::sort(due.begin(), due.end(), [](const Tile::Deed& a, const Tile::Deed& b) {
        return std::pair(a.at, a.hart->number) < std::pair(b.at, b.hart->number);
    });
    for (Tile::Deed& d : due) {
        Scheduler& scheduler = d.hart->tile->scheduler;
        if (d.request) {
            try {
                d.request();
            } catch (...) {
                fail(std::current_exception());
                return;
            }
            resume(*d.hart, window_end_);
        } else {
            running_hart = d.hart;
            scheduler.step(d.hart->number);
            if (recorder_ != nullptr)
                recorder_->collect(); // others' caches too have dropped copies
            if (scheduler.failure()) {
                fail(scheduler.failure());
                return;
            }
        }
    }
}

/// A thread that had left goes on at cycle `t`, when the window has ended if it waited for that. What it does
/// to shared words comes after what the others did meanwhile.
void Engine::resume(Hart& h, cycle t) {
    h.now = std::max(h.now, t);
    come_back(h, t);
    h.tile->scheduler.wake(Scheduler::key(t, h.number));
}

/// Those go on whose tickets are answered, or whose L1 may have room.
void Engine::answer_parked(Tile& tile, cycle t, const std::function<bool(const Hart&)>& has_room) {
    std::erase_if(tile.parked, [&](const Tile::Parked& p) {
        Answered a{};
        if (p.ticket != 0 ? !tile.tickets.find(p.ticket, a) : !has_room(*p.hart))
            return false;
        resume(*p.hart, t);
        return true;
    });
}

/// Where caches within tiles act in order of time, threads go on as soon as these have answered.
void Engine::follow_events(Tile& tile) {
    if (tile.events)
        tile.events->tell([this, &tile](cycle t, const Cache* by) {
            answer_parked(tile, t, [&](const Hart& h) {
                return by == nullptr || by->level() != 0 || by == &h.core->l1;
            });
        });
}

/// Drops tickets that lie behind the next operation of every thread of the tile.
void Engine::forget_tickets(Tile& tile) {
    if (tile.tickets.size() < 4096)
        return;
    // Many are of the last loads and stores of threads that others outlive.
    for (Hart* h : tile.harts)
        if (h->finished) {
            settle_loads(*h);
            settle_stores(*h);
        }
    cycle earliest = window_end_;
    for (Hart* h : tile.harts)
        if (h->worker >= 0 && h->waits_for == nullptr && !h->finished)
            earliest = std::min(earliest, begin(*h).at());
    tile.tickets.forget(earliest);
}

/// No request that is not served yet arrives at memory before `arrival`.
void Engine::set_floors(cycle arrival) {
    const Floors floors{arrival + shortest_answer_, arrival + shortest_line_};
    for (Tile* tile : active_)
        if (tile->events)
            tile->events->set_floors(floors);
        else
            tile->tickets.set_floors(floors);
}

/// What the order of the following must not matter for.
void Engine::shuffle() {
    std::shuffle(order_.begin(), order_.end(), shuffled_);
    std::shuffle(active_.begin(), active_.end(), shuffled_);
    for (Tile& tile : tiles_) {
        std::shuffle(tile.deeds.begin(), tile.deeds.end(), shuffled_);
        std::shuffle(tile.leaving.requests.begin(), tile.leaving.requests.end(), shuffled_);
        std::shuffle(tile.parked.begin(), tile.parked.end(), shuffled_);
        std::shuffle(tile.sleepers.begin(), tile.sleepers.end(), shuffled_);
    }
}

/// No operation of a window that begins at cycle `begin` looks further back than this.
void Engine::forget_before(cycle begin) {
    for (Tile& tile : tiles_)
        tile.earliest = begin > reach_ ? begin - reach_ : 0;
}

/// All tiles have come to the window's end: what they left to do then is done, and who waited for it goes on.
void Engine::end_window() {
    if (!failure_)
        perform_deeds();
    serve_window();
    for (Tile* tile : active_) {
        if (!tile->parked.empty())
            answer_parked(*tile, window_end_, [](const Hart&) { return true; });
        forget_tickets(*tile);
        tile->attribution.publish_notes();
    }
}

/// For a trace. Where tiles go on by themselves, nothing happens in the window before cycle `next`; what
/// happens counts from its beginning.
void Engine::note_window(cycle next, cycle served) {
    recorder_->window(window_end_, tiles_.front().events ? next : served);
    for (Tile& tile : tiles_)
        if (tile.events)
            tile.events->take_count();
}

/// Runs the next window in which something happens; false if nothing ever will.
bool Engine::run_window() {
    find_active_tiles();
    cycle next = next_event();
    if (next == ~cycle{0})
        return false;
    const cycle served = window_end_;
    window_end_ = std::max(window_end_ + window_cycles_, (next / window_cycles_ + 1) * window_cycles_);
    if (recorder_ != nullptr)
        note_window(next, served);
    set_floors(next);
    cycle begin = window_end_ - window_cycles_;
    if (intervals_.due(begin))
        intervals_.close(begin, sums());
    forget_before(begin);
    run_tiles();
    if (options_.host_order != 0)
        shuffle();
    if (recorder_ != nullptr)
        recorder_->collect();
    end_window();
    if (recorder_ == nullptr)
        return true;
    recorder_->collect();
    if (LineSharing* const sharing = recorder_->sharing(); sharing != nullptr && sharing->due(window_end_)) {
        const auto cores = wide(config_.chip.cores);
        sharing->look(window_end_, [&](unsigned level, std::uint64_t core, std::uint64_t address) {
            Tile& tile = tiles_[core / cores];
            return level == 0 ? tile.cores[core % cores].l1.holds(address)
                              : tile.cache_of(level, core % cores).holds(address);
        });
    }
    return true;
}

/// What left the tiles in the window is answered, as far as it can be by now.
void Engine::serve_window() {
    for (Tile* tile : order_) // what others take from their caches leaves idle tiles too
        if (!tile->leaving.requests.empty())
            beyond_->accept(tile->leaving.requests);
    beyond_->serve(window_end_);
    set_floors(window_end_);
    for (Tile* tile : active_)
        if (tile->events)
            tile->events->try_again();
}

/// No thread does anything any more: windows go on until nothing is on its way within the tiles.
void Engine::settle_tiles() {
    const auto busy = [this] {
        return std::any_of(tiles_.begin(), tiles_.end(),
                           [](const Tile& t) { return t.events && t.events->busy(); });
    };
    while (busy()) {
        find_active_tiles();
        const cycle next = next_event();
        window_end_ = std::max(window_end_ + window_cycles_, (next / window_cycles_ + 1) * window_cycles_);
        set_floors(next);
        forget_before(window_end_ - window_cycles_);
        for (Tile& tile : tiles_)
            run_tile(tile);
        serve_window();
    }
}

void Engine::run_workers() {
    auto unfinished = [this] {
        return std::any_of(tiles_.begin(), tiles_.end(),
                           [](const Tile& t) { return t.scheduler.unfinished() > 0; });
    };
    while (!failure_ && unfinished())
        if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed))
            fail(std::make_exception_ptr(Stopped()));
        else if (!(sampler_ ? run_sampled_window() : run_window()))
            fail(std::make_exception_ptr(Deadlock(describe_deadlock())));
    if (failure_) {
        for (Tile& tile : tiles_)
            tile.scheduler.cancel();
        std::rethrow_exception(failure_);
    }
}

std::string Engine::describe_deadlock() const {
    std::string who;
    for (const Tile& tile : tiles_)
        for (const Hart* h : tile.sleepers) {
            auto offset =
                static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(h->waits_for) - base_);
            const isa::region* r = space_.find(offset);
            if (who.size() > 400) {
                who += who.ends_with("...") ? "" : ", ...";
                continue;
            }
            who += fmt::format("{}worker {} since cycle {} for a word of {}", who.empty() ? "" : ", ",
                               h->worker, h->acting.at(), r == nullptr ? "unknown memory" : r->structure);
        }
    return fmt::format("deadlock: nobody is left to write what the others wait for: {}", who);
}

} // namespace sim
