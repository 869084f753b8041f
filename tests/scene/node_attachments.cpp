// Objects that hang on nodes and joints of glTF models, against the same by hand.
#include "razor/scene/attachment.h"

#include "razor/scene/animation/moving_scene.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace razor {
namespace {

constexpr float root_half = 0.70710678F;

/// About z, by so many quarter turns.
glm::dvec3 turned(double quarters, const glm::dvec3& p) {
    const double angle = quarters * std::numbers::pi / 2, c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

// What nodes of crane() do to a point, `x` of the way through its clip.
glm::dvec3 arm(double x, const glm::dvec3& p) {
    return glm::dvec3(4 * x, 0, 0) + turned(x, p);
}
glm::dvec3 hook(double x, const glm::dvec3& p) {
    return arm(x, glm::dvec3(0, 3, 0) + 2.0 * glm::dvec3(p.x, -p.y, p.z)); // larger, and mirrored
}
glm::dvec3 hand(double x, const glm::dvec3& p) {
    return turned(x, glm::dvec3(0, 1, 0) + p);
}

/// A triangle bound to the joint Hand, beside nodes that carry nothing; a second long.
GltfWriter crane() {
    GltfWriter w = triangle();
    auto& attributes = w.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = w.accessor(std::vector<std::uint8_t>(12, 1), 4);
    attributes["WEIGHTS_0"] = w.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
    w.json["nodes"][0]["skin"] = 0;
    const int hip = w.add("nodes", {{"name", "Hip"}, {"children", {2}}});
    const int hand = w.add("nodes", {{"name", "Hand"}, {"translation", {0, 1, 0}}});
    const int arm = w.add("nodes", {{"name", "Arm"}, {"children", {4}}});
    w.add("nodes", {{"name", "Hook"}, {"translation", {0, 3, 0}}, {"scale", {2, -2, 2}}});
    w.add("nodes", {{"name", "Twin"}});
    w.add("nodes", {{"name", "Twin"}});
    w.add("nodes", {{"name", "Flat"}, {"scale", {1, 0, 1}}, {"children", {8}}});
    w.add("nodes", {{"name", "Leaf"}});
    const int fading = w.add("nodes", {{"name", "Fading"}, {"children", {10}}});
    w.add("nodes", {{"name", "Ghost"}});
    const int crossing = w.add("nodes", {{"name", "Crossing"}});
    w.add("nodes", {{"name", "Elsewhere"}});
    w.add("nodes", {{"name", "Base"}, {"translation", {0, 0, -1}}});
    w.json["scenes"] = {{{"nodes", {0, 1, 3, 5, 6, 7, 9, 11, 13}}}, {{"nodes", {12}}}};
    const int bind = w.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1, //
                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                              16);
    w.add("skins", {{"joints", {hip, hand}}, {"inverseBindMatrices", bind}});
    const std::vector<float> quarter{0, 0, 0, 1, 0, 0, root_half, root_half};
    w.channel(hip, "rotation", {0, 1}, quarter, 4);
    w.channel(arm, "rotation", {0, 1}, quarter, 4);
    w.channel(arm, "translation", {0, 1}, {0, 0, 0, 4, 0, 0}, 3);
    w.channel(fading, "scale", {0, 0.5, 1}, {1, 1, 1, 0, 0, 0, 1, 1, 1}, 3);
    w.channel(crossing, "scale", {0, 1}, {1, 1, 1, 1, -1, 1}, 3);
    return w;
}

class NodeAttachments : public ::testing::Test {
protected:
    NodeAttachments() {
        folder_.file("crane.glb", crane().glb());
        folder_.file("nameless.glb", triangle().glb());
        folder_.file("tags.md3", write_md3(two_surfaces(), 2, {{"tag_head", {{}, {}}}}));
    }
    /// A box on a node of the crane. `keys`: of the crane's mesh, its object, the box.
    static std::string on(std::string_view node, std::string_view mesh = "", std::string_view carrier = "",
                          std::string_view box = "") {
        return fmt::format("[[mesh]]\nname = \"crane\"\nfile = \"crane.glb\"\n{}\n[[mesh]]\nname = \"box\"\n"
                           "shape = \"box\"\n[[object]]\nmesh = \"box\"\nattach = \"crane\"\nnode = \"{}\"\n"
                           "{}\n[[object]]\nmesh = \"crane\"\n{}\n",
                           mesh, node, box, carrier);
    }
    SceneDescription scene(std::string_view text) const {
        return parse_scene_file(text, "s.toml", folder_.path());
    }
    std::string message(std::string_view text) const {
        try {
            scene(text);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
            return error.what();
        }
        return {};
    }
    TemporaryFolder folder_;
};

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    // The quaternions of the file are of single precision.
    EXPECT_LT(glm::length(a - b), 1e-6 * (1 + glm::length(b)))
        << fmt::format("{} {} {} is not {} {} {}", a.x, a.y, a.z, b.x, b.y, b.z);
}

