// Calendars of slots against a set of the slots that are taken.
#include "sim/core/calendar.h"

#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <random>
#include <set>
#include <vector>

namespace sim::test {
namespace {

// Requests spread farther and farther apart and the earliest moves on.
TEST(Calendar, EqualsASetOfSlots) {
    std::mt19937 random(11);
    int taken_near = 0, refused_near = 0;
    for (unsigned per_cycle : {1U, 3U}) {
        cycle earliest = 0;
        Calendar calendar("test", earliest, per_cycle);
        unsigned shift = Calendar::log2_group(per_cycle);
        std::set<std::uint64_t> taken;
        auto free = [&](std::uint64_t s) { return s % (1U << shift) < per_cycle && taken.count(s) == 0; };
        for (int i = 0; i < 20000; ++i) {
            std::uint64_t spread = 50 + static_cast<std::uint64_t>(i);
            std::uint64_t from = (earliest + random() % spread) << shift;
            std::uint64_t want = from;
            if (per_cycle == 1 && random() % 4 == 0) {
                // often of the same lengths, as what has been seen for one is remembered
                constexpr std::array<std::uint32_t, 4> usual = {4, 8, 7, 31};
                auto length = random() % 4 == 0 ? static_cast<std::uint32_t>(1 + random() % 100)
                                                : usual[random() % usual.size()];
                auto busy = [&] {
                    auto next = taken.lower_bound(want);
                    return next != taken.end() && *next < want + length;
                };
                while (busy())
                    want = *taken.lower_bound(want) + 1;
                ASSERT_EQ(calendar.find_run(from, length), want) << i;
                if (random() % 2 == 0) {
                    ASSERT_EQ(calendar.take_run(from, length), want) << i;
                    for (std::uint32_t k = 0; k < length; ++k)
                        taken.insert(want + k);
                }
            } else if (random() % 4 == 0) { // one, and some of those taken are given back now and then
                while (!free(want))
                    ++want;
                ASSERT_EQ(calendar.take(from), want) << i;
                taken.insert(want);
                if (random() % 4 == 0) {
                    auto some = taken.lower_bound(from);
                    for (std::size_t k = 1 + random() % 40; k != 0 && some != taken.end(); --k) {
                        calendar.release(*some);
                        some = taken.erase(some);
                    }
                }
            } else {
                auto count = static_cast<std::uint32_t>(1 + random() % (i % 8 == 0 ? 300 : 64));
                Calendar::Span span{};
                if (random() % 2 == 0) { // only if they are near
                    count = 1 + count / 8;
                    const Calendar::Slot latest = from + random() % 400;
                    std::uint64_t last = from;
                    for (std::uint32_t k = 0; k < count; ++k, ++last)
                        while (!free(last))
                            ++last;
                    while (!free(want))
                        ++want;
                    const bool near = want / 64 == (last - 1) / 64 && want / 64 * 64 + 63 <= latest;
                    const bool took = calendar.take_near(from, count, latest, span);
                    // words without a free slot may be passed or not
                    ASSERT_TRUE(took == near || (near && from / 64 != want / 64)) << i;
                    (took ? taken_near : refused_near) += 1;
                    if (!took)
                        continue;
                } else {
                    span = calendar.take(from, count);
                }
                for (std::uint32_t k = 0; k < count; ++k, ++want) {
                    while (!free(want))
                        ++want;
                    taken.insert(want);
                    if (k == 0) {
                        ASSERT_EQ(span.first, want) << i;
                    }
                }
                ASSERT_EQ(span.last, want - 1) << i;
            }
            earliest += random() % 70; // most slots are taken
        }
    }
    EXPECT_GT(taken_near, 1000);
    EXPECT_GT(refused_near, 1000);
}

// Many ask for runs in the same crowded cycles, in which some are given back: what a calendar remembers to be
// taken is looked at again.
TEST(Calendar, EqualsASetOfSlotsWhereManyWait) {
    std::mt19937 random(12);
    cycle earliest = 0;
    Calendar calendar("test", earliest);
    std::set<std::uint64_t> taken;
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t from = earliest + random() % 300;
        constexpr std::array<std::uint32_t, 5> lengths = {1, 3, 4, 8, 31};
        const std::uint32_t length = lengths[random() % lengths.size()];
        std::uint64_t want = from;
        for (auto next = taken.lower_bound(want); next != taken.end() && *next < want + length; ++next)
            want = *next + 1;
        ASSERT_EQ(calendar.find_run(from, length), want) << i;
        if (random() % 3 == 0) {
            calendar.mark_run(want, length);
            for (std::uint32_t k = 0; k < length; ++k)
                taken.insert(want + k);
        } else if (random() % 4 == 0) {
            auto some = taken.lower_bound(from);
            for (std::size_t k = random() % 10; k != 0 && some != taken.end(); --k) {
                calendar.release(*some);
                some = taken.erase(some);
            }
        }
        earliest += random() % 3;
    }
}

// What is earlier than anybody asks for is remembered for a while, and may be taken; of what is forgotten it
// is said that it was free.
TEST(Calendar, TakesWhatHasPassedAsFarAsItRemembers) {
    std::mt19937 random(13);
    for (const unsigned per_cycle : {1U, 3U}) {
        cycle earliest = 0;
        Calendar calendar("test", earliest, per_cycle);
        const unsigned shift = Calendar::log2_group(per_cycle);
        std::set<std::uint64_t> taken;
        for (int i = 0; i < 1500; ++i)
            taken.insert(calendar.take(random() % 600 << shift));
        earliest = 600; // and nobody has asked for anything since
        for (int i = 0; i < 400; ++i) {
            const std::uint64_t from = random() % 700 << shift, end = from + (random() % 12 << shift);
            const auto before = taken.lower_bound(end);
            ASSERT_EQ(calendar.last_taken_before(end), before == taken.begin() ? 0 : *std::prev(before));
            std::vector<std::uint64_t> free;
            for (std::uint64_t s = from; s < end && free.size() < 2; ++s)
                if (s % (1U << shift) < per_cycle && taken.count(s) == 0)
                    free.push_back(s);
            ASSERT_EQ(calendar.take_two_before(from, end), free.size() == 2) << i;
            if (free.size() == 2)
                taken.insert(free.begin(), free.end());
        }
        calendar.take(Calendar::Slot{100000} << shift);
        EXPECT_EQ(calendar.last_taken_before((600U << shift) / 64 * 64), 0U);
        EXPECT_TRUE(calendar.take_two_before(0, 1));
    }
}

TEST(CalendarDeathTest, WhatHasPassedIsNotAskedFor) {
    cycle earliest = 0;
    Calendar calendar("test", earliest);
    calendar.take(100000);
    calendar.take(0); // not before the earliest
    earliest = 5000;
    calendar.take(1000000);
    calendar.take(5000);
    EXPECT_DEATH(calendar.take(4900), "broken invariant: the calendar of test was asked for slot 4864");
}

} // namespace
} // namespace sim::test
