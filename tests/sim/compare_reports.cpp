// Comparisons of reports say what differs, all of it, and nothing else.
#include "sim/config/error.h"
#include "sim/reports/compare.h"
#include "sim/reports/flat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace sim::test {
namespace {

using nlohmann::json;

ReportFile report(double cycles, double misses = 100, int ways = 4) {
    json r{{"program", "razor-sim"},
           {"scene", "a\nb\n"},
           {"mode", "fast"},
           {"options", {{"workers", 8}}},
           {"machine", {{"l1", {{"ways", ways}, {"line_bytes", 32}}}, {"sim", {{"jitter", cycles}}}}},
           {"cycles", cycles},
           {"l1", {{"misses", misses}}},
           {"stack", {{"busy", 10}, {"idle", 0}}},
           {"host", {{"seconds", cycles}}}};
    r["phases"] = json::array();
    r["phases"].push_back({{"phase", "traverse"}, {"vops", misses * 2}});
    r["traffic"] = json::array();
    r["traffic"].push_back({{"structure", "grids"}, {"memory_reads", misses}, {"memory_writes", 1}});
    r["traffic"].push_back({{"structure", "grids"}, {"memory_reads", 3}, {"memory_writes", 0}});
    return {"report", r};
}

ReportComparison compare(const std::vector<ReportFile>& a, const std::vector<ReportFile>& b) {
    return compare_reports(a, b);
}

TEST(CompareReports, OfOneRunFindNothing) {
    const ReportComparison c = compare({report(1000)}, {report(1000)});
    EXPECT_TRUE(c.settings.empty());
    EXPECT_TRUE(c.scene.empty());
    EXPECT_TRUE(c.all.empty());
    ASSERT_EQ(c.figures.size(), 3u) << "cycles, misses, busy; what is 0 in both is left out";
    for (const FigureChange& f : c.figures) {
        EXPECT_EQ(f.ratio(), 1) << f.name;
        EXPECT_FALSE(f.beyond_spread()) << f.name;
    }
    EXPECT_NE(comparison_text(c, 0, true).find("the same machine and run"), std::string::npos);
}

TEST(CompareReports, FindSettingsScenesAndFigures) {
    ReportFile other = report(1500, 50, 8);
    other.json["scene"] = "a\nc\nd\n";
    const ReportComparison c = compare({report(1000)}, {other});
    ASSERT_EQ(c.settings.size(), 1u) << "jitter's seed is no other design";
    EXPECT_EQ(c.settings[0].name, "l1.ways");
    EXPECT_EQ(c.settings[0].first, "4");
    EXPECT_EQ(c.settings[0].second, "8");
    ASSERT_EQ(c.scene.size(), 2u);
    EXPECT_EQ(c.scene[0].first, "b");
    EXPECT_EQ(c.scene[1].second, "d");
    EXPECT_EQ(c.figures[0].name, "cycles");
    EXPECT_EQ(c.figures[0].ratio(), 1.5);
    EXPECT_TRUE(c.figures[0].beyond_spread());
    EXPECT_EQ(c.figures[1].name, "l1.misses");
    EXPECT_EQ(c.figures[1].ratio(), 0.5);
    ASSERT_EQ(c.memory_bytes.size(), 1u);
    EXPECT_EQ(c.memory_bytes[0].first.median, 32 * 104);
    EXPECT_EQ(c.memory_bytes[0].second.median, 32 * 54);
    ASSERT_EQ(c.all.size(), 1u) << "the host's seconds are not the machine's";
    EXPECT_EQ(c.all[0].name, "phases.traverse.vops");
    EXPECT_EQ(json::parse(comparison_json(c))["figures"][0]["ratio"], 1.5);
}

TEST(CompareReports, TellEstimatesFromRuns) {
    ReportFile sampled = report(1000);
    sampled.json["estimate"] = {{"how", "sampled"}};
    const ReportComparison c = compare({report(1000)}, {sampled});
    ASSERT_EQ(c.settings.size(), 1u);
    EXPECT_EQ(c.settings[0].name, "run.estimate");
    EXPECT_EQ(c.settings[0].first, "");
    EXPECT_EQ(c.settings[0].second, "sampled");
}

// Memory has lines of the last cache that there is.
TEST(CompareReports, TakeBytesOfMemoryByItsLines) {
    ReportFile larger = report(1000);
    larger.json["machine"]["l2"] = {{"size_bytes", 65536}, {"line_bytes", 256}};
    larger.json["machine"]["l3"] = {{"size_bytes", 0}, {"line_bytes", 64}};
    const ReportComparison c = compare({report(1000)}, {larger});
    EXPECT_EQ(c.memory_bytes[0].first.median, 32 * 104);
    EXPECT_EQ(c.memory_bytes[0].second.median, 256 * 104);
}

TEST(CompareReports, KnowWhatRunsOfOneDesignDifferBy) {
    const ReportComparison c = compare({report(1000, 90), report(1100, 90), report(1050, 90)},
                                       {report(1090, 80), report(1200, 80), report(1150, 80)});
    EXPECT_EQ(c.figures[0].first.median, 1050);
    EXPECT_EQ(c.figures[0].second.most, 1200);
    EXPECT_FALSE(c.figures[0].beyond_spread());
    EXPECT_TRUE(c.figures[1].beyond_spread());
    const std::string text = comparison_text(c, 0, false);
    EXPECT_NE(text.find("within the runs' spread"), std::string::npos) << text;
    EXPECT_NE(comparison_text(c, 20, false).find("within noise"), std::string::npos);
    EXPECT_THROW(compare({report(1), report(1, 2, 8)}, {report(1)}), ConfigError);
}

/// An estimate has no levels of caches, a machine no third one: that is not none.
TEST(CompareReports, InventNothing) {
    ReportFile estimate = report(1000);
    estimate.json.erase("l1");
    estimate.json.erase("traffic");
    const ReportComparison c = compare({report(1000)}, {estimate});
    ASSERT_EQ(c.figures[1].name, "l1.misses");
    EXPECT_FALSE(c.figures[1].known());
    EXPECT_TRUE(std::isnan(c.figures[1].ratio()));
    EXPECT_FALSE(c.figures[1].beyond_spread());
    ASSERT_EQ(c.memory_bytes.size(), 1u);
    EXPECT_FALSE(c.memory_bytes[0].known());
    EXPECT_TRUE(json::parse(comparison_json(c))["figures"][1]["second"].is_null());
    const std::string text = comparison_text(c, 0, true);
    EXPECT_EQ(text.find("0.0000"), std::string::npos) << text;
    EXPECT_NE(text.find("of one alone"), std::string::npos) << text;

    ReportFile other = report(1000); // traffic of another structure: of the first's there was none
    other.json["traffic"][0]["structure"] = "nodes";
    const ReportComparison d = compare({report(1000)}, {other});
    ASSERT_EQ(d.memory_bytes.size(), 2u);
    EXPECT_TRUE(d.memory_bytes[1].known());
    EXPECT_EQ(d.memory_bytes[1].first.median, 0);
}

TEST(CompareReports, AreOfReports) {
    EXPECT_THROW(read_report("/nowhere/report.json"), ConfigError);
    EXPECT_THROW(read_report(RAZOR_SOURCE_DIR "/README.md"), ConfigError);
    EXPECT_THROW(read_report(RAZOR_SOURCE_DIR), ConfigError);
}

TEST(CompareReports, NamePartsThatNoRunWrites) {
    const std::pair<std::string, std::string> cases[] = {
        {R"("machine":1)", "/machine"},
        {R"("machine":{"l1":{"line_bytes":"many"}})", "/machine/l1/line_bytes"},
        {R"("machine":{},"options":[])", "/options"},
        {R"("machine":{},"stack":3)", "/stack"},
        {R"("machine":{},"scene":3)", "/scene"},
        {R"("machine":{},"mode":[])", "/mode"},
        {R"("machine":{},"traffic":{})", "/traffic"},
        {R"("machine":{},"traffic":[{"structure":"grids"},4])", "/traffic/1"},
        {R"("machine":{},"traffic":[{"structure":4}])", "/traffic/0"},
        {R"("machine":{},"traffic":[{"memory_reads":"4"}])", "/traffic/0"},
        {R"("machine":{},"traffic":[{"memory_writes":null}])", "/traffic/0"},
        {R"("machine":)" + std::string(100000, '[') + std::string(100000, ']'), "nests more than 64 deep"},
    };
    const std::string file = testing::TempDir() + "misfit.json";
    for (const auto& [part, named] : cases) {
        std::ofstream(file) << R"({"program":"razor-sim","cycles":1,)" << part << "}";
        try {
            read_report(file);
            ADD_FAILURE() << part.substr(0, 80);
        } catch (const ConfigError& error) {
            EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
        }
    }
    std::ofstream(file) << R"({"program":"razor-sim","cycles":1,"machine":{}})";
    EXPECT_EQ(read_report(file).json.at("cycles"), 1);
}

TEST(FlatReports, NameThingsByWhatTheyAre) {
    const json value{{"a", {{"b", 1}, {"c", "word"}}}, {"list", json::array({1.5, 2})}};
    EXPECT_EQ(flat_numbers(value).at("a.b"), 1);
    EXPECT_EQ(flat_numbers(value).at("list.1"), 2);
    EXPECT_EQ(flat_words(value).at("a.c"), "word");
    EXPECT_EQ(flat_numbers(report(1).json).at("traffic.grids.memory_reads"), 103)
        << "rows of one name add up";
}

} // namespace
} // namespace sim::test
