#include "sim/memory/cache.h"

#include <algorithm>
#include <utility>

namespace sim {
namespace {

unsigned log2(integer x) {
    return static_cast<unsigned>(std::countr_zero(wide(x)));
}
bool is(const Config& machine, unsigned level, const char* inclusion) {
    return level != 0 && level < machine.cache_levels() && machine.cache(level).inclusion == inclusion;
}
std::size_t sets(const CacheConfig& c) {
    return wide(c.size_bytes / (c.ways * c.line_bytes));
}

/// Within a tile, in order of time.
bool heard(const Config& machine, unsigned level) {
    return machine.sim.mode == "reference" && level < machine.tile_levels();
}

} // namespace

Cache::Cache(const Config& machine, unsigned level, bool last, const cycle& earliest, const SiteAtHand& site,
             Below& below, Tickets& tickets, Attribution& attribution)
    : Cache(machine, machine.cache(level), level, last, earliest, site, below, tickets, attribution) {}

Cache::Cache(const Config& machine, const CacheConfig& config, unsigned level, bool last,
             const cycle& earliest, const SiteAtHand& site, Below& below, Tickets& tickets,
             Attribution& attribution)
    : level_(level), line_shift_(log2(config.line_bytes)),
      bank_shift_(level == 0 ? 0 : log2(config.bank_bytes)),
      port_bytes_(static_cast<std::uint32_t>(machine.l1.port_bytes)), latency_(wide(config.latency)),
      bank_mask_(level == 0 ? 0 : wide(config.banks) - 1), last_(last),
      through_(config.write_policy == "through"), around_(config.write_miss == "around"),
      inclusive_(is(machine, level, "inclusive")), exclusive_(is(machine, level, "exclusive")),
      coherent_(machine.coherence.kept() && level < machine.tile_levels()),
      sends_clean_(is(machine, level + 1, "exclusive")),
      cause_(static_cast<Cause>(static_cast<unsigned>(Cause::l1) + level)), attribution_(&attribution),
      array_(sets(config), wide(config.ways), replacement_of(config.replacement), coherent_),
      traffic_(traffic_of_level[level]),
      banks_(level == 0 ? 0 : wide(config.banks), Calendar("cache bank", earliest)),
      mshrs_(wide(config.mshrs), tickets, heard(machine, level)),
      write_backs_(wide(config.write_back_buffer), tickets, heard(machine, level)),
      prefetcher_(config.prefetcher, static_cast<std::uint32_t>(config.prefetch_degree),
                  wide(config.prefetch_sites)),
      tickets_(tickets), below_(below), site_(site), beyond_(level >= machine.tile_levels()) {
    if (last)
        mshrs_.lift_limit();
    if (machine.sim.miss_causes == "on")
        causes_ = std::make_unique<MissCauses>(wide(config.size_bytes / config.line_bytes));
    special_ = through_ || around_ || coherent_ || causes_ || prefetcher_.kind() != Prefetcher::Kind::none;
}

/// An access that found its line on its way there, or prefetched and not used yet.
Answer Cache::in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present) {
    const Pool::Hold* const hold = mshrs_.find(line, present.ready);
    const bool waits = hold != nullptr;
    if (array_.prefetched(entry)) {
        array_.set_prefetched(entry, false);
        used_prefetched_ = true;
        ++counters_.prefetches_useful;
        counters_.prefetches_late += waits ? 1 : 0;
    }
    if (!waits) {
        array_.set_in_flight(entry, false);
        return present;
    }
    ++counters_.hits_in_flight;
    if (is_ticket(hold->until)) // the line may be there before the access
        return {tickets_.no_earlier(hold->until, present.ready, present.from), hold->cause};
    return {hold->until, hold->cause};
}

/// Sends a line on its way, from the buffer that it has entered at `t`, unless it is refused.
Answer Cache::write_back(CacheArray::Entry entry, cycle t, cycle down, std::size_t column, bool followed,
                         bool forced, bool stays) {
    std::uint64_t line = array_.line(entry);
    std::uint64_t address = line << line_shift_;
    const bool dirty = array_.dirty(entry);
    Access written{address, std::uint32_t{1} << line_shift_, down, column, true, followed, false, forced,
                   !dirty};
    written.owned = true;
    written.stays = stays;
    written.by = this;
    written.asker = number_;
    Answer accepted = below_.write(written);
    if (accepted.refused) {
        note_refused(Passing::write, written, accepted);
        return accepted;
    }
    note_passed(dirty ? traces::Kind::write_back : traces::Kind::clean_back, written);
    if (dirty) {
        ++counters_.write_backs;
        ++(attribution_->cell(address, column).*traffic_.write_backs);
    } else {
        ++counters_.clean_victims;
    }
    if (!last_)
        write_backs_.hold({line, t, accepted.ready, Cause::mshrs});
    return accepted;
}

