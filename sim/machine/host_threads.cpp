#include "sim/machine/host_threads.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace sim {
namespace {

void pause() {
#if defined(__x86_64__)
    _mm_pause();
#endif
}

/// Windows take some ten microseconds of a chip's tiles, what one thread waits for another is a part of that,
/// and to sleep and be woken costs five: threads with a core each sleep only where they have nothing to do
/// for many windows. Those that share cores let each other have them.
std::chrono::microseconds patience_of(int count) {
    const unsigned cores = std::thread::hardware_concurrency();
    return std::chrono::microseconds(cores == 0 || static_cast<unsigned>(count) > cores ? 5 : 100);
}

} // namespace

HostThreads::HostThreads(int count) : patience_(patience_of(count)) {
    for (int i = 1; i < count; ++i) {
        Other& other = others_.emplace_back();
        other.thread = std::thread(serve, std::ref(other), i, patience_);
    }
}

HostThreads::~HostThreads() {
    for (Other& other : others_)
        ask(other, nullptr);
    for (Other& other : others_)
        other.thread.join();
}

void HostThreads::ask(Other& other, const std::function<void(int)>* job) {
    other.job = job;
    other.asked.fetch_add(1, std::memory_order_release);
    other.asked.notify_one();
}

void HostThreads::wait_until(const std::atomic<std::uint32_t>& count, std::uint32_t reached,
                             Patience patience) {
    using Clock = std::chrono::steady_clock;
    constexpr int looks = 32; // between two looks at the clock
    const auto reached_soon = [&] {
        for (int look = 0; look < looks; ++look) {
            if (count.load(std::memory_order_acquire) == reached)
                return true;
            pause();
        }
        return false;
    };
    if (reached_soon())
        return;
    for (const Clock::time_point end = Clock::now() + patience; Clock::now() < end;)
        if (reached_soon())
            return;
    for (std::uint32_t seen = count.load(std::memory_order_acquire); seen != reached;
         seen = count.load(std::memory_order_acquire))
        count.wait(seen, std::memory_order_acquire);
}

void HostThreads::serve(Other& other, int number, Patience patience) {
    for (std::uint32_t job = 1;; ++job) {
        wait_until(other.asked, job, patience);
        if (other.job == nullptr)
            return;
        (*other.job)(number);
        other.done.store(job, std::memory_order_release);
        other.done.notify_one();
    }
}

void HostThreads::await(const Other& other) const {
    wait_until(other.done, other.asked.load(std::memory_order_relaxed), patience_);
}

void HostThreads::first(int wanted, const std::function<void(int)>& job) {
    const auto others = static_cast<std::size_t>(std::min(wanted, count()) - 1);
    for (std::size_t i = 0; i < others; ++i)
        ask(others_[i], &job);
    job(0);
    for (std::size_t i = 0; i < others; ++i)
        await(others_[i]);
}

} // namespace sim
