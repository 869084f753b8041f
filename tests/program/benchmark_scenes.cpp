// The benchmark scenes: frames of a sequence, and each alone by other workers.
#include "tests/program/pictures.h"
#include "tests/program/run.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

class BenchmarkScene : public ::testing::TestWithParam<const char*> {};

TEST_P(BenchmarkScene, EachFrameIsTheOneRenderedAlone) {
    const TemporaryFolder folder;
    const auto render = [&](const std::string& arguments) {
        const Outcome result =
            run(quoted_argument(RAZOR_PROGRAM) + " render " +
                    quoted_argument(std::string(RAZOR_SOURCE_DIR "/configs/scenes/") + GetParam() + ".toml") +
                    " --size 20x20 --spp 1 " + arguments,
                folder.path());
        ASSERT_EQ(result.code, 0) << result.err;
    };
    render("--frames 30:32 --threads 1 -o %d.exr");
    const Film first = read_exr(folder / "30.exr"), last = read_exr(folder / "32.exr");
    EXPECT_NE(first.find("depth.Z")->values, last.find("depth.Z")->values) << "nothing moves";
    for (const char* how : {"--threads 2", "--threads 3 --share worker"}) {
        render(std::string("--frame 32 -o alone.exr ") + how);
        expect_same_picture(folder / "alone.exr", folder / "32.exr");
    }
    // There is something to see, in the light.
    const std::vector<float>& depth = last.find("depth.Z")->values;
    EXPECT_GT(std::count_if(depth.begin(), depth.end(), [](float d) { return std::isfinite(d); }), 250);
    const std::vector<float>& red = last.find("R")->values;
    EXPECT_GT(*std::max_element(red.begin(), red.end()), 0.2F);
}

INSTANTIATE_TEST_SUITE_P(All, BenchmarkScene,
                         ::testing::Values("courtyard", "interior", "forest", "showcase",
                                           "showcase-displaced"),
                         [](const auto& name) {
                             std::string text = name.param;
                             std::erase(text, '-');
                             return text;
                         });

} // namespace
} // namespace razor