/// A line is about to leave an inclusive cache: so do its copies above, and what they have changed is here.
void Cache::recall(CacheArray::Entry leaving) {
    const std::uint64_t line = array_.line(leaving);
    if (line == CacheArray::no_line)
        return;
    const std::uint64_t address = line << line_shift_, bytes = std::uint64_t{1} << line_shift_;
    bool dirty = coming_ != nullptr && coming_->recall(address, bytes); // on its way here, to be written back
    for (Cache* c : above_)
        dirty |= c->back_invalidate(address, bytes);
    if (dirty)
        array_.set_dirty(leaving, true);
}

/// Drops all lines of these bytes here, above and between; returns whether any was dirty.
bool Cache::back_invalidate(std::uint64_t address, std::uint64_t bytes) {
    bool dirty = coming_ != nullptr && coming_->recall(address, bytes);
    for (std::uint64_t at = address; at < address + bytes; at += std::uint64_t{1} << line_shift_) {
        for (Cache* c : above_)
            dirty |= c->back_invalidate(at, std::uint64_t{1} << line_shift_);
        CacheArray::Entry entry = array_.find(at >> line_shift_);
        if (entry == CacheArray::none)
            continue;
        dirty |= array_.dirty(entry);
        ++counters_.back_invalidations;
        count_useless(entry);
        array_.drop(entry);
    }
    if (dirty)
        note_held(address, bytes, 0, Passing::held | Passing::changed);
    return dirty;
}

/// Reads the line from below, which is asked at `down`. Whoever was there is written back if it is dirty. To
/// an exclusive level it goes after the read, into the room that this has left.
Answer Cache::fill(std::uint64_t line, cycle t, cycle down, std::size_t column, bool forced, bool to_write,
                   traces::Kind why) {
    CacheArray::Entry entry = array_.victim(line);
    cycle retry = 0;
    if (!last_ && !forced && (retry = mshrs_.take(t)) != t)
        return Answer::later(retry);
    bool moved = inclusive_;
    if (inclusive_) [[unlikely]]
        recall(entry);
    if (leaves_with_news(entry)) {
        if (!last_ && !forced && (retry = write_backs_.take(t)) != t)
            return Answer::later(retry, moved);
        if (!sends_clean_) {
            if (const Answer out = write_back(entry, down, down, column, true, forced); out.refused)
                return Answer::later(out.ready, moved || out.moved);
            array_.set_dirty(entry, false);
            moved = true;
        }
    }
    Access wanted{line << line_shift_, std::uint32_t{1} << line_shift_, down, column};
    wanted.forced = forced;
    wanted.exclusive = to_write;
    wanted.by = this;
    wanted.asker = number_;
    Answer below = below_.read(wanted);
    if (below.refused) {
        note_refused(Passing::read, wanted, below);
        below.moved |= moved;
        return below;
    }
    note_passed(why, wanted);
    if (sends_clean_ && array_.line(entry) != CacheArray::no_line) [[unlikely]]
        write_back(entry, down, down, column, false, true);
    ++counters_.fills;
    mshrs_.hold({line, t, below.ready, below.from, to_write ? Pool::What::line_to_write : Pool::What::line});
    count_useless(entry);
    array_.fill(entry, line);
    array_.set_in_flight(entry, !tickets_.at_once());
    if (below.dirty) [[unlikely]]
        array_.set_dirty(entry, true);
    if (coherent_) [[unlikely]]
        array_.set_shared(entry, below.shared);
    return {below.ready, below.from};
}

void Cache::prefetch(std::uint64_t address, cycle t, std::size_t column) {
    std::uint64_t line = address >> line_shift_;
    if (array_.find(line) != CacheArray::none)
        return;
    if (fill(line, t, t + latency_, column, false, false, traces::Kind::prefetch).refused) {
        ++counters_.prefetches_dropped;
        return;
    }
    ++counters_.prefetches;
    if (causes_)
        causes_->use(line, true);
}

/// An access to an L1, whatever it finds.
Answer Cache::other_access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t,
                           std::size_t column) {
    if (special_)
        return special_access(line, write, accesses, t, column);
    const CacheArray::Entry entry = array_.find(line);
    if (entry == CacheArray::none || array_.in_flight(entry))
        return waiting_access(entry, line, write, accesses, t, column);
    array_.touch(entry);
    if (write)
        array_.set_dirty(entry, true);
    counters_.hits += accesses;
    count_accesses(line, write, accesses, column);
    return {t + latency_, Cause::l1};
}

