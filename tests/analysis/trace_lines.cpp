// Which lines references touch, what they count for, and what becomes of lines.
#include "analysis/traces/line_use.h"
#include "analysis/traces/table.h"
#include "analysis/traces/touches.h"
#include "analysis/traces/windows.h"
#include "tests/analysis/plain_caches.h"
#include "traces/block_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace analysis {
namespace {

using traces::Kind;

traces::Block block_of(const std::vector<traces::Reference>& references) {
    traces::BlockBuilder builder;
    for (const traces::Reference& r : references)
        builder.add(r);
    traces::Block block;
    builder.take(block);
    return block;
}

std::vector<Touch> touches_of(Touches& touches, const traces::Block& block) {
    std::vector<Touch> out;
    touches.each(block, [&](const Touch& t) { out.push_back(t); });
    return out;
}

TEST(Touches, SplitReferencesAtLines) {
    const traces::Block block = block_of({{0, 60, 0, {.size = 70}},
                                          {1, 128, 0, {.size = 0, .kind = Kind::write}},
                                          {2, ~std::uint64_t{0}, 0, {.size = 8}},
                                          {3, 0, 0, {.size = 64, .kind = Kind::prefetch}}});
    Touches touches(6, Touches::demand, By::all);
    const std::vector<Touch> got = touches_of(touches, block);
    const std::vector<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, bool>> expected = {
        {0, 60, 63, false},
        {1, 0, 63, false},
        {2, 0, 1, false},
        {2, 0, 0, true},
        {~std::uint64_t{0} >> 6U, 63, 63, false}};
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i)
        EXPECT_EQ(std::tuple(got[i].line, got[i].low, got[i].high, got[i].writes), expected[i]) << i;
}

TEST(Touches, TellGroupsApart) {
    traces::Description d;
    d.structures = {"unknown", "nodes", "packets"};
    d.phases = {"build", "trace"};
    d.streams = {"one", "two"};
    d.sites = {"a.h:1", "b.h:2"};
    const traces::Block block =
        block_of({{0, 0, 0, {.site = 2, .structure = 2}},
                  {1, 0, 1, {.site = 0, .structure = 1, .phase = 1, .kind = Kind::modify}},
                  {2, 0, 5, {.site = 2, .structure = 2, .kind = Kind::write}}});
    const auto names = [&](By by) {
        Touches touches(6, Touches::demand, by);
        std::vector<std::string> out;
        for (const Touch& t : touches_of(touches, block))
            out.push_back(touches.name(t.group, d));
        return out;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names(By::all), Names({"all", "all", "all"}));
    EXPECT_EQ(names(By::structure), Names({"packets", "nodes", "packets"}));
    EXPECT_EQ(names(By::phase), Names({"build", "trace", "build"}));
    EXPECT_EQ(names(By::kind), Names({"read", "modify", "write"}));
    EXPECT_EQ(names(By::thread), Names({"one", "two", "thread 5"}));
    EXPECT_EQ(names(By::site), Names({"b.h:2", "unknown", "b.h:2"}));
    d.site_addresses = true;
    EXPECT_EQ(names(By::site), Names({"0x2", "unknown", "0x2"}));
}

/// By several things at once, threads and windows among them; nothing is lost.
TEST(Touches, TellCombinationsApart) {
    traces::Description d;
    d.structures = {"unknown", "nodes", "packets"};
    d.streams = {"one", "two"};
    std::vector<traces::Reference> all;
    for (std::uint64_t i = 0; i < 600; ++i)
        all.push_back({i,
                       i * 64,
                       static_cast<std::uint32_t>(i / 3 % 2),
                       {.structure = static_cast<std::uint16_t>(1 + i % 2)}});
    Touches touches(6, Touches::demand, Grouping({By::thread, By::window, By::structure}, 100));
    std::map<std::string, std::uint64_t> counts, expected;
    for (const std::size_t half : {0U, 300U}) // groups go on from block to block
        for (const Touch& t :
             touches_of(touches, block_of({all.begin() + static_cast<std::ptrdiff_t>(half),
                                           all.begin() + static_cast<std::ptrdiff_t>(half) + 300})))
            ++counts[touches.name(t.group, d)];
    for (const traces::Reference& r : all)
        ++expected[d.streams[r.stream] + ", " + std::to_string(r.time / 100 * 100) + ", " +
                   d.structures[r.what.structure]];
    EXPECT_EQ(counts, expected);
    EXPECT_EQ(counts.size(), 24U);
    EXPECT_EQ(touches.groups(), 24U);
    const std::vector<Table::Cell> cells = touches.cells(0, d);
    ASSERT_EQ(cells.size(), 3U);
    EXPECT_EQ(std::get<std::uint64_t>(cells[1]), 0U);
    EXPECT_EQ(Touches(6, Touches::demand, By::all).cells(0, d).size(), 0U);
}

