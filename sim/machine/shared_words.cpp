// Words shared between workers (rule 5), waiting for them, and what workers ask of the host; with the timing
// port's functions (isa/simulated/port.h).
#include "sim/machine/issue.h"
#include "sim/trace/passing.h"

#include <fmt/core.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace sim {
namespace {

/// A worker has failed, or is cancelled as another has: what its destructors write takes no time, as no
/// exception may leave them, nor may another thread have the host's stack before they are done.
bool unwinding() {
    return std::uncaught_exceptions() > 0;
}

} // namespace

/// Shared words are not reordered: they act after all earlier operations of the thread have issued, when no
/// other thread is earlier. A load acts at its issue; only it does not wait for the others under a quantum. A
/// release acts when the thread's stores are in the L1, a read-modify-write then and when the L2 lets it have
/// the line. Where another tile may reach the word, it acts between windows.
void Engine::before_atomic(Hart& h, isa::timing::atomic kind, const void* p, Due ready, bool waits) {
    if (unwinding()) [[unlikely]]
        return;
    bool writes = kind != isa::timing::atomic::load_acquire;
    std::uint64_t a = address(p);
    if (warming_) [[unlikely]]
        return begin_passing(h, writes, kind != isa::timing::atomic::store_release, a);
    Scheduler& scheduler = h.tile->scheduler;
    auto catch_up =
        [&h](cycle t) { // what is independent of the word does not stay behind for as long as it waits
            if (t > booking_reach)
                h.bound.later(Due(t - booking_reach, Cause::synchronise));
        };
    settle(h, ready);
    if (writes) {
        await_stores(h);
        ready.later(Due(h.stored, Cause::synchronise));
    }
    ready.later(Due(std::max(h.now, h.issued), Cause::synchronise));
    Issued at = issue(h, writes ? store_kind : load_kind, ready);
    h.now = at.last;
    const cycle begins = translated(h, a, a + 3, at.last);
    h.now = std::max(h.now, begins);
    finish_issue(h, at, 0);
    count(h, 1, false);
    ++h.counters.atomics;
    h.acting = Due(begins, Cause::synchronise);
    h.asked = begins;
    if (scheduler.exact() || writes) {
        Away away(h);
        scheduler.wait_turn(Scheduler::key(begins, h.number));
        catch_up(begins);
    }
    if (writes && kind != isa::timing::atomic::store_release) {
        ++h.counters.modifications;
        h.tile->site = {};
        Access change{a, line_bytes_, begins + l1_latency_, h.column}; // a read that leaves the line dirty
        change.modify = change.owned = true;                           // its line is claimed by itself
        change.asker = h.core->l1.number();
        Answer line = h.core->words.read(change);
        while (line.refused)
            [[unlikely]] {
                if (line.moved) {
                    note_refused(h, a, 4, Passing::change, change.at - l1_latency_, traces::Part::aside);
                    note_word(asker(h), 1, traces::Kind::refused, change,
                              Passing::of(change, {}, Passing::change));
                }
                change.at = await_room(h, change.at, line.ready);
                h.tile->site = {}; // others have accessed something meanwhile
                line = h.core->words.read(change);
            }
        note_core(h, traces::Kind::modify, a, 4, change.at - l1_latency_, traces::Part::aside);
        note_word(asker(h), 1, traces::Kind::word, change, Passing::of(change, {}));
        if (h.tile->events && is_ticket(line.ready)) { // its place in the queue is that of the L2's answer
            const Answered there = await(h, line.ready);
            line.ready = there.last;
            line.from = there.from;
        }
        auto [ready_at, behind] =
            h.tile->queues.enter(a, line.ready, wide(config_.coherence.atomic_cycles), h.tile->tickets);
        Answered there{ready_at, ready_at, line.from};
        if (is_ticket(ready_at))
            there = await(h, ready_at);
        h.asked = there.last;
        h.acting = Due(there.last + behind, behind == 0 ? there.from : Cause::synchronise);
        Away away(h);
        scheduler.wait_turn(Scheduler::key(h.acting.at(), h.number));
        catch_up(h.acting.at());
    }
    Homes::Use use = writes ? Homes::Use::writes : waits ? Homes::Use::waits : Homes::Use::looks;
    if (!homes_.acts_at_once(a, h.tile->number, use)) {
        h.tile->deeds.push_back({h.acting.at(), &h, {}});
        {
            Away away(h);
            scheduler.park();
        }
        homes_.note(a, h.tile->number, use);
    }
}

