// razor check: what it finds in cages and scenes that have it, and does not in ones that do not.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace razor {
namespace {

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

class CheckScene : public ::testing::Test {
protected:
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }
    nlohmann::json read(const std::string& name) const {
        std::ifstream file(folder_ / name);
        return nlohmann::json::parse(file);
    }
    nlohmann::json check(const std::string& arguments, int code = 0) const {
        const Outcome result = razor("check " + arguments + " --json report.json");
        EXPECT_EQ(result.code, code) << arguments << result.err << result.out;
        return read("report.json");
    }
    /// How many of that kind the cage has.
    nlohmann::json of_mesh(const std::string& kind, std::string_view cage) {
        folder_.file("cage.obj", cage);
        return check("cage.obj --no-floor --size 32x32 --scheme bilinear").at("meshes").at(0).at(kind);
    }
    /// Findings of that kind, of a square and what else the scene has.
    nlohmann::json of_scene(const std::string& kind, const std::string& more) {
        folder_.file("square.obj", square);
        folder_.file("scene.toml", "[settings]\nsize = [32, 32]\nsamples = 1\n" + more);
        nlohmann::json found = nlohmann::json::array();
        const nlohmann::json report = check("scene.toml");
        for (const nlohmann::json& f : report.at("findings"))
            if (f.at("kind") == kind)
                found.push_back(f);
        return found;
    }

    TemporaryFolder folder_;
    const std::string mesh_ = "[[mesh]]\nname = \"square\"\nfile = \"square.obj\"\nscheme = \"bilinear\"\n";
    const std::string light_ = "[[light]]\nkind = \"point\"\nposition = [0, 3, 3]\nintensity = 5\n";
};

TEST_F(CheckScene, FindsSlivers) {
    const nlohmann::json found =
        of_mesh("slivers", std::string(square) + "v 2 0 0\nv 3 0 0\nv 3 0.00001 0\nf 5 6 7\n");
    EXPECT_EQ(found.at("count"), 1);
    EXPECT_EQ(found.at("first"), 1);
    EXPECT_EQ(of_mesh("slivers", std::string(square) + "v 2 0 0\nv 3 0 0\nv 3 0.01 0\nf 5 6 7\n").at("count"),
              0);
}

TEST_F(CheckScene, FindsRepeatedFaces) {
    const nlohmann::json found = of_mesh("repeated_faces", std::string(square) + "f 3 2 1 4\n");
    EXPECT_EQ(found.at("count"), 1);
    EXPECT_EQ(found.at("first"), 1);
    EXPECT_EQ(of_mesh("repeated_faces", std::string(square) + "v 2 0 0\nf 3 2 5\n").at("count"), 0);
}

TEST_F(CheckScene, FindsOppositeWindingsAndBowTies) {
    const std::string two = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n";
    EXPECT_EQ(of_mesh("opposed_edges", two + "f 3 2 4\n").at("count"), 0);
    EXPECT_EQ(of_mesh("opposed_edges", two + "f 2 3 4\n").at("count"), 1);
    const std::string tie = "v 0 0 0\nv 1 1 0\nv -1 1 0\nv 1 -1 0\nv -1 -1 0\nf 1 2 3\n";
    EXPECT_EQ(of_mesh("pinched_points", tie + "f 1 5 4\n").at("first"), 0);
    EXPECT_EQ(of_mesh("pinched_points", tie + "f 1 3 5\n").at("count"), 0);
}

std::string fan(int faces) {
    std::string text = "v 0 0 1\n";
    for (int i = 0; i < faces; ++i)
        text += "v " + std::to_string(std::cos(6.2831853 * i / faces)) + ' ' +
                std::to_string(std::sin(6.2831853 * i / faces)) + " 0\n";
    for (int i = 0; i < faces; ++i)
        text += "f 1 " + std::to_string(i + 2) + ' ' + std::to_string((i + 1) % faces + 2) + '\n';
    return text;
}

TEST_F(CheckScene, FindsHighValenceAndSharpness) {
    EXPECT_EQ(of_mesh("high_valence_points", fan(64)).at("count"), 0);
    EXPECT_EQ(of_mesh("high_valence_points", fan(65)).at("first"), 0);
    EXPECT_EQ(of_mesh("semi_sharp", std::string(square) + "t crease 2/1/0 0 1 2.5\n").at("count"), 1);
    EXPECT_EQ(of_mesh("semi_sharp", std::string(square) + "t crease 2/1/0 0 1 10\n").at("count"), 0);
}

