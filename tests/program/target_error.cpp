// razor render --target-error: what the command chooses, says, writes and refuses.
#include "tests/program/pictures.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace razor {
namespace {

class ProgramTargetError : public ::testing::Test {
protected:
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }
    nlohmann::json json(const std::string& name) const {
        std::ifstream file(folder_ / name);
        return nlohmann::json::parse(file);
    }

    TemporaryFolder folder_;
    const std::string few_ = "--size 48x32 --light-samples 1 --sky-samples 1 ";
};

TEST_F(ProgramTargetError, TellsWhatItTookAndChose) {
    const Outcome result = razor(
        "render " + few_ + "--target-error 0.05 -o a.exr -o a.png --false-colour samples --stats s.json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("levels of detail: edges of "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("within the 0.05 asked for"), std::string::npos) << result.out;
    const nlohmann::json told = json("s.json"), passes = told.at("statistics").at("passes");
    EXPECT_EQ(passes.at("target_error"), 0.05);
    EXPECT_LE(passes.at("reached_error"), 0.05);
    EXPECT_GT(passes.at("reached_error"), 0.02);
    EXPECT_GT(passes.at("reached_error_uncertainty"), 0);
    const std::vector<float> samples = read_exr(folder_ / "a.exr").find("samples")->values;
    EXPECT_GE(*std::min_element(samples.begin(), samples.end()), 16);
    EXPECT_EQ(passes.at("samples"), *std::max_element(samples.begin(), samples.end()));
    const nlohmann::json levels = told.at("levels");
    EXPECT_GT(levels.at("pixels"), 0);
    EXPECT_GT(levels.at("seconds"), 0);
    // The picture can be made again from what it says of itself, and says what was chosen.
    folder_.file("again.toml", told.at("scene").get<std::string>());
    const double edge = levels.at("edge_pixels");
    ASSERT_EQ(razor("render again.toml --target-error 0.05 --edge-pixels " + std::to_string(edge) +
                    " -o b.exr --stats b.json")
                  .code,
              0);
    expect_same_picture(folder_ / "a.exr", folder_ / "b.exr");
    EXPECT_EQ(json("b.json").at("levels").at("reason"), "stated");
}

TEST_F(ProgramTargetError, GoesWithTimeSequencesAndProgress) {
    const Outcome timed = razor("render " + few_ + "--target-error 0.0001 --time 1s --progressive -o a.exr");
    ASSERT_EQ(timed.code, 0) << timed.err;
    EXPECT_EQ(timed.out.find("within the"), std::string::npos) << timed.out;
    const Outcome frames =
        razor("render " + few_ + "--target-error 0.2 --frames 0:1 -o f%d.exr --stats f%d.json");
    ASSERT_EQ(frames.code, 0) << frames.err;
    EXPECT_LE(json("f1.json").at("statistics").at("passes").at("reached_error"), 0.2);
    EXPECT_EQ(json("f0.json").at("levels"), json("f1.json").at("levels")) << "chosen once: edges do not pop";
}

TEST_F(ProgramTargetError, MistakesAreOneLineAndNoFile) {
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"--target-error 0", "--target-error"},
             {"--target-error -0.1", "--target-error"},
             {"--target-error nan", "--target-error"},
             {"--target-error small", "--target-error"},
             {"--target-error 0.1 --noise-threshold 0.1 --spp 64", "leave out one"},
             {"--target-error 0.1 --layers pick", "layers are of whole frames"},
             {"--target-error 0.1 --repeat 2", "one frame"},
             {"--target-error 0.1 --trace t.rzt", "leave out"}}) {
        const Outcome result = razor("render --size 16x16 -o a.exr " + arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
    }
    EXPECT_EQ(folder_.count(), 0U);
}

} // namespace
} // namespace razor