/// What somebody else wrote shortly before `t` is read when it becomes visible, and so is what lies in the
/// future of a thread that a quantum let run behind.
void Engine::check_visible(Hart& h, std::uint64_t address, cycle t, Due& ready) {
    const Published& published = homes_.is_chip(address) ? published_ : h.tile->published;
    const Published::Write* w = published.find(address);
    if (w == nullptr || w->writer == h.number)
        return;
    if (t < w->written)
        ++h.counters.causality_waits;
    const bool near = harts_[w->writer].tile == h.tile;
    ready.later(Due(near ? w->visible : w->visible_elsewhere, Cause::synchronise));
}

/// The line of a word that several tiles write comes to the thread's, which has it for `service` cycles.
cycle Engine::move_line(const Hart& h, std::uint64_t address, cycle t, cycle service) {
    return moves_.write({address, h.tile->number, h.asked, t, service}, h.tile->earliest);
}

/// The word has been written at `written`, which is done at `done`: those that wait for it wake.
void Engine::publish(Hart& h, std::uint64_t address, cycle written, cycle done, bool chip) {
    const cycle visible = done + wide(config_.coherence.visibility_cycles);
    const cycle elsewhere = visible + wide(config_.coherence.remote_cycles);
    (chip ? published_ : h.tile->published)
        .write({address, written, visible, elsewhere, h.number}, h.tile->earliest);
    const auto* word = reinterpret_cast<const std::int32_t*>(base_ + address);
    auto wake = [&](Tile& tile) {
        std::erase_if(tile.sleepers, [&](Hart* sleeper) {
            if (sleeper->waits_for != word)
                return false;
            cycle at = std::max(
                {sleeper->acting.at(), &tile == h.tile ? visible : elsewhere, chip ? window_end_ : 0});
            sleeper->acting = Due(at, Cause::synchronise);
            tile.scheduler.wake(Scheduler::key(at, sleeper->number));
            return true;
        });
    };
    if (!chip)
        wake(*h.tile);
    else
        for (Tile& tile : tiles_)
            wake(tile);
}

stamp Engine::after_atomic(Hart& h, isa::timing::atomic kind, const void* p, bool wrote) {
    if (unwinding()) [[unlikely]]
        return {};
    cycle t = h.acting.at();
    std::uint64_t a = address(p);
    bool chip = homes_.is_chip(a);
    Due ready;
    stamp r;
    if (kind == isa::timing::atomic::load_acquire) {
        check_visible(h, a, t, ready); // before the access can let others run
        Data data;
        cycle from = t;
        h.site = {};
        touch_line(h, a, 4, false, 1, 1, from, data);
        ready.later(Due(data.last, data.from));
        if (data.open != 0) {
            data.first = data.last = ready.at();
            data.from = ready.why();
            r = loaded_ticket(h, data);
        }
    } else {
        const bool release = kind == isa::timing::atomic::store_release;
        drop_copies(config_, tiles_, asker(h), a, t, chip);
        note_core(h, chip ? traces::Kind::invalidate_all : traces::Kind::invalidate, a, 4, t,
                  release ? traces::Part::operation : traces::Part::access);
        if (release) {
            ++h.counters.releases;
            note_core(h, traces::Kind::write_through, a, 4, t, traces::Part::aside);
            Access release{a, line_bytes_, t + l1_latency_, h.column};
            release.forced = release.owned = true;
            release.asker = h.core->l1.number();
            h.core->words.write(release);
            note_word(asker(h), 1, traces::Kind::word, release, Passing::of(release, {}));
            ready = Due(t, Cause::synchronise);
            if (chip && !warming_)
                move_line(h, a, t, 0); // others wait for it, not the writer
        } else {
            const cycle service = wide(config_.coherence.atomic_cycles);
            Due seen = ready = h.acting;
            check_visible(h, a, t, seen);
            if (chip && !warming_)
                ready.later(Due(move_line(h, a, t, service), Cause::synchronise));
            else
                ready = seen;
            ready = Due(ready.at() + service, ready.why());
        }
        claim_line(config_, asker(h), a, t);
        if (wrote)
            publish(h, a, t, ready.at(), chip);
    }
    if (warming_) [[unlikely]]
        return {};
    if (!is_ticket(r.last)) {
        h.complete.later(ready);
        r.first = r.last = ready.at();
        r.cause = static_cast<std::uint8_t>(ready.why());
    }
    if (h.tile->scheduler.stepping() && !warming_) { // the deed is done
        Away away(h);
        h.now = std::max(h.now, window_end_);
        come_back(h, window_end_);
        h.tile->scheduler.yield(Scheduler::key(window_end_, h.number));
    }
    return r;
}

