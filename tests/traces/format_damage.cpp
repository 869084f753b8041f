// What is cut off, damaged or no trace at all: whole blocks and a note, or an Error of one line.
#include "tests/traces/written.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/varint.h"

namespace traces {
namespace {

using test::equal_blocks;
using test::Got;
using test::mixed_references;
using test::read_all;
using test::write_sample;
using test::Written;

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
    later[8] = format_version + 1;
    EXPECT_NE(read_all(later).error.find("version " + std::to_string(format_version + 1)), std::string::npos);
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

} // namespace
} // namespace traces
