// razor check: findings, rays from inside, and what cannot be checked.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>

namespace razor {
namespace {

constexpr std::string_view cube =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
constexpr std::string_view open_box =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv 5 5 5\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n";
// Three faces at the edge 1 2, one of them without area.
constexpr std::string_view fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 2 0 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";

/// Quads of many sizes, so that neighbours are at different levels.
std::string bumpy_torus() {
    std::string text;
    constexpr int rings = 24, sides = 12;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            const double a = 0.2617994 * i + 0.2 * std::sin(3.0 * j), b = 0.5235988 * j;
            const double r = 1 + (0.3 + 0.1 * std::sin(7.0 * i + 5.0 * j)) * std::cos(b);
            text += "v " + std::to_string(r * std::cos(a)) + ' ' + std::to_string(0.4 * std::sin(b)) + ' ' +
                    std::to_string(r * std::sin(a)) + '\n';
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            text += "f";
            for (const auto& [di, dj] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                text += ' ' + std::to_string((i + di) % rings * sides + (j + dj) % sides + 1);
            text += '\n';
        }
    return text;
}

class Check : public ::testing::Test {
protected:
    Check() {
        folder_.file("cube.obj", cube);
        folder_.file("open.obj", open_box);
        folder_.file("fan.obj", fan);
        folder_.file("torus.obj", bumpy_torus());
        folder_.file("coarse.toml", "[settings]\nedge_pixels = 10\n[[mesh]]\nfile = \"torus.obj\"\n");
        folder_.file("both.toml", "[[mesh]]\nfile = \"open.obj\"\n[[mesh]]\nfile = \"cube.obj\"\n");
    }
    Outcome check(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " check " + arguments, folder_.path());
    }
    nlohmann::json json(const std::string& arguments, int code) const {
        const Outcome result = check(arguments + " --json report.json");
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_EQ(result.err, "");
        std::ifstream file(folder_ / "report.json");
        return nlohmann::json::parse(file);
    }
    void expect_refused(const std::string& arguments, const std::string& cause) const {
        const Outcome result = check(arguments + " --json refused.json");
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.json"));
    }
    TemporaryFolder folder_;
};

TEST_F(Check, SaysHowFastHitsConverge) {
    const nlohmann::json report = json("coarse.toml --converge 2000", 0)["convergence"];
    EXPECT_EQ(report["steps"].size(), 5U);
    EXPECT_GT(report["steps"][0]["median_error"], report["steps"][4]["median_error"]);
    EXPECT_NEAR(report["order"].get<double>(), 2, 0.4);
    const Outcome flat = check("cube.obj --no-floor --scheme bilinear --converge 1000");
    EXPECT_EQ(flat.code, 0);
    EXPECT_NE(flat.out.find("no curved surface"), std::string::npos) << flat.out;
    expect_refused("cube.obj --converge 1", "--converge");
}

/// Not only between edge lengths: of so many rays, those to the limit alone take minutes.
TEST_F(Check, InterruptIsHeededWhileRaysConverge) {
    const std::size_t before = folder_.count();
    const auto start = std::chrono::steady_clock::now();
    const Outcome result =
        run("timeout --foreground --preserve-status -s INT -k 40 2 " + quoted_argument(RAZOR_PROGRAM) +
                " check coarse.toml --edge-pixels 1 --converge 1000000 --json report.json",
            folder_.path());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(result.err, "razor: interrupted; nothing written\n");
    EXPECT_LT(seconds, 20);
    EXPECT_EQ(folder_.count(), before);
}

TEST_F(Check, FindsWhatIsWrong) {
    const nlohmann::json good = json("cube.obj --no-floor", 0);
    EXPECT_EQ(good["meshes"].size(), 1U);
    EXPECT_EQ(good["meshes"][0]["closed_bodies"], 1);
    for (const char* key : {"open_edges", "non_manifold_edges", "degenerate_faces", "isolated_points"})
        EXPECT_EQ(good["meshes"][0][key]["count"], 0) << key;
    const nlohmann::json open = json("open.obj --no-floor", 0)["meshes"][0];
    EXPECT_EQ(open["open_edges"]["count"], 4);
    EXPECT_EQ(open["open_edges"]["first"], (std::vector<int>{1, 3}));
    EXPECT_EQ(open["isolated_points"]["first"], 8);
    EXPECT_EQ(open["closed_bodies"], 0);
    const nlohmann::json bad = json("fan.obj --no-floor --scheme bilinear", 0)["meshes"][0];
    EXPECT_EQ(bad["non_manifold_edges"]["count"], 1);
    EXPECT_EQ(bad["degenerate_faces"]["first"], 2);
    EXPECT_NE(check("open.obj").out.find("4 open edges (first between points 1 and 3)"), std::string::npos);
}

TEST_F(Check, ShootsFromInside) {
    for (const char* lod : {"recursive", "fixed"}) {
        const nlohmann::json r =
            json(std::string("cube.obj --size 64x64 --escape 3000 --compare 200 --lod ") + lod, 0)["escape"];
        EXPECT_EQ(r["lod"], lod);
        EXPECT_GE(r["rays"], 3000);
        EXPECT_EQ(r["escapes"], 0);
        EXPECT_GE(r["compared"], 200);
        EXPECT_EQ(r["different"], 0);
    }
    // The same seed, the same rays; what is open is left out.
    const std::string both = "both.toml --size 64x64 --escape 1000 --seed 4";
    const nlohmann::json one = json(both, 0)["escape"], again = json(both, 0)["escape"];
    EXPECT_EQ(one["origins"], again["origins"]);
    EXPECT_EQ(one["patches"], 6);
}

TEST_F(Check, LevelsThatJumpHaveHoles) {
    for (const char* lod : {"discrete", "patch", "paper"}) {
        const nlohmann::json r = json(
            std::string("torus.obj --size 256x256 --escape 60000 --compare 10 --lod ") + lod, 1)["escape"];
        EXPECT_EQ(r["lod"], lod);
        EXPECT_GT(r["escapes"], 0);
        EXPECT_EQ(r["compared"], 0);
        EXPECT_EQ(r["first_escapes"].size(), 3U);
    }
}

TEST_F(Check, RefusesWhatCannotBeShotFrom) {
    expect_refused("open.obj --escape 100", "open edges, the first between its points 1 and 3");
    expect_refused("cube.obj --escape 0", "--escape '0' is not possible");
    expect_refused("cube.obj --compare 5", "add --escape");
    expect_refused("lost.obj", "lost.obj");
    expect_refused("cube.obj --escape 10 --lod none", "--lod 'none' is unknown");
}

} // namespace
} // namespace razor
