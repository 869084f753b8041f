// For which screen tile of a picture references were: kept in both codings, in hardly any room, and nothing
// but tiles of the picture is read, whatever the bytes are.
#include "traces/tile_runs.h"

#include "tests/traces/written.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/convert.h"

#include <nlohmann/json.hpp>

namespace traces {
namespace {

using test::evicting;
using test::mixed_references;
using test::small_description;
using test::with_tiles;

constexpr Decoder::Limits limits{3, 2, 3, 9, 48}, no_picture{3, 2, 3, 9};

Block block_of(const std::vector<Reference>& all, std::size_t window = 0) {
    BlockBuilder builder;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (window != 0 && i % window == 0)
            builder.mark({Turn::What::window, 0, 0, 1000 + 25 * i, 990 + 25 * i});
        builder.add(all[i]);
    }
    Block block;
    builder.take(block);
    return block;
}
std::string encoded(const Block& block, Coding coding) {
    std::string out;
    Encoder(coding).encode(block, out);
    return out;
}

TEST(Pictures, TilesAreThoseThatPixelsLieIn) {
    const Picture p{60, 44, 8};
    EXPECT_EQ(p.tiles(), 48U);
    for (std::uint32_t y = 0; y < p.height; ++y)
        for (std::uint32_t x = 0; x < p.width; ++x) {
            const std::uint32_t tile = p.tile_of(x, y);
            ASSERT_GE(tile, 1U);
            ASSERT_LE(tile, p.tiles());
            ASSERT_EQ(p.left(tile), x / 8 * 8);
            ASSERT_EQ(p.top(tile), y / 8 * 8);
            ASSERT_EQ(p.tile_of(std::int64_t{y} * 60 + x), tile);
        }
    EXPECT_EQ(p.tile_of(std::int64_t{-1}), 0U);
    EXPECT_EQ(p.tile_of(std::int64_t{60} * 44), 0U);
    EXPECT_EQ(Picture{}.tiles(), 0U);
    EXPECT_EQ(Picture{}.tile_of(std::int64_t{5}), 0U);
}

TEST(Pictures, ThoseThatCannotBeAreRefused) {
    const std::string good = to_json(small_description());
    EXPECT_EQ(description_from_json(good, "here").picture, small_description().picture);
    for (const char* bad :
         {"[0,44,8]", "[60,0,8]", "[60,44,0]", "[60,44,65537]", "[99999999,44,8]", "[60]", "7"}) {
        nlohmann::json j = nlohmann::json::parse(good);
        j["picture"] = nlohmann::json::parse(bad);
        EXPECT_THROW(description_from_json(j.dump(), "here"), Error) << bad;
    }
}

TEST(TraceTiles, AreReadAsTheyWere) {
    Decoder decoder;
    for (const Coding coding : {Coding::columns, Coding::predicted})
        for (const std::size_t n : {1U, 2U, 40U, 3000U})
            for (const std::size_t length : {1U, 9U, 400U}) {
                const Block block =
                    block_of(with_tiles(mixed_references(n, static_cast<std::uint32_t>(n)), length), 7);
                Block back;
                decoder.decode(encoded(block, coding), limits, format_version, "here", back);
                ASSERT_EQ(back.tiles, block.tiles);
                ASSERT_EQ(back.addresses, block.addresses);
                ASSERT_EQ(back.times, block.times);
                ASSERT_EQ(back.order, block.order);
                for (std::size_t i = 0; i < n; ++i)
                    ASSERT_EQ(back.what(i), block.what(i));
                // The decoder's room is used again by what has none.
                const Block plain = block_of(mixed_references(n, 3));
                decoder.decode(encoded(plain, coding), limits, format_version, "here", back);
                ASSERT_TRUE(back.tiles.empty());
            }
}

/// A line makes room for another only where both are of one tile, and else is as any other.
TEST(TraceTiles, OfLinesThatLeaveCachesAreKept) {
    std::size_t left = 0;
    const std::vector<Reference> all = evicting(3000, left);
    for (const std::size_t length : {1U, 2U, 50U}) {
        const Block block = block_of(with_tiles(all, length), 20);
        Block back;
        Decoder().decode(encoded(block, Coding::predicted), limits, format_version, "here", back);
        EXPECT_EQ(back.tiles, block.tiles);
        EXPECT_EQ(back.addresses, block.addresses);
    }
}

/// Threads with a tile each for three hundred references at a time: some bytes a change, whichever the
/// coding; which of the two comes next is told by the order, and its tile by that.
TEST(TraceTiles, TakeRoomWhereTheyChange) {
    constexpr std::size_t n = 30000, length = 300;
    for (const Coding coding : {Coding::columns, Coding::predicted}) {
        const std::vector<Reference> all = mixed_references(n, 4);
        const Block plain = block_of(all), tiled = block_of(with_tiles(all, length));
        const std::size_t more = encoded(tiled, coding).size() - encoded(plain, coding).size();
        EXPECT_GT(more, n / length) << static_cast<int>(coding);
        EXPECT_LT(more, n / length * 4 * 12) << static_cast<int>(coding);
    }
}

TEST(TraceTiles, OfNoPictureAreRefused) {
    Block back;
    for (const Coding coding : {Coding::columns, Coding::predicted}) {
        const std::string good = encoded(block_of(with_tiles(mixed_references(100, 1)), 9), coding);
        EXPECT_THROW(Decoder().decode(good, no_picture, format_version, "here", back), Error);
        EXPECT_THROW(Decoder().decode(good, {3, 2, 3, 9, 20}, format_version, "here", back), Error);
        EXPECT_THROW(Decoder().decode(good, limits, 4, "here", back), Error); // which had none
    }
}

/// With sums that fit, as an enemy would write it.
TEST(TraceTiles, HostileColumnsAreRefusedOrWhole) {
    Block block = block_of(with_tiles(mixed_references(60, 1), 3));
    std::string good;
    put_tiles(block, good);
    std::size_t refused = 0;
    for (std::size_t at = 0; at < good.size(); ++at)
        for (int value = 0; value < 256; value += 3) {
            std::string bad = good;
            bad[at] = static_cast<char>(value);
            Block back = block;
            if (get_tiles(bad, 48, back) != nullptr) {
                ++refused;
                continue;
            }
            ASSERT_EQ(back.tiles.size(), back.size());
            for (const std::uint32_t tile : back.tiles)
                ASSERT_LE(tile, 48U);
        }
    EXPECT_GT(refused, good.size());
    for (std::size_t length = 1; length < good.size(); ++length)
        EXPECT_NE(get_tiles(good.substr(0, length), 48, block), nullptr) << length;
    EXPECT_NE(get_tiles(good + '\1', 48, block), nullptr);
}

TEST(TraceTiles, FormatsThatHaveNoneSaySo) {
    std::string own, csv;
    {
        Writer writer(memory_sink(own), small_description());
        writer.add_sites({"a:1", "b:2", "c:3"});
        writer.write(block_of(with_tiles(mixed_references(50, 1, 3))));
        writer.finish();
    }
    for (const char* name : {"csv", "rzt"}) {
        const Format& format = format_by_name("--to", name);
        const auto input = read_own(memory_source(own, "sample"));
        std::string bytes;
        const auto output = format.write(memory_sink(bytes));
        Conversion conversion(*input, *output, format.holds);
        while (conversion.step()) {
        }
        output->finish();
        EXPECT_EQ(conversion.lost().find("screen tiles") != std::string::npos,
                  std::string_view(name) == "csv")
            << conversion.lost();
        if (std::string_view(name) != "rzt")
            continue;
        Reader back(memory_source(bytes, "back")), first(memory_source(own, "sample"));
        Block a, b;
        ASSERT_TRUE(back.next(a));
        ASSERT_TRUE(first.next(b));
        EXPECT_EQ(a.tiles, b.tiles);
        EXPECT_EQ(back.description().picture, small_description().picture);
    }
}

} // namespace
} // namespace traces
