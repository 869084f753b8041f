// A cache: a core's L1, whose ports the core books, or a level below it, with banks interleaved by
// line, each busy while it moves what is asked for. A line being filled counts as present; whoever hits it
// waits for the fill. A level is neither inclusive nor exclusive of those above, or
// * inclusive: a line that leaves it leaves all caches above it at that moment, and what was changed there
//   goes with it;
// * exclusive: what the level above evicts comes here, clean or dirty; a line that is read moves up, dirty if
//   it was; one that is not here passes by. Of several caches above, each may have what another has too.
// On a coherent machine (coherence.plain) a line that others may have too is marked as shared, and whoever
// writes it asks below for the right to do so (cache_coherence.cpp).
// Misses are held in MSHRs, evicted dirty lines in a write-back buffer; those of the last cache of a tile
// stand where their times are known, beyond the tile. Not modelled: ports and banks of fills; the network to
// the cores (its time is part of the latency); that a line which must make room before it has come would
// still be on its way; banks and ports of prefetches, and of back-invalidations. What one operation writes of
// a line is written through together, a port's width for each of its accesses. A line written back is
// accepted when its bank has taken it, also where that evicts another dirty line.
#pragma once

#include "sim/config/config.h"
#include "sim/core/calendar.h"
#include "sim/core/host_lines.h"
#include "sim/memory/attribution.h"
#include "sim/memory/below.h"
#include "sim/memory/cache_array.h"
#include "sim/memory/counters.h"
#include "sim/memory/miss_causes.h"
#include "sim/memory/pool.h"
#include "sim/memory/prefetcher.h"
#include "sim/trace/passing.h"

#include <array>
#include <bit>
#include <memory>
#include <vector>

namespace sim {

class Cache final : public Below {
public:
    /// `level`: 0 for an L1. `last`: below it the tile ends.
    Cache(const Config& machine, unsigned level, bool last, const cycle& earliest, const SiteAtHand& site,
          Below& below, Tickets& tickets, Attribution& attribution);

    /// A core's `accesses` accesses to the line (number) at cycle `t`.
    Answer access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t, std::size_t column) {
        if (special_ || !array_.use_recent(line, write)) [[unlikely]]
            return other_access(line, write, accesses, t, column);
        counters_.hits += accesses;
        count_accesses(line, write, accesses, column);
        return {t + latency_, Cause::l1};
    }
    /// Of an L1: whether as many adjacent lines as there are places, from this number on, are all here, and
    /// are not on their way, so that accesses are hits and nothing else; where they are then. Changes
    /// nothing.
    template <std::size_t count>
    bool find_present(std::uint64_t line, std::array<CacheArray::Place, count>& places) const {
        if (special_) [[unlikely]]
            return false;
        for (std::size_t i = 0; i < count; ++i)
            if (!array_.find_present(line + i, places[i]))
                return false;
        return true;
    }
    /// `accesses` accesses to each of these lines.
    template <std::size_t count>
    void use_present(std::uint64_t line, const std::array<CacheArray::Place, count>& places, bool write,
                     std::uint32_t accesses, std::size_t column) {
        counters_.hits += count * accesses;
        (write ? counters_.writes : counters_.reads) += count * accesses;
        for (std::size_t i = 0; i < count; ++i) {
            array_.use(places[i], write);
            Traffic& cell = attribution_->touch((line + i) << line_shift_, column);
            (write ? cell.l1_writes : cell.l1_reads) += accesses;
        }
    }
    /// `upper` lies directly above this one.
    void add_above(Cache& upper) {
        upper.number_ = static_cast<std::uint32_t>(above_.size());
        above_.push_back(&upper);
    }
    /// Among those above the same cache.
    std::uint32_t number() const { return number_; }
    /// Its stream in a trace of what it passes on.
    void trace_as(std::uint32_t stream) { stream_ = stream; }
    /// Its stands for one that is not simulated, of which levels below find what is put here.
    void stand_in(std::uint64_t address, bool dirty, bool shared);
    /// ... until here: visit(address, dirty) is called for what is left.
    template <class Visit> void stand_down(Visit visit) {
        array_.for_each([&](CacheArray::Entry e) {
            const std::uint64_t address = array_.line(e) << line_shift_;
            const bool dirty = array_.dirty(e);
            array_.drop(e);
            visit(address, dirty);
        });
    }
    Below& below() const { return below_; }
    std::uint32_t line_bytes() const { return std::uint32_t{1} << line_shift_; }
    /// This one acts in order of time, on what comes that way.
    void act_on(Coming& coming) { coming_ = &coming; }
    /// Whose traffic follows: of a cache that several tiles share.
    void charge(Attribution& attribution) { attribution_ = &attribution; }
    /// Begins a fill if the line is absent and an MSHR is free.
    void prefetch(std::uint64_t address, cycle t, std::size_t column);