/// An access to an L1 whose line is not there yet.
Answer Cache::waiting_access(CacheArray::Entry entry, std::uint64_t line, bool write, std::uint32_t accesses,
                             cycle t, std::size_t column) {
    Answer answer{t + latency_, Cause::l1};
    if (entry != CacheArray::none) {
        counters_.hits += accesses;
        array_.touch(entry);
        answer = in_flight(entry, line, answer);
    } else {
        answer = fill(line, t, t + latency_, column, false, false,
                      write ? traces::Kind::write : traces::Kind::read);
        if (answer.refused)
            return answer;
        entry = array_.find(line);
        counters_.hits += accesses - 1;
        count_miss({line << line_shift_, 0, t, column});
    }
    if (write)
        array_.set_dirty(entry, true);
    count_accesses(line, write, accesses, column);
    return answer;
}

/// An access to an L1 that does more than the least.
Answer Cache::special_access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t,
                             std::size_t column) {
    std::uint64_t address = line << line_shift_;
    bool hit = false;
    Answer answer =
        perform({address, std::min(std::uint32_t{1} << line_shift_, accesses * port_bytes_), t, column}, line,
                write, t + latency_, hit);
    if (answer.refused)
        return answer;
    counters_.hits += hit ? accesses : accesses - 1;
    count_accesses(line, write, accesses, column);
    return answer;
}

Answer Cache::serve(const Access& a, bool write) {
    std::uint32_t slots = slots_of(a);
    if (tickets_.at_once()) [[unlikely]] {
        counters_.busy_cycles += slots;
        return act(a, write, a.at);
    }
    Calendar& bank = banks_[(a.address >> line_shift_) & bank_mask_];
    cycle start = bank.find_run(a.at, slots);
    Answer answer = act(a, write, start);
    if (answer.refused)
        return answer;
    bank.mark_run(start, slots);
    quiet_ = std::max(quiet_, start + slots);
    counters_.busy_cycles += slots;
    return answer;
}

cycle Cache::book(const Access& a) {
    std::uint32_t slots = slots_of(a);
    cycle start = banks_[(a.address >> line_shift_) & bank_mask_].take_run(a.at, slots);
    quiet_ = std::max(quiet_, start + slots);
    counters_.busy_cycles += slots;
    return start;
}

/// What becomes of an access that its bank begins with at `start`.
Answer Cache::act(const Access& a, bool write, cycle start) {
    bool hit = false;
    Answer answer = perform(a, a.address >> line_shift_, write, start + latency_, hit);
    if (answer.refused)
        return answer;
    count_access(a, write, hit);
    return answer;
}

void Cache::count_access(const Access& a, bool write, bool hit) {
    counters_.hits += hit ? 1 : 0;
    Traffic& cell = attribution_->cell(a.address, a.column);
    ++(write ? counters_.writes : counters_.reads);
    ++(cell.*(write ? traffic_.writes : traffic_.reads));
}

Answer Cache::pass(const Access& a) {
    count_access(a, true, true);
    return {a.at + latency_, cause_};
}

bool Cache::came_dirty(std::uint64_t address) {
    const CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry != CacheArray::none)
        array_.set_dirty(entry, true);
    return entry != CacheArray::none;
}

void Cache::send_back(std::uint64_t address, cycle t, std::size_t column) {
    Access written{address, std::uint32_t{1} << line_shift_, t, column, true};
    written.owned = written.forced = true;
    written.by = this;
    written.asker = number_;
    below_.write(written);
    note_passed(traces::Kind::write_back, written);
    ++counters_.write_backs;
    ++(attribution_->cell(address, column).*traffic_.write_backs);
}

/// A read of an exclusive cache.
Answer Cache::move_up(const Access& a, CacheArray::Entry entry, std::uint64_t line, cycle done) {
    Answer answer{done, cause_};
    if (entry != CacheArray::none) {
        if (array_.in_flight(entry))
            answer = in_flight(entry, line, answer);
        answer.dirty = array_.dirty(entry);
        array_.drop(entry);
        ++counters_.moved_up;
    } else {
        if (cycle room = last_ || a.forced ? a.at : mshrs_.take(a.at); room != a.at)
            return Answer::later(room);
        Access wanted{line << line_shift_, std::uint32_t{1} << line_shift_, done, a.column};
        wanted.forced = a.forced;
        wanted.by = a.by; // who gets it
        wanted.asker = number_;
        answer = below_.read(wanted);
        if (answer.refused) {
            note_refused(Passing::read, wanted, answer);
            return answer;
        }
        note_passed(traces::Kind::read, wanted);
        ++counters_.fills;
        mshrs_.hold({line, a.at, answer.ready, answer.from});
        count_miss(a);
        count_cause(line);
    }
    if (causes_)
        causes_->leave(line);
    return answer;
}