/// Looks of before anybody asks for slots any more, as nothing happened for long, take none. But what was
/// begun before may have taken all until later: then there were no looks.
void Engine::pass_looks(Hart& sleeper) const {
    const cycle earliest = sleeper.tile->earliest;
    const std::uint64_t period = spin_cycles_;
    Calendar& issue = sleeper.core->issue;
    if (sleeper.next_look >= earliest)
        return;
    const cycle busy = issue.last_taken_before(earliest << issue_shift_) >> issue_shift_;
    for (; sleeper.next_look <= busy && sleeper.next_look < earliest; sleeper.next_look += period)
        if (!issue.take_two_before(sleeper.next_look << issue_shift_, (sleeper.next_look + period)
                                                                          << issue_shift_))
            ++sleeper.missed_looks;
    if (sleeper.next_look < earliest)
        sleeper.next_look += (earliest - sleeper.next_look + period - 1) / period * period;
}

/// Takes the issue slots of a waiting thread's looks at the word before cycle `end`: two instructions each.
void Engine::look(Hart& sleeper, cycle end) {
    sleeper.looks.clear();
    for (; sleeper.next_look < end; sleeper.next_look += spin_cycles_) {
        Calendar::Span s = sleeper.core->issue.take(sleeper.next_look << issue_shift_, 2);
        sleeper.looks.push_back(s.first);
        sleeper.looks.push_back(s.last);
    }
}

/// Gives back what was taken for looks after the thread woke, and counts those before.
void Engine::stop_looking(Hart& sleeper, cycle woken) {
    for (Calendar::Slot slot : sleeper.looks)
        if (slot >> issue_shift_ >= woken)
            sleeper.core->issue.release(slot);
    sleeper.looks.clear();
}

/// These looks are counted now: those of earlier intervals belong there.
void Engine::move_looks(const Hart& sleeper, cycle since, std::uint64_t looks) {
    const std::uint64_t period = spin_cycles_;
    std::vector<std::int64_t>& moved = sleeper.tile->intervals.looks;
    moved.resize(intervals_.open() + 1);
    std::uint64_t before = 0; // of them
    for (std::size_t i = (since + period - intervals_.origin()) / intervals_.length(); i < intervals_.open();
         ++i) {
        const cycle end = intervals_.origin() + (i + 1) * intervals_.length();
        const std::uint64_t until =
            std::min(looks, (end - 1 - since) / period); // look n comes n periods later
        moved[i] += static_cast<std::int64_t>(2 * (until - before));
        before = until;
    }
    moved.back() -= static_cast<std::int64_t>(2 * before);
}

stamp Engine::wait_while(Hart& h, const std::int32_t* p, std::int32_t value, Due ready) {
    before_atomic(h, isa::timing::atomic::load_acquire, p, ready, true);
    const volatile std::int32_t* word = p;
    while (*word == value) {
        ++h.counters.waits;
        cycle since = std::max(h.acting.at(), h.accounted);
        h.waits_for = p;
        h.next_look = since + spin_cycles_;
        h.missed_looks = 0;
        h.tile->sleepers.push_back(&h);
        if (!warming_)
            look(h, window_end_);
        {
            Away away(h);
            h.tile->scheduler.park();
        }
        h.waits_for = nullptr;
        cycle woken = h.acting.at();
        stop_looking(h, woken);
        if (woken > h.accounted) {
            std::uint64_t looks = (woken - since) / spin_cycles_;
            looks -= std::min(looks, h.missed_looks);
            h.counters.spins += looks;
            h.at->instructions += 2 * looks;
            if (h.interval != 0) [[unlikely]]
                move_looks(h, since, looks);
            h.account(h.accounted, woken, Cause::synchronise);
            h.slept += woken - h.accounted;
            h.accounted = woken;
        }
        h.bound.later(Due(woken, Cause::synchronise));
        h.now = std::max(h.now, woken);
        if (warming_)
            come_to(h);
    }
    return after_atomic(h, isa::timing::atomic::load_acquire, p, false);
}

