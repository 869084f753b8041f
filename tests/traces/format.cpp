// The format: what is written is read.
#include "tests/traces/written.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/in_order.h"
#include "traces/index.h"
#include "traces/sample.h"
#include "traces/varint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <random>
#include <unistd.h>

namespace traces {
namespace {

using test::equal;
using test::equal_blocks;
using test::evicting;
using test::Got;
using test::mixed_references;
using test::read_all;
using test::references_of;
using test::write_sample;
using test::Written;

TEST(TraceFormat, WhatIsWrittenIsRead) {
    const Written sample = write_sample(3, 2000);
    Reader reader(memory_source(sample.bytes, "sample"));
    Block block;
    for (const auto& expected : sample.blocks) {
        ASSERT_TRUE(reader.next(block));
        EXPECT_TRUE(equal_blocks(references_of(block), expected));
    }
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete());
    EXPECT_EQ(reader.note(), "");
    const Description expected = test::small_description();
    EXPECT_EQ(to_json(reader.description()), to_json(expected));
    EXPECT_EQ(reader.description().sites.size(), 9U);
    EXPECT_EQ(reader.description().sites[5], "f:6");
    EXPECT_EQ(reader.bytes(), sample.bytes.size());
}

TEST(TraceFormat, LinesThatLeaveCachesTakeLittle) {
    std::size_t left = 0;
    BlockBuilder builder;
    for (const Reference& r : evicting(30000, left))
        builder.add(r);
    Block block, back;
    builder.take(block);
    std::string bytes, shuffled;
    Encoder().encode(block, bytes);
    Decoder().decode(bytes, {3, 2, 3, 9}, format_version, "here", back);
    EXPECT_EQ(back.addresses, block.addresses);
    EXPECT_EQ(back.times, block.times);
    // As lines that come, which are of any set, they would take some four bytes each.
    test::hide_evictions(block);
    Encoder().encode(block, shuffled);
    EXPECT_GT(left, 10000U);
    EXPECT_LT(bytes.size() + 2 * left, shuffled.size());
    for (std::size_t at = 0; at < bytes.size(); at += 397) { // whatever the bytes are
        std::string bad = bytes;
        bad[at] = static_cast<char>(bad[at] ^ 0x41);
        try {
            Decoder().decode(bad, {3, 2, 3, 9}, format_version, "here", back);
        } catch (const Error&) {
        }
    }
}

/// What comes where a line made room for it is at that line's time: no time of its own is written.
TEST(TraceFormat, LinesThatLeaveHaveTheTimeOfWhatComes) {
    for (const std::uint64_t later : {0U, 1U}) {
        std::size_t left = 0;
        BlockBuilder builder;
        for (Reference& r : evicting(30000, left)) {
            r.time += r.what.kind <= Kind::write ? later : 0;
            builder.add(r);
        }
        Block block, back;
        builder.take(block);
        std::string bytes;
        Encoder().encode(block, bytes);
        Decoder().decode(bytes, {3, 2, 3, 9}, format_version, "here", back);
        EXPECT_EQ(back.addresses, block.addresses);
        EXPECT_EQ(back.times, block.times);
        const std::size_t times = fixed_at<std::uint32_t>(bytes.data() + 24 + 3 * 8), n = block.size();
        if (later == 0)
            EXPECT_LT(times, n - left * 9 / 10);
        else
            EXPECT_GE(times, n);
    }
}

/// Each of many classes walks in steps of its own, in turns that nobody knows: the turns take room alone.
TEST(TraceFormat, AddressesOfAClassAreSideBySide) {
    constexpr std::uint64_t classes = 64, n = 50000;
    std::mt19937_64 random(8);
    std::vector<std::uint64_t> next(classes, 1000);
    BlockBuilder builder;
    for (std::uint64_t i = 0; i < n; ++i) {
        Reference r{i, 0, 0, {}};
        r.what.site = 1 + random() % classes;
        r.address = next[r.what.site - 1] += 4 * r.what.site;
        if (i % 100 == 0) { // makes room: a trace of what a cache passes on
            Reference leaving{i, r.address ^ (std::uint64_t{1} << 20U), 0, r.what};
            leaving.what.kind = Kind::write_back;
            builder.add(leaving);
        }
        builder.add(r);
    }
    Block block, back;
    builder.take(block);
    std::string bytes;
    Encoder().encode(block, bytes);
    Decoder().decode(bytes, {1, 1, 1, classes}, format_version, "here", back);
    EXPECT_EQ(back.addresses, block.addresses);
    EXPECT_LT(bytes.size(), n * 85 / 100); // six bits each, of the class
}

TEST(TraceFormat, TheOrderOfAllStreamsIsKept) {
    const std::vector<Reference> all = test::with_tiles(mixed_references(3000, 5));
    BlockBuilder builder;
    std::vector<Turn> marks;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i % 700 == 0)
            builder.mark(marks.emplace_back(Turn{Turn::What::window, 0, 0, 1000 + i, 900 + i}));
        builder.add(all[i]);
    }
    builder.mark(marks.emplace_back(Turn{Turn::What::end, 0, 0, 77, 5000}));
    Block block, back;
    builder.take(block);
    std::string bytes;
    Encoder().encode(block, bytes);
    Decoder().decode(bytes, {3, 2, 3, 9, 48}, format_version, "here", back);
    EXPECT_EQ(back.order, block.order);
    std::size_t at = 0;
    std::vector<Turn> got;
    each_in_order(
        back,
        [&](const Segment& s, std::size_t i) {
            EXPECT_TRUE(
                equal({back.times[i], back.addresses[i], s.stream, back.what(i), back.tile(i)}, all[at++]));
        },
        [&](const Turn& turn) {
            EXPECT_EQ(at, std::min<std::size_t>(got.size() * 700, all.size()));
            got.push_back(turn);
        });
    EXPECT_EQ(at, all.size());
    EXPECT_EQ(got, marks);
}

