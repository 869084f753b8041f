// Host threads that work in step.
#include "sim/machine/host_threads.h"

#include <gtest/gtest.h>

#include <array>

namespace sim {
namespace {

TEST(HostThreads, CallsThoseThatAreWantedAndNoOthers) {
    HostThreads threads(3);
    ASSERT_EQ(threads.count(), 3);
    for (unsigned mask = 0; mask < 8; ++mask) {
        std::array<int, 3> calls{};
        std::array<std::thread::id, 3> callers;
        threads.these({(mask & 1U) != 0, (mask & 2U) != 0, (mask & 4U) != 0}, [&](int i) {
            ++calls[static_cast<std::size_t>(i)];
            callers[static_cast<std::size_t>(i)] = std::this_thread::get_id();
        });
        for (unsigned i = 0; i < 3; ++i) {
            EXPECT_EQ(calls[i], static_cast<int>(mask >> i & 1U)) << mask;
            if (calls[i] != 0) {
                EXPECT_EQ(callers[i] == std::this_thread::get_id(), i == 0);
            }
        }
    }
}

TEST(HostThreads, AlwaysCallsTheSameThreadForANumber) {
    HostThreads threads(2);
    std::thread::id first, then;
    threads.one(1, [&](int) { first = std::this_thread::get_id(); });
    threads.these({true, true}, [&](int i) {
        if (i == 1)
            then = std::this_thread::get_id();
    });
    EXPECT_EQ(first, then);
}

/// More threads than the host has cores, some of which wait for so long that they sleep.
TEST(HostThreads, SleepAndAreWoken) {
    HostThreads threads(8);
    std::vector<std::uint64_t> sums(8);
    for (int round = 0; round < 200; ++round)
        threads.these(std::vector<bool>(8, true), [&](int i) {
            if (i == round % 8 && round % 20 == 0)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            sums[static_cast<std::size_t>(i)] += static_cast<std::uint64_t>(round);
        });
    for (const std::uint64_t sum : sums)
        EXPECT_EQ(sum, 199U * 200 / 2);
}

} // namespace
} // namespace sim
