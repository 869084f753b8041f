// Why caches miss, how much of lines they use and how much they hold twice: against stays of lines that a
// plainly written cache has, and laws.
#include "analysis/traces/line_residency.h"
#include "analysis/traces/line_use.h"
#include "analysis/traces/miss_causes.h"
#include "analysis/traces/replication.h"
#include "sim/memory/miss_causes.h"
#include "tests/analysis/plain_caches.h"
#include "tests/analysis/plain_memory.h"

#include <gtest/gtest.h>

#include <numeric>
#include <optional>

namespace analysis {
namespace {

using test::plain_stays;
using test::random_touches;
using test::Stay;

struct Case {
    std::uint64_t sets, ways, lines;
    std::uint32_t threads, threads_of_cache;
};
constexpr Case cases[] = {{4, 2, 40, 3, 1},  {1, 16, 60, 4, 2}, {8, 4, 300, 5, 1},
                          {16, 1, 50, 2, 2}, {3, 3, 25, 6, 3},  {2, 16, 60, 3, 1}};
constexpr std::size_t touches_of_case = 3000;
constexpr std::uint64_t line_bytes = 64;

/// Whether a line is in a cache just before a touch.
const Stay* stay_at(const std::vector<Stay>& stays, std::uint32_t cache, std::uint64_t line,
                    std::uint64_t at) {
    for (const Stay& s : stays)
        if (s.cache == cache && s.line == line && s.begin < at && s.end >= at)
            return &s;
    return nullptr;
}
/// The last stay that ended before a touch.
const Stay* last_stay(const std::vector<Stay>& stays, std::uint32_t cache, std::uint64_t line,
                      std::uint64_t at) {
    const Stay* out = nullptr;
    for (const Stay& s : stays)
        if (s.cache == cache && s.line == line && s.begin < at)
            out = &s;
    return out;
}

bool overlaps(const Touch& a, const Touch& b) {
    return a.low <= b.high && b.low <= a.high;
}

/// Whether a cache would have a line just before a touch if no other cache ever wrote to that line.
bool would_have(const std::vector<Touch>& touches, std::uint64_t sets, std::uint64_t ways,
                std::uint32_t threads_of_cache, std::uint32_t cache, std::uint64_t line, std::uint64_t at) {
    std::vector<std::uint64_t> set; // the line's, oldest first
    for (std::uint64_t i = 0; i < at; ++i) {
        const Touch& t = touches[i];
        if (t.line % sets != line % sets)
            continue;
        const bool own = t.stream / threads_of_cache == cache;
        if (own || (t.writes && t.line != line))
            std::erase(set, t.line);
        if (own && set.size() == ways)
            set.erase(set.begin());
        if (own)
            set.push_back(t.line);
    }
    return std::find(set.begin(), set.end(), line) != set.end();
}

/// The causes by their definitions, from all stays and all touches.
std::vector<MissCauses::Group> plain_causes(const std::vector<Touch>& touches, const Case& c) {
    const std::vector<Stay> real = plain_stays(touches, c.sets, c.ways, c.threads_of_cache);
    const std::vector<Stay> full = plain_stays(touches, 1, c.sets * c.ways, c.threads_of_cache);
    std::vector<MissCauses::Group> out(3);
    for (const Touch& t : touches)
        ++out[t.group].references;
    for (const Stay& s : real) {
        MissCauses::Group& g = out[touches[s.begin].group];
        const Stay* before = last_stay(real, s.cache, s.line, s.begin);
        const bool beside = stay_at(full, s.cache, s.line, s.begin) != nullptr;
        const auto would = [&](std::uint64_t sets, std::uint64_t ways) {
            return would_have(touches, sets, ways, c.threads_of_cache, s.cache, s.line, s.begin);
        };
        if (before == nullptr) {
            ++g.compulsory;
        } else if (would(c.sets, c.ways) || (!beside && would(1, c.sets * c.ways))) {
            bool truly = false; // something written elsewhere since it was lost is touched while it stays
            for (std::uint64_t w = before->end; w < s.begin; ++w)
                for (std::uint64_t u = s.begin; u < s.end; ++u)
                    truly = truly ||
                            (touches[w].line == s.line && touches[w].writes &&
                             touches[w].stream / c.threads_of_cache != s.cache && touches[u].line == s.line &&
                             touches[u].stream / c.threads_of_cache == s.cache &&
                             overlaps(touches[w], touches[u]));
            ++(truly ? g.true_sharing : g.false_sharing);
        } else {
            ++(beside ? g.conflict : g.capacity);
        }
    }
    return out;
}

/// A class's answers for a case.
template <class Analysis> Analysis analysed(const std::vector<Touch>& touches, const Case& c) {
    Analysis analysis({c.sets, c.ways, line_bytes});
    for (const Touch& t : touches)
        analysis.touch(t, t.stream / c.threads_of_cache);
    return analysis;
}

TEST(MissCauses, AreThoseOfTheDefinitions) {
    std::uint32_t seed = 0;
    MissCauses::Group met;
    for (const Case& c : cases) {
        SCOPED_TRACE(testing::Message() << c.sets << " x " << c.ways);
        const auto touches = random_touches(touches_of_case, c.lines, c.threads, line_bytes, ++seed);
        auto causes = analysed<MissCauses>(touches, c);
        causes.finish();
        const std::vector<MissCauses::Group> expected = plain_causes(touches, c);
        ASSERT_EQ(causes.groups().size(), expected.size());
        for (std::size_t g = 0; g < expected.size(); ++g) {
            const MissCauses::Group &got = causes.groups()[g], &e = expected[g];
            EXPECT_EQ(got.references, e.references) << g;
            EXPECT_EQ(got.compulsory, e.compulsory) << g;
            EXPECT_EQ(got.capacity, e.capacity) << g;
            EXPECT_EQ(got.conflict, e.conflict) << g;
            EXPECT_EQ(got.true_sharing, e.true_sharing) << g;
            EXPECT_EQ(got.false_sharing, e.false_sharing) << g;
            met.capacity += e.capacity;
            met.conflict += e.conflict;
            met.true_sharing += e.true_sharing;
            met.false_sharing += e.false_sharing;
        }
    }
    EXPECT_GT(std::min({met.capacity, met.conflict, met.true_sharing, met.false_sharing}), 100U);
}

/// As many misses as the simulator's classifier finds for each cache, of the same causes, but that it calls
/// those of lines that a write dropped coherence however long ago that was.
TEST(MissCauses, AreThoseOfTheSimulator) {
    std::uint64_t sharing = 0, coherence = 0;
    for (const Case& c : cases) {
        const auto touches = random_touches(20000, c.lines, c.threads, line_bytes, 77);
        auto causes = analysed<MissCauses>(touches, c);
        causes.finish();
        const std::vector<Stay> stays = plain_stays(touches, c.sets, c.ways, c.threads_of_cache);
        const std::uint32_t caches = (c.threads - 1) / c.threads_of_cache + 1;
        std::vector<sim::MissCauses> classifiers(caches, sim::MissCauses(c.sets * c.ways));
        std::vector<std::set<std::uint64_t>> held(caches);
        std::array<std::uint64_t, 4> expected{};
        std::size_t next = 0; // stay to begin
        std::multimap<std::uint64_t, const Stay*> ends;
        for (const Stay& s : stays)
            ends.emplace(s.end, &s);
        for (std::size_t i = 0; i < touches.size(); ++i) {
            const Touch& t = touches[i];
            const std::uint32_t cache = t.stream / c.threads_of_cache;
            if (next < stays.size() && stays[next].begin == i) {
                ++expected[static_cast<std::size_t>(classifiers[cache].of(t.line))];
                ++next;
            }
            classifiers[cache].use(t.line, true);
            if (t.writes)
                for (std::uint32_t other = 0; other < caches; ++other)
                    if (other != cache)
                        classifiers[other].invalidate(t.line, held[other].contains(t.line));
            for (auto [at, end] = ends.equal_range(i); at != end; ++at)
                held[at->second->cache].erase(at->second->line);
            held[cache].insert(t.line);
        }
        MissCauses::Group all;
        for (const MissCauses::Group& g : causes.groups()) {
            all.compulsory += g.compulsory;
            all.capacity += g.capacity;
            all.conflict += g.conflict;
            all.true_sharing += g.true_sharing + g.false_sharing;
        }
        EXPECT_EQ(all.compulsory, expected[static_cast<std::size_t>(sim::MissCause::compulsory)]);
        EXPECT_GE(all.capacity, expected[static_cast<std::size_t>(sim::MissCause::capacity)]);
        EXPECT_GE(all.conflict, expected[static_cast<std::size_t>(sim::MissCause::conflict)]);
        EXPECT_LE(all.true_sharing, expected[static_cast<std::size_t>(sim::MissCause::coherence)]);
        EXPECT_EQ(all.misses(), std::accumulate(expected.begin(), expected.end(), std::uint64_t{0}));
        sharing += all.true_sharing;
        coherence += expected[static_cast<std::size_t>(sim::MissCause::coherence)];
    }
    EXPECT_LT(sharing, coherence);
}

/// What a write elsewhere took is not missed for it once the cache would have lost it anyway.
TEST(MissCauses, ForgetSharingWhenTheLineWouldBeGone) {
    for (const std::uint64_t others : {3U, 4U, 5000U}) {
        MissCauses causes({1, 4, line_bytes});
        causes.touch({1, 0, 7, 0, 0, 0, false}, 0);
        causes.touch({1, 0, 7, 1, 1, 0, true}, 1);
        for (std::uint64_t other = 0; other < others; ++other)
            causes.touch({100 + other, 0, 7, 0, 0, 0, false}, 0);
        causes.touch({1, 0, 7, 2, 0, 0, false}, 0);
        causes.finish();
        const MissCauses::Group& again = causes.groups()[2];
        EXPECT_EQ(again.misses(), 1U);
        EXPECT_EQ(again.true_sharing, others < 4 ? 1U : 0U) << others;
        EXPECT_EQ(again.capacity, others < 4 ? 0U : 1U) << others;
    }
}

TEST(MissCauses, SumToTheMissesOfAPlainCache) {
    for (const auto& [sets, ways] : {std::pair<std::uint64_t, std::uint64_t>{1, 32}, {16, 2}, {7, 3}}) {
        const auto touches = random_touches(20000, 200, 4, line_bytes, 5);
        std::vector<std::uint64_t> lines;
        for (const Touch& t : touches)
            lines.push_back(t.line);
        MissCauses causes({sets, ways, line_bytes});
        for (const Touch& t : touches)
            causes.touch(t, 0);
        causes.finish();
        MissCauses::Group all;
        std::uint64_t misses = 0;
        for (const MissCauses::Group& g : causes.groups()) {
            misses += g.misses();
            all.compulsory += g.compulsory;
            all.conflict += g.conflict;
            all.true_sharing += g.true_sharing + g.false_sharing;
        }
        EXPECT_EQ(misses, test::plain_misses(lines, sets, ways, true));
        EXPECT_EQ(all.compulsory, std::set(lines.begin(), lines.end()).size());
        EXPECT_EQ(all.true_sharing, 0U); // nobody else
        EXPECT_EQ(all.conflict == 0, sets == 1);
    }
}

/// Two threads take turns: the one writes where the other reads, or beside it.
TEST(MissCauses, TellSharingFromFalseSharing) {
    for (const bool beside : {false, true}) {
        MissCauses causes({1, 4, line_bytes});
        for (int i = 0; i < 10; ++i) {
            causes.touch({1, 0, 7, 0, 0, 0, true}, 0);
            const std::uint64_t at = beside ? 8 : 0;
            causes.touch({1, at, at + 7, 1, 1, 0, false}, 1);
        }
        causes.finish();
        const MissCauses::Group& reader = causes.groups()[1];
        EXPECT_EQ(reader.compulsory, 1U);
        EXPECT_EQ(reader.true_sharing, beside ? 0U : 9U);
        EXPECT_EQ(reader.false_sharing, beside ? 9U : 0U);
        EXPECT_EQ(causes.groups()[0].misses(), 1U); // it keeps what it writes
    }
    // What was written elsewhere is touched late in the stay, beside it first.
    MissCauses causes({1, 4, line_bytes});
    causes.touch({1, 8, 8, 0, 1, 0, false}, 1);
    causes.touch({1, 0, 7, 0, 0, 0, true}, 0);
    for (const std::uint64_t at : {8U, 9U, 3U})
        causes.touch({1, at, at, 1, 1, 0, false}, 1);
    causes.finish();
    EXPECT_EQ(causes.groups()[1].true_sharing, 1U);
}

TEST(LineResidency, IsThatOfPlainStays) {
    std::uint32_t seed = 20;
    for (const Case& c : cases) {
        SCOPED_TRACE(testing::Message() << c.sets << " x " << c.ways);
        const auto touches = random_touches(touches_of_case, c.lines, c.threads, line_bytes, ++seed);
        auto residency = analysed<LineResidency>(touches, c);
        residency.finish();
        std::vector<LineResidency::Group> expected(3);
        for (const Stay& s : plain_stays(touches, c.sets, c.ways, c.threads_of_cache)) {
            std::set<std::uint64_t> bytes;
            std::uint64_t count = 0;
            for (std::uint64_t i = s.begin; i < s.end; ++i)
                if (touches[i].line == s.line && touches[i].stream / c.threads_of_cache == s.cache) {
                    ++count;
                    for (std::uint64_t b = touches[i].low; b <= touches[i].high; ++b)
                        bytes.insert(b);
                }
            LineResidency::Group& g = expected[touches[s.begin].group];
            ++g.stays;
            g.touches += count;
            g.bytes += bytes.size();
            g.once += count == 1 ? 1 : 0;
            g.dropped += s.dropped ? 1 : 0;
            ++g.parts[bytes.size() <= 16 ? 0 : bytes.size() <= 32 ? 1 : bytes.size() <= 48 ? 2 : 3];
        }
        std::uint64_t all = 0;
        for (std::size_t g = 0; g < 3; ++g) {
            const LineResidency::Group &got = residency.groups()[g], &e = expected[g];
            EXPECT_EQ(got.stays, e.stays);
            EXPECT_EQ(got.touches, e.touches);
            EXPECT_EQ(got.bytes, e.bytes);
            EXPECT_EQ(got.once, e.once);
            EXPECT_EQ(got.dropped, e.dropped);
            EXPECT_EQ(got.parts, e.parts);
            EXPECT_EQ(std::accumulate(got.parts.begin(), got.parts.end(), std::uint64_t{0}), got.stays);
            all += got.touches;
        }
        EXPECT_EQ(all, touches.size()); // each is of a stay
    }
}

TEST(Replication, IsThatOfPlainStays) {
    std::uint32_t seed = 40;
    for (const Case& c : cases) {
        SCOPED_TRACE(testing::Message() << c.sets << " x " << c.ways);
        const auto touches = random_touches(1000, c.lines, c.threads, line_bytes, ++seed);
        const auto replication = analysed<Replication>(touches, c);
        std::map<std::uint64_t, std::uint32_t> owner; // of lines: who touched them first
        for (const Touch& t : touches)
            owner.emplace(t.line, t.group);
        const std::vector<Stay> stays = plain_stays(touches, c.sets, c.ways, c.threads_of_cache);
        std::vector<std::uint64_t> copies(3, 0), different(3, 0);
        for (std::uint64_t now = 0; now < touches.size(); ++now) { // after each touch
            std::set<std::uint64_t> lines;
            for (const Stay& s : stays)
                if (s.begin <= now && s.end > now) {
                    ++copies[owner.at(s.line)];
                    lines.insert(s.line);
                }
            for (const std::uint64_t line : lines)
                ++different[owner.at(line)];
        }
        const std::vector<Replication::Group> got = replication.groups();
        bool twice = false;
        for (std::size_t g = 0; g < 3; ++g) {
            const auto n = static_cast<double>(touches.size());
            EXPECT_NEAR(got[g].copies, static_cast<double>(copies[g]) / n, 1e-9) << g;
            EXPECT_NEAR(got[g].lines, static_cast<double>(different[g]) / n, 1e-9) << g;
            twice = twice || got[g].copies > got[g].lines + 0.2;
        }
        EXPECT_EQ(twice, c.threads > c.threads_of_cache);
    }
}

TEST(LineUse, CountsWhoSharesWhat) {
    const auto touches = random_touches(5000, 300, 6, line_bytes, 9);
    LineUse use(line_bytes);
    std::map<std::uint64_t, std::map<std::uint32_t, std::set<std::uint64_t>>> bytes; // by line and thread
    std::map<std::uint64_t, std::uint32_t> owner;
    std::map<std::uint64_t, std::set<std::uint32_t>> writers;
    for (const Touch& t : touches) {
        use.touch(t);
        owner.emplace(t.line, t.group);
        for (std::uint64_t b = t.low; b <= t.high; ++b)
            bytes[t.line][t.stream].insert(b);
        if (t.writes)
            writers[t.line].insert(t.stream);
    }
    std::uint64_t lines = 0, references = 0, copies = 0;
    for (const LineUse::Shared& s : use.shared()) {
        std::uint64_t expected = 0, written = 0;
        for (const auto& [line, threads] : bytes)
            if (owner.at(line) == s.group && threads.size() == s.threads) {
                ++expected;
                written += writers[line].empty() ? 0 : 1;
            }
        EXPECT_EQ(s.lines, expected);
        EXPECT_EQ(s.written, written);
        lines += s.lines;
        references += s.touches;
        copies += s.lines * s.threads;
    }
    EXPECT_EQ(lines, bytes.size());
    EXPECT_EQ(references, touches.size());
    std::uint64_t of_threads = 0;
    for (const LineUse::Footprint& f : use.footprints()) {
        std::uint64_t all = 0, alone = 0, used = 0, written = 0;
        for (const auto& [line, threads] : bytes)
            if (threads.contains(f.stream)) {
                ++all;
                alone += threads.size() == 1 ? 1 : 0;
                used += threads.at(f.stream).size();
                written += writers[line].contains(f.stream) ? 1 : 0;
            }
        EXPECT_EQ(f.lines, all);
        EXPECT_EQ(f.alone, alone);
        EXPECT_EQ(f.bytes, used);
        EXPECT_EQ(f.written, written);
        of_threads += f.lines;
    }
    EXPECT_EQ(of_threads, copies);
}

} // namespace
} // namespace analysis
