// Levels of detail compared: what the programs make of times and errors, with a renderer whose times and
// pictures are formulas.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace razor {
namespace {

// Fixed level K: error 0.01 x 2^K, camera rays 8 / 2^K s, shadow rays 16 / 3^K s. `recursive` is at the
// geometric mean of levels 1 and 2, `discrete` is finer than all. A first frame takes twice as long; later
// ones lie about their median.
constexpr const char* renderer = R"(#!/usr/bin/python3
import json, sys
words = sys.argv[1:]
def option(name, default=None):
    return words[words.index(name) + 1] if name in words else default
if words[0] == "compare":
    a, b = (float(open(name).read()) for name in words[1:3])
    if option("-o"):
        open(option("-o"), "w").write(str(a - b))
    json.dump({"rmse": abs(a - b)}, open(option("--json"), "w"))
    sys.exit()
if "--print-config" in words:
    print("edge_pixels = 2.0\nposition = [0, 0, 0]\ntarget = [0, 0, 1]")
    sys.exit()
lod, edge = option("--lod"), float(option("--edge-pixels", 2.0))
name, _, k = lod.partition(":")
level = 1.5 if lod == "recursive" else -1 if lod == "discrete" else float(k or 0)
seed_noise = 0.5 * int(option("--seed", 0))
reference = lod == "camera"
assert not reference or edge == 0.5
open(option("-o"), "w").write(str(seed_noise + (0 if reference else 0.01 * 2**level)))
host = [4, 2, 1] # a host that gets faster, turn by turn, where `recursive`, the first of each, gets slower
try:
    turn = int(open("turn").read()) + (lod == "recursive" and "--light-samples" in words and "--repeat" in words)
    open("turn", "w").write(str(turn))
    host = host[turn % 3] * ([1, 1.1, 3][turn % 3] if lod == "recursive" else 1)
except FileNotFoundError:
    host = 1
seconds = 8 / 2**level + (0 if "--light-samples" in words else 16 / 3**level)
frames = [2 * seconds * host] + [seconds * host * part for part in (1.1, 1, 0.9)][:int(option("--repeat", 1)) - 1]
json.dump({"statistics": {"host": {"frames": [{"render_processor_seconds": s} for s in frames]},
                          "visible": {"squares": 400.0},
                          "counters": {"triangles_made": 900, "blended_tests": 1, "block_tests": 4},
                          "built": {"grid_bytes": 5e6}}}, open(option("--stats"), "w"))
)";

class Levels : public ::testing::Test {
protected:
    Levels() {
        std::filesystem::permissions(folder_.file("razor.py", renderer), std::filesystem::perms::owner_all);
    }
    Outcome script(const std::string& name, const std::string& arguments) const {
        return run("python3 " + quoted_argument(RAZOR_SOURCE_DIR "/analysis/levels/" + name) +
                       " --razor ./razor.py --reference 4 --spp 3 " + arguments,
                   folder_.path());
    }
    nlohmann::json read(const std::string& name) const {
        std::ifstream file(folder_ / name);
        return nlohmann::json::parse(file);
    }
    TemporaryFolder folder_;
};

