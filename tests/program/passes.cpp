// razor render --progressive and --time: whole pictures at any moment, and what is said of them.
#include "tests/program/pictures.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace razor {
namespace {

class ProgramPasses : public ::testing::Test {
protected:
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " render --lod fixed " + arguments, folder_.path());
    }
    std::string samples_of(const std::string& name) const {
        ImageAttributes attributes;
        read_exr(folder_ / name, &attributes);
        for (const auto& [key, value] : attributes)
            if (key == "razor.samples")
                return value;
        return "";
    }

    TemporaryFolder folder_;
};

TEST_F(ProgramPasses, EndWithThePictureOfOneGo) {
    ASSERT_EQ(razor("--size 64x48 --spp 12 -o go.exr").code, 0);
    const Outcome result =
        razor("--size 64x48 --spp 12 --progressive -o passes.exr -o passes.png --stats s.json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(result.out.starts_with("12 samples a pixel in 3 passes")) << result.out;
    EXPECT_EQ(samples_of("passes.exr"), "12");
    EXPECT_EQ(samples_of("go.exr"), "");
    EXPECT_EQ(folder_.count(), 4U) << "a temporary file was left";
    const Film go = read_exr(folder_ / "go.exr"), passes = read_exr(folder_ / "passes.exr");
    for (const char* name : {"R", "albedo.G"})
        for (std::size_t i = 0; i < go.pixel_count(); ++i)
            ASSERT_NEAR(go.find(name)->values[i], passes.find(name)->values[i], 1e-5);
    std::ifstream file(folder_ / "s.json");
    const nlohmann::json told = nlohmann::json::parse(file).at("statistics").at("passes");
    EXPECT_EQ(told.at("count"), 3);
    EXPECT_EQ(told.at("samples"), 12);
    EXPECT_GT(told.at("error"), 0);
    EXPECT_LT(told.at("relative_error"), 0.1);
}

TEST_F(ProgramPasses, GoOnForATime) {
    const Outcome result =
        razor("--size 8x8 --light-samples 0 --sky-samples 0 --time 700ms -o a.exr --quiet");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_GT(std::stoi(samples_of("a.exr")), 4);
}

TEST_F(ProgramPasses, LeaveAWholePictureWhenInterrupted) {
    Outcome result;
    for (int seconds = 1; seconds < 100 && folder_.count() == 0;
         seconds *= 4) // until there was time for a pass
        result =
            run("timeout --foreground --preserve-status -s INT " + std::to_string(seconds) + " " +
                    quoted_argument(RAZOR_PROGRAM) + " render --size 64x48 --time 1h --progressive -o a.exr",
                folder_.path());
    EXPECT_EQ(result.code, 130);
    EXPECT_EQ(result.err,
              "razor: interrupted; the pictures are of " + samples_of("a.exr") + " samples a pixel\n");
    EXPECT_EQ(folder_.count(), 1U);
}

} // namespace
} // namespace razor
