// razor-sim: who shares a kd-tree, and what machines and options it refuses: exit code 2, one line, no file.
#include "razor/image/exr.h"
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

namespace razor {
namespace {

constexpr const char* tiny = RAZOR_SOURCE_DIR "/configs/machines/tiny.toml";

class Simulator : public ::testing::Test {
protected:
    Outcome simulator(const std::string& arguments) const {
        return run(std::string(RAZOR_SIMULATOR) + " " + arguments, folder_.path());
    }
    std::string text(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    nlohmann::json report(const std::string& name) const {
        nlohmann::json all = nlohmann::json::parse(text(name));
        all.erase("host");
        return all;
    }

    TemporaryFolder folder_;
};

TEST_F(Simulator, SharesTreesAsAsked) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 33x33 --spp 1 --sky-samples 1 "
                                          "--light-samples 1 --edge-pixels 4 --machine ") +
                              tiny + " ";
    ASSERT_EQ(simulator(start + "-o first.exr").code, 0);
    struct Case {
        const char *options, *share;
        int trees;
    };
    // tiny has 4 cores of 2 threads.
    const Case cases[] = {
        {"", "chip", 1},
        {"--share tile", "tile", 1},
        {"--share core", "core", 4},
        {"--share core --workers 5", "core", 4},
        {"--share core --workers 5 -g chip.placement=pack", "core", 3},
        {"--share worker", "worker", 8},
        {"--share worker -g chip.placement=pack", "worker", 8},
        {"--share 3", "3", 3},
        {"--share 3 -g chip.placement=pack", "3", 3},
        {"-g kdtree.share=2", "2", 4},
        {"-g kdtree.share=worker --share core", "core", 4},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.options);
        const Outcome result = simulator(start + c.options + " -o a.exr --json a.json");
        ASSERT_EQ(result.code, 0) << result.err;
        const nlohmann::json a = report("a.json");
        EXPECT_EQ(a.at("options").at("share"), c.share);
        EXPECT_EQ(a.at("renderer").at("trees"), c.trees);
        EXPECT_EQ(a.at("renderer").at("tree_of_worker").size(), a.at("workers"));
        const Film expected = read_exr(folder_ / "first.exr"), got = read_exr(folder_ / "a.exr");
        for (const Plane& plane : expected.planes)
            EXPECT_EQ(got.find(plane.name)->values, plane.values) << plane.name;
        ASSERT_EQ(simulator(start + c.options + " --json b.json").code, 0);
        EXPECT_EQ(report("b.json"), a);
    }
    EXPECT_EQ(report("a.json").at("renderer").at("tree_of_worker"),
              nlohmann::json::parse("[0, 1, 2, 3, 0, 1, 2, 3]"));
}

} // namespace
} // namespace razor
