// What results say together: tables, fronts, plots, pages; drawings as pixels.
#include "analysis/plots/raster.h"
#include "analysis/study/collect.h"
#include "tests/analysis/study_parts.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace analysis {
namespace {

class StudyCollection : public ::testing::Test {
protected:
    StudyCollection() {
        study_ = test_study(
            "kind = \"test\"\ntitle = \"A <study>\"\n[knobs]\nlod = [\"x\", \"y\"]\nsamples = [1, 2, 3]\n"
            "[[plot]]\nx = \"seconds\"\ny = \"error\"\nlines = [\"lod\"]\n");
        points_ = resolve_points(study_, [](const Point& p) { return toml_text(p.settings); });
        // x: (1, 8) (2, 4) (4, 4.5, on some runs 3.9); y: (1, 9) failed, missing.
        add(0, {1, 1, 1.1}, {8});
        add(1, {2.2, 2, 2}, {4});
        add(2, {4, 1.9, 5}, {4.5});
        add(3, {1.2, 1.2, 1.2}, {9});
        Result failed;
        failed.failed = "it fell over";
        store_.write_result(points_[4], failed, "test 1");
        all_ = collect(study_, points_, store_,
                       {{"seconds", "time, s"}, {"error", "error"}, {"none", "none"}}, {});
    }
    void add(std::size_t point, std::vector<double> seconds, std::vector<double> error) const {
        Result result;
        result.host["seconds"] = std::move(seconds);
        result.values["error"] = std::move(error);
        store_.write_result(points_[point], result, "test 1");
    }
    std::string text(const char* name) const {
        std::ifstream in(folder_ / "s" / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    razor::TemporaryFolder folder_;
    Store store_{folder_ / "s"};
    Study study_;
    std::vector<Point> points_;
    Collection all_;
};

TEST_F(StudyCollection, TablesEveryPoint) {
    EXPECT_EQ(all_.missing, 1U);
    EXPECT_EQ(all_.failed, 1U);
    const std::string csv = all_.table().csv();
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "lod,samples,seconds,seconds_least,seconds_most,error,error_least,error_most,"
              "error-seconds,state,point");
    EXPECT_NE(csv.find("x,1,1,1,1.1,8,8,8,front,measured," + points_[0].name), std::string::npos) << csv;
    EXPECT_NE(csv.find("x,3,4,1.9,5,4.5,4.5,4.5,dominated,measured,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("y,2,-,-,-,-,-,-,-,failed: it fell over,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("y,3,-,-,-,-,-,-,-,missing,"), std::string::npos) << csv;
    const auto json = nlohmann::json::parse(all_.json());
    EXPECT_EQ(json["points"][0]["figures"]["seconds"]["median"], 1);
    EXPECT_EQ(json["points"][0]["settings"]["samples"], 1);
    EXPECT_EQ(json["points"][4]["failed"], "it fell over");
}

// An axis with no multiple of a power of ten on it, and names too long for a line.
TEST(Scatter, NamesTicksOfAnyAxisAndAllOfEachSeries) {
    ScatterChart chart;
    chart.series.push_back({"sim.mode fast, memory.controller queued", {{}, {}}, false});
    chart.series[0].marks[0].x = 1.31e7;
    chart.series[0].marks[1].x = 1.72e7;
    chart.series[0].marks[0].y = chart.series[0].marks[1].y = 0.01;
    const std::string svg = chart.drawing().str();
    EXPECT_NE(svg.find(">1.4e+07</text>"), std::string::npos) << svg;
    EXPECT_NE(svg.find(">1.6e+07</text>"), std::string::npos);
    EXPECT_NE(svg.find(">sim.mode fast,</text>"), std::string::npos);
    EXPECT_NE(svg.find(">memory.controller queued</text>"), std::string::npos);
    chart.series[0].name = std::string(26, 'a') + "\u00e9 without a comma"; // cut before the character
    EXPECT_NE(chart.drawing().str().find('>' + std::string(26, 'a') + "...</text>"), std::string::npos);
}

TEST_F(StudyCollection, PlotsAreLogarithmicAndShowTheFront) {
    const ScatterChart& chart = all_.plots.at(0).chart;
    EXPECT_EQ(chart.front, (std::vector<std::pair<double, double>>{{1, 8}, {2, 4}}));
    ASSERT_EQ(chart.series.size(), 2U);
    EXPECT_EQ(chart.series[0].name, "lod x");
    ASSERT_EQ(chart.series[0].marks.size(), 3U);
    // Doubling is the same step everywhere.
    const std::string svg = chart.drawing().str();
    std::vector<double> xs;
    for (std::size_t at = svg.find("<circle cx=\""); at != std::string::npos;
         at = svg.find("<circle cx=\"", at + 1))
        xs.push_back(std::stod(svg.substr(at + 12)));
    ASSERT_EQ(xs.size(), 4U);
    EXPECT_NEAR(xs[1] - xs[0], xs[2] - xs[1], 0.02); // 1, 2, 4 seconds
    EXPECT_GT(xs[1] - xs[0], 50);
    EXPECT_NE(svg.find(">time, s</text>"), std::string::npos);
}

TEST_F(StudyCollection, WritesWholeFiles) {
    const std::vector<std::string> written = write_collection(all_, store_, {"A remark."});
    EXPECT_EQ(written.size(), 5U);
    EXPECT_EQ(text("study.csv"), all_.table().csv());
    const std::string page = text("study.html");
    EXPECT_NE(page.find("A &lt;study&gt;"), std::string::npos);
    EXPECT_NE(page.find("6 points; 4 measured, 1 failed, 1 missing."), std::string::npos);
    EXPECT_NE(page.find("A remark."), std::string::npos);
    EXPECT_NE(page.find("2 points on the front, 0 tied with it."), std::string::npos);
    for (const char* elsewhere : {"src=\"http", "href=\"http", "@import"})
        EXPECT_EQ(page.find(elsewhere), std::string::npos);
    EXPECT_EQ(text("error-seconds.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(text("error-seconds.svg").substr(0, 5), "<?xml");
    // Nothing else is left.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "s"), {}), 7);
}

std::array<int, 3> pixel(const Pixels& pixels, std::size_t x, std::size_t y) {
    const std::size_t at = 3 * (y * pixels.width + x);
    return {pixels.rgb[at], pixels.rgb[at + 1], pixels.rgb[at + 2]};
}

TEST(Raster, FillsWhatTheDrawingHolds) {
    using Rgb = std::array<int, 3>;
    Svg svg(40, 30);
    svg.rectangle(5, 5, 10, 10, "#ff0000");
    svg.rectangle(20.25, 5, 10.5, 10, "#0000ff");
    svg.circle(10, 22, 5, "white", "#00ff00");
    const Pixels one = rasterised(svg, 1);
    EXPECT_EQ(one.width, 40U);
    EXPECT_EQ(one.height, 30U);
    EXPECT_EQ(pixel(one, 0, 0), (Rgb{255, 255, 255}));
    EXPECT_EQ(pixel(one, 5, 5), (Rgb{255, 0, 0}));
    EXPECT_EQ(pixel(one, 14, 14), (Rgb{255, 0, 0}));
    EXPECT_EQ(pixel(one, 15, 14), (Rgb{255, 255, 255}));
    EXPECT_EQ(pixel(one, 20, 8), (Rgb{64, 64, 255})); // three quarters covered
    EXPECT_EQ(pixel(one, 30, 8), (Rgb{64, 64, 255}));
    EXPECT_EQ(pixel(one, 25, 8), (Rgb{0, 0, 255}));
    EXPECT_EQ(pixel(one, 10, 22), (Rgb{255, 255, 255})); // inside of the ring
    EXPECT_EQ(pixel(one, 14, 22)[1], 255);               // most of it
    EXPECT_LT(pixel(one, 14, 22)[0], 80);
    // The ring's area at a finer scale: pi ((5.8)^2 - (4.2)^2), drawn with 24 corners.
    const Pixels fine = rasterised(svg, 8);
    double green = 0;
    for (std::size_t y = 0; y < fine.height; ++y)
        for (std::size_t x = 0; x < fine.width; ++x)
            if (pixel(fine, x, y) != Rgb{255, 255, 255} && x < 18 * 8 && y > 16 * 8)
                green += (255 - pixel(fine, x, y)[0]) / 255.0 / 64;
    EXPECT_NEAR(green, 3.14159 * (5.8 * 5.8 - 4.2 * 4.2), 1);
}

TEST(Raster, LettersStandWhereTheyShould) {
    const auto box = [](Svg::Anchor anchor, double degrees) {
        Svg svg(200, 200);
        svg.text(100, 100, "ABC", anchor, 20, degrees);
        const Pixels pixels = rasterised(svg, 1);
        std::array<std::size_t, 4> out{200, 200, 0, 0};
        for (std::size_t y = 0; y < 200; ++y)
            for (std::size_t x = 0; x < 200; ++x)
                if (pixel(pixels, x, y)[0] < 128)
                    out = {std::min(out[0], x), std::min(out[1], y), std::max(out[2], x),
                           std::max(out[3], y)};
        return out;
    };
    const auto start = box(Svg::Anchor::start, 0), end = box(Svg::Anchor::end, 0),
               turned = box(Svg::Anchor::start, -90);
    EXPECT_GE(start[0], 100U);
    EXPECT_LE(end[2], 100U);
    EXPECT_LE(start[3], 100U); // above the base line
    EXPECT_NEAR(static_cast<double>(start[3] - start[1]), 0.72 * 20, 2);
    EXPECT_LE(turned[2], 100U); // reads upwards, to the left of where it stands
    EXPECT_LE(turned[3], 100U);
    EXPECT_NEAR(static_cast<double>(turned[3] - turned[1]), static_cast<double>(start[2] - start[0]), 2);
}

} // namespace
} // namespace analysis
