// What screen tiles asked for, against plain counts and plainly written caches; filters and groups by tile
// agree.
#include "analysis/traces/tile_counts.h"
#include "analysis/traces/touches.h"
#include "tests/analysis/plain_caches.h"
#include "tests/analysis/plain_memory.h"
#include "tests/traces/samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace analysis {
namespace {

using traces::Picture;

TEST(TileCounts, AreThoseOfPlainCachesSplitByTile) {
    constexpr std::uint64_t sets = 4, ways = 2;
    const Picture picture{20, 12, 8}; // 3 x 2 tiles
    std::vector<Touch> touches = test::random_touches(3000, 40, 3, 64, 5);
    for (std::size_t i = 0; i < touches.size(); ++i)
        touches[i].tile = static_cast<std::uint32_t>(i / 50 % 6); // the last has none
    TileCounts tiles({sets, ways, 64}, picture.tiles());
    std::map<std::uint32_t, TileCount> expected;
    for (const Touch& t : touches) {
        tiles.touch(t, t.stream);
        ++expected[t.tile].references;
        expected[t.tile].bytes += t.high - t.low + 1;
    }
    std::set<std::pair<std::uint32_t, std::uint64_t>> met; // cache and line
    for (const test::Stay& s : test::plain_stays(touches, sets, ways, 1)) {
        TileCount& c = expected[touches[s.begin].tile];
        ++c.misses;
        c.first += met.insert({s.cache, s.line}).second ? 1 : 0;
    }
    ASSERT_EQ(tiles.counts().size(), 7U);
    for (std::uint32_t tile = 0; tile <= picture.tiles(); ++tile) {
        const TileCount &got = tiles.counts()[tile], &want = expected[tile];
        EXPECT_EQ(got.references, want.references) << tile;
        EXPECT_EQ(got.bytes, want.bytes) << tile;
        EXPECT_EQ(got.misses, want.misses) << tile;
        EXPECT_EQ(got.first, want.first) << tile;
        EXPECT_EQ(got.misses != 0, tile != 6) << tile;
    }
    const std::vector<double> misses = tiles.pixels(TileFigure::misses, picture),
                              ratio = tiles.pixels(TileFigure::ratio, picture);
    ASSERT_EQ(misses.size(), 240U);
    for (std::uint32_t y = 0; y < 12; ++y)
        for (std::uint32_t x = 0; x < 20; ++x) {
            const TileCount& want = expected[y / 8 * 3 + x / 8 + 1];
            ASSERT_EQ(misses[y * 20 + x], static_cast<double>(want.misses));
            if (want.references == 0)
                ASSERT_TRUE(std::isnan(ratio[y * 20 + x]));
            else
                ASSERT_DOUBLE_EQ(ratio[y * 20 + x],
                                 static_cast<double>(want.misses) / static_cast<double>(want.references));
        }
}

TEST(Touches, GroupsAndFiltersByTileAgree) {
    traces::BlockBuilder builder;
    const std::vector<traces::Reference> all =
        traces::test::with_tiles(traces::test::mixed_references(4000, 2), 5);
    for (const traces::Reference& r : all)
        builder.add(r);
    traces::Block block;
    builder.take(block);
    const traces::Description d = traces::test::small_description();
    Touches::Kinds every{};
    every.fill(true);
    std::map<std::string, std::uint64_t> expected, got;
    for (const traces::Reference& r : all)
        ++expected[(r.tile == 0
                        ? "none"
                        : std::to_string((r.tile - 1) % 8 * 8) + "," + std::to_string((r.tile - 1) / 8 * 8)) +
                   ", " + d.structures[r.what.structure]];
    Touches grouped(6, every, {{By::tile, By::structure}, 1});
    std::map<std::uint32_t, std::uint64_t> of_tile;
    grouped.each_access(block, [&](const Access& a) {
        ++got[grouped.name(a.group, d)];
        ++of_tile[a.tile];
    });
    EXPECT_EQ(got, expected);
    EXPECT_EQ(of_tile.size(), 49U);
    for (const std::uint32_t tile : {1U, 17U, 48U}) {
        std::uint64_t count = 0;
        Touches(6, every, {{}, 1, tile}).each_access(block, [&](const Access& a) {
            ++count;
            ASSERT_EQ(a.tile, tile);
        });
        EXPECT_EQ(count, of_tile[tile]);
        EXPECT_GT(count, 0U);
    }
}

} // namespace
} // namespace analysis
