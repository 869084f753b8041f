// razor render --frames of cages that change their shape: each frame is the one rendered alone.
#include "tests/program/pictures.h"
#include "tests/program/run.h"
#include "tests/scene/scene_texts.h"

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>

namespace razor {
namespace {

const std::string head = R"(
    [settings]
    size = [40, 30]
    samples = 2
    [animation]
    rate = 2
    [camera]
    position = [0, 2, 6]
    target = [0, 0.5, 0]
    [sky]
    radiance = 0.4
)" + lamp_text + R"(
    [[mesh]]
    name = "floor"
    shape = "plane"
    scheme = "bilinear"
    scale = 3
    translate = [0, -1, 0]
)";

/// A closed box, its top a pentagon, with points moved as asked. `more`: its front is two triangles.
std::string box(const std::function<glm::dvec3(const glm::dvec3&)>& move, bool more = false) {
    std::string text;
    for (const glm::dvec3& p : {glm::dvec3(-1, -1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, -1, -1),
                                glm::dvec3(-1, -1, -1), glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, 1),
                                glm::dvec3(1, 1, -1), glm::dvec3(-1, 1, -1), glm::dvec3(0.2, 1, 0.4)}) {
        const glm::dvec3 q = move(p);
        text += fmt::format("v {} {} {}\n", q.x, q.y, q.z);
    }
    text += "f 4 3 2 1\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 9 6 7 8\n"; // the top is concave
    return text + (more ? "f 1 2 6\nf 1 6 5\nf 5 6 9\n" : "f 1 2 6 5\nf 5 6 9\n");
}

glm::dvec3 turned(const glm::dvec3& p, double angle) {
    return {std::cos(angle) * p.x + std::sin(angle) * p.z, p.y,
            std::cos(angle) * p.z - std::sin(angle) * p.x};
}

class Deforming : public ::testing::Test {
protected:
    Outcome razor(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " render " + arguments, folder_.path());
    }
    void scene(const std::string& name, const std::string& meshes) const {
        folder_.file(name, head + meshes);
    }
    void expect_equal(const std::string& a, const std::string& b) const {
        expect_same_picture(folder_ / a, folder_ / b);
    }
    /// Every frame, and each alone by several workers.
    void expect_each_alone(const std::string& toml, int frames) const {
        const Outcome all = razor(fmt::format("{} --frames 0:{} --threads 2 -o %d.exr", toml, frames - 1));
        ASSERT_EQ(all.code, 0) << all.err;
        for (int n = 0; n < frames; ++n)
            for (const char* how : {"--threads 1", "--threads 3 --share worker", "--threads 3 --share 2"}) {
                const Outcome alone = razor(fmt::format("{} --frame {} -o alone.exr {}", toml, n, how));
                ASSERT_EQ(alone.code, 0) << alone.err;
                expect_equal("alone.exr", fmt::format("{}.exr", n));
            }
        EXPECT_NE(read_exr(folder_ / "0.exr").find("R")->values,
                  read_exr(folder_ / "1.exr").find("R")->values);
    }

    TemporaryFolder folder_;
};

// The top is planar in the first frame alone; sides of all others are saddles.
TEST_F(Deforming, FilesAndFormulas) {
    for (int n = 0; n < 4; ++n)
        folder_.file(fmt::format("box_{}.obj", n), box([&](const glm::dvec3& p) {
                         const bool notch = p.x == 0.2;
                         return turned(p, 0.4 * n * p.y) * (1 - 0.1 * n) +
                                glm::dvec3(0, notch ? 0.2 * n : 0, 0);
                     }));
    scene("s.toml", R"(
        [[mesh]]
        file = "box_%d.obj"
        scheme = "bilinear"
        translate = [-1.4, 0, 0]
        scale = 0.8
        frame_rate = 3
        [[mesh]]
        file = "box_%d.obj"
        translate = [1.4, 0, 0]
        interpolation = "smooth"
        frame_rate = 1
        cycle = 4
        start = 0.3
        [[mesh]]
        name = "gear"
        shape = "gear"
        scale = 0.4
        [[mesh.deform]]
        kind = "bend"
        axis = [1, 0, 0]
        direction = [0, 1, 0]
        amount = 50
        period = 3
        [[mesh.deform]]
        kind = "twist"
        amount = 30
        [[object]]
        mesh = "gear"
        translate = [0, 0, 2]
        [[object.key]]
        time = 0
        translate = [0, 0, 2]
        [[object.key]]
        time = 2
        translate = [0, 1, 2]
    )");
    expect_each_alone("s.toml", 4);
}