/// Where the corners of a mesh are, by the instance of it that objects place.
std::vector<glm::dvec3> corners(const SceneDescription& scene, std::size_t mesh, double seconds) {
    const SceneDescription posed = pose_at(scene, seconds);
    const FlatGraph flat = flatten(build_graph(posed), mesh_bounds(posed));
    const auto placed = std::find_if(flat.instances.begin(), flat.instances.end(),
                                     [&](const FlatInstance& i) { return i.mesh == static_cast<int>(mesh); });
    std::vector<glm::dvec3> points = placed_points(posed.meshes[mesh]);
    for (glm::dvec3& p : points)
        p = flat.nodes[static_cast<std::size_t>(placed->node)].world(p);
    return points;
}

/// The box's corners are where `expected` takes those of its mesh, at several moments.
template <class Expected> void expect_corners(const SceneDescription& scene, Expected expected) {
    const std::vector<glm::dvec3> at_home = placed_points(scene.meshes[1]);
    ASSERT_EQ(at_home.size(), 8U);
    for (const double t : {0.0, 0.25, 0.5, 0.8, 1.0, 3.0}) {
        const std::vector<glm::dvec3> found = corners(scene, 1, t);
        for (std::size_t c = 0; c < at_home.size(); ++c)
            expect_near(found[c], expected(t, at_home[c]));
    }
}

TEST_F(NodeAttachments, BodiesGoWhereNodesGo) {
    const auto end = [](double t) { return std::min(t, 1.0); };
    expect_corners(scene(on("Arm")), [&](double t, const glm::dvec3& p) { return arm(end(t), p); });
    expect_corners(scene(on("Hook")), [&](double t, const glm::dvec3& p) { return hook(end(t), p); });
    expect_corners(scene(on("Hand")), [&](double t, const glm::dvec3& p) { return hand(end(t), p); });
    expect_corners(scene(on("Base")), [&](double, const glm::dvec3& p) { return p - glm::dvec3(0, 0, 1); });
}

/// What hangs on a joint by its inverse bind matrix is where the skin is that follows the joint alone.
TEST_F(NodeAttachments, JointsCarryAsTheyCarryTheirSkin) {
    const SceneDescription s = scene(
        "[[mesh]]\nname = \"crane\"\nfile = \"crane.glb\"\n[[mesh]]\nname = \"skin\"\n"
        "file = \"nameless.glb\"\n[[object]]\nmesh = \"crane\"\ntranslate = [0, 0, 5]\n[[object]]\nmesh = "
        "\"skin\"\nattach = \"crane\"\nnode = \"Hand\"\ntranslate = [0, -1, 0]\n");
    for (const double t : {0.0, 0.3, 1.0}) {
        const std::vector<glm::dvec3> skinned = corners(s, 0, t), carried = corners(s, 1, t);
        ASSERT_EQ(skinned.size(), carried.size());
        for (std::size_t c = 0; c < skinned.size(); ++c)
            EXPECT_LT(glm::length(skinned[c] - carried[c]), 1e-13);
    }
}

