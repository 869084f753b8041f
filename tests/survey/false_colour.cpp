// Numbers as colours.
#include "razor/image/false_colour.h"
#include "razor/image/png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace razor {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// As Green weighs them, for which the map's lightness is its fraction.
double lightness(const glm::vec3& c) {
    return 0.30 * c.r + 0.59 * c.g + 0.11 * c.b;
}

TEST(FalseColour, GrowsLighterAllTheWay) {
    double before = 0;
    for (int i = 0; i <= 100; ++i) {
        const double now = lightness(false_colour(i / 100.0));
        EXPECT_NEAR(now, 0.15 + 0.8 * i / 100.0, 2e-3) << i;
        EXPECT_GT(now, before) << i;
        before = now;
    }
    EXPECT_EQ(false_colour(-1), false_colour(0));
    EXPECT_EQ(false_colour(2), false_colour(1));
}

TEST(FalseColour, NamesOfNeighboursDiffer) {
    for (int i = 0; i < 2000; ++i)
        for (int step = 1; step <= 3; ++step) {
            const glm::vec3 a = name_colour(i), b = name_colour(i + step);
            const double apart = std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
            EXPECT_GT(apart, 0.15) << i << ' ' << step;
            EXPECT_GT(lightness(a), 0.15);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(a[c], 0);
                EXPECT_LE(a[c], 1);
            }
        }
    EXPECT_EQ(name_colour(123456), name_colour(123456));
}

TEST(FalseColour, RangeLeavesOutWhatIsMissing) {
    const Plane plane{"x", {3, -1, infinity, 7, std::nanf(""), 5}};
    const auto minus_one = [](float v) { return v == -1; };
    const auto never = [](float) { return false; };
    EXPECT_EQ(range_of(plane, minus_one).low, 3);
    EXPECT_EQ(range_of(plane, minus_one).high, 7);
    EXPECT_EQ(range_of(plane, never).low, -1);
    EXPECT_EQ(range_of({"x", {-1, infinity}}, minus_one).low, 0);
    EXPECT_EQ(range_of({"x", {-1, infinity}}, minus_one).high, 1);
}

TEST(FalseColour, NamesBeyondFloatsHaveColoursOfTheirOwn) {
    Film film(3, 1);
    film.add_ids("x").ids = {16777216, 16777217, no_id};
    const auto never = [](float) { return false; };
    EXPECT_EQ(range_of(film.planes[0], never).high, 16777217);
    const Film shown = false_coloured(film, film.planes[0], true, {}, never);
    const auto colour = [&](std::size_t i) {
        return std::tuple(shown.planes[0].values[i], shown.planes[1].values[i], shown.planes[2].values[i]);
    };
    EXPECT_NE(colour(0), colour(1));
    EXPECT_EQ(colour(2), std::tuple(0.0F, 0.0F, 0.0F));
}

TEST(FalseColour, FilmShowsItsColours) {
    Film film(6, 1);
    film.add("x").values = {2, 6, 4, -1, infinity, 100};
    const auto minus_one = [](float v) { return v == -1; };
    const Film shown = false_coloured(film, film.planes[0], false, {2, 6}, minus_one);
    const double places[] = {0, 1, 0.5, -1, -1, 1};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double expected =
                places[i] < 0 ? 0 : 255 * double{false_colour(places[i])[static_cast<int>(c)]};
            EXPECT_NEAR(to_srgb8(shown.planes[c].values[i]), expected, 1) << i << ' ' << c;
        }
    const Film names = false_coloured(film, film.planes[0], true, {2, 6}, minus_one);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(to_srgb8(names.planes[c].values[1]), 255 * name_colour(6)[static_cast<int>(c)], 1);
}

} // namespace
} // namespace razor