/// What it says of hits holds for the depths of a picture of a plane far from the scene's centre, and is not
/// far above them.
TEST_F(CheckScene, KnowsHowExactHitsAre) {
    const std::string view = "[camera]\nposition = [1e6, 0, 30]\ntarget = [1e6, 0, 0]\n";
    const std::string far =
        mesh_ + "translate = [1e6, 0, 0]\nedge_length = 0.001\n" + mesh_ + "translate = [-1e6, 0, 0]\n";
    const nlohmann::json found = of_scene("precision", view + far + light_);
    ASSERT_GE(found.size(), 1U);
    EXPECT_NE(found[0].at("object").get<std::string>().find("square"), std::string::npos);
    EXPECT_EQ(of_scene("precision", mesh_ + light_).size(), 0U);
    const nlohmann::json budget = check("scene.toml").at("precision").at(0);
    EXPECT_GT(budget.at("bits"), 8);
    folder_.file("scene.toml", "[settings]\nsize = [32, 32]\nsamples = 1\n" + view + far + light_);
    const nlohmann::json worst = check("scene.toml").at("precision").at(0);
    // Of 10^6 in a 24-bit number: steps of 1/16.
    EXPECT_EQ(worst.at("error"), 1.0 / 32);
    EXPECT_NEAR(worst.at("bits"), std::log2(std::exp2(-10) * 16), 0.6);
}