TEST(TraceFormat, BlocksHoldEveryStreamInItsOrder) {
    BlockBuilder builder;
    const std::vector<Reference> all = test::with_tiles(mixed_references(5000, 3));
    for (const Reference& r : all)
        builder.add(r);
    Block block;
    builder.take(block);
    EXPECT_EQ(builder.size(), 0U);
    ASSERT_EQ(block.size(), all.size());
    for (const Segment& s : block.segments) {
        std::vector<Reference> expected;
        std::copy_if(all.begin(), all.end(), std::back_inserter(expected),
                     [&](const Reference& r) { return r.stream == s.stream; });
        std::vector<Reference> got;
        for (std::size_t i = s.begin; i < s.end; ++i)
            got.push_back({block.times[i], block.addresses[i], s.stream, block.what(i), block.tile(i)});
        EXPECT_TRUE(equal_blocks(got, expected)) << s.stream;
    }
}

TEST(TraceFormat, StreamsAreMergedByTimeWithoutLeavingTheirOrder) {
    BlockBuilder builder;
    const auto add = [&](std::uint32_t stream, std::uint64_t time) {
        builder.add({time, builder.size(), stream, {}});
    };
    add(0, 10), add(0, 30), add(0, 20), add(0, 40);
    add(1, 10), add(1, 15), add(1, 35), add(1, 35);
    Block block;
    builder.take(block);
    std::vector<std::uint64_t> order;
    each_in_time(block, [&](const Segment&, std::size_t i) { order.push_back(block.addresses[i]); });
    EXPECT_EQ(order, (std::vector<std::uint64_t>{0, 4, 5, 1, 2, 6, 7, 3}));
}

TEST(TraceFormat, ABlockHoldsAsManyReferencesAsItMay) {
    BlockBuilder builder;
    while (!builder.full()) // each its own class: the widest numbers
        builder.add({builder.size(), builder.size() * 3, 0, {.site = builder.size()}});
    Block block, back;
    builder.take(block);
    std::string bytes;
    Encoder().encode(block, bytes);
    Decoder().decode(bytes, {1, 1, 1, ~std::uint64_t{0}}, format_version, "here", back);
    EXPECT_EQ(back.size(), most_references);
    EXPECT_EQ(back.addresses, block.addresses);
    EXPECT_EQ(back.times, block.times);
    EXPECT_EQ(back.what(70000), block.what(70000));
    EXPECT_EQ(back.what(most_references - 1), block.what(most_references - 1));
}

