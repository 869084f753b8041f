// Clips played on other skeletons beside closed forms, and what scene files say of it.
#include "razor/scene/animation/retarget.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <numbers>

namespace razor {
namespace {

glm::dquat turn(double degrees, glm::dvec3 axis) {
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

/// Three joints in a row, each `bone` beyond the one before and turned in it by `roll`; the first stands at
/// (1, 2, 3).
Skeleton chain(double bone, const glm::dquat& roll = {1, 0, 0, 0}) {
    Skeleton s;
    glm::dquat world{1, 0, 0, 0};
    for (int n = 0; n < 3; ++n) {
        const glm::dvec3 step = n == 0 ? glm::dvec3(1, 2, 3) : glm::dvec3(0, bone, 0);
        s.nodes.push_back({.parent = n - 1, .translation = glm::inverse(world) * step, .rotation = roll});
        world = world * roll;
    }
    s.order = parents_first(s.nodes);
    return s;
}

Channel rotations(int node, const glm::dquat& from, const glm::dquat& to) {
    return {node,
            Channel::Path::rotation,
            {.width = 4,
             .rotation = true,
             .times = {0, 1},
             .values = {from.x, from.y, from.z, from.w, to.x, to.y, to.z, to.w}}};
}

/// The joints of chain(1), all turning, the first moving by (2, 0, -1) too.
Clip dance() {
    Clip clip{"dance",
              {rotations(0, {1, 0, 0, 0}, turn(40, {1, 2, 0})),
               rotations(1, turn(10, {0, 0, 1}), turn(90, {0, 1, 1})),
               rotations(2, {1, 0, 0, 0}, turn(70, {1, 0, -1}))}};
    clip.channels.push_back(
        {0, Channel::Path::translation, {.width = 3, .times = {0, 1}, .values = {1, 2, 3, 3, 2, 2}}});
    return clip;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(a[axis], b[axis], tolerance) << axis;
}

TEST(Retarget, OnItsOwnSkeletonItIsTheClip) {
    const Skeleton s = chain(1);
    const RetargetedMotion motion(s, dance(), s, {0, 1, 2});
    EXPECT_EQ(motion.length(), 1);
    for (const double t : {0.0, 0.3, 1.0, 2.0}) {
        const SkeletonPose expected = pose_at(s, dance(), t), found = motion.at(t);
        for (std::size_t n = 0; n < 3; ++n) {
            expect_near(found.world[n].translation, expected.world[n].translation);
            for (int axis = 0; axis < 3; ++axis)
                expect_near(found.world[n].linear[axis], expected.world[n].linear[axis]);
        }
    }
}

/// Joints with other axes, and matrices instead of rotations, but the same places at rest.
TEST(Retarget, AxesOfBonesDoNotMatter) {
    for (const glm::dquat& roll : {turn(90, {0, 1, 0}), turn(33, {1, 2, 3})}) {
        Skeleton target = chain(1, roll);
        for (const bool matrices : {false, true}) {
            if (matrices)
                for (SkeletonNode& node : target.nodes) {
                    node.matrix = Affine{glm::mat3_cast(node.rotation) * 2.0, node.translation};
                    node.rotation = {1, 0, 0, 0};
                }
            if (matrices) // what a matrix scales must be made up for below
                for (std::size_t n = 1; n < 3; ++n)
                    target.nodes[n].matrix->translation /= std::pow(2.0, static_cast<double>(n));
            const RetargetedMotion motion(chain(1), dance(), target, {0, 1, 2});
            for (const double t : {0.0, 0.5, 1.0})
                for (std::size_t n = 0; n < 3; ++n)
                    expect_near(motion.at(t).world[n].translation,
                                pose_at(chain(1), dance(), t).world[n].translation);
        }
    }
}

TEST(Retarget, BonesKeepTheirLengthsAndTheFirstOneGoesAsFarAsItIsLarge) {
    const Skeleton large = chain(3);
    const RetargetedMotion motion(chain(1), dance(), large, {0, 1, 2});
    for (const double t : {0.0, 0.5, 1.0}) {
        const SkeletonPose source = pose_at(chain(1), dance(), t), found = motion.at(t);
        const glm::dvec3 first =
            glm::dvec3(1, 2, 3) + 3.0 * (source.world[0].translation - glm::dvec3(1, 2, 3));
        for (std::size_t n = 0; n < 3; ++n)
            expect_near(found.world[n].translation,
                        first + 3.0 * (source.world[n].translation - source.world[0].translation));
    }
}

TEST(Retarget, WhatFollowsNothingKeepsItsPlaceInItsParent) {
    // The target has a joint more in the middle of its first bone, and stands in a small, turned frame.
    Skeleton target;
    target.nodes = {{.translation = {7, 0, 0}, .scale = glm::dvec3(0.01), .rotation = turn(90, {0, 1, 0})},
                    {.parent = 0, .translation = {0, 200, 0}, .rotation = turn(-90, {0, 1, 0})},
                    {.parent = 1, .translation = {0, 50, 0}},
                    {.parent = 2, .translation = {0, 50, 0}},
                    {.parent = 3, .translation = {0, 100, 0}},
                    {.parent = 4, .translation = {5, 0, 0}}};
    target.order = parents_first(target.nodes);
    const RetargetedMotion motion(chain(1), dance(), target, {-1, 0, -1, 1, 2, -1});
    EXPECT_EQ(motion.moved(), (std::vector<bool>{false, true, true, true, true, true}));
    const SkeletonPose source = pose_at(chain(1), dance(), 0.6), found = motion.at(0.6);
    const auto moved = [&](std::size_t n) {
        return source.world[n].translation + glm::dvec3(7, 2, 0) - glm::dvec3(1, 2, 3);
    };
    expect_near(found.world[0].translation, {7, 0, 0});
    expect_near(found.world[1].translation, moved(0));
    expect_near(found.world[2].translation, 0.5 * (moved(0) + moved(1)));
    expect_near(found.world[3].translation, moved(1));
    expect_near(found.world[4].translation, moved(2));
    expect_near(found.world[5].translation, moved(2) + 0.05 * source.world[2].linear[0]);
    const RetargetedMotion part(chain(1), dance(), target, {-1, -1, -1, -1, 2, -1});
    EXPECT_EQ(part.moved(), (std::vector<bool>{false, false, false, false, true, true}));
    expect_near(part.at(1).world[3].translation, {7, 3, 0});
}

class RetargetInScenes : public ::testing::Test {
protected:
    /// A triangle that follows joint 2 of a chain of bones of this length; joints are called so.
    static GltfWriter model(float bone, const std::vector<std::string>& names) {
        GltfWriter w = triangle();
        auto& attributes = w.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["JOINTS_0"] = w.accessor(std::vector<std::uint8_t>(12, 1), 4);
        attributes["WEIGHTS_0"] = w.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
        w.json["nodes"][0]["skin"] = 0;
        w.add("nodes", {{"name", names[0]}, {"children", {2}}});
        w.add("nodes", {{"name", names[1]}, {"translation", {0, bone, 0}}});
        w.add("skins", {{"joints", {1, 2}}});
        w.json["scenes"][0]["nodes"] = {0, 1};
        return w;
    }
    RetargetInScenes() {
        GltfWriter run = model(1, {"hip", "knee"});
        run.channel(1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0}, 4); // by 180 degrees about z
        run.json["animations"][0]["name"] = "Run";
        folder_.file("run.glb", run.glb());
        folder_.file("still.glb", model(1, {"hip", "knee"}).glb());
        GltfWriter walker = model(2, {"hip", "knee"});
        walker.channel(2, "translation", {0, 1}, {0, 2, 0, 5, 5, 5}, 3);
        folder_.file("walker.glb", walker.glb());
        folder_.file("other.glb", model(2, {"a", "b"}).glb());
        folder_.file("twins.glb", model(2, {"hip", "hip"}).glb());
    }
    SceneDescription scene(const std::string& keys) const {
        return parse_scene_file("[[mesh]]\n" + keys, "s.toml", folder_.path());
    }
    std::string message(const std::string& keys) const {
        try {
            scene(keys);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return {};
    }
    TemporaryFolder folder_;
};

TEST_F(RetargetInScenes, OneFilesClipMovesAnothersModel) {
    const SceneDescription d =
        scene("file = \"walker.glb\"\nclip_file = \"run.glb\"\nclip = \"Run\"\ncycle = 4.0\n"
              "[[mesh]]\nfile = \"walker.glb\"\n[[mesh]]\nfile = \"still.glb\"\n"
              "clip_file = \"run.glb\"\nspeed = 0.5\n");
    EXPECT_TRUE(is_animated(d));
    EXPECT_EQ(d.meshes[2].playback.clip, "Run") << "the first";
    const Scene s = build_scene(pose_at(d, 1));
    expect_near(s.meshes[0].points[0], {0, -2, 0}, 1e-6);
    expect_near(s.meshes[0].points[1], {-1, -2, 0}, 1e-6);
    expect_near(s.meshes[1].points[0], {5, 5, 5}, 1e-6);
    expect_near(s.meshes[2].points[0], {-1, 0, 0}, 1e-6);
    EXPECT_EQ(s.meshes[0].rest, build_scene(scene("file = \"walker.glb\"\n")).meshes[0].points);
    const SceneDescription again = parse_scene_file(to_toml(d), "t", {});
    EXPECT_EQ(to_toml(again), to_toml(d));
    for (const double t : {0.0, 0.4, 4.4})
        expect_same(build_scene(pose_at(again, t)), build_scene(pose_at(d, t)));
}

TEST_F(RetargetInScenes, MistakesAreNamed) {
    EXPECT_NE(message("file = \"other.glb\"\nclip_file = \"run.glb\"\n")
                  .find("other.glb: none of its joints is called as one of " +
                        (folder_ / "run.glb").string() + "; rename them; it has: a, b"),
              std::string::npos);
    EXPECT_NE(message("file = \"walker.glb\"\nclip_file = \"still.glb\"\n").find("has no animation; give"),
              std::string::npos);
    EXPECT_NE(message("file = \"walker.glb\"\nclip_file = \"run.glb\"\nclip = \"Walk\"\n")
                  .find("run.glb: no animation is named 'Walk'; there are: Run"),
              std::string::npos);
    EXPECT_NE(message("file = \"twins.glb\"\nclip_file = \"run.glb\"\n")
                  .find("twins.glb: two joints are called 'hip'; rename one"),
              std::string::npos);
    EXPECT_NE(message("file = \"walker.glb\"\nclip_file = \"none.glb\"\n").find("none.glb: no such file"),
              std::string::npos);
    EXPECT_NE(message("file = \"walker.glb\"\nclip_file = \"a.obj\"\n").find("give a .gltf or .glb file"),
              std::string::npos);
    EXPECT_NE(
        message("shape = \"box\"\nclip_file = \"run.glb\"\n").find("clip_file in a mesh whose file has no"),
        std::string::npos);
}

} // namespace
} // namespace razor
