// Bits and values that differ, channel by channel.
#include "analysis/metrics/differences.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Channel floats(const char* name, const std::vector<float>& values) {
    Channel out{name, Channel::Kind::float32, {}};
    for (const float value : values) {
        out.bits.push_back(std::bit_cast<std::uint32_t>(value));
    }
    return out;
}

TEST(Differences, CountBitsAndMeasureValues) {
    const ImageFile a{3, 2, {floats("G", {1, 2, 3, 4, 5, 6}), floats("R", {0, 0, 0, 0, 0, 0})}};
    const ImageFile b{3, 2, {floats("G", {1, 2.5F, 3, 1, 5, 6}), floats("R", {0, 0, 0, -0.0F, 0, 1})}};
    EXPECT_TRUE(differences(a, a).identical());
    const Differences result = differences(a, b);
    EXPECT_FALSE(result.identical());
    EXPECT_EQ(result.pixels_differing, 3U); // 1, 3 (twice) and 5
    ASSERT_EQ(result.channels.size(), 2U);
    const ChannelDifference& g = result.channels[0];
    EXPECT_EQ(g.differing, 2U);
    EXPECT_EQ(g.first, 1U);
    EXPECT_EQ(g.largest, 3);
    EXPECT_EQ(g.largest_at, 3U);
    EXPECT_EQ(g.a, 4);
    EXPECT_EQ(g.b, 1);
    EXPECT_NEAR(g.rmse, std::sqrt((0.25 + 9) / 6), 1e-12);
    EXPECT_EQ(result.channels[1].differing, 2U);
    EXPECT_EQ(result.channels[1].largest_at, 5U);
}

TEST(Differences, KeepNumbersApartFromOthers) {
    const ImageFile a{5, 1, {floats("Z", {infinity, nan, 1, 2, infinity})}};
    const ImageFile b{5, 1, {floats("Z", {infinity, nan, nan, 3, -infinity})}};
    const ChannelDifference z = differences(a, b).channels.at(0);
    EXPECT_EQ(z.differing, 3U);
    EXPECT_EQ(z.left_out, 4U);
    EXPECT_EQ(z.not_numbers_differing, 2U);
    EXPECT_EQ(z.largest, 1);
    EXPECT_EQ(z.rmse, 1);
}

TEST(Differences, NameChannelsWithoutPartner) {
    ImageFile a{1, 1, {floats("A", {1}), floats("B", {1})}};
    const ImageFile b{1, 1, {floats("B", {1}), floats("C", {1})}};
    const Differences result = differences(a, b);
    EXPECT_FALSE(result.identical());
    EXPECT_EQ(result.only_in_a, std::vector<std::string>{"A"});
    EXPECT_EQ(result.only_in_b, std::vector<std::string>{"C"});
    a.channels[1].kind = Channel::Kind::uint32;
    EXPECT_EQ(differences(a, b).stored_as_different_types, std::vector<std::string>{"B"});
    EXPECT_FALSE(differences(a, ImageFile{2, 1, {}}).same_size);
    EXPECT_FALSE(differences(a, ImageFile{2, 1, {}}).identical());
}

} // namespace
} // namespace analysis
