// Order among the hardware threads of a tile. All are fibres, of which one runs at a time; it goes on
// until its next operation lies behind the horizon, then the earliest other one runs. With exact order the
// horizon is the next thread's operation; with a quantum it is the end of the quantum that the operation lies
// in. No thread passes the end of the window that run() was given, and a quantum that is no shorter than a
// window does not cut it: each thread has all of it in turn. Keys order by (cycle, core, thread). In the
// reference mode events of the tile (tile_events.h) happen in between.
#pragma once

#include "sim/core/fibre.h"
#include "sim/core/stalls.h"
#include "sim/machine/turns.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <vector>

namespace sim {

/// What happens by itself between the threads' operations, before those of the same cycle.
class Timeline {
public:
    Timeline() = default;
    Timeline(const Timeline&) = delete;
    Timeline& operator=(const Timeline&) = delete;
    virtual ~Timeline() = default;
    /// The earliest event happens.
    virtual void step() = 0;

    cycle next = ~cycle{0}; // of these; ~0: there is none
};

class Scheduler {
public:
    using Key = Turns::Key;
    static constexpr unsigned thread_bits = 16;
    static Key key(cycle t, std::uint32_t thread) { return t << thread_bits | thread; }
    static cycle cycle_of(Key k) { return k >> thread_bits; }

    /// `quantum` and `window` in cycles.
    Scheduler(std::uint64_t quantum, std::uint64_t window, std::size_t stack_bytes)
        : quantum_(quantum), whole_windows_(quantum >= window), stack_bytes_(stack_bytes) {}

    /// Adds a thread that begins at cycle `t`: a new one (ascending numbers), or one that has ended once
    /// more. `prefetch` brings what it works on to the host's caches, soon before it goes on.
    void add(std::uint32_t thread, cycle t, std::function<void()> body, std::function<void()> prefetch = {});
    /// Of a scheduler with exact order: from now on these events have their place among the operations.
    void follow(Timeline& events) { events_ = &events; }
    /// One of them was added.
    void foresee(cycle t) { horizon_ = std::min(horizon_, key(t, 0) == 0 ? 0 : key(t, 0) - 1); }

    // From outside of all threads:
    /// Runs threads until none is earlier than cycle `end`, or one has failed.
    void run(cycle end);
    /// Runs one thread that has parked until it parks or yields again, or ends.
    void step(std::uint32_t thread);
    /// The earliest cycle at which a thread wants to go on, or something happens; ~0 if none does.
    cycle next() const {
        const cycle event = events_ == nullptr ? ~cycle{0} : events_->next;
        const Key first = turns_.first();
        return first == Turns::none ? event : std::min(event, cycle_of(first));
    }
    std::size_t unfinished() const { return unfinished_; }
    /// What the first thread that failed threw.
    const std::exception_ptr& failure() const { return failure_; }
    /// Unwinds all threads.
    void cancel();

    // From within a thread:
    bool exact() const { return quantum_ <= 1; }
    bool stepping() const { return stepping_; }
    Key horizon() const { return horizon_; }
    /// Returns when no thread is earlier than this one would be with `k`.
    void wait_turn(Key k) {
        if (k >= limit_ || k > turns_.first() || k >= first_event())
            yield(k);
    }
    /// Lets earlier threads run first.
    void yield(Key k);
    /// Stops this thread until wake() or step().
    void park();
    /// Makes the parked thread that `k` names run when `k` is earliest.
    void wake(Key k);
    /// Runs `request` on the scheduler's stack, with time standing still.
    void call(std::function<void()> request);

private:
    struct Thread {
        Thread(std::uint32_t number, std::function<void()> prefetch, std::size_t stack_bytes,
               std::function<void()> body, Fibre& home)
            : number(number), fibre(stack_bytes, std::move(body), home), prefetch(std::move(prefetch)) {}
        std::uint32_t number;
        Fibre fibre;
        std::function<void()> prefetch;
    };
    struct Cancelled {};

    /// Operations from this key on come after the next event.
    Key first_event() const {
        return events_ == nullptr || events_->next > cycle_of(Turns::none) ? Turns::none
                                                                           : key(events_->next, 0);
    }
    static std::uint32_t thread_of(Key k) {
        return static_cast<std::uint32_t>(k & ((Key{1} << thread_bits) - 1));
    }
    void let_events_happen();
    void push(Key k) { turns_.set(thread_of(k), k); }
    Key pop();
    void go_on(Key k);
    void prefetch_next() const;
    void leave();
    void body(const std::function<void()>& work);

    std::uint64_t quantum_;
    bool whole_windows_;
    std::size_t stack_bytes_;
    Turns turns_;                                  // of every thread that could run but does not
    std::vector<std::unique_ptr<Thread>> threads_; // by number; null where there is none
    std::size_t unfinished_ = 0;
    Timeline* events_ = nullptr;
    Key horizon_ = 0, limit_ = 0;
    std::uint32_t current_ = 0;
    Fibre main_;
    std::function<void()> request_;
    std::exception_ptr failure_;
    bool cancelling_ = false, stepping_ = false;
};

} // namespace sim