TEST_F(NodeAttachments, PlacesAndKeysOfBothCount) {
    const std::string keys = "[[object.key]]\ntime = 0\ntranslate = [0, 0, 0]\n[[object.key]]\ntime = 4\n"
                             "translate = [0, 8, 0]\n";
    const SceneDescription s = scene(on("Arm", "scale = 0.25\nrotate = [0, 0, 90]\ntranslate = [1, 0, 2]",
                                        "scale = 2\n" + keys, "rotate = [0, 0, 90]\n"));
    const auto placed = [](const glm::dvec3& p) { return glm::dvec3(1, 0, 2) + turned(1, 0.25 * p); };
    const auto back = [](const glm::dvec3& p) { return turned(-1, p - glm::dvec3(1, 0, 2)) / 0.25; };
    expect_corners(s, [&](double t, const glm::dvec3& p) {
        const double x = std::min(t, 1.0);
        return glm::dvec3(0, 2 * t, 0) + 2.0 * placed(arm(x, back(turned(1, p))));
    });
}

TEST_F(NodeAttachments, ClipsArePlayedAsThoseOfTheMesh) {
    const auto at = [&](std::string_view keys, double seconds) {
        return corners(scene(on("Hook", keys)), 1, seconds)[0];
    };
    const glm::dvec3 p = scene(on("Hook")).meshes[1].cage->points[0];
    expect_near(at("cycle = 2", 4.25), hook(0.25, p));
    expect_near(at("speed = 0.5\nstart = 0.2", 0.6), hook(0.5, p));
    expect_near(at("moment = 0.75", 9), hook(0.75, p));
    EXPECT_FALSE(is_animated(scene(on("Base", "moment = 0"))));
    EXPECT_FALSE(is_animated(scene(on("Arm", "moment = 0"))));
}

/// A node may move though nothing of the model's own does.
TEST_F(NodeAttachments, WhatHangsOnAMovingNodeMoves) {
    GltfWriter w = triangle();
    w.add("nodes", {{"name", "Ferry"}});
    w.add("nodes", {{"name", "Pier"}});
    w.json["scenes"][0]["nodes"] = {0, 1, 2};
    w.channel(1, "translation", {0, 2}, {0, 0, 0, 6, 0, 0}, 3);
    folder_.file("crane.glb", w.glb());
    const SceneDescription ferry = scene(on("Ferry"));
    EXPECT_FALSE(changes_shape(ferry.meshes[0]));
    EXPECT_TRUE(is_animated(ferry));
    EXPECT_FALSE(is_animated(scene(on("Pier"))));
    expect_corners(ferry,
                   [](double t, const glm::dvec3& p) { return p + glm::dvec3(3 * std::min(t, 2.0), 0, 0); });
}

/// By the clip of another file, of twice the size: all goes twice as far.
TEST_F(NodeAttachments, RetargetedNodesCarryToo) {
    const auto model = [](float bone, bool animated) {
        GltfWriter w = triangle();
        w.add("nodes", {{"name", "root"}, {"children", {2}}});
        w.add("nodes", {{"name", "tip"}, {"translation", {0, bone, 0}}});
        w.json["scenes"][0]["nodes"] = {0, 1};
        if (animated) {
            w.channel(1, "translation", {0, 1}, {0, 0, 0, 2, 0, 0}, 3);
            w.channel(1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, root_half, root_half}, 4);
        }
        return w;
    };
    folder_.file("crane.glb", model(2, false).glb());
    folder_.file("run.glb", model(1, true).glb());
    const SceneDescription s = scene(on("tip", "clip_file = \"run.glb\""));
    EXPECT_TRUE(is_animated(s));
    expect_corners(s, [](double t, const glm::dvec3& p) {
        const double x = std::min(t, 1.0);
        return glm::dvec3(4 * x, 0, 0) + turned(x, glm::dvec3(0, 2, 0) + p);
    });
}

TEST_F(NodeAttachments, PrintedAndReadTheyAreTheSame) {
    const SceneDescription s = scene(on("Hand", "cycle = 2", "scale = 2", "rotate = [0, 10, 0]"));
    for (const SceneDescription& d : {s, pose_at(s, 0.75)}) {
        const SceneDescription again = scene(to_toml(d));
        EXPECT_EQ(to_toml(again), to_toml(d));
        for (const double t : {0.0, 0.3, 1.5})
            EXPECT_EQ(corners(again, 1, t), corners(d, 1, t));
    }
}

