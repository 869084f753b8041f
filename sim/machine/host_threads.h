// Host threads that work in step: all do something and meet again, or one does while the others wait. Number
// 0 is the caller's.
#pragma once

#include <atomic>
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
    /// Calls job(i) on each thread i; returns when all have returned. `job` does not throw.
    void all(const std::function<void(int)>& job);
    /// Calls job(i) on thread i alone.
    void one(int i, const std::function<void(int)>& job);

private:
    struct Other {
        std::atomic<std::uint32_t> asked{0}, done{0}; // how many jobs
        const std::function<void(int)>* job = nullptr;
        std::thread thread;
    };
    static void ask(Other& other, const std::function<void(int)>* job);
    static void wait_until(const std::atomic<std::uint32_t>& count, std::uint32_t reached);
    static void serve(Other& other, int number);

    std::deque<Other> others_;
};

} // namespace sim
