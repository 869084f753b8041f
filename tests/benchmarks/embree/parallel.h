// A loop shared by threads.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace razor::baseline {

/// task(i, thread) for every i in [0, count), each taken by whichever thread is free first, in order.
template <class Task> void share_out(int threads, int count, const Task& task) {
    std::atomic<int> next = 0;
    const auto work = [&](int thread) {
        for (int i = next++; i < count; i = next++)
            task(i, thread);
    };
    std::vector<std::jthread> others;
    for (int t = 1; t < threads; ++t)
        others.emplace_back(work, t);
    work(0);
}

} // namespace razor::baseline
