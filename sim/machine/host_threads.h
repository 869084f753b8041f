// Host threads that work in step: the first of them do something and meet again. Number 0 is the caller's.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <thread>

namespace sim {

class HostThreads {
public:
    explicit HostThreads(int count);
    ~HostThreads();
    HostThreads(const HostThreads&) = delete;
    HostThreads& operator=(const HostThreads&) = delete;

    int count() const { return static_cast<int>(others_.size()) + 1; }
    /// Calls job(i) on each thread i < wanted; returns when all have returned. `job` does not throw.
    void first(int wanted, const std::function<void(int)>& job);

private:
    using Patience = std::chrono::steady_clock::duration;
    /// What the caller writes and what the thread writes lie in lines of their own.
    struct alignas(64) Other {
        std::atomic<std::uint32_t> asked{0}; // how many jobs
        const std::function<void(int)>* job = nullptr;
        std::thread thread;
        alignas(64) std::atomic<std::uint32_t> done{0}; // of these
    };
    static void ask(Other& other, const std::function<void(int)>* job);
    static void wait_until(const std::atomic<std::uint32_t>& count, std::uint32_t reached, Patience patience);
    static void serve(Other& other, int number, Patience patience);
    void await(const Other& other) const;

    Patience patience_; // how long who waits looks before it sleeps
    std::deque<Other> others_;
};

} // namespace sim