/// What an access does to lines here and below; what hits is there at `done`.
Answer Cache::perform(const Access& a, std::uint64_t line, bool write, cycle done, bool& hit) {
    CacheArray::Entry entry = array_.find(line);
    hit = entry != CacheArray::none;
    if (exclusive_ && !write && !a.modify) [[unlikely]]
        return move_up(a, entry, line, done);
    bool brings = !hit && !(write && around_);
    bool changes = (write && !a.clean) || a.modify;
    bool goes_on = (changes && through_) || (write && !hit && around_);
    if (goes_on && !last_ && !a.forced)
        if (cycle room = write_backs_.take(a.at); room != a.at)
            return Answer::later(room);
    // Others' copies go, and where a write stays here, it needs the right to it.
    const bool writes = coherent_ && (a.exclusive || (changes && !a.owned));
    Answer answer{done, cause_};
    Answer right = answer;
    if (hit) {
        if (writes) [[unlikely]] {
            if (array_.shared(entry) && (a.exclusive || !through_))
                if (right = ask_right(a, entry, line, done); right.refused)
                    return right;
            drop_others(a, entry);
        }
        array_.touch(entry);
        if (changes && !through_)
            array_.set_dirty(entry, true);
        if (array_.in_flight(entry)) [[unlikely]]
            answer = in_flight(entry, line, answer);
        if (coherent_) [[unlikely]]
            answer = writes ? later_of(answer, right) : share_others(a, entry, answer);
    } else if (brings) {
        answer = allocate(a, line, write, done);
        if (answer.refused)
            return answer;
    }
    if (goes_on) {
        Answer accepted = send_on(a, done);
        answer = write ? accepted : answer;
    }
    if (!hit) {
        count_miss(a);
        if (!brings)
            note(kind_of_miss(a, write), a.address, a.at, a.column);
        counters_.written_around += brings ? 0 : 1;
        count_cause(line);
    }
    if (causes_)
        causes_->use(line, !(write && around_));
    if (prefetcher_.kind() != Prefetcher::Kind::none)
        prefetch_after(a, line, brings || std::exchange(used_prefetched_, false), done);
    if (coherent_) [[unlikely]]
        answer.shared = !owns(a.address) || (!a.exclusive && above_hold(a.address, a.by));
    return answer;
}

/// The line of an access that missed comes, and makes room for itself.
Answer Cache::allocate(const Access& a, std::uint64_t line, bool write, cycle done) {
    Answer answer{done, cause_};
    if (write && a.whole && a.bytes >> line_shift_ != 0 &&
        (!coherent_ || a.owned)) { // all of the line comes from above
        CacheArray::Entry entry = array_.victim(line);
        if (inclusive_)
            recall(entry);
        if (leaves_with_news(entry))
            if (const Answer out = write_back(entry, done, done, a.column, false, a.forced); out.refused)
                return Answer::later(out.ready, inclusive_ || out.moved);
        count_useless(entry);
        array_.fill(entry, line);
        note(kind_of_miss(a, write), a.address, a.at, a.column); // nobody below is asked
    } else {
        answer = fill(line, a.at, done, a.column, a.forced, coherent_ && (a.exclusive || write || a.modify),
                      kind_of_miss(a, write));
        if (answer.refused)
            return answer;
    }
    if (((write && !a.clean) || a.modify) && !through_)
        array_.set_dirty(array_.find(line), true);
    return answer;
}

/// A write goes on to the level below.
Answer Cache::send_on(const Access& a, cycle down) {
    Access on{a.address, a.bytes, down, a.column, a.whole, false, false, true};
    on.owned = a.owned;
    on.by = this;
    on.asker = number_;
    Answer accepted = below_.write(on);
    ++counters_.written_through;
    note_passed(traces::Kind::write_through, on);
    if (!last_)
        write_backs_.hold({a.address >> line_shift_, a.at, accepted.ready, Cause::mshrs});
    return accepted;
}

void Cache::count_miss(const Access& a) {
    ++counters_.misses;
    attribution_->count(a.address, traffic_.misses, a.column);
}

/// What has been asked below, for a trace of this level.
void Cache::note_passed(traces::Kind kind, const Access& a) {
    if (attribution_->notes(level_ + 1)) [[unlikely]]
        attribution_->note(level_ + 1, kind, a.address, a.bytes, a.at, a.column,
                           beyond_ ? attribution_->tile() : stream_, Passing::of(a, site_));
}

