// razor render --frames: sequences of what moves.
#include "tests/program/pictures.h"
#include "tests/program/run.h"
#include "tests/scene/scene_texts.h"

#include <nlohmann/json.hpp>

namespace razor {
namespace {

const std::string moving = R"(
    [settings]
    size = [48, 32]
    samples = 2
    [camera]
    position = [0, 2, 6]
    [[camera.key]]
    time = 0
    position = [0, 2, 6]
    [[camera.key]]
    time = 0.25
    position = [2, 1, 5]
)" + lamp_text + R"(
    [[light.key]]
    time = 0
    corner = [-1, 4, -1]
    [[light.key]]
    time = 0.25
    corner = [1, 4, -1]
)" + floor_and_gear_text + R"(
    [[object]]
    mesh = "gear"
    cycle = 1
    [[object.key]]
    time = 0
    rotate = [0, 0, 0]
    [[object.key]]
    time = 1
    rotate = [360, 0, 0]
)";

class Sequence : public ::testing::Test {
protected:
    Sequence() { folder_.file("moving.toml", moving); }

    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " render moving.toml " + arguments, folder_.path());
    }
    Film film(const std::string& name) const { return read_exr(folder_ / name); }
    void expect_equal(const std::string& a, const std::string& b) const {
        expect_same_picture(folder_ / a, folder_ / b);
    }

    TemporaryFolder folder_;
};

TEST_F(Sequence, EachFrameIsTheOneRenderedAlone) {
    const Outcome all = razor("--frames 0:4 --threads 2 -o %02d.exr --stats %02d.json");
    ASSERT_EQ(all.code, 0) << all.err;
    EXPECT_EQ(std::count(all.out.begin(), all.out.end(), '\n'), 5) << all.out;
    EXPECT_NE(all.out.find("frame 3: "), std::string::npos);
    EXPECT_EQ(all.err, "");
    for (const std::string frame : {"0", "3", "4"})
        for (const char* how : {"--threads 1", "--threads 3 --share worker", "--threads 3 --share 2"}) {
            ASSERT_EQ(razor("--frame " + frame + " -o alone.exr " + how).code, 0);
            expect_equal("alone.exr", "0" + frame + ".exr");
        }
    const Film first = film("00.exr"), second = film("01.exr");
    EXPECT_NE(first.find("R")->values, second.find("R")->values);
    std::ifstream file(folder_ / "03.json");
    const nlohmann::json stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats.at("options").at("frame"), 3);
    // The configuration that comes with a frame renders that frame.
    folder_.file("pose.toml", stats.at("scene").get<std::string>());
    ASSERT_EQ(run(quoted_argument(RAZOR_PROGRAM) + " render pose.toml -o pose.exr", folder_.path()).code, 0);
    expect_equal("pose.exr", "03.exr");
    ASSERT_EQ(razor("--frame 2 -o one%d.exr").code, 0);
    expect_equal("one2.exr", "02.exr");
    EXPECT_EQ(razor("--frames 2 --quiet -o again.exr").out, "");
    expect_equal("again.exr", "02.exr");
}

// Another unit, another tree of boxes, light and lens that come and go: nothing of one frame is left in the
// next.
TEST_F(Sequence, NothingStaysOfTheFrameBefore) {
    folder_.file("wild.toml", R"(
        [settings]
        size = [40, 30]
        samples = 4
        [camera]
        position = [0, 2, 9]
        interpolation = "step"
        [[camera.key]]
        time = 0
        aperture_radius = 0.5
        [[camera.key]]
        time = 0.04
        aperture_radius = 0
        position = [0, 2e9, 9e9]
        [[camera.key]]
        time = 0.16
        aperture_radius = 0.25
        position = [1, 3, 8]
        [sky]
        radiance = 0.5
        [[light]]
        corner = [-1, 4, -1]
        edge_u = [2, 0, 0]
        edge_v = [0, 0, 2]
        radiance = 8
        interpolation = "step"
        [[light.key]]
        time = 0
        radiance = 8
        [[light.key]]
        time = 0.08
        radiance = 0
        [[light.key]]
        time = 0.2
        radiance = 3
        [[light]]
        corner = [-4, 3, 1]
        edge_u = [0, 1, 0]
        edge_v = [0, 0, 1]
        interpolation = "step"
        [[light.key]]
        time = 0
        radiance = 0
        [[light.key]]
        time = 0.04
        radiance = 5
        [[light.key]]
        time = 0.12
        corner = [-4, 2, 1]
        [[mesh]]
        name = "gear"
        shape = "gear"
        [[mesh]]
        name = "sponge"
        shape = "sponge"
        scheme = "bilinear"
        [[object]]
        mesh = "gear"
        array = [5, 1, 5]
        spacing = [1.5, 0, -1.5]
        translate = [-3, 0, 0]
        [[object]]
        mesh = "sponge"
        interpolation = "step"
        [[object.key]]
        time = 0
        translate = [0, 1, 0]
        [[object.key]]
        time = 0.04
        translate = [1e9, 0, -3e9]
        scale = 1e9
        [[object.key]]
        time = 0.16
        translate = [0, 2, 0]
        rotate = [30, 40, 0]
        scale = [1, -1e-3, 1]
    )");
    const std::string program = quoted_argument(RAZOR_PROGRAM) + " render wild.toml ";
    const Outcome all = run(program + "--frames 0:6 -o w%d.exr --stats w%d.json --threads 1", folder_.path());
    ASSERT_EQ(all.code, 0) << all.err;
    for (int frame = 0; frame <= 6; ++frame) {
        const std::string n = std::to_string(frame);
        ASSERT_EQ(
            run(program + "--frame " + n + " -o alone.exr --stats alone.json --threads 1", folder_.path())
                .code,
            0);
        expect_equal("alone.exr", "w" + n + ".exr");
        std::ifstream left(folder_ / "alone.json"), right(folder_ / ("w" + n + ".json"));
        nlohmann::json alone = nlohmann::json::parse(left).at("statistics"),
                       in_turn = nlohmann::json::parse(right).at("statistics");
        for (const char* same : {"built", "opened", "left_out"}) {
            alone.at(same).erase("topology_page_bytes");
            in_turn.at(same).erase("topology_page_bytes");
            EXPECT_EQ(alone.at(same), in_turn.at(same)) << frame;
        }
    }
    EXPECT_NE(film("w0.exr").find("R")->values, film("w4.exr").find("R")->values);
}

