// What must hold of points' numbers: expressions against C++'s own, mistakes with their places, and points
// left out.
#include "analysis/study/constraint.h"
#include "analysis/study/error.h"
#include "tests/analysis/study_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace analysis {
namespace {

const std::map<std::string, double, std::less<>> numbers = {
    {"a", 6}, {"b.c", 4}, {"core.lanes_2", 0.5}, {"zero", 0}};

bool holds(std::string_view text) {
    return Constraint(text).holds([](std::string_view key) {
        const auto found = numbers.find(key);
        if (found == numbers.end())
            throw StudyError("no " + std::string(key));
        return found->second;
    });
}

TEST(StudyConstraint, IsWhatTheExpressionSays) {
    const double a = 6, c = 4, lanes = 0.5;
#define SAME(text, expression) EXPECT_EQ(holds(text), expression) << text
    SAME("a * b.c <= 24", a * c <= 24);
    SAME("a * b.c < 24", a * c < 24);
    SAME("a - b.c - 1 == 1", a - c - 1 == 1); // from the left
    SAME("a / b.c / 2 == 0.75", a / c / 2 == 0.75);
    SAME("2 + a * b.c == 26", 2 + a * c == 26);
    SAME("(2 + a) * b.c == 26", (2 + a) * c == 26);
    SAME("-a + 10 == b.c", -a + 10 == c);
    SAME("2 * -a == -12", 2 * -a == -12);
    SAME("a % b.c == 2", std::fmod(a, c) == 2);
    SAME("core.lanes_2 != 0.5", lanes != 0.5);
    SAME("a > 1 or a > 7 and a > 8", (a > 1 || (a > 7 && a > 8)));
    SAME("(a > 1 or a > 7) and a > 8", ((a > 1 || a > 7) && a > 8));
    SAME("not a > 8 and b.c >= 4", (!(a > 8) && c >= 4));
    SAME("not (a > 1 and b.c > 1)", !(a > 1 && c > 1));
    SAME("64 KiB == 65536", true);
    SAME("1MiB*2 == 2 MiB", true);
    SAME("1e3 == 1000", true);
#undef SAME
    // Parts are shared and evaluated once: else these would take 2^90 steps, or as many bytes.
    EXPECT_TRUE(holds(std::string(90, '-') + "a == 6"));
    std::string nested = "a";
    for (int depth = 0; depth < 45; ++depth)
        nested = "(" + nested + " + -1 * -1)";
    EXPECT_TRUE(holds(nested + " == 51"));
    std::string chain = "a == 0";
    while (chain.size() + 10 <= 4096)
        chain += " or a == 0";
    EXPECT_FALSE(holds(chain));
    EXPECT_EQ(Constraint("a < b.c and a < 2").keys(), (std::vector<std::string>{"a", "b.c"}));
}

TEST(StudyConstraint, SaysWhatIsWrongAndWhere) {
    const auto mistake = [](std::string_view text) -> std::string {
        try {
            holds(text);
        } catch (const StudyError& error) {
            return error.what();
        }
        return "";
    };
    const std::pair<std::string, std::string> cases[] = {
        {"a * 2", "character 1: this is a number; compare it"},
        {"a * <= 2", "character 5: a number or a setting is missing"},
        {"1 < a < 8", "character 7: a second comparison; write `a <= b and b <= c`"},
        {"a = 6", "character 3: `=` alone"},
        {"(a > 1", "character 7: a parenthesis is open"},
        {"a > 1 b.c > 2", "character 7: something more stands here"},
        {"a > 1 and 2", "joins conditions, and a side is a number"},
        {"(a > 1) + 2 > 1", "takes numbers, and a side is a condition"},
        {"not a", "joins conditions"},
        {"a > 1 and not", "a number or a setting is missing"},
        {"a / zero > 1", "divides by zero"},
        {"a % 0 == 1", "divides by zero"},
        {"a > other", "no other"},
        {"", "character 1: a number or a setting is missing"},
        {"a > 1e999", "a number or a setting is missing"},
        {std::string(3000, '(') + "a > 1", "nest too deeply"},
        {std::string(3000, '-') + "a > 1", "nest too deeply"},
        {"a > " + std::string(5000, ' '), "has 5004 characters, and 4096 are read"},
    };
    for (const auto& [text, wanted] : cases)
        EXPECT_NE(mistake(text).find(wanted), std::string::npos)
            << text.substr(0, 40) << ": " << mistake(text);
}

TEST(StudyFile, LeavesOutPointsThatBreakAConstraint) {
    const Study study = test_study(R"(
        kind = "test"
        where = ["samples * edge <= 8", "samples >= 2"]
        [settings]
        edge = 2
        [knobs]
        samples = [1, 2, 4, 8]
        [[points]]
        samples = [3, 4]
        edge = [1, 3]
    )");
    std::vector<std::string> left;
    for (const Settings& point : study.points)
        left.push_back(toml_text(point));
    EXPECT_EQ(left, (std::vector<std::string>{"edge = 2.0\nsamples = 2\n", "edge = 2.0\nsamples = 4\n",
                                              "edge = 1.0\nsamples = 3\n", "edge = 1.0\nsamples = 4\n"}));
}

TEST(StudyFile, ConstraintsHaveMistakesWithTheirPlaces) {
    const auto mistake = [](const std::string& where) -> std::string {
        try {
            test_study("kind = \"test\"\nwhere = " + where + "\n[knobs]\nsamples = [1, 2]\nlod = [\"x\"]\n");
        } catch (const StudyError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(mistake("[\"samples <= 2\"]"), "");
    for (const auto& [where, wanted] : {std::pair{"[\"samples\"]", "test.toml:2:9: \"samples\", character 1"},
                                        {"[\"lod > 1\"]", "lod = \"x\" is no number"},
                                        {"[\"edge > 1\"]", "the study does not say edge"},
                                        {"[\"samples > 2\"]", "all points are left out; mend where"}})
        EXPECT_NE(mistake(where).find(wanted), std::string::npos) << mistake(where);
}

} // namespace
} // namespace analysis