// Catmull-Clark frames against their files, of which each is rendered as a mesh that stands still: moved far
// away, collapsed to a point, to a line, turned inside out, mirrored, with other faces.
TEST_F(Deforming, NoShapeOfOneFrameHarmsAnother) {
    const std::function<glm::dvec3(const glm::dvec3&)> moves[] = {
        [](const glm::dvec3& p) { return p; },
        [](const glm::dvec3& p) { return p + glm::dvec3(1e6, 0, 0); },
        [](const glm::dvec3& p) { return turned(p, 0.5); },
        [](const glm::dvec3&) { return glm::dvec3(0.5, 0, 0); },
        [](const glm::dvec3& p) { return glm::dvec3(0, p.y, 0); },
        [](const glm::dvec3& p) { return -p; },
        [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, -0.5 * p.z); },
        [](const glm::dvec3& p) { return turned(p, 0.3); }, // other faces
        [](const glm::dvec3& p) { return p * 1e-6; },
        [](const glm::dvec3& p) { return p * 8.0; }, // the camera is inside
        [](const glm::dvec3& p) { return p; },
    };
    const int frames = std::size(moves);
    for (int n = 0; n < frames; ++n) {
        folder_.file(fmt::format("{}.obj", n), box(moves[n], n == 7));
        scene(fmt::format("still_{}.toml", n), fmt::format("[[mesh]]\nfile = \"{}.obj\"\n", n));
    }
    scene("s.toml", "[[mesh]]\nfile = \"%d.obj\"\ninterpolation = \"step\"\n");
    expect_each_alone("s.toml", frames);
    for (int n = 0; n < frames; ++n) {
        ASSERT_EQ(razor(fmt::format("still_{}.toml -o still.exr --threads 1", n)).code, 0) << n;
        expect_equal("still.exr", fmt::format("{}.exr", n));
    }
    expect_equal("0.exr", "10.exr");
    // Bilinear frames: quadrilaterals may be flat or not in one that stands still, so against each alone.
    scene("b.toml", "[[mesh]]\nfile = \"%d.obj\"\ninterpolation = \"step\"\nscheme = \"bilinear\"\n");
    expect_each_alone("b.toml", frames);
}

// A box at rest whose sides become saddles, against one that never was a box.
TEST_F(Deforming, NothingStaysFlat) {
    for (int n = 0; n < 2; ++n)
        folder_.file(fmt::format("box_{}.obj", n),
                     box([&](const glm::dvec3& p) { return turned(p, 0.8 * n * p.y); }));
    scene("s.toml", "[[mesh]]\nfile = \"box_%d.obj\"\nframe_rate = 2\nscheme = \"bilinear\"\n");
    scene("still.toml", "[[mesh]]\nfile = \"box_1.obj\"\nscheme = \"bilinear\"\n");
    ASSERT_EQ(razor("s.toml --frame 1 -o posed.exr").code, 0);
    ASSERT_EQ(razor("still.toml -o still.exr").code, 0);
    for (const char* plane : {"depth.Z", "normal.X", "normal.Z"}) {
        const std::vector<float> posed = read_exr(folder_ / "posed.exr").find(plane)->values,
                                 still = read_exr(folder_ / "still.exr").find(plane)->values;
        int apart = 0;
        for (std::size_t i = 0; i < posed.size(); ++i)
            apart += std::abs(posed[i] - still[i]) > 1e-3F ? 1 : 0;
        EXPECT_LT(apart, 20) << plane << " of " << posed.size();
    }
}

TEST_F(Deforming, TopologyIsAnalysedOnce) {
    for (int n = 0; n < 3; ++n)
        folder_.file(fmt::format("box_{}.obj", n),
                     box([&](const glm::dvec3& p) { return turned(p, 0.4 * n * p.y); }));
    scene("s.toml", "[[mesh]]\nfile = \"box_%d.obj\"\nframe_rate = 2\n");
    ASSERT_EQ(razor("s.toml --frames 0:2 --threads 1 -o %d.exr --stats %d.json").code, 0);
    const auto pages = [&](int n) {
        std::ifstream file(folder_ / fmt::format("{}.json", n));
        return nlohmann::json::parse(file)
            .at("statistics")
            .at("built")
            .at("topology_page_bytes")
            .get<std::int64_t>();
    };
    EXPECT_GT(pages(0), 0);
    EXPECT_GE(pages(2), pages(0)) << "kept from frame to frame";
}

// Real characters: at a frame's time the picture is that of the frame's file.
TEST_F(Deforming, CharactersAreTheirFiles) {
    const std::filesystem::path shared(RAZOR_SHARED_SCENES);
    if (!std::filesystem::exists(shared / "makehuman_anim"))
        GTEST_SKIP() << "no " << shared;
    for (const auto& [name, scale, up, last] :
         {std::tuple("makehuman_anim", 0.2, "", 11),
          std::tuple("oa_gargoyle", 0.05, "rotate = [-90, 0, 0]\n", 9)}) {
        const std::string mesh = fmt::format("[[mesh]]\nscale = {}\n{}", scale, up);
        const std::string file = (shared / name).string() + "/frame_";
        scene("s.toml", mesh + fmt::format("file = \"{}%03d.obj\"\nframe_rate = 2\n", file));
        ASSERT_EQ(razor(fmt::format("s.toml --frames 0:{} -o %d.exr", last)).code, 0);
        for (const int n : {0, 5, last}) {
            scene("still.toml", mesh + fmt::format("file = \"{}{:03}.obj\"\n", file, n));
            ASSERT_EQ(razor("still.toml -o still.exr").code, 0);
            expect_equal("still.exr", fmt::format("{}.exr", n));
        }
    }
}

TEST_F(Deforming, AFrameThatCannotBeReadEndsIt) {
    for (int n = 0; n < 3; ++n)
        folder_.file(fmt::format("{}.obj", n),
                     n == 2 ? "v 1 2\n" : box([&](const glm::dvec3& p) { return p * (1.0 + n); }));
    scene("s.toml", "[[mesh]]\nfile = \"%d.obj\"\nframe_rate = 2\nname = \"b\"\n");
    const Outcome result = razor("s.toml --frames 0:2 -o %d.exr");
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error_lines(), 1) << result.err;
    EXPECT_NE(result.err.find("razor: frame 2: s: mesh 'b': "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("2.obj:1: "), std::string::npos) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "1.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "2.exr"));
}

} // namespace
} // namespace razor
