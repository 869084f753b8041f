// Blocks of which each bit is predicted: all is read as it was, takes the room that its information asks for,
// and bytes of an enemy give a block that keeps its promises, or an Error.
#include "traces/predicted.h"

#include "tests/traces/samples.h"
#include "traces/arithmetic.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace traces {
namespace {

using test::evicting;
using test::mixed_references;

constexpr Decoder::Limits limits{3, 2, 3, 9};

Block block_of(const std::vector<Reference>& all, std::size_t window = 0) {
    BlockBuilder builder;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (window != 0 && i % window == 0)
            builder.mark({Turn::What::window, 0, 0, 1000 + 25 * i, 990 + 25 * i});
        builder.add(all[i]);
    }
    if (window != 0)
        builder.mark({Turn::What::end, 0, 0, 77, 5000});
    Block block;
    builder.take(block);
    return block;
}

std::string encoded(const Block& block, Coding coding = Coding::predicted) {
    std::string out;
    Encoder(coding).encode(block, out);
    return out;
}

void expect_same(const Block& got, const Block& want) {
    ASSERT_EQ(got.size(), want.size());
    EXPECT_EQ(got.addresses, want.addresses);
    EXPECT_EQ(got.times, want.times);
    EXPECT_EQ(got.order, want.order);
    EXPECT_EQ(got.tiles, want.tiles);
    ASSERT_EQ(got.segments.size(), want.segments.size());
    for (std::size_t s = 0; s < got.segments.size(); ++s) {
        EXPECT_EQ(got.segments[s].stream, want.segments[s].stream);
        EXPECT_EQ(got.segments[s].end, want.segments[s].end);
    }
    for (std::size_t i = 0; i < got.size(); ++i)
        ASSERT_EQ(got.what(i), want.what(i)) << i;
}

/// Bits that are set with probability p / 65536 take what Shannon's bound says.
TEST(ArithmeticCoder, TakesTheRoomOfTheInformation) {
    for (const std::uint32_t p : {50U, 3000U, 32768U, 60000U}) {
        std::mt19937 random(p);
        std::vector<std::uint32_t> bits(200000);
        for (std::uint32_t& b : bits)
            b = (random() & 65535U) < p ? 1 : 0;
        std::string bytes;
        BitWriter writer(bytes);
        double information = 0;
        for (const std::uint32_t b : bits) {
            writer.code(p, b);
            information -= std::log2((b != 0 ? p : 65536 - p) / 65536.0);
        }
        writer.finish();
        EXPECT_NEAR(static_cast<double>(bytes.size()), information / 8, information / 8 * 0.002 + 5) << p;
        BitReader reader(bytes);
        for (const std::uint32_t b : bits)
            ASSERT_EQ(reader.code(p, 0), b);
        EXPECT_TRUE(reader.ended());
        for (int i = 0; i < 100; ++i)
            reader.code(32768, 0);
        EXPECT_TRUE(reader.beyond());
    }
}

