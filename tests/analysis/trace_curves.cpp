// Curves of misses against caches that are written plainly, published counts, and laws of replacement.
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/object_lru.h"
#include "analysis/traces/optimum.h"
#include "analysis/traces/recent_stack.h"
#include "analysis/traces/set_curve.h"
#include "analysis/traces/touches.h"
#include "tests/analysis/plain_caches.h"
#include "traces/formats/format.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <list>
#include <set>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace analysis {
namespace {

using test::plain_distances;
using test::plain_misses;
using test::random_lines;

template <class Stack> class Stacks : public testing::Test {};
using AllStacks = testing::Types<StackDistance, RecentStack>;
TYPED_TEST_SUITE(Stacks, AllStacks);

TYPED_TEST(Stacks, SayThePlaceOfLines) {
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        const std::vector<std::uint64_t> touches =
            random_lines(6000, 1 + seed * seed * 60, seed, seed % 2 == 1);
        const std::vector<std::uint64_t> expected = plain_distances(touches);
        TypeParam stack;
        for (std::size_t i = 0; i < touches.size(); ++i) {
            const std::uint64_t got = stack.touch(touches[i] << (seed * 9));
            ASSERT_EQ(got == StackDistance::first ? 0 : got, expected[i]) << seed << ' ' << i;
        }
        EXPECT_EQ(stack.lines(), std::set(touches.begin(), touches.end()).size());
    }
}

/// Far more touches than slots, and more lines than the first row of slots holds: rows are packed and grow.
TYPED_TEST(Stacks, SurvivePacking) {
    constexpr std::uint64_t lines = 50000;
    TypeParam stack;
    for (std::uint64_t i = 0; i < lines; ++i)
        ASSERT_EQ(stack.touch(i), StackDistance::first);
    for (int round = 0; round < 8; ++round)
        for (std::uint64_t i = 0; i < lines; ++i) { // there and back
            const std::uint64_t line = round % 2 == 0 ? lines - 1 - i : i;
            ASSERT_EQ(stack.touch(line), i + 1) << round;
        }
    EXPECT_EQ(stack.lines(), lines);
}

TYPED_TEST(Stacks, ForgetLines) {
    std::vector<std::uint64_t> stack; // the top last
    TypeParam tested(512);
    std::mt19937_64 random(5);
    for (int i = 0; i < 200000; ++i) {
        const std::uint64_t line = random() % 300;
        const auto found = std::find(stack.rbegin(), stack.rend(), line);
        if (random() % 5 == 0 && found != stack.rend()) {
            stack.erase(std::next(found).base());
            tested.forget(line);
            continue;
        }
        const std::uint64_t expected = found == stack.rend()
                                           ? StackDistance::first
                                           : static_cast<std::uint64_t>(found - stack.rbegin()) + 1;
        if (found != stack.rend())
            stack.erase(std::next(found).base());
        stack.push_back(line);
        ASSERT_EQ(tested.touch(line), expected) << i;
        ASSERT_EQ(tested.lines(), stack.size());
    }
}

TEST(Curves, HaveTheMissesOfPlainCaches) {
    const std::vector<std::uint64_t> sizes = {1, 2, 3, 8, 50, 64, 200, 5000};
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const std::vector<std::uint64_t> touches = random_lines(8000, 300, seed, seed % 2 == 1);
        LruCurve curve(sizes);
        SetCurve four(4, {1, 2, 5, 16}), seven(7, {1, 3});
        for (std::size_t i = 0; i < touches.size(); ++i) {
            curve.touch(touches[i], i % 3);
            four.touch(touches[i], i % 3);
            seven.touch(touches[i], i % 3);
        }
        const auto all = [](const ReuseCounts& counts, std::size_t size) {
            return counts.misses(0, size) + counts.misses(1, size) + counts.misses(2, size);
        };
        for (std::size_t s = 0; s < sizes.size(); ++s)
            EXPECT_EQ(all(curve.counts(), s), plain_misses(touches, 1, sizes[s], true)) << sizes[s];
        for (std::size_t w = 0; w < 4; ++w)
            EXPECT_EQ(all(four.counts(), w), plain_misses(touches, 4, four.counts().sizes()[w], true)) << w;
        for (std::size_t w = 0; w < 2; ++w)
            EXPECT_EQ(all(seven.counts(), w), plain_misses(touches, 7, seven.counts().sizes()[w], true)) << w;
        for (std::size_t group = 0; group < 3; ++group) {
            EXPECT_EQ(curve.counts().references(group), (touches.size() - group + 2) / 3);
            for (std::size_t s = 1; s < sizes.size(); ++s) // a stack policy
                EXPECT_LE(curve.counts().misses(group, s), curve.counts().misses(group, s - 1));
            EXPECT_EQ(curve.counts().misses(group, sizes.size() - 1), curve.counts().firsts(group));
        }
    }
}

