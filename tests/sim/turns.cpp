// The tournament of turns beside an ordered set: the same first key after every change, however threads were
// admitted.
#include "sim/machine/turns.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace {

using sim::Turns;

Turns::Key key(std::uint64_t t, std::uint32_t thread) {
    return t << 16U | thread;
}

/// Random changes of so many threads' turns, of numbers from `first` on; some are admitted late.
void compare(std::uint32_t first, std::uint32_t threads) {
    std::mt19937 random(threads * 1000 + first);
    Turns turns;
    std::set<Turns::Key> all;
    std::vector<Turns::Key> of(threads, Turns::none);
    std::uint32_t admitted = 0;
    for (int step = 0; step < 4000; ++step) {
        if (admitted < threads && (admitted == 0 || random() % 50 == 0))
            turns.admit(first + admitted++);
        const auto which = static_cast<std::uint32_t>(random() % admitted);
        const Turns::Key next = random() % 4 == 0 ? Turns::none : key(random() % 64, first + which);
        all.erase(of[which]);
        if (next != Turns::none)
            all.insert(next);
        of[which] = next;
        turns.set(first + which, next);
        ASSERT_EQ(turns.first(), all.empty() ? Turns::none : *all.begin())
            << threads << " threads from " << first << ", step " << step;
    }
    EXPECT_EQ(admitted, threads);
}

TEST(Turns, FirstIsThatOfAnOrderedSet) {
    for (const std::uint32_t first : {0U, 1U, 96U, 60000U})
        for (const std::uint32_t threads : {1U, 2U, 3U, 4U, 5U, 31U, 32U, 33U, 64U})
            compare(first, threads);
}

TEST(Turns, NobodyHasOneAtFirst) {
    Turns turns;
    EXPECT_EQ(turns.first(), Turns::none);
    turns.admit(7);
    EXPECT_EQ(turns.first(), Turns::none);
    turns.admit(7); // once more, as a thread that begins again
    turns.set(7, key(3, 7));
    turns.admit(9);
    EXPECT_EQ(turns.first(), key(3, 7));
}

} // namespace