/// A frame of a sequence is the one alone.
TEST_F(NodeAttachments, MovingScenesMoveThem) {
    const SceneDescription s =
        scene(on("Hook") + "[[object]]\nname = \"second\"\nmesh = \"box\"\nattach = \"crane\"\nnode = "
                           "\"Hand\"\ntranslate = [0, 0, 1]\n");
    MovingScene moving(s);
    for (const double t : {0.0, 0.5, 1.0, 2.5, 0.25}) {
        moving.go_to(t);
        EXPECT_EQ(to_toml(moving.description()), to_toml(pose_at(s, t))) << t;
        expect_same(moving.scene(), build_scene(pose_at(s, t)));
    }
    moving.go_to(2);
    EXPECT_EQ(moving.changes()->placements.size(), 2U);
    moving.go_to(3); // the clip has ended
    EXPECT_TRUE(moving.changes()->placements.empty());
}

TEST_F(NodeAttachments, MistakesAreNamed) {
    const auto expect = [&](const std::string& text, std::string_view part) {
        const std::string found = message(text);
        EXPECT_EQ(found.find("s.toml:"), 0U) << found;
        EXPECT_NE(found.find(part), std::string::npos) << found;
    };
    expect(on("Hnad"), "the model of 'crane' has no node 'Hnad'; did you mean 'Hand'? It has: Hip, ");
    expect(on("Elsewhere"), "has no node 'Elsewhere'"); // of another scene of the file
    expect(on("Twin"), "2 nodes of the model of 'crane' are called 'Twin'; rename them");
    expect(on("Flat"), "the axes of the node 'Flat' of 'crane' are flat or not finite 0 s after");
    expect(on("Leaf"), "the axes of the node 'Leaf' of 'crane' are flat or not finite 0 s after");
    for (const std::string_view node : {"Fading", "Ghost"})
        expect(on(node), fmt::format("the node '{}' of 'crane' are flat or not finite 0.5 s after", node));
    EXPECT_EQ(message(on("Fading", "moment = 0.25")), "");
    expect(on("Fading", "moment = 0.5"), "are flat or not finite 0.5 s after");
    expect(on(""), "the name of the node is empty");
    expect(on("Arm", "[[mesh.deform]]\nkind = \"wave\"\n"), "has deformations, which nodes do not follow");
    expect(on("Arm", "", "array = [2, 1, 1]\nspacing = [1, 0, 0]"), "'crane' is an array");
    expect(on("Arm", "", "attach = \"crane\"\nnode = \"Hand\""), "'crane' hangs on itself: crane on crane; ");
    expect(on("Arm", "", "attach = \"box\"\ntag = \"t\""), "'box' has no tags to attach to; name an object");
    expect(on("Arm", "", "attach = \"box\"\nnode = \"t\""),
           "'box' has no nodes to attach to; name an object");
    expect(on("Arm", "", "", "tag = \"t\""), "hangs on a tag or on a node, not on both");
    const auto replaced = [](std::string text, std::string_view what, std::string_view by) {
        return text.replace(text.find(what), what.size(), by);
    };
    expect(replaced(on("Arm"), "attach = \"crane\"", ""), "write attach and one of them, or nothing");
    expect(replaced(on("Arm"), "node = \"Arm\"", "tag = \"Arm\""),
           "'crane' has no tags to attach to; name one of its model's nodes, node = ");
    expect(replaced(on("Arm"), "crane.glb", "tags.md3"), "name one of its model's tags, tag = ");
    expect(replaced(on("Arm"), "crane.glb", "nameless.glb"),
           "'crane' has no nodes to attach to; name an object");
}

/// Between keys nobody looked: then it is that frame which cannot be made.
TEST_F(NodeAttachments, WhatIsFlatBetweenKeysIsToldInItsFrame) {
    const SceneDescription s = scene(on("Crossing"));
    const auto told = [](auto go) -> std::string {
        try {
            go();
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    };
    const std::string expected =
        "s: 0.5 s after the beginning 'box' hangs on the node 'Crossing' of 'crane', which is flat or "
        "not finite then; mend the scales of the model's animation";
    EXPECT_EQ(told([&] { pose_at(s, 0.5); }), expected);
    MovingScene moving(s);
    moving.go_to(0.25);
    EXPECT_EQ(told([&] { moving.go_to(0.5); }), expected);
    moving.go_to(0.75);
    EXPECT_EQ(to_toml(moving.description()), to_toml(pose_at(s, 0.75)));
}

} // namespace
} // namespace razor