/// Numbers that a context tells cost nothing, whichever of several contexts it is; those that none tells cost
/// what they hold, and little more.
TEST(Predictor, LearnsWhichContextTells) {
    std::mt19937_64 random(5);
    constexpr int n = 20000;
    for (const auto& [told, checked] :
         {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
        std::string bytes;
        BitWriter writer(bytes);
        Predictor<3> to, from;
        to.begin(12, checked);
        from.begin(12, checked);
        std::vector<std::array<std::uint64_t, 3>> all;
        for (int i = 0; i < n; ++i) {
            const std::uint64_t hint = random() % 5, noise = random();
            const std::uint64_t value =
                told ? std::array<std::uint64_t, 5>{0, 7, 300, ~0ULL, 1ULL << 40U}[hint]
                     : 128 + random() % 128;
            all.push_back({hint, noise, value});
            to.number(writer, {context(0), context(noise), context(hint)}, 1, value);
        }
        writer.finish();
        const double bits = 8.0 * static_cast<double>(bytes.size()) / n;
        if (told)
            EXPECT_LT(bits, 0.2);
        else
            EXPECT_NEAR(bits, 7.2, 0.2);
        BitReader reader(bytes);
        for (const auto& [hint, noise, value] : all)
            ASSERT_EQ(from.number(reader, {context(0), context(noise), context(hint)}, 1, 0), value);
        EXPECT_TRUE(reader.ended());
    }
}

/// Contexts that come once do not take the lines of those that come again; without checks they do.
TEST(Predictor, ContextsDoNotDisturbEachOther) {
    const auto bits = [](bool checked) {
        std::string bytes;
        BitWriter writer(bytes);
        Predictor<1> p;
        p.begin(8, checked);
        constexpr std::uint64_t n = 40000;
        std::mt19937_64 random(3);
        double before = 0;
        for (std::uint64_t i = 0; i < n; ++i) {
            const std::uint64_t known = random() % 64;
            p.symbol(writer, {context(known)}, 0, 4, static_cast<std::uint32_t>(known * 7 % 16));
            before = static_cast<double>(bytes.size());
            p.symbol(writer, {context(1000 + i)}, 1, 4, static_cast<std::uint32_t>(random() % 16));
        }
        return 8 * before / n - 4; // of those whose context is known, as the others take four each
    };
    EXPECT_LT(bits(true), 1);
    EXPECT_GT(bits(false), 2 * bits(true));
}

/// Bytes that nobody wrote: every bit is set.
struct Ones {
    std::uint32_t code(std::uint32_t, std::uint32_t) { return 1; }
};
TEST(Predictor, NumbersOfDamagedBytesHaveSixtyFourBitsAtMost) {
    Predictor<1> p;
    p.begin(4, true);
    Ones ones;
    EXPECT_EQ(p.number(ones, {0}, 0, 0), ~std::uint64_t{0});
}

TEST(PredictedBlocks, AreReadAsTheyWere) {
    Decoder decoder;
    for (const std::size_t n : {1U, 2U, 40U, 3000U})
        for (const std::size_t window : {0U, 1U, 7U}) {
            std::vector<Reference> all = mixed_references(n, static_cast<std::uint32_t>(n));
            for (std::size_t i = 1; i < all.size(); i += 5) { // pieces of what comes before
                all[i].what.part = Part::piece;
                all[i].stream = all[i - 1].stream;
                all[i].time = all[i - 1].time;
            }
            Block block = block_of(all, window), back;
            decoder.decode(encoded(block), limits, format_version, "here", back);
            expect_same(back, block);
            block.order.clear(); // it is not known
            decoder.decode(encoded(block), limits, format_version, "here", back);
            expect_same(back, block);
        }
}

TEST(PredictedBlocks, LinesThatLeaveCachesTakeLittle) {
    std::size_t left = 0;
    Block block = block_of(evicting(30000, left), 50), back;
    const std::string bytes = encoded(block);
    Decoder().decode(bytes, limits, format_version, "here", back);
    expect_same(back, block);
    // One of three places and one of two kinds are three bits; as lines of any set they would take four
    // bytes.
    test::hide_evictions(block);
    EXPECT_GT(left, 10000U);
    EXPECT_LT(bytes.size() + 3 * left, encoded(block).size());
}

/// Memory is told of them as writes.
TEST(PredictedBlocks, WritesToMemoryTakeLittle) {
    std::size_t left = 0;
    std::vector<Reference> all = evicting(30000, left);
    for (Reference& r : all)
        r.what.kind = Evictions::leaves(r.what) ? Kind::write : Kind::read;
    const Block block = block_of(all, 50);
    Block back;
    const std::string bytes = encoded(block);
    Decoder().decode(bytes, limits, format_version, "here", back);
    expect_same(back, block);
    // One of three places is two bits. Where there is a line that leaves by its kind, writes are like all
    // else.
    all[0].what.kind = Kind::write_back;
    const Block other = block_of(all, 50);
    const std::string more = encoded(other);
    Decoder().decode(more, limits, format_version, "here", back);
    expect_same(back, other);
    EXPECT_LT(bytes.size() + 3 * left, more.size());
    // In columns too: cores, whose traces these are, read and write.
    EXPECT_GT(encoded(block, Coding::columns).size(), bytes.size() + 4 * left);
}

/// Four walks through one structure, in turns that nothing tells: two bits each, and nothing for lines and
/// times.
TEST(PredictedBlocks, WalksTakeTheRoomOfTheirTurns) {
    std::mt19937_64 random(7);
    std::array<std::uint64_t, 4> line{1000, 70000, 5000000, 88000000};
    std::vector<Reference> all;
    constexpr std::size_t n = 40000;
    for (std::uint64_t time = 0; all.size() < n; time += 10) {
        std::uint64_t& l = line[random() % line.size()];
        Reference r{time, ++l * 64, 0, {}};
        r.what.size = 64;
        all.push_back(r);
    }
    const Block block = block_of(all);
    const auto bits = [&](Coding coding) {
        return 8.0 * static_cast<double>(encoded(block, coding).size()) / n;
    };
    // Where they are among those used last is a little more than which they are.
    EXPECT_GT(bits(Coding::predicted), 2.0);
    EXPECT_LT(bits(Coding::predicted), 3.0);
    EXPECT_GT(bits(Coding::columns), 8.0);
}

/// The same bytes from every host and version, else files could not be read elsewhere.
TEST(PredictedBlocks, HaveTheBytesOfTheFormat) {
    const Block block = block_of(mixed_references(500, 9), 20);
    std::vector<std::uint32_t> rank(block.table.size());
    for (std::size_t i = 0; i < rank.size(); ++i)
        rank[i] = static_cast<std::uint32_t>(i);
    std::string bytes;
    ReferenceModel model;
    put_predicted(model, block, rank, block.table, 0, 5, bytes);
    EXPECT_EQ(bytes.size(), 1867U);
    EXPECT_EQ(checksum("", bytes), 873692467U);
}

/// With sums that fit, as an enemy would write it.
TEST(PredictedBlocks, HostileOnesAreRefusedOrWhole) {
    std::size_t left = 0;
    const std::vector<Reference> evictions = evicting(300, left);
    std::vector<Reference> all = mixed_references(60, 1);
    all.insert(all.end(), evictions.begin(), evictions.end());
    const std::string good = encoded(block_of(all, 9));
    Decoder decoder;
    Block back;
    std::size_t refused = 0;
    for (std::size_t at = 0; at < good.size(); at += at < 100 ? 1 : 5)
        for (const int value : {0, 1, 0x80, 0xFF}) {
            std::string bad = good;
            bad[at] = static_cast<char>(value);
            try {
                decoder.decode(bad, limits, format_version, "here", back);
                ASSERT_LE(back.size(), most_references);
                ASSERT_EQ(back.segments.back().end, back.size());
                ASSERT_LE(back.order.size(), 3 * back.size() + 16);
                for (std::size_t i = 0; i < back.size(); ++i)
                    ASSERT_LT(back.classes[i], back.table.size());
            } catch (const Error& e) {
                ++refused;
                ASSERT_TRUE(std::string(e.what()).starts_with("here: ")) << e.what();
            }
        }
    EXPECT_GT(refused, 200U);
    for (std::size_t length = 0; length < good.size(); length += 11)
        EXPECT_THROW(decoder.decode(good.substr(0, length), limits, format_version, "here", back), Error);
    EXPECT_THROW(decoder.decode(good, limits, 3, "here", back), Error); // which had no such blocks
}

} // namespace
} // namespace traces
