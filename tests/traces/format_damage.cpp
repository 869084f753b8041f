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

/// Blocks that are decoded ahead, and chunks read for that, change nothing, wherever a file is damaged or
/// ends.
TEST(TraceFormat, WhatIsReadAheadIsSaidInItsTurn) {
    const Written sample = write_sample(5, 30);
    const auto expect_alike = [](const std::string& bytes, std::size_t at) {
        const Got one = read_all(bytes, 1);
        for (const std::size_t ahead : {2U, 4U}) {
            const Got more = read_all(bytes, ahead);
            EXPECT_EQ(more.error, one.error) << at;
            EXPECT_EQ(more.note, one.note) << at;
            EXPECT_EQ(more.complete, one.complete) << at;
            ASSERT_EQ(more.blocks.size(), one.blocks.size()) << at;
            for (std::size_t b = 0; b < one.blocks.size(); ++b)
                EXPECT_TRUE(equal_blocks(more.blocks[b], one.blocks[b])) << at;
        }
    };
    expect_alike(sample.bytes, 0);
    for (std::size_t at = 0; at < sample.bytes.size(); at += 7) {
        std::string bad = sample.bytes;
        bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
        expect_alike(bad, at);
        expect_alike(sample.bytes.substr(0, at), at);
        // With a sum that fits: what is wrong is seen where the block is decoded.
        const auto end = std::find_if(sample.ends.begin(), sample.ends.end(), [&](auto e) { return e > at; });
        if (end == sample.ends.end())
            continue;
        const std::size_t begin = sample.bytes.rfind(block_chunk, *end - 1);
        if (at < begin + chunk_header_bytes)
            continue;
        const std::string content = bad.substr(begin + chunk_header_bytes, *end - begin - chunk_header_bytes);
        expect_alike(bad.replace(begin, chunk_header_bytes, chunk_header(block_chunk, content)), at);
    }
}

/// Bytes of a source, of which it counts those that were taken.
class Counting final : public Source {
public:
    Counting(std::string bytes, std::size_t& taken) : bytes_(std::move(bytes)), taken_(taken) {}
    std::size_t read(void* to, std::size_t most) override {
        const std::size_t n = bytes_.copy(static_cast<char*>(to), most, taken_);
        taken_ += n;
        return n;
    }

private:
    std::string bytes_;
    std::size_t& taken_;
};

/// Two blocks, and no more, whatever the file has; none beyond names, which say what may follow.
TEST(TraceFormat, SoManyBlocksAreReadAhead) {
    const Written sample = write_sample(5, 30); // names come before the first two blocks
    const std::size_t names = sample.bytes.find(names_chunk, sample.ends[0]);
    const std::size_t end_of_names = sample.bytes.find(block_chunk, names);
    for (const std::size_t ahead : {1U, 2U, 3U}) {
        std::size_t taken = 0;
        Reader reader(std::make_unique<Counting>(sample.bytes, taken), ahead);
        Block block;
        ASSERT_TRUE(reader.next(block));
        EXPECT_EQ(taken, ahead == 1 ? sample.ends[0] : end_of_names) << ahead;
        EXPECT_EQ(reader.bytes(), sample.ends[0]);
        EXPECT_EQ(reader.description().sites.size(), 5U);
        ASSERT_TRUE(reader.next(block));
        EXPECT_EQ(taken, sample.ends[ahead]) << ahead;
        EXPECT_EQ(reader.bytes(), sample.ends[1]);
        EXPECT_EQ(reader.description().sites.size(), 9U);
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