TEST(Optimum, IsTheLeastThatAnyChoiceGives) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const std::vector<std::uint64_t> touches = random_lines(24, 6, seed, seed % 2 == 0);
        Optimum optimum;
        for (const std::uint64_t line : touches)
            optimum.touch(line, 0);
        for (const std::size_t lines : {1U, 2U, 3U, 4U})
            EXPECT_EQ(optimum.misses(lines, 1)[0], test::least_misses(touches, lines))
                << seed << ' ' << lines;
    }
}

TEST(Optimum, LetsItsCallerEndIt) {
    Optimum optimum;
    for (std::uint64_t i = 0; i < 200000; ++i)
        optimum.touch(i % 100, 0);
    int looks = 0;
    EXPECT_THROW(optimum.misses(10, 1,
                                [&] {
                                    if (++looks == 3)
                                        throw std::runtime_error("enough");
                                }),
                 std::runtime_error);
}

TEST(Optimum, IsNoMoreThanAnyPolicyNeeds) {
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const std::vector<std::uint64_t> touches = random_lines(20000, 900, seed, seed % 2 == 0);
        Optimum optimum;
        for (std::size_t i = 0; i < touches.size(); ++i)
            optimum.touch(touches[i], i % 2);
        std::uint64_t before = touches.size();
        for (const std::uint64_t lines : {1U, 4U, 16U, 64U, 256U, 1024U}) {
            const std::vector<std::uint64_t> by_group = optimum.misses(lines, 2);
            const std::uint64_t least = by_group[0] + by_group[1];
            EXPECT_LE(least, plain_misses(touches, 1, lines, true));
            EXPECT_LE(least, plain_misses(touches, 1, lines, false));
            EXPECT_LE(least, before);
            EXPECT_GE(least, optimum.lines());
            before = least;
        }
        EXPECT_EQ(before, optimum.lines());
    }
}

TEST(Objects, HaveTheMissesOfAPlainCache) {
    std::mt19937_64 random(4);
    for (const std::uint64_t capacity : {1U, 50U, 1000U, 20000U}) {
        ObjectLru cache(capacity);
        std::list<std::pair<std::uint64_t, std::uint64_t>> plain; // object, bytes; the last touched first
        for (int i = 0; i < 20000; ++i) {
            const std::uint64_t object = random() % 200 * (random() % 200) / 200;
            const std::uint64_t bytes = random() % 20 == 0 ? random() % 300 : object % 97 + 1;
            const auto found =
                std::find_if(plain.begin(), plain.end(), [&](const auto& p) { return p.first == object; });
            const bool hit = found != plain.end();
            if (hit)
                plain.erase(found);
            if (bytes <= capacity)
                plain.emplace_front(object, bytes);
            std::uint64_t held = 0;
            for (const auto& p : plain)
                held += p.second;
            for (; held > capacity; plain.pop_back())
                held -= plain.back().second;
            ASSERT_EQ(cache.touch(object, bytes), hit) << capacity << ' ' << i;
            ASSERT_EQ(cache.bytes(), held) << capacity << ' ' << i;
        }
    }
}

/// Counts that libCacheSim publishes for this trace.
TEST(Objects, HaveThePublishedMisses) {
    const std::string file = RAZOR_SHARED_SCENES "/traces/cloudPhysicsIO.id_size.txt.gz";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << file << " is not there";
    std::string text(std::size_t{8} << 20, '\0');
    const auto source = traces::open_source(file);
    text.resize(source->read(text.data(), text.size()));
    const std::vector<std::uint64_t> published = {93374, 89783, 81722, 71704};
    std::vector<ObjectLru> caches;
    for (const std::uint64_t mebibytes : {128U, 256U, 512U, 1024U})
        caches.emplace_back(mebibytes << 20U);
    std::vector<std::uint64_t> misses(caches.size(), 0);
    std::istringstream in(text);
    std::uint64_t object = 0, bytes = 0, count = 0;
    for (; in >> object >> bytes; ++count)
        for (std::size_t c = 0; c < caches.size(); ++c)
            misses[c] += caches[c].touch(object, bytes) ? 0 : 1;
    EXPECT_EQ(count, 113872U);
    EXPECT_EQ(misses, published);
}

} // namespace
} // namespace analysis
