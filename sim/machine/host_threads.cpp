#include "sim/machine/host_threads.h"

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

} // namespace

HostThreads::HostThreads(int count) {
    for (int i = 1; i < count; ++i) {
        Other& other = others_.emplace_back();
        other.thread = std::thread(serve, std::ref(other), i);
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

/// Windows are about a microsecond long: looks for longer than that before it lets the host have the core.
void HostThreads::wait_until(const std::atomic<std::uint32_t>& count, std::uint32_t reached) {
    for (int look = 0; look < 500; ++look) {
        if (count.load(std::memory_order_acquire) == reached)
            return;
        pause();
    }
    for (std::uint32_t seen = count.load(std::memory_order_acquire); seen != reached;
         seen = count.load(std::memory_order_acquire))
        count.wait(seen, std::memory_order_acquire);
}

void HostThreads::serve(Other& other, int number) {
    for (std::uint32_t job = 1;; ++job) {
        wait_until(other.asked, job);
        if (other.job == nullptr)
            return;
        (*other.job)(number);
        other.done.store(job, std::memory_order_release);
        other.done.notify_one();
    }
}

void HostThreads::all(const std::function<void(int)>& job) {
    for (Other& other : others_)
        ask(other, &job);
    job(0);
    for (Other& other : others_)
        wait_until(other.done, other.asked.load(std::memory_order_relaxed));
}

void HostThreads::one(int i, const std::function<void(int)>& job) {
    if (i == 0) {
        job(0);
        return;
    }
    Other& other = others_[static_cast<std::size_t>(i) - 1];
    ask(other, &job);
    wait_until(other.done, other.asked.load(std::memory_order_relaxed));
}

} // namespace sim