    /// A line of the cache above, or a word.
    Answer read(const Access& a) override { return serve(a, false); }
    /// A line written back from above, or a released word.
    Answer write(const Access& a) override { return serve(a, true); }
    /// For accesses in order of time: takes the access's bank; returns when that begins with it. Then, with
    /// that as its cycle, or one to try again at:
    cycle book(const Access& a);
    Answer serve_booked(const Access& a, bool write) { return act(a, write, a.at); }
    /// A write that is on its way no longer, as the level below recalled its line.
    Answer pass(const Access& a);
    /// A line that was asked for comes dirty, from an exclusive level; false: it is not here any more.
    bool came_dirty(std::uint64_t address);
    /// ... and goes back.
    void send_back(std::uint64_t address, cycle t, std::size_t column);
    /// A shared word in the line was written elsewhere: drops the line, writing it back if it is dirty.
    void invalidate(std::uint64_t address, cycle t, std::size_t column);
    Answer own(const Access& a) override;
    /// ... for accesses in order of time, as serve_booked().
    Answer own_booked(const Access& a) { return give_right(a, a.at); }
    /// What the level below has said of a line that was asked for there: whether it may be written here, and
    /// then above too, where one cache alone has it.
    void settle_right(std::uint64_t address, std::uint64_t bytes, bool shared);
    /// Nobody below has lines of these bytes but this cache: they may be written here, and above where one
    /// cache alone has them.
    void grant(std::uint64_t address, std::uint64_t bytes);
    /// Somebody else writes the lines of these bytes, which leave this cache and those above; returns whether
    /// any was dirty.
    bool lose(std::uint64_t address, std::uint64_t bytes);
    /// Somebody else reads them: they are shared and clean from now on, likewise. One that was dirty in a
    /// last cache counts as written back.
    bool share(std::uint64_t address, std::uint64_t bytes, cycle t, std::size_t column);
    /// For the directory: as below, and a trace says so.
    bool says_it_holds(std::uint64_t address, cycle t);
    bool says_it_owns(std::uint64_t address, cycle t);
    bool holds(std::uint64_t address) const {
        return array_.find(address >> line_shift_) != CacheArray::none;
    }
    /// Whether it may be written at once.
    bool owns(std::uint64_t address) const {
        const CacheArray::Entry entry = array_.find(address >> line_shift_);
        return entry != CacheArray::none && !array_.shared(entry);
    }
    template <class Visit> void each_address(Visit visit) const {
        array_.for_each([&](CacheArray::Entry e) { visit(array_.line(e) << line_shift_); });
    }
    /// Lines that may be written here, but not below, or that another cache above the one below has too: 0.
    std::uint64_t incoherent() const;
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t address);
    /// Lines that were prefetched and not used yet were useless to what counts until now.
    void judge_prefetches() {
        array_.for_each([&](CacheArray::Entry e) {
            count_useless(e);
            array_.set_prefetched(e, false);
        });
    }
    /// The frame is over: `keep(address)` says which dirty lines are written back; all others are dropped.
    template <class Keep> void finish(cycle t, std::size_t column, Keep keep) {
        judge_prefetches();
        array_.for_each([&](CacheArray::Entry e) {
            if (!array_.dirty(e))
                return;
            if (keep(array_.line(e) << line_shift_))
                write_back(e, t, t, column, false, true, true);
            else
                ++counters_.dropped;
            array_.set_dirty(e, false);
            if (sends_clean_ && keep(array_.line(e) << line_shift_)) // it has moved
                array_.drop(e);
        });
    }
    /// What an access of the line (number) looks at comes to the host's caches.
    void bring_set(std::uint64_t line) const { array_.bring_set(line); }
    /// What most accesses touch comes to the host's caches.
    void prefetch_host() const { prefetch_lines(this, &counters_ + 1); }
    CacheCounters& counters() { return counters_; }
    const CacheCounters& counters() const { return counters_; }
    /// Lines that are not where the level's inclusion says: 0. Exclusive ones are looked at below one cache
    /// alone.
    std::uint64_t misplaced() const;
    std::uint64_t latency() const { return latency_; }
    std::uint64_t line_of(std::uint64_t address) const { return address >> line_shift_; }
    Cause cause() const { return cause_; }
    unsigned level() const { return level_; }
    bool coherent() const { return coherent_; }
    /// From this cycle on no bank is busy.
    cycle quiet() const { return quiet_; }

