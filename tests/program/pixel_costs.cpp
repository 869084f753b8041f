// razor-sim run --costs and --false-colour: what is in files, and mistakes.
#include "razor/image/exr.h"
#include "tests/program/simulator.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace razor {
namespace {

/// A model to the left, and to its right only the sky.
const std::string scene = R"(
[settings]
size = [48, 16]
samples = 2
[camera]
position = [2.5, 0, 4]
target = [2.5, 0, 0]
fov = 30
[[mesh]]
shape = "urchin"
)";

class PixelCosts : public Simulator {
protected:
    PixelCosts() { folder_.file("s.toml", scene); }
    std::string start(const std::string& more) const {
        return "run --quiet --no-native --scene s.toml --report r.txt --machine " + tiny + " " + more;
    }
    static double sum(const Film& film, const std::string& name) {
        const std::vector<float>& values = film.find(name)->values;
        return std::accumulate(values.begin(), values.end(), 0.0);
    }
};

TEST_F(PixelCosts, SumToWhatTheReportSays) {
    for (const std::string mode : {"fast", "reference"}) {
        SCOPED_TRACE(mode);
        const std::string set = "-g sim.mode=" + mode + " ";
        const Outcome plain = simulator(start(set + "-o plain.exr --json plain.json"));
        ASSERT_EQ(plain.code, 0) << plain.err;
        const Outcome asked = simulator(start(set + "--costs -o a.exr --json a.json"));
        ASSERT_EQ(asked.code, 0) << asked.err;
        nlohmann::json with = report("a.json");
        const nlohmann::json owners = with.at("owners");
        with.erase("owners");
        EXPECT_EQ(with, report("plain.json")) << "recording changes the run";
        const Film film = read_exr(folder_ / "a.exr"), before = read_exr(folder_ / "plain.exr");
        for (const Plane& plane : before.planes)
            EXPECT_EQ(film.find(plane.name)->values, plane.values) << plane.name;
        for (const auto& [figure, sums] : owners.items()) { // all small enough for exact floats
            EXPECT_EQ(sum(film, "cost." + figure), sums.at("owners").get<double>()) << figure;
            EXPECT_EQ(sum(film, "build." + figure), sums.at("builds").get<double>()) << figure;
        }
        EXPECT_EQ(sum(film, "cost.dram_bytes"),
                  64 * (sum(film, "cost.dram_reads") + sum(film, "cost.dram_writes")));
        EXPECT_GT(owners.at("dram_reads").at("builds"), 0);
        // Rendering is somebody's: the rest is the first pass over the scene, queues and idle threads.
        EXPECT_GT(owners.at("instructions").at("owners"), owners.at("instructions").at("nobody"));
    }
}

TEST_F(PixelCosts, AreThoseOfWhatPixelsShow) {
    ASSERT_EQ(simulator(start("--costs -o a.exr")).code, 0);
    const Film film = read_exr(folder_ / "a.exr");
    const std::vector<float>& depth = film.find("depth.Z")->values;
    struct Mean {
        double pixels = 0, traced = 0, built = 0; // instructions
    } model, sky;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double cost = film.find("cost.instructions")->values[i];
        const double built = film.find("build.instructions")->values[i];
        EXPECT_GT(cost, 0) << i;
        EXPECT_LE(built, cost) << i;
        EXPECT_LE(film.find("cost.stalled")->values[i] + film.find("cost.waiting")->values[i],
                  film.find("cost.cycles")->values[i])
            << i;
        const bool far = i % 48 >= 32; // in tiles that see nothing
        EXPECT_FALSE(far && std::isfinite(depth[i])) << i;
        if (far || std::isfinite(depth[i])) {
            Mean& of = far ? sky : model;
            ++of.pixels;
            of.traced += cost - built;
            of.built += built;
        }
    }
    ASSERT_GT(model.pixels, 30);
    EXPECT_GT(model.traced / model.pixels, 5 * sky.traced / sky.pixels);
    EXPECT_GT(model.built / model.pixels, 5 * sky.built / sky.pixels);
}

// A crop's pixels have the numbers of the whole picture; those of its screen tiles that it does not show are
// in no file.
TEST_F(PixelCosts, AreOfCropsToo) {
    for (const std::string crop : {"16,8,16,8", "19,3,10,7"}) {
        ASSERT_EQ(simulator(start("--costs -o a.exr --json a.json --crop " + crop)).code, 0) << crop;
        const Film film = read_exr(folder_ / "a.exr");
        for (const float cost : film.find("cost.instructions")->values)
            EXPECT_GT(cost, 0) << crop;
        const double all = report("a.json").at("owners").at("instructions").at("owners");
        if (crop.starts_with("16"))
            EXPECT_EQ(sum(film, "cost.instructions"), all);
        else
            EXPECT_LT(sum(film, "cost.instructions"), all);
    }
}

TEST_F(PixelCosts, AreShownInColours) {
    const Outcome result = simulator(start("--false-colour cost.cycles --range 0:1000 -o a.png -o a.exr"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(text("r.txt").find("cost.cycles: 0 (dark) to 1000 (bright)"), std::string::npos);
    EXPECT_NE(read_exr(folder_ / "a.exr").find("cost.cycles"), nullptr);
    ASSERT_EQ(simulator(start("-o b.png")).code, 0);
    EXPECT_NE(text("a.png"), text("b.png"));
}

TEST_F(PixelCosts, MistakesAreOneLine) {
    const std::pair<const char*, const char*> cases[] = {
        {"--costs -o a.png", "add -o FILE.exr"},
        {"--costs", "add -o FILE.exr"},
        {"--false-colour cost.cycles -o a.exr", "add -o FILE.png"},
        {"--false-colour cost.cycle -o a.png", "did you mean 'cost.cycles'?"},
        {"--false-colour cost.l4_misses -o a.png", "did you mean"},
        {"--false-colour cost.cycles --range 4:4 -o a.png", "ends before it begins"},
        {"--range 0:4 -o a.png", "--range without --false-colour"},
        {"--costs -o a.exr --estimate sample:0.2", "leave out --costs"}};
    for (const auto& [options, cause] : cases) {
        SCOPED_TRACE(options);
        const std::size_t before = folder_.count();
        const Outcome result = simulator(start(options));
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }
}

} // namespace
} // namespace razor
