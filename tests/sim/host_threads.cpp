// Host threads that work in step.
#include "sim/machine/host_threads.h"

#include <gtest/gtest.h>

#include <array>

namespace sim {
namespace {

TEST(HostThreads, CallsTheFirstAndNoOthersAndAlwaysTheSameForANumber) {
    HostThreads threads(3);
    ASSERT_EQ(threads.count(), 3);
    std::array<std::thread::id, 3> known{std::this_thread::get_id()};
    for (int wanted : {1, 3, 2, 3, 1, 2, 8}) {
        std::array<int, 3> calls{};
        std::array<std::thread::id, 3> callers;
        threads.first(wanted, [&](int i) {
            ++calls[static_cast<std::size_t>(i)];
            callers[static_cast<std::size_t>(i)] = std::this_thread::get_id();
        });
        for (int i = 0; i < 3; ++i) {
            const auto n = static_cast<std::size_t>(i);
            EXPECT_EQ(calls[n], i < wanted ? 1 : 0) << wanted;
            if (calls[n] == 0)
                continue;
            if (known[n] == std::thread::id())
                known[n] = callers[n];
            EXPECT_EQ(callers[n], known[n]) << wanted;
        }
    }
    EXPECT_NE(known[1], known[0]);
    EXPECT_NE(known[2], known[1]);
}

/// More threads than the host has cores, some of which wait for so long that they sleep.
TEST(HostThreads, SleepAndAreWoken) {
    HostThreads threads(8);
    std::vector<std::uint64_t> sums(8);
    for (int round = 0; round < 200; ++round)
        threads.first(8, [&](int i) {
            if (i == round % 8 && round % 20 == 0)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            sums[static_cast<std::size_t>(i)] += static_cast<std::uint64_t>(round);
        });
    for (const std::uint64_t sum : sums)
        EXPECT_EQ(sum, 199U * 200 / 2);
}

} // namespace
} // namespace sim