TEST_F(CheckScene, FindsLevelsThatAreNotThere) {
    folder_.file("cage.obj",
                 "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
                 "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    const std::string mesh = "[[mesh]]\nfile = \"cage.obj\"\nedge_length = ";
    EXPECT_EQ(of_scene("levels", mesh + "1e-5\n" + light_).size(), 1U); // 2 / 2^13 is 2.4e-4
    EXPECT_EQ(of_scene("levels", mesh + "1e-3\n" + light_).size(), 0U);
}

TEST_F(CheckScene, FindsLightsThatAreNone) {
    const auto rectangle = [](const char* v, const char* radiance) {
        return std::string(
                   "[[light]]\nkind = \"rectangle\"\ncorner = [0, 0, 3]\nedge_u = [1, 0, 0]\nedge_v = ") +
               v + "\nradiance = " + radiance + "\n";
    };
    EXPECT_EQ(of_scene("zero_area_light", mesh_ + rectangle("[0, 1, 0]", "1")).size(), 0U);
    EXPECT_EQ(of_scene("light_turned_away", mesh_ + rectangle("[0, 1, 0]", "1")).size(), 1U);
    EXPECT_EQ(of_scene("light_turned_away", mesh_ + rectangle("[0, -1, 0]", "1")).size(), 0U);
    for (const char* const kind : {"disk", "spot"})
        for (const bool away : {false, true})
            EXPECT_EQ(of_scene("light_turned_away", mesh_ + "[[light]]\nkind = \"" + kind +
                                                        "\"\nposition = [0, 0, 3]\ndirection = [0, 0, " +
                                                        (away ? "1]\n" : "-1]\n"))
                          .size(),
                      away ? 1U : 0U);
    EXPECT_EQ(of_scene("dark_light", mesh_ + rectangle("[0, 1, 0]", "0")).size(), 1U);
    EXPECT_EQ(of_scene("dark_light", mesh_ + rectangle("[0, 1, 0]", "1")).size(), 0U);
    EXPECT_EQ(
        of_scene("light_range", mesh_ + rectangle("[0, 1, 0]", "1") + rectangle("[0, 1, 0]", "1e7")).size(),
        1U);
    EXPECT_EQ(
        of_scene("light_range", mesh_ + rectangle("[0, 1, 0]", "1") + rectangle("[0, 1, 0]", "1e5")).size(),
        0U);
    EXPECT_EQ(of_scene("no_light", mesh_ + rectangle("[0, 1, 0]", "0") + "[sky]\nradiance = 0\n").size(), 1U);
    EXPECT_EQ(of_scene("no_light", mesh_ + rectangle("[0, 1, 0]", "1") + "[sky]\nradiance = 0\n").size(), 0U);
}

TEST_F(CheckScene, FindsMaterialsThatDoTooMuchOrNothing) {
    const auto material = [](const char* albedo) {
        return std::string("[[material]]\nname = \"stuff\"\nalbedo = ") + albedo + "\n";
    };
    const std::string of_stuff = mesh_ + "material = \"stuff\"\n" + light_;
    EXPECT_EQ(of_scene("unused_material", of_stuff + material("[0.5, 0.5, 0.5]") +
                                              "[[material]]\nname = \"more\"\nalbedo = [0.1, 0.1, 0.1]\n")
                  .size(),
              1U);
    EXPECT_EQ(of_scene("unused_material", of_stuff + material("[0.5, 0.5, 0.5]")).size(), 0U);
    folder_.file("bounces.toml", "[settings]\nsize = [32, 32]\nsamples = 1\ndiffuse_bounces = 3\n" +
                                     of_stuff + material("[1, 1, 1]"));
    const auto albedo_one = [&](const std::string& options) {
        const nlohmann::json all = check("bounces.toml " + options).at("findings");
        return std::count_if(all.begin(), all.end(),
                             [](const auto& f) { return f.at("kind") == "albedo_one"; });
    };
    EXPECT_EQ(albedo_one(""), 1);
    EXPECT_EQ(albedo_one("--diffuse-bounces 0"), 0);
}

TEST_F(CheckScene, NamesFacesWithAPictureAndNoTextureCoordinates) {
    ASSERT_EQ(razor("render --size 4x4 --spp 1 --quiet -o p.png").code, 0);
    folder_.file("m.mtl", "newmtl plain\nKd 1 0 0\nnewmtl painted\nKd 1 1 1\nmap_Kd p.png\n");
    const auto outcome = [&](const std::string& last_face) {
        folder_.file("m.obj",
                     "mtllib m.mtl\nusemtl plain\n" + std::string(square) + "v 2 0 0\nv 2 1 0\n" + last_face);
        return razor("check m.obj --no-floor --size 32x32 --scheme bilinear");
    };
    const Outcome painted = outcome("usemtl painted\nf 2 5 6 3\n");
    EXPECT_EQ(painted.code, 2);
    EXPECT_NE(painted.err.find("'painted' (1 of 2 faces, from face 1 on) has a texture"), std::string::npos)
        << painted.err;
    EXPECT_EQ(outcome("f 2 5 6 3\n").code, 0);
}

/// Against what a frame did build.
TEST_F(CheckScene, KnowsWhatAFrameTakes) {
    for (const char* size : {"256x256", "512x384"}) {
        const std::string scene = std::string("--size ") + size;
        const nlohmann::json told = check(scene).at("memory");
        ASSERT_EQ(razor("render --spp 1 --threads 1 --quiet --stats s.json " + scene).code, 0);
        const nlohmann::json built = read("s.json").at("statistics").at("built");
        const double bytes = built.at("grid_bytes").get<double>() + built.at("node_bytes").get<double>() +
                             built.at("list_bytes").get<double>();
        const double least = told.at("built_bytes_least"), most = told.at("built_bytes_most");
        EXPECT_GT(bytes, 0.8 * least) << size;
        EXPECT_LT(bytes, 1.1 * most) << size;
        EXPECT_LT(most, 2 * least) << "nothing is said";
        EXPECT_GT(told.at("total_bytes"), most);
    }
}

TEST_F(CheckScene, SaysWhatIsInUseAndEndsAsScriptsNeed) {
    const nlohmann::json features = check("--size 32x32").at("features");
    EXPECT_EQ(features.at("rectangle lights"), true);
    EXPECT_EQ(features.at("lens"), false);
    const Outcome explained = razor("render --size 32x32 --spp 1 --explain");
    const Outcome text = razor("check --size 32x32");
    for (const char* line : {"in use: ", "left out: "}) {
        const auto begin = explained.out.find(line);
        ASSERT_NE(begin, std::string::npos);
        EXPECT_NE(text.out.find(explained.out.substr(begin, explained.out.find('\n', begin) - begin)),
                  std::string::npos)
            << "not what --explain says";
    }
    folder_.file("bad.obj", std::string(square) + "f 1 2 3 4\n");
    folder_.file("good.obj", square);
    EXPECT_EQ(razor("check bad.obj --size 32x32 --scheme bilinear --no-floor").code, 0);
    EXPECT_EQ(razor("check bad.obj --size 32x32 --scheme bilinear --no-floor --strict").code, 1);
    EXPECT_EQ(razor("check good.obj --size 32x32 --scheme bilinear --no-floor --strict").code, 0);
    // The floor under pictures of models is no part of them.
    const Outcome bare = razor("check good.obj --size 32x32 --scheme bilinear --strict");
    EXPECT_EQ(bare.code, 0);
    EXPECT_EQ(bare.out.find("floor"), std::string::npos) << bare.out;
}

} // namespace
} // namespace razor
