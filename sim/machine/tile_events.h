// What happens within a tile by itself, in order of time: requests of a cache come to the one below it, take
// its bank, and act when that begins with them. Each stands for a ticket, which is answered when it has
// acted. At the same cycle what has waited for room goes first, then caches by their numbers, each in the
// order in which it asked; and all that before the threads' operations. Of one line, what a cache asks for
// comes in the order in which it asked. A request that finds no room (an MSHR, a place in the write-back
// buffer) waits until there may be some, in order of arrival, and behind it what comes for its line; others
// pass, as its bank does not wait. Not modelled: ports of arrivals; that a line is found in a write-back that
// is on its way.
#pragma once

#include "sim/machine/scheduler.h"
#include "sim/memory/cache.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace sim {

class TileEvents;

/// The way to a cache from those above.
class Arrivals final : public Below, public Coming {
public:
    Arrivals(TileEvents& events, std::uint32_t number, Cache& cache)
        : events_(events), number_(number), cache_(cache) {
        cache.act_on(*this);
    }
    // Who has the right to write the line is said when this has acted.
    Answer read(const Access& a) override {
        if (at_once()) [[unlikely]]
            return cache_.read(a);
        return {.ready = enter(a, Kind::read), .from = cache_.cause(), .shared = true};
    }
    Answer own(const Access& a) override {
        return {.ready = enter(a, Kind::own), .from = cache_.cause(), .shared = true};
    }
    Answer write(const Access& a) override {
        if (at_once()) [[unlikely]]
            return cache_.write(a);
        return {enter(a, Kind::write), cache_.cause()};
    }
    /// The line of this address will be dead when word of it has come.
    void discard(std::uint64_t address, cycle t, std::uint32_t asker) {
        if (at_once()) [[unlikely]]
            return cache_.discard(address);
        Access a{address, 0, t, 0};
        a.asker = asker;
        enter(a, Kind::discard);
    }
    bool is_asked(std::uint64_t address, const Cache& by) const override;
    bool recall(std::uint64_t address, std::uint64_t bytes) override;
    bool clean(std::uint64_t address, std::uint64_t bytes) override;

private:
    friend class TileEvents;
    static constexpr std::uint64_t nothing = ~std::uint64_t{0};

    enum class Kind : std::uint8_t { read, own, write, discard };
    struct Request {
        Access access;
        cycle ticket;
        SiteAtHand site; // of the operation that asks
        std::uint64_t sequence;
        cycle comes; // from then on it waits for its bank, or for room
        Kind kind;
        bool booked = false; // its bank
        bool recalled = false;
    };
    bool at_once() const;
    cycle enter(const Access& a, Kind kind);
    cycle after_others(const Access& a, Kind kind, cycle at) const;
    void happen(std::uint32_t slot, cycle now);
    bool act(std::uint32_t slot, cycle now);
    Answer serve(const Request& r, const Access& a);
    void finish(std::uint32_t slot, const Answer& answer, cycle now);
    template <class Visit> void each_write(std::uint64_t address, std::uint64_t bytes, Visit visit);
    void deliver_dirty(const Access& a, cycle now);
    bool waits(std::uint64_t line) const;
    void wait(std::uint32_t slot) { waiting_.push_back(slot); }
    void note_refusal(cycle again);
    void retry(cycle now);

    TileEvents& events_;
    std::uint32_t number_;
    Cache& cache_;
    std::vector<Request> requests_;
    std::vector<std::uint64_t> lines_;   // of these, as the cache has them; or nothing: free
    std::vector<std::uint32_t> free_;    // of these
    std::vector<std::uint32_t> waiting_; // for room, in order of arrival
    cycle again_ = ~cycle{0};            // they try then ...
    bool until_answer_ = false;          // ... and when any ticket is answered
};

class TileEvents final : public Timeline {
public:
    /// Something was answered at this cycle, to this cache (null: to a core); all that may wait for it.
    using Heard = std::function<void(cycle, const Cache*)>;

    TileEvents(Scheduler& scheduler, Tickets& tickets, SiteAtHand& site)
        : scheduler_(scheduler), tickets_(tickets), site_(site) {
        scheduler.follow(*this);
    }
    Arrivals& before(Cache& cache) {
        least_ = std::min(least_, cache.latency());
        return arrivals_.emplace_back(*this, static_cast<std::uint32_t>(arrivals_.size()), cache);
    }
    /// Whether anything is on its way, or waits for room.
    bool busy() const {
        return !events_.empty() || std::any_of(arrivals_.begin(), arrivals_.end(),
                                               [](const Arrivals& a) { return !a.waiting_.empty(); });
    }
    /// Who waits for room hears at this cycle too, as if something had been answered.
    void look_again(cycle t) { foresee(t, 0, ~std::uint64_t{0}, nobody, no_slot); }
    /// How many events of requests have happened since this was asked last.
    std::uint32_t take_count() { return std::exchange(count_, 0U); }
    /// Nothing has happened yet that is later.
    cycle now() const { return now_; }
    void tell(Heard heard) { heard_ = std::move(heard); }

    void step() override;
    /// The tile's window has ended: what follows is no earlier.
    void come_to(cycle now) { now_ = std::max(now_, now); }
    /// What lies beyond has answered: those that waited for that try again.
    void try_again();
    /// Of tickets of what lies beyond the tile.
    void set_floors(const Floors& floors) {
        beyond_ = floors;
        update();
    }

private:
    friend class Arrivals;
    struct Event {
        cycle at;
        std::uint64_t asker, sequence; // asker 0: who has waited
        std::uint32_t where, slot;
        bool operator>(const Event& e) const {
            return at != e.at ? at > e.at : asker != e.asker ? asker > e.asker : sequence > e.sequence;
        }
    };
    static constexpr std::uint32_t no_slot = ~std::uint32_t{0}, nobody = no_slot;

    void foresee(cycle at, std::uint64_t asker, std::uint64_t sequence, std::uint32_t where,
                 std::uint32_t slot) {
        events_.push({at, asker, sequence, where, slot});
        update();
        scheduler_.foresee(at);
    }
    void answered(cycle now, const Cache* by);
    void update() {
        next = events_.empty() ? ~cycle{0} : events_.top().at;
        const cycle here = next == ~cycle{0} ? next : next + least_;
        tickets_.set_floors({std::min(beyond_.any, here), std::min(beyond_.lines, here)});
    }

    Scheduler& scheduler_;
    Tickets& tickets_;
    SiteAtHand& site_;
    Heard heard_;
    std::deque<Arrivals> arrivals_;
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::uint64_t sequence_ = 0;
    std::uint32_t count_ = 0;                       // for a trace
    std::uint64_t least_ = ~std::uint64_t{0} >> 1U; // cycles that a cache takes
    cycle now_ = 0;
    Floors beyond_;
};

/// Nothing is busy, nor on its way for long (Tickets::at_once).
inline bool Arrivals::at_once() const {
    return events_.tickets_.at_once();
}

} // namespace sim