private:
    Cache(const Config& machine, const CacheConfig& config, unsigned level, bool last, const cycle& earliest,
          const SiteAtHand& site, Below& below, Tickets& tickets, Attribution& attribution);
    void count_accesses(std::uint64_t line, bool write, std::uint32_t accesses, std::size_t column) {
        Traffic& cell = attribution_->touch(line << line_shift_, column);
        (write ? counters_.writes : counters_.reads) += accesses;
        (write ? cell.l1_writes : cell.l1_reads) += accesses;
    }
    Answer other_access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t, std::size_t column);
    Answer waiting_access(CacheArray::Entry entry, std::uint64_t line, bool write, std::uint32_t accesses,
                          cycle t, std::size_t column);
    Answer in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present);
    Answer fill(std::uint64_t line, cycle t, cycle down, std::size_t column, bool forced, bool to_write,
                traces::Kind why);
    std::uint64_t begin_of(std::uint64_t address) const { return address >> line_shift_ << line_shift_; }
    void recall(CacheArray::Entry leaving);
    bool back_invalidate(std::uint64_t address, std::uint64_t bytes);
    template <class Visit> void each_line(Visit visit) const { // and of those above
        array_.for_each([&](CacheArray::Entry e) { visit(array_.line(e) << line_shift_); });
        for (const Cache* c : above_)
            c->each_line(visit);
    }
    bool leaves_with_news(CacheArray::Entry e) const {
        return array_.dirty(e) || (sends_clean_ && array_.line(e) != CacheArray::no_line);
    }
    Answer write_back(CacheArray::Entry entry, cycle t, cycle down, std::size_t column, bool followed,
                      bool forced, bool stays = false);
    Answer later_of(Answer a, Answer b) const;
    Answer ask_right(const Access& a, CacheArray::Entry entry, std::uint64_t line, cycle done);
    Answer give_right(const Access& a, cycle start);
    void drop_others(const Access& a, CacheArray::Entry entry);
    Answer share_others(const Access& a, CacheArray::Entry entry, Answer answer);
    bool above_hold(std::uint64_t address, const Cache* but) const;
    Answer special_access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t,
                          std::size_t column);
    Answer serve(const Access& a, bool write);
    Answer act(const Access& a, bool write, cycle start);
    void count_access(const Access& a, bool write, bool hit);
    std::uint32_t slots_of(const Access& a) const {
        return (a.bytes + (1U << bank_shift_) - 1) >> bank_shift_;
    }
    Answer move_up(const Access& a, CacheArray::Entry entry, std::uint64_t line, cycle done);
    Answer perform(const Access& a, std::uint64_t line, bool write, cycle done, bool& hit);
    Answer allocate(const Access& a, std::uint64_t line, bool write, cycle done);
    Answer send_on(const Access& a, cycle down);
    void prefetch_after(const Access& a, std::uint64_t line, bool first, cycle down);
    void count_cause(std::uint64_t line);
    /// A line that goes to or comes from below, for a trace of this level.
    void note(traces::Kind kind, std::uint64_t address, cycle t, std::size_t column,
              std::uint32_t detail = 0) {
        attribution_->note(level_ + 1, kind, address >> line_shift_ << line_shift_,
                           std::uint32_t{1} << line_shift_, t, column,
                           beyond_ ? attribution_->tile() : stream_, detail);
    }
    void note_passed(traces::Kind kind, const Access& a);
    void note_refused(Passing::Asks asks, const Access& a, const Answer& refused);
    void note_held(std::uint64_t address, std::uint64_t bytes, cycle t, std::uint32_t what);
    static traces::Kind kind_of_miss(const Access& a, bool write) {
        return a.modify ? traces::Kind::modify : write ? traces::Kind::write : traces::Kind::read;
    }
    void count_miss(const Access& a);
    void count_useless(CacheArray::Entry leaving) {
        counters_.prefetches_useless += array_.prefetched(leaving) ? 1 : 0;
    }

    // --- what nearly every access touches
    unsigned level_, line_shift_, bank_shift_;
    std::uint32_t port_bytes_; // of the L1
    std::uint64_t latency_, bank_mask_;
    bool last_, through_, around_;
    bool inclusive_, exclusive_;
    bool coherent_;
    bool sends_clean_;             // to an exclusive level below
    bool special_;                 // an L1 that does more than the least
    bool used_prefetched_ = false; // by the access at hand, for the first time
    Cause cause_;
    Attribution* attribution_;
    CacheArray array_;
    cycle quiet_ = 0;
    CacheCounters counters_;
    // --- what others do
    TrafficOfLevel traffic_;
    std::vector<Calendar> banks_;
    Pool mshrs_, write_backs_;
    Prefetcher prefetcher_;
    std::unique_ptr<MissCauses> causes_; // if wanted
    Tickets& tickets_;
    Below& below_;
    const SiteAtHand& site_;
    std::vector<Cache*> above_;
    std::uint32_t number_ = 0, stream_ = 0;
    bool beyond_; // the tiles
    Coming* coming_ = nullptr;
};

} // namespace sim
