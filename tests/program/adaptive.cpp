// razor render --noise-threshold: what the command says, writes and refuses.
#include "tests/program/pictures.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <set>

namespace razor {
namespace {

class ProgramAdaptive : public ::testing::Test {
protected:
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " " + arguments, folder_.path());
    }

    TemporaryFolder folder_;
};

TEST_F(ProgramAdaptive, TellsAndShowsWhereSamplesWent) {
    const Outcome result = razor("render --size 64x48 --spp 256 --noise-threshold 0.05 --light-samples 1 "
                                 "--sky-samples 1 -o a.exr -o a.png --false-colour samples --stats s.json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("% of pixels within noise 0.05; estimated error of luminance"),
              std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("samples: 16 (dark) to "), std::string::npos) << result.out;
    ImageAttributes attributes;
    const Film film = read_exr(folder_ / "a.exr", &attributes);
    double sum = 0;
    std::set<float> different;
    for (const float samples : film.find("samples")->values) {
        sum += double{samples};
        different.insert(samples);
    }
    EXPECT_GT(different.size(), 2U);
    EXPECT_EQ(*different.begin(), 16);
    std::ifstream file(folder_ / "s.json");
    const nlohmann::json told = nlohmann::json::parse(file).at("statistics").at("passes");
    EXPECT_NEAR(told.at("mean_samples"), sum / static_cast<double>(film.pixel_count()), 1e-9);
    EXPECT_EQ(told.at("samples"), *different.rbegin());
    EXPECT_EQ(told.at("noise_threshold"), 0.05);
    EXPECT_GT(told.at("within_threshold"), 0.95);
    const auto samples = std::find_if(attributes.begin(), attributes.end(),
                                      [](const auto& a) { return a.first == "razor.samples"; });
    ASSERT_NE(samples, attributes.end());
    EXPECT_NEAR(std::stod(samples->second), told.at("mean_samples"), 1e-3);
}

TEST_F(ProgramAdaptive, IsOfSceneFilesToo) {
    ASSERT_EQ(razor("render --size 32x24 --spp 64 --noise-threshold 0.1 -o a.exr --quiet").code, 0);
    const Outcome config = razor("render --size 32x24 --spp 64 --noise-threshold 0.1 --print-config");
    EXPECT_NE(config.out.find("\nnoise_threshold = 0.1\n"), std::string::npos);
    folder_.file("scene.toml", config.out);
    ASSERT_EQ(razor("render scene.toml -o b.exr --quiet").code, 0);
    expect_same_picture(folder_ / "a.exr", folder_ / "b.exr");
    ASSERT_EQ(razor("render scene.toml --noise-threshold 0 -o c.exr --quiet").code, 0);
    EXPECT_EQ(read_exr(folder_ / "c.exr").find("samples"), nullptr);
    ASSERT_EQ(razor("render --size 32x24 --spp 64 -o d.exr --quiet").code, 0);
    expect_same_picture(folder_ / "c.exr", folder_ / "d.exr");
}

TEST_F(ProgramAdaptive, MistakesAreOneLineAndNoFile) {
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"--noise-threshold 0.1", "16 to begin with; give more (--spp)"},
             {"--noise-threshold -1 --spp 64", "--noise-threshold"},
             {"--noise-threshold little --spp 64", "--noise-threshold"},
             {"--noise-threshold 0.1 --spp 64 --layers pick", "layers are of whole frames"},
             {"--noise-threshold 0.1 --spp 64 --repeat 2", "one frame"},
             {"--false-colour samples -o a.png", "add --noise-threshold"}}) {
        const Outcome result = razor("render --size 16x16 -o a.exr " + arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
    }
    EXPECT_EQ(folder_.count(), 0U);
}

} // namespace
} // namespace razor
