// Order among hardware threads. All are fibres on one host thread; the one that runs goes on until its next
// operation lies behind the horizon, then the earliest other one runs. With exact order the horizon is the
// next thread's operation; with a quantum it is the end of the window that the operation lies in. Keys order
// by (cycle, core, thread).
#pragma once

#include "isa/services.h"
#include "sim/core/fibre.h"
#include "sim/core/stalls.h"

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sim {

class Scheduler {
public:
    using Key = std::uint64_t;
    static constexpr unsigned thread_bits = 16;
    static Key key(cycle t, std::uint32_t thread) { return t << thread_bits | thread; }

    Scheduler(std::uint64_t quantum, std::size_t stack_bytes)
        : quantum_(quantum), stack_bytes_(stack_bytes) {}

    /// Adds a thread (ascending numbers, all before run()).
    void add(std::uint32_t thread, std::function<void()> body);
    /// Runs all to their ends. Throws a Deadlock with the message of `stuck` if all sleep. Rethrows the first
    /// exception of a thread, after unwinding all others.
    void run(const std::function<std::string()>& stuck);

    // From within a thread:
    bool exact() const { return quantum_ <= 1; }
    Key horizon() const { return horizon_; }
    /// Returns when no thread is earlier than this one would be with `k`.
    void wait_turn(Key k) {
        if (!queue_.empty() && k > queue_.front())
            yield(k);
    }
    /// Lets earlier threads run first.
    void yield(Key k);
    /// Parks this thread until wake().
    void sleep();
    /// Makes the sleeping thread that `k` names run when `k` is earliest.
    void wake(Key k);
    /// Runs `request` on the scheduler's stack.
    void call(std::function<void()> request);

private:
    struct Thread {
        std::uint32_t number;
        std::unique_ptr<Fibre> fibre;
    };
    struct Cancelled {};

    void push(Key k);
    Key pop();
    void go_on(Key k);
    void body(const std::function<void()>& work);
    void cancel();

    std::uint64_t quantum_;
    std::size_t stack_bytes_;
    std::vector<Key> queue_; // a heap, smallest first: every thread that could run but does not
    std::vector<std::unique_ptr<Thread>> threads_; // by number; null where there is none
    std::size_t unfinished_ = 0;
    Key horizon_ = 0;
    std::uint32_t current_ = 0;
    Fibre main_;
    std::function<void()> request_;
    std::exception_ptr failure_;
    bool cancelling_ = false;
};

} // namespace sim
