// Cages that change their shape: sequences of OBJ files, deformers, what scene files say of them.
#include "razor/scene/animation/cage_frames.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/framing.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/models/obj_reader.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

namespace razor {
namespace {

/// A square of side 1 and, beside it, a triangle; `shift` is added to one corner.
std::string square(double shift, bool triangle = true) {
    return fmt::format("v 0 0 0\nv 1 0 0\nv {} {} 0\nv 0 1 {}\nv 2 0 0\n", 1 + shift, 1 - shift, 3 * shift) +
           "f 1 2 3 4\n" + (triangle ? "f 2 5 3\n" : "");
}

class ObjFrames : public ::testing::Test {
protected:
    ObjFrames() {
        for (int n = 3; n <= 6; ++n)
            folder_.file(fmt::format("w_{:02}.obj", n), square(n * n));
    }
    std::string name() const { return (folder_ / "w_%02d.obj").string(); }
    SceneDescription scene(const std::string& keys) const {
        return parse_scene_file("[[mesh]]\nfile = \"w_%02d.obj\"\n" + keys, "s.toml", folder_.path());
    }
    std::string message(const std::string& keys) const {
        try {
            pose_at(scene(keys), 0.5);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }

    TemporaryFolder folder_;
};

TEST_F(ObjFrames, AreReachedAtTheirTimesAndBlendedInBetween) {
    const CageSequence motion(name(), 3, 6, 2, {});
    EXPECT_EQ(motion.length(), 1.5);
    const std::vector<glm::dvec3> rest = read_obj(folder_ / "w_03.obj").points;
    for (int n = 3; n <= 6; ++n) {
        const auto cage = motion.at((n - 3) / 2.0);
        EXPECT_EQ(cage->points, read_obj(folder_ / fmt::format("w_{:02}.obj", n)).points) << n;
        EXPECT_EQ(cage->rest, rest) << n;
    }
    EXPECT_EQ(motion.at(-1)->points, motion.at(0)->points);
    EXPECT_EQ(motion.at(9)->points, motion.at(1.5)->points);
    EXPECT_EQ(motion.at(0.125)->points[2].x, 1 + 9 + 7 / 4.0);
    EXPECT_EQ(motion.at(1.25)->points[3].z, 3 * (25 + 11 / 2.0));
    EXPECT_EQ(CageSequence(name(), 3, 6, 2, {Interpolation::step, 0}).at(0.99)->points,
              motion.at(0.5)->points);
    // Squares are a parabola, which cubics through three keys keep.
    const CageSequence smooth(name(), 3, 6, 2, {Interpolation::smooth, 0});
    EXPECT_NEAR(smooth.at(0.7)->points[2].x, 1 + 4.4 * 4.4, 1e-12);
    // 6 (at 1.5 s) and 3 (at 2 s) are neighbours.
    EXPECT_EQ(CageSequence(name(), 3, 6, 2, {Interpolation::linear, 2}).at(3.75)->points[2].x, 1 + 22.5);
    EXPECT_EQ(CageSequence(name(), 4, 5, 1, {}).at(0)->points, motion.at(0.5)->points);
}

TEST_F(ObjFrames, WithOtherFacesOnlyFollowEachOther) {
    folder_.file("w_05.obj", square(25, false));
    EXPECT_NE(message("frame_rate = 4\n")
                  .find("w_05.obj: its faces are not those of w_03.obj; write interpolation = "
                        "\"step\""),
              std::string::npos)
        << message("frame_rate = 4\n");
    const SceneDescription s = scene("frame_rate = 4\ninterpolation = \"step\"\n");
    EXPECT_EQ(build_scene(pose_at(s, 0.3)).meshes[0].face_sizes, (std::vector<int>{4, 3}));
    const Mesh other = build_scene(pose_at(s, 0.5)).meshes[0];
    EXPECT_EQ(other.face_sizes, std::vector<int>{4});
    EXPECT_EQ(other.rest, other.points);
}

TEST_F(ObjFrames, AllThereAreUnlessSomeAreNamed) {
    EXPECT_EQ(scene("").meshes[0].playback.frames, std::pair(3, 6));
    EXPECT_EQ(scene("").meshes[0].name, "w");
    folder_.file("w_08.obj", square(1));
    folder_.file("w_008.obj", square(1));
    folder_.file("w_2.obj", square(1));
    EXPECT_EQ(scene("frames = [3, 6]\n").meshes[0].playback.frames, std::pair(3, 6)) << "up to the gap";
    EXPECT_EQ(scene("frames = [8, 8]\n").meshes[0].playback.frames, std::pair(8, 8));
    EXPECT_NE(message("frames = [5, 8]\n").find("w_07.obj: no such file, of frames 5 to 8"),
              std::string::npos)
        << message("frames = [5, 8]\n");
}

TEST_F(ObjFrames, PlayAsTheirMeshSays) {
    const std::string keys = "frame_rate = 2\nstart = 0.25\nspeed = 0.5\nscale = [2, 1, 1]\n";
    const SceneDescription s = scene(keys);
    EXPECT_TRUE(is_animated(s));
    const SceneDescription posed = pose_at(s, 1.5); // 1 s of its own: frame 5
    EXPECT_FALSE(is_animated(posed));
    EXPECT_EQ(build_scene(posed).meshes[0].points[2], glm::dvec3(2 * 26, 1 - 25, 0));
    EXPECT_EQ(build_scene(posed).meshes[0].rest[2], glm::dvec3(2 * 10, 1 - 9, 0));
    EXPECT_EQ(build_scene(pose_at(posed, 77)).meshes[0].points, build_scene(posed).meshes[0].points);
    for (const SceneDescription& scene : {s, posed}) {
        const SceneDescription again = parse_scene_file(to_toml(scene), "t.toml", {});
        EXPECT_EQ(to_toml(again), to_toml(scene));
        for (const double t : {0.0, 0.3, 2.0})
            expect_same(build_scene(pose_at(again, t)), build_scene(pose_at(scene, t)));
    }
}

TEST_F(ObjFrames, BareSequencesAreFramedWithAllTheirMotion) {
    const SceneDescription s = describe(name(), {});
    EXPECT_EQ(s.name, "w");
    const glm::dvec3 far(1 + 36, 1 - 36, 0); // in the last frame alone
    const glm::dvec3 view = glm::normalize(s.camera.target - s.camera.position), p = far - s.camera.position;
    EXPECT_LT(glm::degrees(std::acos(glm::dot(glm::normalize(p), view))), s.camera.fov_degrees * 0.75);
    EXPECT_LT(s.meshes[1].translate.y, -35) << "the floor lies below all frames";
}

TEST_F(ObjFrames, MistakesAreNamed) {
    const std::pair<const char*, const char*> cases[] = {
        {"frames = [6, 3]\n", "s.toml:3:10: frames from 6 to 3"},
        {"frame_rate = 0\n", "frame_rate"},
        {"interpolation = \"cubic\"\n", "step, linear, smooth"},
        {"frame_rate = 2\ncycle = 1.25\n",
         "s.toml:4:9: frames 3 to 6, 2 a second, of which the last is at 1.5 s "
         "of a cycle of 1.25 s; make the cycle longer"},
        {"frame_rate = 2\ninterpolation = \"smooth\"\ncycle = 0.5\n", "s.toml:5:9: frames 3 to 6"},
        {"start = 1\nmoment = 2\n", "start and moment"},
        {"clip = \"run\"\n", "clip"},
        {"[[mesh.deform]]\namount = 1\n", "a deformation without a kind"},
        {"[[mesh.deform]]\nkind = \"bend\"\ndirection = [0, -3, 0]\n", "is along the axis"},
        {"[[mesh.deform]]\nkind = \"twist\"\naxis = [0, 0, 0]\n", "the axis has no length"},
        {"[[mesh.deform]]\nkind = \"twist\"\nwavelength = 2\n", "wavelength"},
        {"[[mesh.deform]]\nkind = \"wave\"\nwavelength = 0\n", "wavelength"},
    };
    for (const auto& [keys, cause] : cases)
        EXPECT_NE(message(keys).find(cause), std::string::npos) << message(keys) << "\n" << keys;
    for (const char* key :
         {"frames = [0, 1]\n", "frame_rate = 2\n", "cycle = 1\n", "start = 1\n", "moment = 1\n"}) {
        std::string cause;
        try {
            parse_scene_file("[[mesh]]\nshape = \"box\"\n" + std::string(key), "s.toml", {});
        } catch (const UserError& error) {
            cause = error.what();
        }
        EXPECT_NE(cause.find("s.toml:3:"), std::string::npos) << cause << key;
    }
    EXPECT_EQ(message("frame_rate = 2\ncycle = 1.5\n"), "");
    EXPECT_EQ(message("frame_rate = 2\nframes = [4, 5]\ncycle = 0.5\n"), "");
    EXPECT_THROW(describe(folder_ / "none_%d.obj", {}), UserError);
}

TEST_F(ObjFrames, KnownKeysAreListedOnce) {
    const std::string said = message("nosuch = 1\n");
    EXPECT_EQ(said.find("moment"), said.rfind("moment")) << said;
    EXPECT_NE(said.find("moment"), std::string::npos) << said;
}

TEST_F(ObjFrames, AGapIsSaid) {
    folder_.file("w_08.obj", square(1));
    EXPECT_NE(message("").find("w_07.obj: no such file, but there are some up to number 8; add it"),
              std::string::npos)
        << message("");
    EXPECT_NE(message("").find("frames = [3, 6]"), std::string::npos) << message("");
    EXPECT_EQ(message("frames = [3, 6]\n"), "");
    folder_.file("w_07.obj", square(1));
    EXPECT_EQ(message(""), "");
}

/// The points of one deformer at work on these.
std::vector<glm::dvec3> deformed(const Deformer& d, double seconds, std::vector<glm::dvec3> points) {
    deform(d, seconds, points);
    return points;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-12)
        << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

TEST(Deform, WavesTravelAlongTheirAxis) {
    const Deformer d{.kind = DeformerKind::wave,
                     .origin = {5, 0, 0},
                     .axis = {0, 0, 2},
                     .direction = {0, 3, 0},
                     .amount = 0.5,
                     .wavelength = 4,
                     .period = 8,
                     .phase = 0.25};
    const std::vector<glm::dvec3> p = {{1, 2, 0}, {1, 2, 1}, {-7, 2, 3}};
    expect_near(deformed(d, 0, p)[0], {1, 2.5, 0});
    expect_near(deformed(d, 0, p)[1], {1, 2, 1});
    expect_near(deformed(d, 0, p)[2], {-7, 2, 3});
    for (const double t : {0.7, 3.0, 8e5 + 1.5}) // as far as it came in t
        expect_near(deformed(d, t, {{0, 0, 1 + 4 * t / 8}})[0] - glm::dvec3(0, 0, 4 * t / 8),
                    deformed(d, 0, {{0, 0, 1}})[0]);
    EXPECT_EQ(deformed(d, 1.25, p), deformed(d, 9.25, p));
}

// By less than one can differ by.
TEST(Deform, WavesBarelyBeforeTheirBeginningAreAtIt) {
    Deformer d{
        .kind = DeformerKind::wave, .axis = {0, 0, 1}, .direction = {1, 0, 0}, .amount = 1, .wavelength = 4};
    for (const double phase : {-1e-20, -1e-17, 0.0, 1e-20, 1.0, -1.0}) {
        d.phase = phase;
        expect_near(deformed(d, 0, {{0, 0, 0}})[0], {0, 0, 0});
    }
}

TEST(Deform, TwistsTurnAboutTheirAxis) {
    const Deformer d{.kind = DeformerKind::twist, .origin = {1, 0, 0}, .axis = {0, 5, 0}, .amount = 45};
    expect_near(deformed(d, 3, {{3, 2, 0}})[0], {1, 2, -2});
    expect_near(deformed(d, 3, {{3, 0, 1}})[0], {3, 0, 1});
    expect_near(deformed(d, 3, {{3, -2, 0}})[0], {1, -2, 2});
    Deformer swings = d;
    swings.period = 4;
    expect_near(deformed(swings, 1, {{3, 2, 0}})[0], {1, 2, -2});
    expect_near(deformed(swings, 3, {{3, 2, 0}})[0], {1, 2, 2});
    expect_near(deformed(swings, 2, {{3, 2, 0}})[0], {3, 2, 0});
}

TEST(Deform, BendsAreArcs) {
    const double quarter = std::numbers::pi / 2;
    // 90 degrees over a length of pi/2: an arc of radius 1 about (1, 0, 0).
    const Deformer d{.kind = DeformerKind::bend, .direction = {2, 9, 0}, .amount = 90 / quarter};
    const auto at = [&](double x, double y, double z) { return deformed(d, 0, {{x, y, z}})[0]; };
    expect_near(at(0, quarter, 0), {1, 1, 0});
    expect_near(at(0.25, quarter, 7), {1, 0.75, 7});
    expect_near(at(0, 2 * quarter, 0), {2, 0, 0});
    expect_near(at(-1, 2 * quarter, 0), {3, 0, 0});
    for (const double y : {0.1, 0.7, 1.3})
        EXPECT_NEAR(glm::length(at(0.5, y, 0) - glm::dvec3(1, 0, 0)), 0.5, 1e-12);
    EXPECT_EQ(at(0.3, -2, 1), glm::dvec3(0.3, -2, 1));
    // No jump where it hardly bends: cubic terms are below rounding.
    Deformer little = d;
    little.amount = 1e-7;
    const double rate = 1e-7 * std::numbers::pi / 180;
    expect_near(deformed(little, 0, {{0, 3, 0}})[0], {rate * 9 / 2, 3, 0});
    little.amount = 0;
    EXPECT_EQ(deformed(little, 0, {{0.3, 3, 0.1}})[0], glm::dvec3(0.3, 3, 0.1));
}

TEST(Deform, WorksOneAfterTheOtherInTheMeshsOwnTime) {
    const std::string text = R"(
        [[mesh]]
        shape = "box"
        speed = 2
        start = 1
        [[mesh.deform]]
        kind = "twist"
        amount = 45
        [[mesh.deform]]
        kind = "wave"
        direction = [0, 0, 1]
        amount = 0.25
        period = 8
    )";
    const SceneDescription s = parse_scene_file(text, "s.toml", {});
    EXPECT_TRUE(is_animated(s));
    std::vector<glm::dvec3> points = s.meshes[0].source->points;
    deform(s.meshes[0].deformers[0], 0, points);
    deform(s.meshes[0].deformers[1], 1 + 2 * 3, points);
    const Mesh posed = build_scene(pose_at(s, 3)).meshes[0];
    EXPECT_EQ(posed.points, points);
    EXPECT_EQ(posed.rest, s.meshes[0].source->points);
    for (const SceneDescription& scene : {s, pose_at(s, 3)}) {
        const SceneDescription again = parse_scene_file(to_toml(scene), "t.toml", {});
        EXPECT_EQ(to_toml(again), to_toml(scene));
        expect_same(build_scene(pose_at(again, 3)), build_scene(pose_at(scene, 3)));
    }
    // Without a period it never changes, but is deformed.
    const SceneDescription still =
        parse_scene_file(text.substr(0, text.find("[[mesh.deform]]\n        kind = \"wave\"")), "s.toml", {});
    EXPECT_FALSE(is_animated(still));
    EXPECT_NE(build_scene(still).meshes[0].points, still.meshes[0].source->points);
}

} // namespace
} // namespace razor