/// ... and what was not served, though lines below have moved for it.
void Cache::note_refused(Passing::Asks asks, const Access& a, const Answer& refused) {
    if (refused.moved && attribution_->notes(level_ + 1)) [[unlikely]]
        attribution_->note(level_ + 1, traces::Kind::refused, a.address, a.bytes, a.at, a.column,
                           beyond_ ? attribution_->tile() : stream_, Passing::of(a, site_, asks));
}

/// ... and what was here when those below asked.
void Cache::note_held(std::uint64_t address, std::uint64_t bytes, cycle t, std::uint32_t what) {
    if (attribution_->notes(level_ + 1)) [[unlikely]]
        attribution_->note(level_ + 1, traces::Kind::recall, address, static_cast<std::uint32_t>(bytes), t, 0,
                           beyond_ ? attribution_->tile() : stream_,
                           Passing::of(static_cast<Passing::Held>(what)));
}

bool Cache::says_it_holds(std::uint64_t address, cycle t) {
    const bool held = holds(address);
    if (held)
        note_held(address, line_bytes(), t, Passing::held);
    return held;
}

bool Cache::says_it_owns(std::uint64_t address, cycle t) {
    const bool owned = owns(address);
    if (owned)
        note_held(address, line_bytes(), t, Passing::held | Passing::owned);
    return owned;
}

void Cache::stand_in(std::uint64_t address, bool dirty, bool shared) {
    const std::uint64_t line = address >> line_shift_;
    CacheArray::Entry entry = array_.find(line);
    if (entry == CacheArray::none) {
        entry = array_.victim(line);
        array_.fill(entry, line);
        if (coherent_)
            array_.set_shared(entry, shared);
    } else if (coherent_ && !shared) {
        array_.set_shared(entry, false);
    }
    if (dirty)
        array_.set_dirty(entry, true);
}

void Cache::count_cause(std::uint64_t line) {
    if (!causes_)
        return;
    switch (causes_->of(line)) {
    case MissCause::compulsory:
        ++counters_.compulsory;
        break;
    case MissCause::capacity:
        ++counters_.capacity;
        break;
    case MissCause::conflict:
        ++counters_.conflict;
        break;
    case MissCause::coherence:
        ++counters_.coherence;
        break;
    }
}

/// Prefetches stay on their access's side of the end of frame memory.
void Cache::prefetch_after(const Access& a, std::uint64_t line, bool first, cycle down) {
    if (prefetcher_.kind() == Prefetcher::Kind::stride && level_ == 0 && !site_.first)
        return;
    std::uint64_t end = attribution_->spill_begin() >> line_shift_;
    prefetcher_.after(line, first, site_.number, [&](std::uint64_t wanted) {
        if ((wanted < end) != (line < end) || array_.find(wanted) != CacheArray::none)
            return;
        // The line at hand is not yet in the caches above, from where it could be recalled.
        const bool takes_its_place = inclusive_ && array_.line(array_.victim(wanted)) == line;
        if (takes_its_place ||
            fill(wanted, a.at, down, a.column, false, false, traces::Kind::prefetch).refused) {
            ++counters_.prefetches_dropped;
            return;
        }
        array_.set_prefetched(array_.find(wanted), true);
        ++counters_.hardware_prefetches;
        if (causes_)
            causes_->use(wanted, true);
    });
}

void Cache::invalidate(std::uint64_t address, cycle t, std::size_t column) {
    std::uint64_t line = address >> line_shift_;
    CacheArray::Entry entry = array_.find(line);
    if (causes_)
        causes_->invalidate(line, entry != CacheArray::none);
    if (entry == CacheArray::none)
        return;
    ++counters_.invalidations;
    if (inclusive_)
        recall(entry);
    if (array_.dirty(entry))
        write_back(entry, t, t, column, false, true);
    count_useless(entry);
    array_.drop(entry);
}

std::uint64_t Cache::misplaced() const {
    std::uint64_t lines = 0;
    if (inclusive_)
        for (const Cache* c : above_)
            c->each_line([&](std::uint64_t address) { lines += holds(address) ? 0 : 1; });
    if (exclusive_ && above_.size() == 1)
        array_.for_each([&](CacheArray::Entry e) {
            lines += above_.front()->holds(array_.line(e) << line_shift_) ? 1 : 0;
        });
    return lines;
}

void Cache::discard(std::uint64_t address) {
    CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry != CacheArray::none && array_.dirty(entry)) {
        array_.set_dirty(entry, false);
        ++counters_.discarded;
    }
}

} // namespace sim
