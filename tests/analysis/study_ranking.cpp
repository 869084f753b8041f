// Places that runs tell apart and those that they do not; ratios of a setting's extremes; curves.
#include "analysis/study/collect.h"
#include "tests/analysis/study_parts.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace analysis {
namespace {

std::vector<Spread> spreads(const std::vector<std::vector<double>>& runs) {
    std::vector<Spread> out;
    for (const auto& one : runs)
        out.push_back(spread_of(one));
    return out;
}

TEST(StudyRanking, PlacesAreAsSureAsRunsAre) {
    // The second and third overlap; the fourth is last beyond doubt; the fifth has too few runs.
    const auto places = rank(spreads({{1, 2, 1.5}, {3, 5, 4}, {4.5, 6, 5}, {7, 7, 7}, {0.1, 0.2}, {}}));
    std::vector<std::string> texts;
    for (const Place& place : places)
        texts.push_back(place_text(place));
    EXPECT_EQ(texts, (std::vector<std::string>{"1", "2-3", "2-3", "4", "-", "-"}));
    // Equal to the last digit is no order either; one run each says nothing.
    for (const Place& place : rank(spreads({{5, 5, 5}, {5, 5, 5}})))
        EXPECT_EQ(place_text(place), "1-2");
    for (const Place& place : rank(spreads({{1}, {2}})))
        EXPECT_FALSE(place.known());
}

// Against the definition, pair by pair.
TEST(StudyRanking, IsWhatPairsSay) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> value(0, 40), runs(2, 5);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<std::vector<double>> all(12);
        for (auto& one : all)
            for (int i = runs(random), at = value(random); i > 0; --i)
                one.push_back(at + value(random) % 6);
        const auto points = spreads(all);
        const auto places = rank(points);
        const auto ranked =
            std::count_if(all.begin(), all.end(), [](const auto& r) { return r.size() >= 3; });
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].size() < 3) {
                EXPECT_FALSE(places[i].known());
                continue;
            }
            std::size_t better = 0, worse = 0;
            for (const Spread& other : points) {
                better += surely_below(other, points[i]) ? 1 : 0;
                worse += surely_below(points[i], other) ? 1 : 0;
            }
            EXPECT_EQ(places[i].best, better + 1);
            EXPECT_EQ(places[i].worst, static_cast<std::size_t>(ranked) - worse);
        }
    }
}

class StudyRatios : public ::testing::Test {
protected:
    /// figure(lod, samples, edge) at all combinations, but where it is not finite; `noise` apart.
    template <class Figure> Collection collected(const std::string& more, double noise, Figure figure) {
        study_ = test_study(
            "kind = \"test\"\nrank = [\"error\"]\n[knobs]\nlod = [\"x\", \"y\", \"z\"]\nsamples = [4, 1, "
            "2]\nedge = [1, 3]\n" +
            more);
        points_ = resolve_points(study_, [](const Point& p) { return toml_text(p.settings); });
        for (const Point& point : points_) {
            const double value =
                figure(std::get<std::string>(point.settings.at("lod")),
                       *number_of(point.settings.at("samples")), *number_of(point.settings.at("edge")));
            if (!std::isfinite(value))
                continue;
            Result result;
            result.values["error"] = {value, value * (1 + noise), value * (1 - noise)};
            result.details = nlohmann::ordered_json::object();
            result.details["limited_by"] = "memory";
            store_.write_result(point, result, "test 1");
        }
        return collect(study_, points_, store_, {{"error", "error, m", more_}},
                       {{}, {}, true, {"limited_by"}});
    }
    static const Sensitivity& of(const Collection& all, const char* knob) {
        const auto& ratios = all.rankings.at(0).ratios;
        return *std::find_if(ratios.begin(), ratios.end(), [&](const auto& r) { return r.knob == knob; });
    }

    razor::TemporaryFolder folder_;
    Store store_{folder_ / "s"};
    Study study_;
    std::vector<Point> points_;
    bool more_ = false;
};

// Of a product each factor's ratio is the same at all other settings; of what is none there is a range.
TEST_F(StudyRatios, AreThoseOfFactors) {
    const Collection all = collected("", 0.01, [](const std::string& lod, double samples, double edge) {
        return (lod == "y" ? 9 : lod == "z" ? 3 : 1) * samples * samples * (samples > 1 ? edge : 1);
    });
    const Sensitivity &lod = of(all, "lod"), &samples = of(all, "samples"), &edge = of(all, "edge");
    EXPECT_EQ(plain_text(lod.from) + plain_text(lod.to), "xz"); // words: as the file has them
    EXPECT_DOUBLE_EQ(lod.ratio.median, 3);
    EXPECT_EQ(lod.ratio.count, 6U);
    EXPECT_EQ(lod.sure, 6U);
    EXPECT_EQ(plain_text(samples.from) + plain_text(samples.to), "14"); // numbers: the least and the greatest
    EXPECT_DOUBLE_EQ(samples.ratio.least, 16);
    EXPECT_DOUBLE_EQ(samples.ratio.most, 48);
    EXPECT_DOUBLE_EQ(edge.ratio.least, 1);
    EXPECT_DOUBLE_EQ(edge.ratio.median, 3);
    EXPECT_EQ(edge.sure, 6U); // of nine: not those of one sample
    // The strongest comes first, and the drawing has a bar for each.
    EXPECT_EQ(all.rankings[0].ratios.front().knob, "samples");
    const std::string svg = all.rankings[0].chart().drawing().str();
    EXPECT_NE(svg.find(">samples: 1 to 4</text>"), std::string::npos) << svg;
    // One curve by default: over the one setting of three numbers.
    ASSERT_EQ(all.curves.size(), 1U);
    EXPECT_EQ(all.curves[0].request.x, "samples");
    ASSERT_EQ(all.curves[0].chart.series.size(), 6U);
    const auto& series = all.curves[0].chart.series[0];
    EXPECT_EQ(series.name, "lod x, edge 1");
    EXPECT_EQ(series.points, (std::vector<std::pair<double, double>>{{1, 1}, {2, 4}, {4, 16}}));
    EXPECT_NEAR(series.errors[2], 0.16, 1e-12);
    const std::string csv = all.table().csv();
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "lod,samples,edge,error,error_least,error_most,limited_by,error_place,state,point");
    const auto json = nlohmann::json::parse(all.json());
    EXPECT_EQ(json["sensitivity"]["error"][0]["ratio"]["most"], 48);
}

