// Registers of values, and of the machine, against a list of the last values used.
#include "sim/core/machine_registers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace sim::test {
namespace {

/// The plain version: which values are held, last used first, and which were stored.
struct PlainRegisters {
    std::size_t room;
    std::size_t pieces; // of a value that is no broadcast
    std::size_t interleaved = 0;
    std::deque<std::uint32_t> held{}, stretch{}; // of `stretch` the first `interleaved`
    std::set<std::uint32_t> stored{};

    void hold(std::uint32_t value) {
        held.push_front(value);
        std::size_t taken = 0;
        const auto out = std::find_if(held.begin(), held.end(), [&](std::uint32_t v) {
            taken += MachineRegisters::is_broadcast(v) ? 1 : pieces;
            return taken > room;
        });
        held.erase(out, held.end());
    }
    /// Whether it is one of the `interleaved` others used last in the stretch, or was itself.
    bool passes(std::uint32_t value) {
        const auto at = std::find(stretch.begin(), stretch.end(), value);
        const bool there =
            static_cast<std::size_t>(at - stretch.begin()) < std::min(interleaved, stretch.size());
        if (at != stretch.end())
            stretch.erase(at);
        stretch.push_front(value);
        return there;
    }
    RegisterFile::Use use(std::uint32_t value) {
        auto where = RegisterFile::Use::resident;
        const bool passing = passes(value);
        if (const auto at = std::find(held.begin(), held.end(), value); at != held.end())
            held.erase(at);
        else if (!passing)
            where = stored.insert(value).second ? RegisterFile::Use::unstored : RegisterFile::Use::stored;
        hold(value);
        return where;
    }
};

TEST(Registers, EqualAListOfTheLastUsed) {
    std::mt19937 random(5);
    for (const std::size_t capacity : {1U, 2U, 3U, 7U, 8U, 9U, 16U, 17U, 40U}) {
        RegisterFile file(capacity);
        PlainRegisters plain{capacity, 1};
        std::uint32_t last = 0;
        std::array<int, 3> seen{};
        for (int i = 0; i < 20000; ++i) {
            if (last == 0 || random() % 3 == 0) {
                last = file.make();
                plain.hold(last);
                continue;
            }
            // Not so old that whether it was stored is forgotten.
            const auto back = static_cast<std::uint32_t>(random() % std::min(last, std::uint32_t{60}));
            const std::uint32_t value = last - back;
            const RegisterFile::Use expected = plain.use(value);
            const RegisterFile::Use use = file.use(value);
            ASSERT_EQ(use, expected) << "of " << capacity << ", step " << i;
            ++seen[static_cast<std::size_t>(use)];
        }
        for (const int count : seen)
            EXPECT_GT(count, 100) << capacity;
    }
}

// Two at once are used as one after the other, or not at all.
TEST(Registers, OperandsAreUsedTogether) {
    std::mt19937 random(6);
    for (const std::size_t capacity : {1U, 2U, 5U, 8U, 12U}) {
        RegisterFile file(capacity), plain(capacity);
        std::array<int, 2> seen{};
        std::uint32_t last = 0;
        for (int i = 0; i < 20000; ++i) {
            if (last < 20 || random() % 3 == 0) {
                last = file.make();
                ASSERT_EQ(plain.make(), last);
                continue;
            }
            const auto any = [&] {
                return random() % 5 == 0 ? 0 : last - static_cast<std::uint32_t>(random() % 10);
            };
            const std::uint32_t a = any(), b = any();
            const bool all = file.use_all(a, b);
            ++seen[all ? 1 : 0];
            for (const std::uint32_t value : {a, b}) {
                const RegisterFile::Use use = plain.use(value);
                if (all)
                    ASSERT_EQ(use, RegisterFile::Use::resident) << "of " << capacity << ", step " << i;
                else
                    ASSERT_EQ(file.use(value), use) << "of " << capacity << ", step " << i;
            }
        }
        EXPECT_GT(seen[0], 100) << capacity;
        EXPECT_GT(seen[1], 100) << capacity;
    }
}

// Three used and a new one made in one go, as while caches are warmed: all as one after the other.
TEST(Registers, OperandsAndResultGoAsOneAfterTheOther) {
    std::mt19937 random(8);
    for (const std::size_t capacity : {0U, 1U, 2U, 5U, 8U, 12U}) {
        RegisterFile file(capacity), plain(capacity);
        std::uint32_t last = 0;
        int reloads = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto any = [&] {
                return random() % 5 == 0 || last < 20 ? 0 : last - static_cast<std::uint32_t>(random() % 12);
            };
            const std::array<std::uint32_t, 3> values = {any(), any(), any()};
            const bool makes = last < 20 || random() % 3 == 0;
            std::vector<std::pair<std::uint32_t, RegisterFile::Use>> absent, expected;
            RegisterFile::Absent found;
            const std::uint32_t made = file.use_and_make(makes, found, values[0], values[1], values[2]);
            for (std::uint32_t k = 0; k < found.count; ++k)
                absent.emplace_back(found.values[k], file.store_once(found.values[k]));
            for (const std::uint32_t value : values)
                if (const auto where = plain.use(value); where != RegisterFile::Use::resident)
                    expected.emplace_back(value, where);
            ASSERT_EQ(absent, expected) << "of " << capacity << ", step " << i;
            ASSERT_EQ(made, makes ? plain.make() : 0) << "of " << capacity << ", step " << i;
            last = makes ? made : last;
            reloads += static_cast<int>(absent.size());
        }
        EXPECT_EQ(reloads > 100, capacity != 0) << capacity;
    }
}

TEST(Registers, UnlimitedOnesAreNeverReloaded) {
    RegisterFile file(0);
    const std::uint32_t first = file.make();
    for (int i = 0; i < 3000; ++i)
        file.make();
    EXPECT_EQ(file.use(first), RegisterFile::Use::resident);
    EXPECT_EQ(file.use(0), RegisterFile::Use::resident);
}

TEST(Registers, OfTheMachineEqualAListOfTheLastUsed) {
    std::mt19937 random(7);
    for (const std::size_t pieces : {1U, 2U, 4U, 8U})
        for (const std::size_t values : {1U, 2U, 3U, 6U}) {
            const std::size_t interleaved = values == 2 ? 0 : pieces + 1;
            MachineRegisters file(values * pieces, pieces, interleaved);
            PlainRegisters plain{values * pieces, pieces, interleaved};
            std::vector<std::uint32_t> made;
            std::array<int, 3> seen{};
            for (int i = 0; i < 20000; ++i) {
                if (random() % 8 == 0) {
                    file.end_stretch();
                    plain.stretch.clear();
                }
                if (made.empty() || random() % 3 == 0) {
                    const bool broadcast = random() % 3 == 0;
                    made.push_back(file.make(broadcast));
                    ASSERT_EQ(MachineRegisters::is_broadcast(made.back()), broadcast);
                    ASSERT_EQ(MachineRegisters::number(made.back()), made.size());
                    plain.hold(made.back());
                    plain.passes(made.back());
                    continue;
                }
                const std::uint32_t value =
                    made[made.size() - 1 - random() % std::min<std::size_t>(made.size(), 60)];
                const RegisterFile::Use expected = plain.use(value);
                const RegisterFile::Use use = file.use(value);
                ASSERT_EQ(use, expected) << values << " values of " << pieces << ", step " << i;
                ++seen[static_cast<std::size_t>(use)];
            }
            for (const int count : seen)
                EXPECT_GT(count, 100) << values << " values of " << pieces;
        }
}

} // namespace
} // namespace sim::test