TEST_F(Levels, TimesAtEqualError) {
    const Outcome result =
        script("levels.py", "any.toml --json l.json --schemes recursive discrete fixed fixed:1 fixed:2");
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json rows = read("l.json");
    const auto& recursive = rows.at(0);
    EXPECT_NEAR(recursive.at("rmse").get<double>(), 0.01 * std::pow(2, 1.5), 1e-9);
    EXPECT_NEAR(recursive.at("camera_seconds").get<double>(), 8 / std::pow(2, 1.5), 1e-9);
    EXPECT_NEAR(recursive.at("first_shadow_seconds").get<double>(), 32 / std::pow(3, 1.5), 1e-9);
    // On the line through the logarithms of levels 1 and 2 it takes as long as a fixed level of its error.
    for (const char* rays : {"camera", "shadow", "first_camera", "first_shadow"})
        EXPECT_NEAR(recursive.at(std::string(rays) + "_over_fixed").at(1).get<double>(), 1, 1e-9) << rays;
    EXPECT_NEAR(recursive.at("made_over_needed").get<double>(), 900 / (2 * 400.0 / 4), 1e-9);
    EXPECT_NEAR(recursive.at("blended").get<double>(), 0.25, 1e-9);
    // Finer than every fixed level, in twice the time of the finest: at most that.
    const auto& discrete = rows.at(1);
    EXPECT_FALSE(discrete.contains("camera_over_fixed"));
    EXPECT_NEAR(discrete.at("camera_over_fixed_at_most").at(1).get<double>(), 2, 1e-9);
    EXPECT_NEAR(discrete.at("shadow_over_fixed_at_most").at(1).get<double>(), 3, 1e-9);
    EXPECT_NEAR(recursive.at("camera_over_discrete").at(1).get<double>(), std::pow(2, -2.5), 1e-9);
    EXPECT_NEAR(recursive.at("shadow_over_discrete").at(1).get<double>(), std::pow(3, -2.5), 1e-9);
    EXPECT_NE(result.out.find("<2.00"), std::string::npos) << result.out;
    for (const char* none : {"--repeat 0", "--frames 0"}) {
        const Outcome refused = script("levels.py", std::string("any.toml --schemes fixed ") + none);
        EXPECT_EQ(refused.code, 2) << none;
        EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    }
    // Between levels of which only one is there: beside none.
    const Outcome alone = script("levels.py", "any.toml --json d.json --schemes recursive fixed --repeat 1");
    ASSERT_EQ(alone.code, 0) << alone.err;
    EXPECT_FALSE(read("d.json").at(0).contains("camera_over_fixed"));
    EXPECT_FALSE(read("d.json").at(0).contains("camera_over_fixed_at_most"));
}

TEST_F(Levels, RatiosAreOfTimesOfOneTurn) {
    folder_.file("turn", "-1");
    const Outcome result =
        script("levels.py", "any.toml --repeat 3 --json t.json --schemes recursive fixed fixed:1 fixed:2");
    ASSERT_EQ(result.code, 0) << result.err;
    for (const char* rays : {"camera", "shadow"}) {
        const nlohmann::json ratios = read("t.json").at(0).at(std::string(rays) + "_over_fixed");
        for (const auto& [i, ratio] : {std::pair(0, 1.0), std::pair(1, 1.1), std::pair(2, 3.0)})
            EXPECT_NEAR(ratios.at(static_cast<std::size_t>(i)).get<double>(), ratio, 1e-9) << rays;
    }
    EXPECT_NE(result.out.find("1.10 (1.00-3.00)"), std::string::npos) << result.out;
}

TEST_F(Levels, ViewsAreOneTable) {
    std::filesystem::create_directories(folder_ / "models/spot");
    folder_.file("models/spot/spot_quadrangulated.obj", "");
    const Outcome result = script("views.py", "models --only cow crowd --repeat 1 --json v.json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "skipped: crowd (makehuman/male1591.obj) is not there\n");
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 7) << result.out;
    EXPECT_NE(result.out.find("| cow | `recursive` | 0.02828 | 0.02828 | 2.828 | 3.079 | 1.00 | 1.00 |"),
              std::string::npos)
        << result.out;
    EXPECT_EQ(read("v.json").at("views").at("cow").size(), 5U);
    for (const char* wrong : {"nowhere", "models --only cows"}) {
        const Outcome refused = script("views.py", wrong);
        EXPECT_EQ(refused.code, 2) << wrong;
        EXPECT_EQ(refused.error_lines(), 1) << refused.err;
        EXPECT_EQ(refused.out, "") << wrong;
    }
}

TEST_F(Levels, AViewIsASceneOfItsOwn) {
    std::filesystem::create_directories(folder_.path() / "models/spot");
    folder_.file("models/spot/spot_quadrangulated.obj", "");
    const Outcome result = script("views.py", "models --only cow --write-scene cow.toml");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    std::ifstream scene(folder_ / "cow.toml");
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(scene), {}}),
              "edge_pixels = 2.0\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\n");
    ASSERT_EQ(script("levels.py", "any.toml --from 1,2,3 --write-scene seen.toml").code, 0);
    std::ifstream seen(folder_ / "seen.toml");
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(seen), {}}),
              "edge_pixels = 2.0\nposition = [1.0, 2.0, 3.0]\ntarget = [0, 0, 1]\n");
    for (const char* wrong : {"models --write-scene a.toml", "models --only crowd --write-scene a.toml",
                              "models --only cow --write-scene nowhere/a.toml"}) {
        const Outcome refused = script("views.py", wrong);
        EXPECT_EQ(refused.code, 2) << wrong;
        EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.toml"));
}

} // namespace
} // namespace razor
