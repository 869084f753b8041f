// Strides against a plain list of all references, and counts of frequent values against all counts.
#include "analysis/traces/strides.h"
#include "traces/block_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace analysis {
namespace {

std::vector<Access> random_accesses(std::size_t count, std::uint32_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Access> out;
    std::map<std::uint32_t, std::uint64_t> at;
    for (std::size_t i = 0; i < count; ++i) {
        Access a{};
        a.stream = static_cast<std::uint32_t>(random() % 3);
        a.group = static_cast<std::uint32_t>(random() % 2);
        a.more = random() % 2 == 0 ? 7 : 3;
        std::uint64_t& next = at[a.stream];
        switch (random() % 4) {
        case 0:
            next += a.more + 1;
            break;
        case 1:
            next += 96;
            break;
        case 2:
            next = random() % 5000;
            break;
        default:
            break;
        }
        a.address = next;
        out.push_back(a);
    }
    return out;
}

TEST(Strides, AreThoseOfAPlainList) {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        const std::vector<Access> all = random_accesses(4000, seed);
        Strides strides;
        for (const Access& a : all)
            strides.add(a);
        std::vector<std::array<std::uint64_t, Strides::patterns>> expected(2);
        std::vector<std::map<std::int64_t, std::uint64_t>> counts(2);
        for (std::size_t i = 0; i < all.size(); ++i) {
            std::vector<std::size_t> before; // of the same thread and group, the last first
            for (std::size_t k = i; k-- > 0 && before.size() < 2;)
                if (all[k].stream == all[i].stream && all[k].group == all[i].group)
                    before.push_back(k);
            auto& of = expected[all[i].group];
            if (before.empty()) {
                ++of[Strides::first];
                continue;
            }
            const Access& last = all[before[0]];
            const auto stride = static_cast<std::int64_t>(all[i].address - last.address);
            const auto other =
                before.size() < 2 ? 0 : static_cast<std::int64_t>(last.address - all[before[1]].address);
            ++counts[all[i].group][stride];
            ++of[all[i].address == last.address                   ? Strides::same
                 : all[i].address == last.address + last.more + 1 ? Strides::sequential
                 : stride == other                                ? Strides::strided
                                                                  : Strides::irregular];
        }
        for (std::size_t g = 0; g < 2; ++g) {
            const Strides::Group& got = strides.groups()[g];
            EXPECT_EQ(got.counts, expected[g]);
            std::uint64_t references = 0, in_buckets = 0;
            for (const Access& a : all)
                references += a.group == g ? 1 : 0;
            EXPECT_EQ(got.references(), references);
            for (std::size_t b = 0; b < Strides::buckets; ++b) {
                std::uint64_t forwards = 0, backwards = 0;
                for (const auto& [stride, n] : counts[g]) {
                    const std::uint64_t size = static_cast<std::uint64_t>(stride < 0 ? -stride : stride);
                    if ((size == 0 && b == 0) ||
                        (size != 0 && b != 0 && size >= std::uint64_t{1} << (b - 1) &&
                         (b == 64 || size < std::uint64_t{1} << b)))
                        (stride < 0 ? backwards : forwards) += n;
                }
                EXPECT_EQ(got.forwards[b], forwards) << b;
                EXPECT_EQ(got.backwards[b], backwards) << b;
                in_buckets += forwards + backwards;
            }
            EXPECT_EQ(in_buckets + got.counts[Strides::first], references);
            for (const auto& [value, count] : got.values.most(8)) {
                EXPECT_LE(count, counts[g].at(value));
                EXPECT_GE(count + got.values.error(), counts[g].at(value));
            }
            const auto most =
                std::max_element(counts[g].begin(), counts[g].end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; });
            EXPECT_EQ(got.values.most(1)[0].value, most->first);
        }
    }
}

TEST(Strides, KnowWholeSweepsAndSteps) {
    Strides strides;
    for (std::uint64_t i = 0; i < 100; ++i) {
        strides.add({i * 8, 7, 0, 0, i, false});              // through an array
        strides.add({1 << 20, 7, 1, 0, i, false});            // always there
        strides.add({(1 << 20) - i * 48, 7, 2, 0, i, false}); // backwards over records
    }
    using P = Strides;
    EXPECT_EQ(strides.groups()[0].counts[P::sequential], 99U);
    EXPECT_EQ(strides.groups()[1].counts[P::same], 99U);
    EXPECT_EQ(strides.groups()[2].counts[P::strided], 98U);
    EXPECT_EQ(strides.groups()[2].counts[P::irregular], 1U); // the first step has none before it
    EXPECT_EQ(strides.groups()[2].values.most(3).size(), 1U);
    EXPECT_EQ(strides.groups()[2].values.most(3)[0].value, -48);
    EXPECT_EQ(strides.groups()[2].backwards[6], 99U);
}

/// Many more values than there is room for: frequent ones are there, their counts within the error.
TEST(FrequentValues, KeepsWhatIsFrequent) {
    std::mt19937_64 random(3);
    FrequentValues values(20);
    std::map<std::int64_t, std::uint64_t> all;
    constexpr std::uint64_t count = 100000;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto value = static_cast<std::int64_t>(random() % 4 == 0 ? random() % 3 : random() % 100000);
        values.add(value);
        ++all[value];
    }
    EXPECT_GT(values.error(), 0U);
    EXPECT_LE(values.error(), count / 21);
    const auto most = values.most(20);
    for (std::int64_t frequent = 0; frequent < 3; ++frequent) {
        const auto found =
            std::find_if(most.begin(), most.end(), [&](const auto& m) { return m.value == frequent; });
        ASSERT_NE(found, most.end());
        EXPECT_LE(found->count, all[frequent]);
        EXPECT_GE(found->count + values.error(), all[frequent]);
    }
}

} // namespace
} // namespace analysis