TEST_F(StudyRatios, BelowTheSpreadAreNoise) {
    const Collection all = collected("", 0.05, [](const std::string& lod, double samples, double edge) {
        return edge == 3 && lod == "x" ? std::nan("") : (lod == "y" ? 1.03 : 1) * samples;
    });
    EXPECT_EQ(of(all, "lod").sure, 0U);
    EXPECT_EQ(of(all, "lod").ratio.count, 3U); // x has edge 1 alone
    EXPECT_EQ(of(all, "edge").ratio.count, 6U);
    EXPECT_EQ(of(all, "samples").sure, 5U);
    EXPECT_TRUE(all.rankings[0].chart().bars.back().faint);
    EXPECT_FALSE(all.rankings[0].chart().bars.front().faint);
    // Five designs of one sample are within noise of each other.
    EXPECT_NE(all.rankings[0].verdict(all.points, all.knobs).find("5 points may be the best by error"),
              std::string::npos);
    const std::string page = all.html({});
    EXPECT_NE(page.find("places"), std::string::npos);
    EXPECT_NE(page.find("1-5"), std::string::npos);
}

TEST_F(StudyRatios, MoreMayBeBetter) {
    more_ = true;
    const Collection all = collected("[[plot]]\nx = \"seconds\"\ny = \"error\"\n", 0.01,
                                     [](const auto& lod, double samples, double edge) {
                                         return (lod == "x" ? 1.0 : lod == "y" ? 2.0 : 3.0) * samples * edge;
                                     });
    EXPECT_EQ(place_text(all.rankings[0].places[all.rankings[0].order.front()]), "1");
    EXPECT_NE(all.rankings[0].verdict(all.points, all.knobs).find("lod z, samples 4, edge 3"),
              std::string::npos);
}

// Of words the first and the last that is another, though points come back to the first.
TEST(StudySensitivity, WordsMayComeBackToTheFirst) {
    std::vector<Settings> settings;
    for (const auto& [lod, samples] :
         std::vector<std::pair<const char*, std::int64_t>>{{"x", 1}, {"y", 1}, {"z", 1}, {"z", 2}, {"x", 2}})
        settings.push_back({{"lod", std::string(lod)}, {"samples", samples}});
    std::vector<Response> responses;
    for (std::size_t i = 0; i < settings.size(); ++i)
        responses.push_back({&settings[i], spread_of(std::vector{static_cast<double>(i + 1)})});
    const std::vector<Sensitivity> found = sensitivities(responses, {"lod"});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(plain_text(found[0].from) + plain_text(found[0].to), "xz");
    EXPECT_EQ(found[0].ratio.count, 2U);
    EXPECT_DOUBLE_EQ(found[0].ratio.most, 3);
    EXPECT_DOUBLE_EQ(found[0].ratio.least, 0.8);
}

// A value that has no logarithm leaves the axis as it is, wherever among the points it comes.
TEST(StudyCurve, IsLogarithmicOnlyWhereAllValuesArePositive) {
    const auto curve = [](const std::vector<double>& values) {
        std::vector<CollectedPoint> points;
        for (const double x : values) {
            CollectedPoint& point = points.emplace_back();
            point.point.settings["x"] = x;
            point.result.emplace();
            point.result->values["y"] = {1};
        }
        return curve_of(points, {"x"}, {"x", "y"}, "y").chart;
    };
    EXPECT_TRUE(curve({8, 1, 2}).x.logarithmic);
    EXPECT_FALSE(curve({3, 1, 2}).x.logarithmic);
    EXPECT_FALSE(curve({0, 1, 8}).x.logarithmic);
    EXPECT_FALSE(curve({8, 0, 1}).x.logarithmic);
    EXPECT_FALSE(curve({-4, 0, 1, 8}).x.logarithmic);
    EXPECT_FALSE(curve({}).x.logarithmic);
}

// Bars begin at 1 and end at the median, to the side of what it is.
TEST(RatioChart, BarsReachFromOneToTheMedian) {
    const RatioChart chart{"cycles", {{"less", 0.5, 0.4, 0.6, false}, {"more", 2, 1.5, 2.5, true}}};
    const std::string svg = chart.drawing().str();
    const auto number = [&](std::size_t bar, const std::string& attribute) {
        std::size_t at = svg.find("</title>");
        for (std::size_t i = 0; i < bar; ++i)
            at = svg.find("</title>", at + 1);
        const std::size_t begin = svg.rfind("<rect ", at);
        return std::stod(svg.substr(svg.find(" " + attribute + "=\"", begin) + attribute.size() + 3));
    };
    EXPECT_NEAR(number(0, "x") + number(0, "width"), number(1, "x"), 0.02); // both have an end at 1
    EXPECT_NEAR(number(0, "width"), number(1, "width"), 0.02);              // a half and twice: as far
    EXPECT_GT(number(0, "x"), 330);
    EXPECT_LT(number(1, "x") + number(1, "width"), 770);
    EXPECT_GT(number(0, "width"), 50);
}

} // namespace
} // namespace analysis