TEST(TraceFormat, TheIndexSaysWhereBlocksAre) {
    const Written sample = write_sample(3, 500);
    const std::string path = testing::TempDir() + "/traces_index.rzt";
    std::ofstream(path, std::ios::binary) << sample.bytes;
    const std::optional<Index> index = read_index(path);
    ASSERT_TRUE(index);
    ASSERT_EQ(index->blocks.size(), 3U);
    EXPECT_EQ(index->references(), 1500U);
    std::array<std::uint64_t, kind_names.size()> by_kind{};
    for (std::size_t b = 0; b < 3; ++b) {
        const IndexEntry& e = index->blocks[b];
        EXPECT_EQ(sample.bytes.substr(e.offset, 4), block_chunk);
        const auto& refs = sample.blocks[b];
        const auto earlier = [](const Reference& x, const Reference& y) { return x.time < y.time; };
        EXPECT_EQ(e.first_time, std::min_element(refs.begin(), refs.end(), earlier)->time);
        EXPECT_EQ(e.last_time, std::max_element(refs.begin(), refs.end(), earlier)->time);
        for (const Reference& r : refs)
            ++by_kind[static_cast<std::size_t>(r.what.kind)];
    }
    EXPECT_EQ(index->by_kind, by_kind);
    std::ofstream(path, std::ios::binary) << sample.bytes.substr(0, sample.bytes.size() - 1);
    EXPECT_FALSE(read_index(path));
    std::filesystem::remove(path);
    EXPECT_FALSE(read_index(path));
}

TEST(TraceFormat, AnEmptyTraceIsWhole) {
    std::string bytes;
    Writer writer(memory_sink(bytes), test::small_description());
    writer.write({});
    writer.finish();
    const Got got = read_all(bytes);
    EXPECT_EQ(got.error, "");
    EXPECT_TRUE(got.complete);
    EXPECT_TRUE(got.blocks.empty());
}

TEST(TraceFormat, CompressionIsSeenByContent) {
    const Written sample = write_sample(3, 3000);
    for (const char* suffix : {"", ".gz", ".xz", ".zst"}) {
        const std::string path = testing::TempDir() + "/traces_compressed.rzt" + suffix;
        {
            const auto sink = open_sink(path);
            for (std::size_t at = 0; at < sample.bytes.size(); at += 777)
                sink->write(std::string_view(sample.bytes).substr(at, 777));
            EXPECT_FALSE(std::filesystem::exists(path));
            sink->commit();
        }
        std::ifstream file(path, std::ios::binary);
        std::string stored((std::istreambuf_iterator<char>(file)), {});
        EXPECT_EQ(stored == sample.bytes, suffix[0] == '\0');
        Got got = read_all(stored);
        EXPECT_EQ(got.error, "") << suffix;
        EXPECT_TRUE(got.complete) << suffix;
        EXPECT_EQ(got.blocks.size(), 3U);
        if (suffix[0] != '\0') { // two of them, one after the other, and a part of one
            std::string text(100000, 'x');
            {
                const auto sink = open_sink(path);
                sink->write(text);
                sink->commit();
            }
            std::ifstream again(path, std::ios::binary);
            const std::string member((std::istreambuf_iterator<char>(again)), {});
            std::string back(300000, '\0');
            back.resize(memory_source(member + member, "twice")->read(back.data(), back.size()));
            EXPECT_EQ(back, text + text) << suffix;
            if (suffix == std::string_view(".gz")) { // filled up with zeros, as tapes are
                const std::string zeros(70001, '\0');
                back.assign(300000, '\0');
                back.resize(memory_source(member + zeros, "padded")->read(back.data(), back.size()));
                EXPECT_EQ(back, text);
                for (const std::string& more : {zeros + member, zeros + 'x', "x" + zeros}) {
                    back.assign(300000, '\0');
                    EXPECT_THROW(memory_source(member + more, "more")->read(back.data(), back.size()), Error);
                }
            }
            got = read_all(stored.substr(0, stored.size() / 2));
            EXPECT_NE(got.error.find("end too early"), std::string::npos) << suffix << got.error;
            stored[stored.size() / 2] = static_cast<char>(stored[stored.size() / 2] ^ 0x55);
            got = read_all(stored);
            EXPECT_NE(got.error + got.note, "") << suffix;
        }
        std::filesystem::remove(path);
    }
}