Touch touch(std::uint64_t line, std::uint64_t low, std::uint64_t high, std::uint32_t stream, bool writes) {
    return {line, low, high, 0, stream, 0, writes};
}

TEST(LineUse, TellsSharingFromFalseSharing) {
    LineUse use(64);
    use.touch(touch(1, 0, 7, 0, false)); // one thread's own
    use.touch(touch(1, 4, 11, 0, true));
    use.touch(touch(2, 0, 63, 0, false)); // shared, not written
    use.touch(touch(2, 0, 0, 1, false));
    use.touch(touch(3, 0, 3, 0, true)); // falsely: beside each other
    use.touch(touch(3, 4, 7, 1, false));
    use.touch(touch(3, 8, 8, 2, true));
    use.touch(touch(4, 0, 3, 0, true)); // truly: one reads what another writes
    use.touch(touch(4, 2, 7, 1, false));
    const std::vector<LineUse::Group> groups = use.groups();
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_EQ(groups[0].lines, 4U);
    EXPECT_EQ(groups[0].touches, 9U);
    EXPECT_EQ(groups[0].bytes, 12U + 64 + 9 + 8);
    EXPECT_EQ(groups[0].copies, 1U + 2 + 3 + 2);
    EXPECT_EQ(groups[0].shared, 3U);
    EXPECT_EQ(groups[0].written, 2U);
    EXPECT_EQ(groups[0].falsely, 1U);
    EXPECT_EQ(groups[0].false_touches, 3U);
    const std::vector<LineUse::Line> hot = use.hottest(2);
    ASSERT_EQ(hot.size(), 2U);
    EXPECT_EQ(hot[0].line, 3U);
    EXPECT_EQ(hot[0].threads, 3U);
    EXPECT_EQ(hot[1].line, 1U);
    EXPECT_EQ(use.hottest(9).size(), 4U);
}

TEST(LineUse, OfLongAndShortLines) {
    for (const std::uint64_t bytes : {1U, 4U, 64U, 256U, 4096U}) {
        LineUse use(bytes);
        use.touch(touch(0, 0, bytes - 1, 0, false));
        use.touch(touch(1, bytes / 2, bytes / 2, 0, false));
        EXPECT_EQ(use.groups()[0].bytes, bytes + std::max<std::uint64_t>(1, bytes / 64)) << bytes;
    }
}

TEST(Windows, CountAsTheWholeDoes) {
    const std::vector<std::uint64_t> lines = test::random_lines(9000, 400, 1, true);
    Windows windows(1000, {1, 16, 128});
    for (std::size_t i = 0; i < lines.size(); ++i)
        windows.touch({lines[i], 0, 0, 0, 0, i + 500, i % 4 == 0});
    ASSERT_EQ(windows.windows().size(), 10U);
    std::vector<std::uint64_t> misses(3, 0);
    std::uint64_t touched = 0, first = 0, writes = 0;
    for (const auto& [number, w] : windows.windows()) {
        const std::size_t begin = number == 0 ? 0 : number * 1000 - 500,
                          end = std::min<std::size_t>(number * 1000 + 500, 9000);
        EXPECT_EQ(w.touches, end - begin);
        EXPECT_EQ(w.lines, std::set(lines.begin() + static_cast<std::ptrdiff_t>(begin),
                                    lines.begin() + static_cast<std::ptrdiff_t>(end))
                               .size());
        touched += w.touches;
        first += w.first;
        writes += w.writes;
        for (std::size_t s = 0; s < 3; ++s)
            misses[s] += w.misses[s];
    }
    EXPECT_EQ(touched, lines.size());
    EXPECT_EQ(writes, lines.size() / 4);
    EXPECT_EQ(first, std::set(lines.begin(), lines.end()).size());
    EXPECT_EQ(misses[0], test::plain_misses(lines, 1, 1, true));
    EXPECT_EQ(misses[1], test::plain_misses(lines, 1, 16, true));
    EXPECT_EQ(misses[2], test::plain_misses(lines, 1, 128, true));
}

TEST(Table, SaysTheSameInAllForms) {
    Table t{{"name", "n", "part"},
            {{std::string("a, \"b\""), std::uint64_t{12}, 0.5},
             {std::string("c"), std::uint64_t{3}, std::nan("")}}};
    EXPECT_EQ(t.text(), "name     n    part\na, \"b\"  12  0.5000\nc        3       -\n");
    EXPECT_EQ(t.csv(), "name,n,part\n\"a, \"\"b\"\"\",12,0.5\nc,3,-\n");
    EXPECT_EQ(t.json().substr(0, 30), "[\n  {\n    \"name\": \"a, \\\"b\\\"\",\n");
    EXPECT_NE(t.json().find("\"part\": null"), std::string::npos);
}

} // namespace
} // namespace analysis
