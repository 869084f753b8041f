// razor-sim run --estimate closed-form: beside whole runs, from one seed, and what it refuses.
#include "tests/program/simulator.h"

#include <algorithm>
#include <filesystem>

namespace razor {
namespace {

const std::string frame = "run --quiet --no-native --scene s.toml --size 64x64 --spp 1 --sky-samples 1 "
                          "--light-samples 1 --edge-pixels 4 --machine " +
                          tiny + " ";
const std::string computed = frame + "--estimate closed-form --seed-report seed.json ";

double cycles(const nlohmann::json& report) {
    return report.at("cycles").get<double>();
}

TEST_F(Simulator, ComputesRunsFromOneTile) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    // Of tiles and threads that the seed never ran; with one tree a tile more is built than by the seed's
    // one.
    std::string seed;
    double first = 0; // instructions
    for (const char* machine : {"-g chip.tiles=1", "-g chip.tiles=4", "-g chip.tiles=2 -g chip.threads=1"}) {
        SCOPED_TRACE(machine);
        const std::string options = std::string(machine) + " -g kdtree.share=tile ";
        ASSERT_EQ(simulator(frame + options + "--json whole.json").code, 0);
        const Outcome result = simulator(computed + options + "--json a.json");
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find("closed form"), std::string::npos) << result.out;
        const nlohmann::json whole = report("whole.json"), a = report("a.json");
        EXPECT_NEAR(cycles(a) / cycles(whole), 1, 0.2);
        // Tiles taken from another tree's stretch are built again, which nobody counts.
        EXPECT_NEAR(a.at("core").at("instructions").get<double>() /
                        whole.at("core").at("instructions").get<double>(),
                    0.92, 0.13);
        EXPECT_NEAR(a.at("memory").at("reads").get<double>() / whole.at("memory").at("reads").get<double>(),
                    1, 0.22);
        EXPECT_EQ(a.at("renderer").at("counters").at("rays"), whole.at("renderer").at("counters").at("rays"));
        const nlohmann::json& value = a.at("estimate").at("figures").at("cycles");
        EXPECT_LT(value.at("low"), value.at("value"));
        for (const nlohmann::json& station : a.at("estimate").at("stations"))
            EXPECT_LE(station.at("utilisation"), 1.001) << station;
        // The seed is made once, and a computed run says the same again.
        if (seed.empty())
            seed = text("seed.json");
        EXPECT_EQ(text("seed.json"), seed);
        ASSERT_EQ(simulator(computed + options + "--json b.json").code, 0);
        EXPECT_EQ(report("b.json"), a);
        if (first == 0)
            first = a.at("core").at("instructions").get<double>();
        else
            EXPECT_GT(a.at("core").at("instructions").get<double>(), 1.02 * first);
    }
}

// Of sixteen screen tiles one sees something: whoever has it builds all of it.
TEST_F(Simulator, ComputesWhoBuildsByWhatScreenTilesNeed) {
    folder_.file("s.toml", "[camera]\nposition = [0, 0, 10]\ntarget = [0, 0, 0]\nfov = 40\n"
                           "[[mesh]]\nname = \"m\"\nshape = \"urchin\"\n"
                           "[[object]]\nmesh = \"m\"\ntranslate = [0.91, -0.91, 0]\nscale = 0.3\n");
    const std::string run = "run --quiet --no-native --scene s.toml --size 32x32 --spp 1 --sky-samples 1 "
                            "--light-samples 1 --edge-pixels 0.25 -g chip.tiles=1 --machine " +
                            tiny;
    ASSERT_EQ(simulator(run + " --json whole.json").code, 0);
    ASSERT_EQ(simulator(run + " --estimate closed-form --seed-report seed.json --json a.json").code, 0);
    const auto needs =
        nlohmann::json::parse(text("seed.json"))["needs"]["surfaces"].get<std::vector<double>>();
    ASSERT_EQ(needs.size(), 16U);
    EXPECT_EQ(std::count(needs.begin(), needs.end(), 0), 15);
    EXPECT_NEAR(cycles(report("a.json")) / cycles(report("whole.json")), 1, 0.1);
}

TEST_F(Simulator, ExplainsWhatItComputes) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"box\"\n");
    ASSERT_EQ(simulator("run --quiet --scene s.toml --size 8x8 --spp 1 --machine " + tiny +
                        " --estimate closed-form --json a.json")
                  .code,
              0);
    EXPECT_TRUE(
        expect_explained(nlohmann::json::parse(text("a.json"))).contains("estimate.stations[].utilisation"));
}

TEST_F(Simulator, RefusesWhatASeedCannotKnow) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = "run --quiet --scene s.toml --size 8x8 --machine " + tiny + " ";
    const std::string spp = "--spp 1 ", how = "--estimate closed-form ", seed = "--seed-report seed.json ";
    ASSERT_EQ(simulator(start + spp + how + seed).code, 0);
    folder_.file("bad.json", "{\"kind\": 3}");
    nlohmann::json minus = nlohmann::json::parse(text("seed.json"));
    minus["seed"]["phases"][1]["alone_cycles"] = -2;
    folder_.file("minus.json", minus.dump());
    nlohmann::json none = nlohmann::json::parse(text("seed.json"));
    for (nlohmann::json& phase : none["seed"]["phases"])
        phase["instructions"] = 0;
    folder_.file("none.json", none.dump());
    nlohmann::json needs = nlohmann::json::parse(text("seed.json"));
    ASSERT_EQ(needs.at("needs").at("nodes").size(), 1U); // screen tiles
    EXPECT_GT(needs["needs"]["surfaces"][0], 0);
    needs["needs"]["surfaces"][0] = -1;
    folder_.file("needless.json", needs.dump());
    for (const char* name : {"nodes", "surfaces"})
        needs["needs"][name] = {1, 2};
    folder_.file("needs.json", needs.dump());
    const std::pair<std::string, const char*> wrong[] = {
        {spp + how + seed + "-g l1.size_bytes=16384", "l1.size_bytes is another"},
        {spp + how + seed + "-g core.lanes=16", "core.lanes is another"},
        {spp + how + seed + "--share worker", "kdtree.share is another"},
        {"--spp 2 " + how + seed, "of another scene"},
        {spp + how + seed + "-o a.exr", "leave out -o"},
        {spp + how + seed + "--frames 2", "leave out --frames"},
        {spp + how + seed + "--estimate-seed 2", "leave out --estimate-seed"},
        {spp + how + "--seed-report bad.json", "bad.json is no seed"},
        {spp + how + "--seed-report s.toml", "made of"},
        {spp + how + "--seed-report minus.json", "minus.json: alone_cycles is below 0"},
        {spp + how + "--seed-report none.json", "none.json counts no instructions"},
        {spp + how + "--seed-report needless.json", "needless.json: needs is below 0"},
        {spp + how + "--seed-report needs.json",
         "needs.json: needs are of 2 screen tiles, but the picture has 1"},
        {spp + "--estimate closed", "or closed-form"},
    };
    for (const auto& [options, message] : wrong) {
        const Outcome result = simulator(start + options + " --json a.json");
        EXPECT_EQ(result.code, 2) << options;
        EXPECT_NE(result.err.find(message), std::string::npos) << options << ": " << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a.json"));
    }
    const Outcome alone =
        simulator("run --quiet --scene s.toml --size 8x8 --machine " + tiny + " --seed-report seed.json");
    EXPECT_EQ(alone.code, 2);
    EXPECT_NE(alone.err.find("of no use without --estimate closed-form"), std::string::npos) << alone.err;
}

} // namespace
} // namespace razor