TEST(TraceFormat, StreamsLieSideBySide) {
    const std::array<std::uint32_t, 6> streams{70000, 3, 4000000000, 65535, 65536, 4};
    std::vector<Reference> all = mixed_references(5000, 1, 9);
    std::minstd_rand random(7);
    BlockBuilder builder;
    for (Reference& r : all) {
        r.stream = streams[random() % streams.size()];
        r.what.part = Part::operation;
        builder.add(r);
    }
    Block block;
    builder.take(block);
    std::stable_sort(all.begin(), all.end(),
                     [](const Reference& a, const Reference& b) { return a.stream < b.stream; });
    ASSERT_EQ(block.segments.size(), streams.size());
    ASSERT_EQ(block.segments.back().end, all.size());
    for (const Segment& s : block.segments)
        for (std::size_t i = s.begin; i < s.end; ++i) {
            EXPECT_EQ(s.stream, all[i].stream);
            EXPECT_EQ(block.times[i], all[i].time);
            EXPECT_EQ(block.addresses[i], all[i].address);
            EXPECT_EQ(block.what(i), all[i].what);
        }
    std::size_t turns = 0;
    for (const Turn& turn : block.order)
        turns += turn.count;
    EXPECT_EQ(turns, all.size());
}

TEST(TraceFormat, WhatIsNotCommittedIsNotThere) {
    const std::string folder = testing::TempDir() + "/traces_uncommitted";
    std::filesystem::create_directory(folder);
    { open_sink(folder + "/x.rzt")->write("some"); }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
    EXPECT_THROW(open_sink(folder + "/no/x.rzt"), Error);
    EXPECT_THROW(open_sink(folder), Error);
    EXPECT_THROW(open_source(folder), Error);
    EXPECT_THROW(open_source(folder + "/none"), Error);
    std::filesystem::remove_all(folder);
}

// What standard output gets there comes behind, as with `-`; and links stay links.
TEST(TraceFormat, OutputsMayBeWhereStandardOutputGoes) {
    const std::string folder = testing::TempDir() + "/traces_standard";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
    const std::string name = folder + "/x", link = folder + "/link";
    std::filesystem::create_symlink("x", link);
    const auto text = [&] {
        std::ifstream written(name);
        return std::string(std::istreambuf_iterator<char>(written), {});
    };
    std::fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666); // NOLINT: as of POSIX
    ASSERT_GE(file, 0);
    dup2(file, STDOUT_FILENO);
    close(file);
    std::fputs("one ", stdout);
    for (const std::string& output : {link, std::string("/dev/stdout")}) {
        const auto sink = open_sink(output);
        sink->write("two ");
        sink->commit();
    }
    std::fputs("three", stdout);
    std::fflush(stdout);
    dup2(before, STDOUT_FILENO);
    close(before);
    EXPECT_EQ(text(), "one two two three");
    const auto sink = open_sink(link);
    sink->write("four");
    sink->commit();
    EXPECT_EQ(text(), "four");
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    std::filesystem::remove_all(folder);
}

/// Seven bits a byte, as README.md says it.
std::string leb128(std::uint64_t x) {
    std::string out;
    for (; x >= 0x80; x >>= 7U)
        out.push_back(static_cast<char>(x | 0x80U));
    out.push_back(static_cast<char>(x));
    return out;
}

TEST(TraceFormat, NumbersAreWhole) {
    std::vector<std::uint64_t> numbers{~std::uint64_t{0}, 0x0123456789ABCDEFU};
    for (unsigned bit = 0; bit < 64; ++bit)
        for (const std::uint64_t less : {0U, 1U})
            for (const std::uint64_t pattern : {0U, 0x5555555U})
                numbers.push_back((std::uint64_t{1} << bit | (pattern & ((std::uint64_t{1} << bit) - 1))) -
                                  less);
    for (const std::uint64_t x : numbers) {
        std::string bytes;
        append_varint(bytes, x);
        EXPECT_EQ(bytes, leb128(x)) << x;
        VarintReader reader(bytes.data(), bytes.data() + bytes.size());
        EXPECT_EQ(reader.next(), x);
        EXPECT_TRUE(reader.ended() && !reader.bad());
        EXPECT_EQ(unzigzag(zigzag(x)), x);
    }
    EXPECT_EQ(zigzag(~std::uint64_t{0}), 1U); // -1
    for (const std::string& bad :
         {std::string("\x80"), std::string(11, '\x80'), std::string(9, '\xff') + "\2"}) {
        VarintReader reader(bad.data(), bad.data() + bad.size());
        reader.next();
        EXPECT_TRUE(reader.bad());
    }
}

TEST(TraceFormat, SamplesAreUniform) {
    std::size_t below = 0;
    for (std::uint64_t line = 0; line < 100000; ++line)
        below += hash_of_line(line * 64) < 0.1 ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(below), 10000, 400); // four standard deviations
}

} // namespace
} // namespace traces