// A frame that cannot be says so; those before are whole.
TEST_F(Sequence, AFrameThatIsImpossibleEndsIt) {
    folder_.file("flat.toml",
                 "[settings]\nsize = [8, 8]\n[[mesh]]\nname = \"a\"\nshape = \"box\"\n[[object]]\nmesh = "
                 "\"a\"\n[[object.key]]\ntime = 0\nscale = [1, 1, 1]\n[[object.key]]\ntime = "
                 "0.25\nscale = [1, 1, -1]\n");
    const Outcome result =
        run(quoted_argument(RAZOR_PROGRAM) + " render flat.toml --frames 0:6 -o %d.png", folder_.path());
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error_lines(), 1) << result.err;
    EXPECT_NE(result.err.find("razor: frame 3: flat: "), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "2.png"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "3.png"));
}

TEST_F(Sequence, GoesOnWhereItStopped) {
    ASSERT_EQ(razor("--frames 0:3 -o a%d.exr -o a%d.png").code, 0);
    std::filesystem::remove(folder_ / "a1.png");
    std::filesystem::remove(folder_ / "a3.exr");
    const auto before = std::filesystem::last_write_time(folder_ / "a0.exr");
    const Outcome rest = razor("--frames 0:4 --resume -o a%d.exr -o a%d.png");
    ASSERT_EQ(rest.code, 0) << rest.err;
    std::string frames;
    for (std::size_t at = 0; (at = rest.out.find("frame ", at)) != std::string::npos; at += 6)
        frames += rest.out[at + 6];
    EXPECT_EQ(frames, "134") << rest.out;
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / "a0.exr"), before);
    for (const char* name : {"a1.png", "a3.exr", "a4.exr", "a4.png"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
}

TEST_F(Sequence, OnlyWholePicturesOfTheSizeAreDone) {
    ASSERT_EQ(razor("--frames 0:6 -o a%d.exr -o a%d.png --stats a%d.json").code, 0);
    folder_.file("a0.exr", "");
    std::filesystem::resize_file(folder_ / "a1.exr", std::filesystem::file_size(folder_ / "a1.exr") / 2);
    std::filesystem::resize_file(folder_ / "a2.png", std::filesystem::file_size(folder_ / "a2.png") / 2);
    folder_.file("a3.json", "{\"statistics\": ");
    ASSERT_EQ(razor("--frame 4 --size 16x16 -o a4.png").code, 0);
    folder_.file("a5.png", "no picture");
    const Outcome rest = razor("--frames 0:6 --resume -o a%d.exr -o a%d.png --stats a%d.json");
    ASSERT_EQ(rest.code, 0) << rest.err;
    std::string frames;
    for (std::size_t at = 0; (at = rest.out.find("frame ", at)) != std::string::npos; at += 6)
        frames += rest.out[at + 6];
    EXPECT_EQ(frames, "012345") << rest.out;
    EXPECT_EQ(razor("--frames 0:6 --resume -o a%d.exr -o a%d.png --stats a%d.json").out, "");
    std::filesystem::create_directory(folder_ / "b1.exr");
    const Outcome folder = razor("--frames 0:1 --resume -o b%d.exr");
    EXPECT_EQ(folder.code, 2) << "a directory is no finished frame";
}

TEST_F(Sequence, MistakesAreOneLineAndNoFile) {
    const std::pair<const char*, const char*> cases[] = {
        {"--frames 0:3 -o one.exr", "one.exr: one name for 4 frames"},
        {"--frames 0:3 -o %d.exr --stats s.json", "s.json: one name for 4 frames"},
        {"--frames 3:0 -o %d.exr", "ends before it begins"},
        {"--frames 0..3 -o %d.exr", "--frames"},
        {"--frames 0:3 --frame 2 -o %d.exr", "--frame and --frames together"},
        {"--resume -o one.exr", "--resume without --frames"},
        {"--frame two -o one.exr", "--frame 'two'"},
        {"--frames 0:3 -o nowhere/%d.exr", "nowhere"},
    };
    const std::size_t before = folder_.count();
    for (const auto& [arguments, cause] : cases) {
        const Outcome result = razor(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
}

TEST_F(Sequence, InterruptLeavesWholeFrames) {
    const Outcome result =
        run("timeout --foreground --preserve-status -s INT 2 " + quoted_argument(RAZOR_PROGRAM) +
                " render moving.toml --frames 0:100000 -o %d.png",
            folder_.path());
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_NE(result.err.find("and what follows are not written; go on with --resume"), std::string::npos)
        << result.err;
    const auto frames = static_cast<std::size_t>(std::count(result.out.begin(), result.out.end(), '\n'));
    EXPECT_GT(frames, 0U);
    EXPECT_EQ(folder_.count(), 1 + frames) << "moving.toml and whole pictures";
    EXPECT_NE(result.err.find("frame " + std::to_string(frames) + " and"), std::string::npos) << result.err;
}

} // namespace
} // namespace razor
