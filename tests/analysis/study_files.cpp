// Study files: products, lists, what is left out, full sizes; mistakes with their places; names of points.
#include "analysis/study/error.h"
#include "analysis/study/point.h"
#include "tests/analysis/study_parts.h"

#include <gtest/gtest.h>

#include <set>

namespace analysis {
namespace {

std::vector<std::string> texts(const Study& study) {
    std::vector<std::string> out;
    for (const Settings& point : study.points)
        out.push_back(toml_text(point));
    return out;
}

TEST(StudyFile, MakesAPointForEachCombination) {
    const Study study = test_study(R"(
        kind = "test"
        seeds = 3
        [settings]
        scene = "a.toml"
        samples = 7
        [knobs]
        lod = ["x", "y"]
        edge = [1, 2.5]
    )");
    EXPECT_EQ(study.title, "test");
    EXPECT_EQ(study.seeds, 3);
    EXPECT_EQ(study.knobs, (std::vector<std::string>{"lod", "edge"})); // the file's order, not the alphabet's
    EXPECT_EQ(texts(study),
              (std::vector<std::string>{"edge = 1.0\nlod = \"x\"\nsamples = 7\nscene = \"a.toml\"\n",
                                        "edge = 2.5\nlod = \"x\"\nsamples = 7\nscene = \"a.toml\"\n",
                                        "edge = 1.0\nlod = \"y\"\nsamples = 7\nscene = \"a.toml\"\n",
                                        "edge = 2.5\nlod = \"y\"\nsamples = 7\nscene = \"a.toml\"\n"}));
}

TEST(StudyFile, AddsListsAndLeavesOutWhatConditionsSay) {
    const Study study = test_study(R"(
        kind = "test"
        [knobs]
        samples = [1, 2, 4, 8]
        edge = [1, 2]
        [[points]]
        samples = [4, 16]
        edge = 2.0          # of these, 4 is there already
        lod = "x"
        [[points]]
        samples = 4
        edge = 2
        [[exclude]]
        samples = { least = 4, most = 8 }
        edge = 1
        [[exclude]]
        samples = [1, 16]
    )");
    EXPECT_EQ(texts(study),
              (std::vector<std::string>{"edge = 1.0\nsamples = 2\n", "edge = 2.0\nsamples = 2\n",
                                        "edge = 2.0\nsamples = 4\n", "edge = 2.0\nsamples = 8\n",
                                        "edge = 2.0\nlod = \"x\"\nsamples = 4\n"}));
}

TEST(StudyFile, NamesSettingsInTablesByBoth) {
    const Study study = test_study("kind = \"test\"\n[knobs]\nl2.size = [1, 2]\n[settings.l2]\nsize = 4\n");
    EXPECT_EQ(texts(study), (std::vector<std::string>{"\"l2.size\" = 1.0\n", "\"l2.size\" = 2.0\n"}));
}

constexpr std::string_view two_sizes = R"(
    kind = "test"
    repeats = 1
    [settings]
    scene = "a"
    samples = 1
    [knobs]
    edge = [1]
    [full]
    repeats = 9
    [full.settings]
    samples = 50
    [full.knobs]
    edge = [1, 2, 3]
)";

TEST(StudyFile, LeavesOutPointsOfEitherSize) {
    const std::string text = "kind = \"test\"\n[knobs]\nedge = [1]\n[[exclude]]\nedge = 2\n[full.knobs]\n";
    EXPECT_EQ(test_study(text + "edge = [1, 2]\n").points.size(), 1U);
    EXPECT_THROW(test_study(text + "edge = [1, 3]\n"), StudyError);
}

TEST(StudyFile, HasAFullSize) {
    EXPECT_EQ(texts(test_study(two_sizes)),
              (std::vector<std::string>{"edge = 1.0\nsamples = 1\nscene = \"a\"\n"}));
    const Study full = test_study(two_sizes, true);
    EXPECT_EQ(full.repeats, 9);
    EXPECT_EQ(full.points.size(), 3U);
    EXPECT_EQ(texts(full).front(), "edge = 1.0\nsamples = 50\nscene = \"a\"\n");
}

TEST(StudyFile, ReadsReferencePlotsAndRivals) {
    const Study study = test_study(R"(
        kind = "test"
        [settings]
        samples = 2
        [knobs]
        edge = [1, 2]
        [reference]
        samples = 100
        seeds = 5
        [[plot]]
        x = "seconds"
        y = "error"
        lines = ["edge"]
        [[rival]]
        name = "other"
        command = ["other", "{scene}"]
        figures = { seconds = "/runs/*/seconds" }
        knobs = { level = [1, 2, 3] }
    )");
    EXPECT_EQ(toml_text(study.reference), "samples = 100\n");
    EXPECT_EQ(study.reference_seeds, 5);
    ASSERT_EQ(study.rivals.size(), 1U);
    EXPECT_EQ(study.rivals[0].points.size(), 3U);
    const std::vector<Point> points =
        resolve_points(study, [](const Point& p) { return p.rival + "\n" + toml_text(p.settings); });
    ASSERT_EQ(points.size(), 5U);
    EXPECT_EQ(points[4].body, "other\nlevel = 3\nsamples = 2\n");
    EXPECT_EQ(find_rival(study, "other"), &study.rivals[0]);
    EXPECT_EQ(find_rival(study, "none"), nullptr);
}

TEST(StudyFile, SaysWhereMistakesAreAndTheMend) {
    const std::string begin = "kind = \"test\"\n";
    const std::string good = begin + "[knobs]\nedge = [1]\n";
    const std::pair<std::string, const char*> cases[] = {
        {"", "there is no kind; write kind"},
        {"kind = 3\n", "test.toml:1:8: kind is no text"},
        {"kind = \"image\"\n", "test.toml:1:8: this program measures studies of kind \"test\""},
        {begin + "[knobs\n", "test.toml:2:7: not TOML"},
        {begin, "there are no points"},
        {begin + "nothing = 1\n[knobs]\nedge = [1]\n",
         "test.toml:2:1: unknown key nothing; there are kind, title"},
        {begin + "[knobs]\nedge = []\n", "test.toml:3:8: edge has no values"},
        {begin + "[knobs]\nedges = [1]\n", "test.toml:3:10: unknown setting edges; did you mean"},
        {begin + "[knobs]\nsamples = [1, 0]\n", "test.toml:3:15: samples out of range"},
        {begin + "[knobs]\nsamples = [[1]]\n", "test.toml:3:12: samples is no single value"},
        {begin + "knobs = 1\n", "test.toml:2:9: knobs is no table"},
        {begin + "[knobs]\n", "[knobs] is empty"},
        {good + "[settings]\nsamples = [1]\n", "test.toml:5:11: settings.samples is a list"},
        {good + "points = 1\n", "test.toml:4:10: unknown setting points"},
        {good + "[points]\nedge = 1\n", "points is no list of tables; write [[points]]"},
        {good + "[[exclude]]\nedge = 1\n", "all points are left out"},
        {good + "[[exclude]]\nedge = { most = 1, less = 2 }\n", "test.toml:5:8: edge has other bounds"},
        {good + "[[plot]]\nx = \"secs\"\ny = \"error\"\n",
         "test.toml:5:5: there is no figure secs; there are"},
        {good + "[[plot]]\nx = \"seconds\"\ny = \"error\"\nlines = [\"lod\"]\n", "lines by lod"},
        {good + "[[plot]]\nx = \"seconds\"\n", "there is no plot.y"},
        {good + "[[plot]]\nx = \"seconds\"\ny = \"error\"\nlines = [\"lod\"]\n", "test.toml:7:9: a plot has"},
        {good + "[[exclude]]\nedge = 1\n", "test.toml:4:1: all points are left out"},
        {good + "[[exclude]]\n", "test.toml:4:1: leaves out no point"},
        {good + "[[exclude]]\nedge = 7\n", "test.toml:4:1: leaves out no point"},
        {good + "[[exclude]]\nlod = \"x\"\n", "test.toml:4:1: leaves out no point"},
        {begin + "rank = []\n[knobs]\nedge = [1]\n", "test.toml:2:8: rank names no figures"},
        {begin + "rank = [\"error\", \"error\"]\n[knobs]\nedge = [1]\n",
         "test.toml:2:8: rank names error twice"},
        {good + "[[plot]]\nx = \"seconds\"\ny = \"off\"\n",
         "test.toml:6:5: off is measured beside a reference, and there is none"},
        {good + "[settings]\nmesh = \"none.obj\"\n", "test.toml:5:8: mesh = \"none.obj\": there is no file"},
        {good + "[[rival]]\nname = \"a\"\n", "there is no rival.command"},
        {good + "[[rival]]\nname = \"a\"\ncommand = [1]\n", "rival.command is no list of texts"},
        {good + "[[rival]]\nname = \"a\"\ncommand = [\"b\"]\nfigures = { seconds = \"x\" }\n",
         "JSON pointer"},
        {good + "[reference]\nsamples = 1000\n", "test.toml:5:11: samples out of range"},
        {good + "[reference]\nseeds = 0\n", "test.toml:5:9: reference.seeds is out of range"},
        // Of the other size too, whichever is asked for.
        {good + "[full.knobs]\nedge = [-1]\n", "test.toml:5:9: edge is not above 0"},
        {good + "[full]\nnothing = 1\n", "unknown key nothing"},
    };
    for (const auto& [text, says] : cases) {
        SCOPED_TRACE(text);
        try {
            test_study(text);
            ADD_FAILURE() << "it was taken";
        } catch (const StudyError& error) {
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    std::string many = begin + "[knobs]\n";
    for (const char* key : {"edge", "l2.size"}) {
        many += std::string(key) + " = [1";
        for (int i = 2; i < 400; ++i)
            many += fmt::format(", {}", i);
        many += "]\n";
    }
    EXPECT_THROW(test_study(many), StudyError);
    EXPECT_THROW(read_study("there_is_no_such_file.toml", test_vocabulary()), StudyError);
}

// uuid.uuid5() of Python says so. Names are the same on every machine and in every version: results of others
// are found again.
TEST(StudyPoint, NamesAreStable) {
    EXPECT_EQ(point_name("edge = 1.0\nlod = \"x\"\n"), "16fb92a832f059f2bbefd319d69087d0");
    std::set<std::string> names;
    for (int i = 0; i < 1000; ++i)
        names.insert(point_name(fmt::format("samples = {}\n", i)));
    EXPECT_EQ(names.size(), 1000U);
}

TEST(StudyPoint, EqualValuesAreEqualPoints) {
    // Whole numbers and real ones, orders and tables: the text is one.
    const auto name = [](std::string_view knobs) {
        const Study study = test_study(fmt::format("kind = \"test\"\n{}", knobs));
        return resolve_points(study, [](const Point& p) { return toml_text(p.settings); }).at(0).name;
    };
    EXPECT_EQ(name("[knobs]\nedge = [2]\nlod = [\"x\"]\n"), name("[knobs]\nlod = \"x\"\nedge = [2.0]\n"));
    EXPECT_EQ(name("[knobs]\nedge = [2]\n[settings]\nlod = \"x\"\n"),
              name("[knobs]\nlod = \"x\"\nedge = 2e0\n"));
    EXPECT_NE(name("[knobs]\nedge = [2]\n"), name("[knobs]\nedge = [2.0000000000000004]\n"));
}

TEST(StudyPoint, EqualBodiesAreMeasuredOnceAndImpossibleOnesAreKept) {
    const Study study = test_study("kind = \"test\"\n[knobs]\nedge = [1, 2, 3]\n");
    const std::vector<Point> points = resolve_points(study, [](const Point& p) -> std::string {
        const double edge = std::get<double>(p.settings.at("edge"));
        if (edge == 3)
            throw std::runtime_error("no such edge");
        return "all the same";
    });
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[0].impossible, "");
    EXPECT_EQ(points[1].impossible, "test.toml:3:15: no such edge");
    EXPECT_NE(points[1].name, points[0].name);
}

TEST(StudySettings, TextReadsBackAsItWas) {
    const Settings settings{{"a b", std::string("quote \" slash \\ line\n")},
                            {"c", 0.1},
                            {"d", -0.0},
                            {"e", 1e300},
                            {"f", true},
                            {"g", std::int64_t{-7}}};
    EXPECT_EQ(
        toml_text(settings),
        "\"a b\" = \"quote \\\" slash \\\\ line\\u000A\"\nc = 0.1\nd = 0.0\ne = 1e+300\nf = true\ng = -7\n");
}

// What is wrong with a point is told of the line that says so.
TEST(StudyFile, KnowsWhereSettingsStand) {
    const Study study =
        test_study("kind = \"test\"\n[settings]\nsamples = 3\n[knobs]\nedge = [1, 2]\n[[points]]\n"
                   "edge = 4\nsamples = 5\n");
    const auto of = [&](const char* wrong, std::size_t point) {
        return study.placed(wrong, study.points.at(point));
    };
    EXPECT_EQ(of("edge is odd", 1), "test.toml:5:12: edge is odd");
    EXPECT_EQ(of("edge is odd", 2), "test.toml:7:8: edge is odd");
    EXPECT_EQ(of("5 samples of an edge", 2), "test.toml:8:11: 5 samples of an edge");
    EXPECT_EQ(of("edge 1 of 3 samples", 0), "test.toml:5:9: edge 1 of 3 samples");
    EXPECT_EQ(of("edges and l1.edge, edge_pixels", 0), "edges and l1.edge, edge_pixels") << "other words";
    EXPECT_EQ(of("test.toml:1:1: edge", 0), "test.toml:1:1: edge");
    EXPECT_EQ(study.place_of("edge", Value(9.0)), "test.toml");
}

TEST(StudyPoint, StatesTexts) {
    const std::string body = "# x = \"no\"\ndigest = \"abc\"\nseeds = 1\n[settings]\nx = \"digest\"\n";
    EXPECT_EQ(stated(body, "digest"), "abc");
    for (const char* none : {"x", "seeds", "settings", "abc"})
        EXPECT_EQ(stated(body, none), "") << none;
    EXPECT_EQ(stated("no TOML", "digest"), "");
}

} // namespace
} // namespace analysis
