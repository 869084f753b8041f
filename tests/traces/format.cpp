// The format: what is written is read, and nothing else is.
#include "tests/traces/samples.h"
#include "traces/background_writer.h"
#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/in_order.h"
#include "traces/index.h"
#include "traces/reader.h"
#include "traces/sample.h"
#include "traces/varint.h"
#include "traces/writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

namespace traces {
namespace {

using test::equal;
using test::mixed_references;
using test::references_of;

struct Written {
    std::string bytes;
    std::vector<std::vector<Reference>> blocks; // in the order that blocks have
    std::vector<std::uint64_t> ends;            // of each block's chunk
};

Written write_sample(std::size_t blocks, std::size_t references) {
    Written out;
    Writer writer(memory_sink(out.bytes), test::small_description());
    writer.add_sites({"a:1", "b:2", "c:3", "d:4", "e:5"});
    BlockBuilder builder;
    Block block;
    for (std::size_t b = 0; b < blocks; ++b) {
        if (b == 1)
            writer.add_sites({"f:6", "g:7", "h:8", "i:9"});
        for (const Reference& r : mixed_references(references, static_cast<std::uint32_t>(b), b == 0 ? 5 : 9))
            builder.add(r);
        builder.take(block);
        writer.write(block);
        out.blocks.push_back(references_of(block));
        out.ends.push_back(out.bytes.size());
    }
    writer.finish();
    EXPECT_EQ(writer.bytes(), out.bytes.size());
    return out;
}

struct Got {
    std::vector<std::vector<Reference>> blocks;
    bool complete = false;
    std::string note, error;
};
Got read_all(const std::string& bytes) {
    Got got;
    try {
        Reader reader(memory_source(bytes, "sample"));
        Block block;
        while (reader.next(block))
            got.blocks.push_back(references_of(block));
        got.complete = reader.complete();
        got.note = reader.note();
    } catch (const Error& e) {
        got.error = e.what();
    }
    return got;
}

bool equal_blocks(const std::vector<Reference>& a, const std::vector<Reference>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

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

/// Bytes of base64.
std::string decoded(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=')
            break;
        bits = bits << 6U | static_cast<std::uint32_t>(digits.find(c));
        count += 6;
        if (count >= 8)
            out.push_back(static_cast<char>(bits >> (count -= 8)));
    }
    return out;
}

/// What version 1 of the program wrote of four references of two streams.
constexpr std::string_view of_version_1 =
    "iVJaVA0KGgoBAAAASEVBRPvgMSAbAQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGlt"
    "ZSI6ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAiZmls"
    "dGVycyI6ICIiLAogInN0cnVjdHVyZXMiOiBbCiAgIm5vZGVzIiwKICAibGlzdHMiCiBdLAogInBoYXNlcyI6IFsKICAiZ28i"
    "LAogICJzdG9wIgogXSwKICJ3b3JrIjogWwogICJ1bmtub3duIgogXSwKICJzdHJlYW1zIjogWwogICJ0aHJlYWQgMCIKIF0s"
    "CiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FXAjA2A0AAAAAAAAAWyJhOjEiLCJiOjIiXUJMQ0uWOKP6iAAAAAAAAAAEAAAA"
    "AgAAAAQAAAACAAAAAQAAAAAAAAAcAAAAJQAAAAQAAAANAAAACAAAABEAAAAEAAAADQAAACi1L/0gHOEAAAACAQIABAAAAAIB"
    "CAAAAAICBAABAAEHQAEBAAEotS/9IAQhAAAAAgEDKLUv/SAIQQAACAqg/wGg/wEotS/9IAQhAAAABAICSU5EWHudv+9WAAAA"
    "AAAAACi1L/0gWW0CAKJEEBeQtTpo3Rqg6TcmT+ZL/+eYSx60N3ZNCQF1kMk35uBF1vNVzfHn5RiE0o+pw0i+YjmiNNEWE5Lk"
    "n/Rb1dZtsc6AAwDnDA7yluWcVEFJTGrWJ4UIAAAAAAAAAOwBAAAAAAAA";

TEST(TraceFormat, FilesOfVersionOneAreRead) {
    Reader reader(memory_source(decoded(of_version_1), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 4U);
    EXPECT_TRUE(equal(all[0], {1, 0x10, 0, {1, 4, 0, 0, 0, Kind::read}}));
    EXPECT_TRUE(equal(all[1], {3, 0x14, 0, {1, 4, 0, 1, 0, Kind::modify}}));
    EXPECT_TRUE(equal(all[2], {2, 0xff40, 1, {2, 8, 0, 0, 0, Kind::write}}));
    EXPECT_TRUE(equal(all[3], {3, 0xff40, 1, {0, 64, 1, 1, 0, Kind::flush}}));
    EXPECT_TRUE(block.order.empty()); // it did not say
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
    EXPECT_EQ(reader.description().structures, (std::vector<std::string>{"nodes", "lists"}));
    EXPECT_TRUE(reader.description().regions.empty());
    EXPECT_EQ(reader.description().window, 0U);
}

/// Likewise version 2.
constexpr std::string_view of_version_2 =
    "iVJaVA0KGgoCAAAASEVBRFX4dVA5AQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGlt"
    "ZSI6ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAid2lu"
    "ZG93IjogMCwKICJmaWx0ZXJzIjogIiIsCiAic3RydWN0dXJlcyI6IFsKICAibm9kZXMiLAogICJsaXN0cyIKIF0sCiAicGhh"
    "c2VzIjogWwogICJnbyIsCiAgInN0b3AiCiBdLAogIndvcmsiOiBbCiAgInVua25vd24iCiBdLAogInN0cmVhbXMiOiBbCiAg"
    "InRocmVhZCAwIgogXSwKICJyZWdpb25zIjogW10sCiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FXAjA2A0AAAAAAAAAWyJh"
    "OjEiLCJiOjIiXUJMQ0v1AuSDowAAAAAAAAAEAAAAAgAAAAQAAAACAAAAAQAAAAAAAAAcAAAAJQAAAAQAAAANAAAACAAAABEA"
    "AAAEAAAADQAAAAoAAAATAAAAKLUv/SAc4QAAAAIBAgAEAAAAAgEIAAAAAgIEAAEAAQhAAQEAASi1L/0gBCEAAAACAQMotS/9"
    "IAhBAAAICqD/AaD/ASi1L/0gBCEAAAAEAgIotS/9IApRAAAEBAIDAgMBAQEBSU5EWGC3NMtZAAAAAAAAACi1L/0gXYUCAMLE"
    "EBeQtTroImRv2YcmT+ZL/+cAt+1Be2PXlAO1kMk3ZuEFrOermuPPy2AQSj+mEiT5Wo7liNJGW4wIJP+k36q2bo91FgQDAMkZ"
    "HtStwDkBVEFJTOuQJtEIAAAAAAAAACUCAAAAAAAA";

TEST(TraceFormat, FilesOfVersionTwoAreRead) {
    Reader reader(memory_source(decoded(of_version_2), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const Description& d = reader.description();
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 4U);
    const auto is = [&](const Reference& r, std::uint64_t time, std::uint64_t address, Kind kind,
                        std::uint32_t size, const char* structure, const char* phase) {
        return r.time == time && r.address == address && r.what.kind == kind && r.what.size == size &&
               d.structures[r.what.structure] == structure && d.phases[r.what.phase] == phase &&
               r.what.detail == 0;
    };
    EXPECT_TRUE(is(all[0], 1, 0x10, Kind::read, 4, "nodes", "go"));
    EXPECT_TRUE(is(all[1], 3, 0x14, Kind::modify, 4, "nodes", "stop"));
    EXPECT_TRUE(is(all[2], 2, 0xff40, Kind::write, 8, "nodes", "go"));
    EXPECT_TRUE(is(all[3], 3, 0xff40, Kind::invalidate, 64, "lists", "stop"));
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
}

/// Likewise version 3, of five.
constexpr std::string_view of_version_3 =
    "iVJaVA0KGgoDAAAASEVBRFX4dVA5AQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGltZSI6"
    "ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAid2luZG93Ijog"
    "MCwKICJmaWx0ZXJzIjogIiIsCiAic3RydWN0dXJlcyI6IFsKICAibm9kZXMiLAogICJsaXN0cyIKIF0sCiAicGhhc2VzIjogWwog"
    "ICJnbyIsCiAgInN0b3AiCiBdLAogIndvcmsiOiBbCiAgInVua25vd24iCiBdLAogInN0cmVhbXMiOiBbCiAgInRocmVhZCAwIgog"
    "XSwKICJyZWdpb25zIjogW10sCiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FB21VOhEAAAAAAAAAWyJhOjEiLCJiOjIiLCIwIl1C"
    "TENLisImxLEAAAAAAAAABQAAAAIAAAAFAAAAAgAAAAEAAAAAAAAAKAAAADEAAAAFAAAADgAAAAkAAAASAAAABAAAAA0AAAAKAAAA"
    "EwAAACi1L/0gKEEBAAADAQIABAAAAAIHAQgAAAACAAIEAAEAAQAiBAABAAAAOkABAQAEgAIotS/9IAUpAAAAAgMBBCi1L/0gCUkA"
    "AAgKFqD/AaD/ASi1L/0gBCEAAAAEAgIotS/9IApRAAAEBAIDAgMBAQIBSU5EWOEcuoFcAAAAAAAAACi1L/0ga50CACKFEReQGeq4"
    "aAAsPH8BGyoxM8MnvxG3N3ZNCQv18E3w+D4cOBGp+arld3NAoGSim0IHw/H1xsnvl2jCSkqQOL5Bt0Vr2RaWWREDADkh+Atx1eGe"
    "VEFJTL2muO8IAAAAAAAAADcCAAAAAAAA";

TEST(TraceFormat, FilesOfVersionThreeAreRead) {
    Reader reader(memory_source(decoded(of_version_3), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 5U);
    EXPECT_TRUE(equal(all[0], {1, 0x10, 0, {1, 4, 0, 0, 0, Kind::read, Part::operation, 7}}));
    EXPECT_TRUE(equal(all[1], {3, 0x14, 0, {1, 4, 0, 1, 0, Kind::modify}}));
    EXPECT_TRUE(equal(all[2], {3, 0x40, 0, {1, 4, 0, 1, 0, Kind::modify, Part::piece}}));
    EXPECT_TRUE(equal(all[3], {2, 0xff40, 1, {2, 8, 0, 0, 0, Kind::write}}));
    EXPECT_TRUE(equal(all[4], {3, 0xff40, 1, {3, 64, 1, 1, 0, Kind::upgrade, Part::aside, 256}}));
    EXPECT_EQ(block.order.size(), 4U);
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
    EXPECT_EQ(reader.description().sites, (std::vector<std::string>{"a:1", "b:2", "0"}));
}

/// What two caches of 32 sets pass on: a line that comes, and mostly one before it that makes room; now and
/// then one of another set, one that never came, or two that leave at once.
TEST(TraceFormat, LinesThatLeaveCachesTakeLittle) {
    std::mt19937_64 random(3);
    std::array<std::vector<std::vector<std::uint64_t>>, 2> sets;
    for (auto& cache : sets)
        cache.resize(32);
    std::vector<Reference> all;
    std::size_t left = 0;
    for (std::uint64_t time = 0; all.size() < 30000; ++time) {
        const auto stream = static_cast<std::uint32_t>(random() % 2);
        const std::uint64_t line = random() % (std::uint64_t{1} << 30U);
        std::vector<std::uint64_t>& set = sets[stream][line % 32];
        Reference r{time, 0, stream, {}};
        r.what.size = 64;
        if (set.size() == 8) {
            const std::size_t at = random() % 3;
            r.what.kind = random() % 4 == 0 ? Kind::clean_back : Kind::write_back;
            r.address = (random() % 50 == 0 ? random() >> 6U : set[at]) * 64;
            set.erase(set.begin() + static_cast<std::ptrdiff_t>(at));
            all.push_back(r);
            if (random() % 50 == 0)
                all.push_back(r);
            ++left;
        }
        r.what.kind = random() % 3 == 0 ? Kind::write : Kind::read;
        r.address = line * 64;
        set.push_back(line);
        all.push_back(r);
    }
    BlockBuilder builder;
    for (const Reference& r : all)
        builder.add(r);
    Block block, back;
    builder.take(block);
    std::string bytes, shuffled;
    Encoder().encode(block, bytes);
    Decoder().decode(bytes, {3, 2, 3, 9}, format_version, "here", back);
    EXPECT_EQ(back.addresses, block.addresses);
    EXPECT_EQ(back.times, block.times);
    // As lines that come, which are of any set, they would take some four bytes each.
    for (Class& c : block.table)
        c.kind = c.kind == Kind::write_back   ? Kind::write_through
                 : c.kind == Kind::clean_back ? Kind::word
                                              : c.kind;
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

TEST(TraceFormat, TheOrderOfAllStreamsIsKept) {
    const std::vector<Reference> all = mixed_references(3000, 5);
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
    Decoder().decode(bytes, {3, 2, 3, 9}, format_version, "here", back);
    EXPECT_EQ(back.order, block.order);
    std::size_t at = 0;
    std::vector<Turn> got;
    each_in_order(
        back,
        [&](const Segment& s, std::size_t i) {
            EXPECT_TRUE(equal({back.times[i], back.addresses[i], s.stream, back.what(i)}, all[at++]));
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
    const std::vector<Reference> all = mixed_references(5000, 3);
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
            got.push_back({block.times[i], block.addresses[i], s.stream, block.what(i)});
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

TEST(TraceFormat, CutOffAnywhereItGivesItsWholeBlocks) {
    const Written sample = write_sample(4, 40);
    const std::size_t end_of_head = sample.ends.front() < 1 ? 0 : sample.bytes.find("NAME");
    for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
        const Got got = read_all(sample.bytes.substr(0, length));
        if (length < end_of_head) {
            EXPECT_NE(got.error, "") << length;
            EXPECT_EQ(got.error.find('\n'), std::string::npos) << got.error;
            continue;
        }
        const auto whole = static_cast<std::size_t>(
            std::count_if(sample.ends.begin(), sample.ends.end(), [&](auto end) { return end <= length; }));
        ASSERT_EQ(got.error, "") << length;
        ASSERT_EQ(got.blocks.size(), whole) << length;
        for (std::size_t b = 0; b < whole; ++b)
            ASSERT_TRUE(equal_blocks(got.blocks[b], sample.blocks[b])) << length;
        if (length < sample.bytes.size() - tail_bytes) {
            EXPECT_FALSE(got.complete) << length;
        }
        EXPECT_NE(got.note.find(std::to_string(whole) + " whole blocks"), std::string::npos) << got.note;
    }
}

TEST(TraceFormat, AFlippedBitIsSeenWhereverItIs) {
    const Written sample = write_sample(2, 60);
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
        std::string bytes = sample.bytes;
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
        const Got got = read_all(bytes);
        EXPECT_TRUE(got.error != "" || got.note != "") << at;
        EXPECT_TRUE(got.error.empty() || got.error.starts_with("sample: ")) << got.error;
        EXPECT_EQ((got.error + got.note).find('\n'), std::string::npos) << got.error;
        for (std::size_t b = 0; b < got.blocks.size(); ++b)
            EXPECT_TRUE(equal_blocks(got.blocks[b], sample.blocks[b])) << at;
    }
}

/// With sums that fit, as an enemy would write it.
TEST(TraceFormat, HostileBlocksAreRefused) {
    BlockBuilder builder;
    for (const Reference& r : mixed_references(50, 1))
        builder.add(r);
    Block block;
    builder.take(block);
    std::string good;
    Encoder().encode(block, good);
    const Decoder::Limits limits{3, 2, 3, 9};
    Block back;
    Decoder decoder;
    decoder.decode(good, limits, format_version, "here", back);
    EXPECT_EQ(back.addresses, block.addresses);
    std::size_t refused = 0;
    for (std::size_t at = 0; at < good.size(); ++at)
        for (const int value : {0, 1, 0x7F, 0x80, 0xFF}) {
            std::string bad = good;
            bad[at] = static_cast<char>(value);
            try {
                decoder.decode(bad, limits, format_version, "here", back);
                ASSERT_LE(back.size(), most_references);
                for (std::size_t i = 0; i < back.size(); ++i) {
                    ASSERT_LT(back.classes[i], back.table.size());
                    ASSERT_LT(back.what(i).structure, 3);
                    ASSERT_LE(back.what(i).site, 9U);
                }
                ASSERT_EQ(back.segments.back().end, back.size());
            } catch (const Error& e) {
                ++refused;
                ASSERT_TRUE(std::string(e.what()).starts_with("here: ")) << e.what();
            }
        }
    EXPECT_GT(refused, good.size());
    for (const Decoder::Limits& narrow : {Decoder::Limits{2, 2, 3, 9}, Decoder::Limits{3, 1, 3, 9},
                                          Decoder::Limits{3, 2, 2, 9}, Decoder::Limits{3, 2, 3, 8}})
        EXPECT_THROW(decoder.decode(good, narrow, format_version, "here", back), Error);
    for (std::size_t length = 0; length < good.size(); ++length)
        EXPECT_THROW(decoder.decode(good.substr(0, length), limits, format_version, "here", back), Error);
}

TEST(TraceFormat, WhatIsNoTraceIsSaidToBe) {
    EXPECT_NE(read_all("").error.find("is empty"), std::string::npos);
    EXPECT_NE(read_all("0 1234\n").error.find("--from"), std::string::npos);
    std::string later = write_sample(1, 1).bytes;
    later[8] = 5;
    EXPECT_NE(read_all(later).error.find("version 5"), std::string::npos);
    std::string endless(magic); // a description of 2^60 bytes
    append_fixed(endless, format_version);
    endless += "HEAD";
    append_fixed(endless, std::uint32_t{0});
    append_fixed(endless, std::uint64_t{1} << 60);
    EXPECT_NE(read_all(endless).error.find("claims"), std::string::npos);
    for (const char* text : {"{}", "[]", "3", "{\"program\": 3}", "not json"}) {
        const std::string head =
            std::string(magic) + std::string("\1\0\0\0", 4) + chunk_header(head_chunk, text) + text;
        EXPECT_NE(read_all(head).error.find("description"), std::string::npos) << text;
    }
}

TEST(TraceFormat, TheIndexSaysWhereBlocksAre) {
    const Written sample = write_sample(3, 500);
    const std::string path = testing::TempDir() + "/traces_index.rzt";
    std::ofstream(path, std::ios::binary) << sample.bytes;
    const std::optional<Index> index = read_index(path);
    ASSERT_TRUE(index);
    ASSERT_EQ(index->blocks.size(), 3U);
    EXPECT_EQ(index->references(), 1500U);
    EXPECT_EQ(index->sites.size(), 9U);
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
            got = read_all(stored.substr(0, stored.size() / 2));
            EXPECT_NE(got.error.find("end too early"), std::string::npos) << suffix << got.error;
            stored[stored.size() / 2] = static_cast<char>(stored[stored.size() / 2] ^ 0x55);
            got = read_all(stored);
            EXPECT_NE(got.error + got.note, "") << suffix;
        }
        std::filesystem::remove(path);
    }
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

TEST(TraceFormat, NumbersAreWhole) {
    for (const std::uint64_t x : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128}, ~std::uint64_t{0},
                                  std::uint64_t{1} << 63}) {
        std::string bytes;
        append_varint(bytes, x);
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

/// Takes some bytes, then no more.
class FullSink final : public Sink {
public:
    explicit FullSink(std::size_t room) : room_(room) {}
    void write(std::string_view bytes) override {
        if (bytes.size() > room_)
            throw Error("no room");
        room_ -= bytes.size();
    }
    void commit() override { ADD_FAILURE() << "what is not whole was committed"; }

private:
    std::size_t room_;
};

TEST(BackgroundWriter, WritesWhatAWriterWrites) {
    for (const std::size_t size : {1U, 7U, 1000U, 5000U}) {
        std::string plain, background;
        Writer writer(memory_sink(plain), test::small_description());
        BackgroundWriter other(memory_sink(background), test::small_description(), size);
        BlockBuilder builder;
        Block block;
        const std::vector<Reference> all = mixed_references(3000, 1, 9);
        writer.add_sites({"a:1", "b:2", "c:3"});
        other.add_sites({"a:1", "b:2", "c:3"});
        for (const Reference& r : all) {
            builder.add(r);
            other.add(r);
            if (builder.size() == size) {
                builder.take(block);
                writer.write(block);
            }
        }
        builder.take(block);
        writer.write(block);
        writer.finish();
        other.finish();
        EXPECT_TRUE(plain == background) << size;
        EXPECT_EQ(other.references(), all.size());
        EXPECT_EQ(other.bytes(), background.size());
    }
}

TEST(BackgroundWriter, TellsWhatFailedAndCommitsNothing) {
    const std::vector<Reference> all = mixed_references(100000, 1, 9);
    for (const std::size_t block : {1000U, 100000U}) {
        BackgroundWriter writer(std::make_unique<FullSink>(5000), test::small_description(), block);
        for (const Reference& r : all)
            writer.add(r); // by those who cannot be interrupted
        EXPECT_THROW(writer.finish(), Error);
    }
    BackgroundWriter left(std::make_unique<FullSink>(1 << 30), test::small_description(), 1000);
    for (const Reference& r : all)
        left.add(r);
}

} // namespace
} // namespace traces
