// Streams merged by time, against the definition: the earliest of the streams' next ones, one after the
// other.
#include "traces/in_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>

namespace traces {
namespace {

using Visits = std::vector<std::pair<std::uint32_t, std::size_t>>; // streams and numbers

Visits plainly(const Block& block) {
    Visits out;
    std::vector<std::size_t> at;
    std::vector<std::uint64_t> time;
    for (const Segment& s : block.segments) {
        at.push_back(s.begin);
        time.push_back(block.times[s.begin]);
    }
    for (std::size_t left = block.size(); left != 0; --left) {
        std::size_t first = at.size();
        for (std::size_t s = 0; s < at.size(); ++s)
            if (at[s] != block.segments[s].end && (first == at.size() || time[s] < time[first]))
                first = s;
        out.emplace_back(block.segments[first].stream, at[first]);
        if (++at[first] != block.segments[first].end)
            time[first] = std::max(time[first], block.times[at[first]]);
    }
    return out;
}

TEST(InTime, VisitsTheEarliestOfTheStreams) {
    TimeOrder order; // keeps nothing of a block but room
    for (std::uint64_t trial = 0; trial < 300; ++trial) {
        std::mt19937_64 random(trial);
        Block block;
        const std::size_t streams = 1 + trial % 9;
        for (std::size_t s = 0; s < streams; ++s) {
            const std::size_t begin = block.times.size(), n = 1 + random() % (trial % 3 == 0 ? 4 : 200);
            std::uint64_t time = random() % 50;
            for (std::size_t i = 0; i < n; ++i) {
                time += random() % 4; // many are equal
                const bool back = random() % 8 == 0;
                block.times.push_back(back ? time - std::min<std::uint64_t>(time, 5) : time);
            }
            block.addresses.resize(block.times.size());
            if (trial % 10 == 0)
                block.times.back() = ~std::uint64_t{0};
            block.segments.push_back({static_cast<std::uint32_t>(3 * s), begin, begin + n});
        }
        Visits visits;
        order.each(block, [&](const Segment& s, std::size_t i) { visits.emplace_back(s.stream, i); });
        ASSERT_EQ(visits, plainly(block)) << trial;
    }
}

/// Sets the signal for as long as it lives.
struct Interrupt {
    Interrupt() { interrupt_signal = 1; }
    ~Interrupt() { interrupt_signal = 0; }
};

// Of blocks that take long, only a few references more are visited.
TEST(InTime, EndsBetweenTwoVisits) {
    for (const std::size_t streams : {1U, 2U, 7U}) {
        constexpr std::size_t of_each = 5000;
        Block block;
        for (std::size_t s = 0; s < streams; ++s) {
            for (std::size_t i = 0; i < of_each; ++i)
                block.times.push_back(i);
            block.segments.push_back({static_cast<std::uint32_t>(s), s * of_each, (s + 1) * of_each});
        }
        block.addresses.resize(block.times.size());
        block.order = {{.segment = 0, .count = of_each}};
        for (const bool ordered : {false, true}) {
            if (!ordered)
                block.order.clear();
            std::size_t visits = 0;
            std::optional<Interrupt> signal;
            const auto visit = [&](const Segment&, std::size_t) {
                if (++visits == 1000)
                    signal.emplace();
            };
            EXPECT_THROW(each_in_order(block, visit, [](const Turn&) {}), Interrupted);
            EXPECT_GE(visits, 1000U);
            EXPECT_LE(visits, 1256U);
        }
    }
}

} // namespace
} // namespace traces