// --- the rest

void Engine::request_page(Hart& h, isa::page_service& service, std::int32_t space, std::int32_t kind,
                          std::int32_t index) {
    ++h.counters.pages;
    if (warming_)
        h.now = passing(h);
    auto request = [&service, space, kind, index] { service.make_page(space, kind, index); };
    Away away(h);
    if (tiles_.size() == 1) {
        h.tile->scheduler.call(request);
    } else {
        h.tile->deeds.push_back({h.now, &h, request});
        h.tile->scheduler.park();
        if (warming_)
            come_to(h);
    }
}

void Engine::check_label(const char* what, std::size_t number, std::size_t count) {
    if (number < count)
        return;
    fmt::print(stderr, "razor-sim: broken invariant: {} {} of {}\n", what, number, count);
    std::abort();
}

std::size_t Engine::set_phase(Hart& h, std::size_t phase) {
    std::size_t phases = labels_.phases.size();
    check_label("phase", phase, phases);
    const std::size_t column = plain_column(h.column), before = column % phases;
    enter(h, column - before + phase);
    return before;
}

std::size_t Engine::set_kind(Hart& h, std::size_t kind) {
    std::size_t phases = labels_.phases.size();
    check_label("kind", kind, labels_.kinds.size());
    const std::size_t column = plain_column(h.column), before = column / phases;
    enter(h, kind * phases + column % phases);
    return before;
}

void Engine::note_level(Hart& h, const void* p, std::uint64_t bytes, int level) const {
    if (bytes != 0)
        h.tile->attribution.note_level(address(p), bytes, level);
}

void Engine::note_level_of(Hart& h, const void* p, std::uint64_t bytes, const void* other) const {
    if (bytes != 0)
        h.tile->attribution.note_level_of(address(p), bytes, address(other));
}

} // namespace sim

namespace isa::timing {

void before_atomic(site where, atomic kind, const void* p, const stamp& address, const stamp& operands) {
    sim::Engine& engine = *sim::running_engine;
    sim::Hart& hart = *sim::running_hart;
    sim::Due ready = engine.begin(hart);
    engine.need_address(hart, ready, address);
    engine.need_scalar(hart, ready, operands);
    engine.note_trace_site(hart, where);
    engine.before_atomic(hart, kind, p, ready);
}
stamp after_atomic(site, atomic kind, const void* p, bool wrote) {
    return sim::running_engine->after_atomic(*sim::running_hart, kind, p, wrote);
}
stamp wait_while(site where, const std::int32_t* p, std::int32_t value, const stamp& address,
                 const stamp& operand) {
    sim::Engine& engine = *sim::running_engine;
    sim::Hart& hart = *sim::running_hart;
    sim::Due ready = engine.begin(hart);
    engine.need_address(hart, ready, address);
    engine.need_scalar(hart, ready, operand);
    engine.note_trace_site(hart, where);
    return engine.wait_while(hart, p, value, ready);
}

void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index) {
    sim::running_engine->request_page(*sim::running_hart, *static_cast<isa::page_service*>(service), space,
                                      kind, index);
}
std::int32_t set_phase(std::int32_t phase) {
    return static_cast<std::int32_t>(
        sim::running_engine->set_phase(*sim::running_hart, static_cast<std::size_t>(phase)));
}
std::int32_t set_kind(std::int32_t kind) {
    return static_cast<std::int32_t>(
        sim::running_engine->set_kind(*sim::running_hart, static_cast<std::size_t>(kind)));
}
std::uint64_t set_owners(const std::int32_t* owner, std::uint64_t lanes) {
    return sim::running_engine->set_owners(*sim::running_hart, owner, lanes);
}
std::uint64_t narrow_owners(std::uint64_t lanes) {
    return sim::running_engine->narrow_owners(*sim::running_hart, lanes);
}
void restore_owners(std::uint64_t before) {
    sim::running_engine->restore_owners(*sim::running_hart, before);
}
void note_level(const void* p, std::uint64_t bytes, std::int32_t level) {
    sim::running_engine->note_level(*sim::running_hart, p, bytes, level);
}
void note_level_of(const void* p, std::uint64_t bytes, const void* other) {
    sim::running_engine->note_level_of(*sim::running_hart, p, bytes, other);
}

} // namespace isa::timing
