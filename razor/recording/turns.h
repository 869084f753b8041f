// Threads that take turns: one runs at a time, in a fixed order, so that what they do together is the same
// each time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

namespace razor {

class Turns {
public:
    /// Thread 0 is the first.
    explicit Turns(std::size_t threads) : in_(threads, true), changed_(threads) {}

    /// A thread begins: waits for its first turn.
    void begin(std::size_t thread) {
        std::unique_lock lock(mutex_);
        wait(lock, thread);
    }
    /// Lets all others have a turn.
    void pass(std::size_t thread) {
        std::unique_lock lock(mutex_);
        hand_on(thread);
        wait(lock, thread);
    }
    /// The thread takes no more turns.
    void end(std::size_t thread) {
        const std::scoped_lock lock(mutex_);
        in_[thread] = false;
        hand_on(thread);
    }

private:
    void wait(std::unique_lock<std::mutex>& lock, std::size_t thread) {
        changed_[thread].wait(lock, [&] { return turn_ == thread; });
    }
    void hand_on(std::size_t thread) {
        for (std::size_t i = 1; i <= in_.size(); ++i) {
            const std::size_t next = (thread + i) % in_.size();
            if (in_[next]) {
                turn_ = next;
                changed_[next].notify_one();
                return;
            }
        }
    }

    std::mutex mutex_;
    std::vector<bool> in_;
    std::deque<std::condition_variable> changed_; // by thread
    std::size_t turn_ = 0;
};

} // namespace razor
