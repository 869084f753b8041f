// Files of earlier versions are read as they were.
#include "tests/traces/old_files.h"
#include "tests/traces/samples.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/error.h"
#include "traces/reader.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace traces {
namespace {

using namespace test;

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

std::vector<Reference> passed_on() {
    std::vector<Reference> all;
    for (std::uint32_t k = 0; k < 200; ++k) {
        Reference r{3 * k, 0, 0, {k % 3, 64, 1, 0, 0, Kind::write_back, Part::operation, k % 2}, k / 40};
        r.address = (std::uint64_t{k} - 64) * 64;
        if (k >= 64)
            all.push_back(r);
        r.what.kind = k % 5 == 0 ? Kind::write : Kind::read;
        r.address = std::uint64_t{k} * 64;
        all.push_back(r);
    }
    return all;
}

void expect_passed_on(const Block& block, bool tiles) {
    const std::vector<Reference> got = references_of(block);
    std::vector<Reference> want = passed_on();
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        want[i].tile = tiles ? want[i].tile : 0;
        EXPECT_TRUE(equal(got[i], want[i])) << i;
    }
    ASSERT_EQ(block.order.size(), 15U); // seven windows, and the end
    EXPECT_EQ(block.order[2], (Turn{Turn::What::window, 0, 0, 2250, 2240}));
    EXPECT_EQ(block.order[3].count, 50U);
    EXPECT_EQ(block.order[14], (Turn{Turn::What::end, 0, 0, 9000, 8000}));
}

TEST(TraceFormat, FilesOfVersionFiveAreRead) {
    for (const std::string_view text : {of_version_5, predicted_of_version_5}) {
        Reader reader(memory_source(decoded(text), "old"));
        Block block;
        ASSERT_TRUE(reader.next(block));
        expect_passed_on(block, true);
        EXPECT_FALSE(reader.next(block));
        EXPECT_TRUE(reader.complete()) << reader.note();
    }
}

TEST(TraceFormat, FilesOfVersionSixAreRead) {
    for (const std::string_view text : {of_version_6, predicted_of_version_6}) {
        Reader reader(memory_source(decoded(text), "old"));
        Block block;
        ASSERT_TRUE(reader.next(block));
        expect_passed_on(block, true);
        EXPECT_FALSE(reader.next(block));
        EXPECT_TRUE(reader.complete()) << reader.note();
    }
}

TEST(TraceFormat, FilesOfVersionSevenAreRead) {
    Reader reader(memory_source(decoded(predicted_of_version_7), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    expect_passed_on(block, true);
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();

    Reader writes(memory_source(decoded(writes_of_version_7), "old"));
    ASSERT_TRUE(writes.next(block));
    const std::vector<Reference> got = references_of(block), want = passed_on();
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].address, want[i].address) << i;
        EXPECT_EQ(got[i].time, want[i].time) << i;
        EXPECT_EQ(got[i].what.kind, want[i].what.kind == Kind::write_back ? Kind::write : Kind::read) << i;
    }
}

/// The first block of a file.
std::string without_last_column(const std::string& file) {
    const std::size_t chunk = file.find(block_chunk);
    std::string bytes =
        file.substr(chunk + chunk_header_bytes, fixed_at<std::uint64_t>(file.data() + chunk + 8));
    constexpr std::size_t sizes = 24 + 5 * 8; // of the last column
    bytes.resize(bytes.size() - fixed_at<std::uint32_t>(bytes.data() + sizes + 4));
    return bytes.erase(sizes, 8);
}

/// Blocks of version 4 are those of version 5 without the last column, of tiles.
TEST(TraceFormat, BlocksOfVersionFourAreRead) {
    std::string bytes = without_last_column(decoded(of_version_5));
    Block back;
    Decoder().decode(bytes, {2, 1, 1, 2}, 4, "old", back);
    expect_passed_on(back, false);
    EXPECT_THROW(Decoder().decode(bytes, {2, 1, 1, 2}, format_version, "new", back), Error);

    bytes = without_last_column(decoded(predicted_without_tiles));
    Decoder().decode(bytes, {2, 1, 1, 2}, 4, "old", back);
    expect_passed_on(back, false);
    EXPECT_THROW(Decoder().decode(bytes, {2, 1, 1, 2}, format_version, "new", back), Error);
}

TEST(TraceFormat, TheDescriptionIsOfThisVersion) {
    std::ifstream file(RAZOR_SOURCE_DIR "/traces/README.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(text.find(fmt::format("## The format, version {}\n", format_version)), std::string::npos);
    EXPECT_NE(text.find(fmt::format("    version   4 bytes   {}\n", format_version)), std::string::npos);
}

} // namespace
} // namespace traces
