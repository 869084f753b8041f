// Cameras and lights of glTF files: where nodes put them and move them, units, and what is refused.
#include "razor/scene/animation/moving_scene.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <cmath>
#include <numbers>

namespace razor {
namespace {

using Json = GltfWriter::Json;

constexpr double pi = std::numbers::pi;
constexpr float root_half = 0.70710678F;

Json perspective(double yfov, double aspect = 0) {
    Json camera{{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}};
    if (aspect > 0)
        camera["perspective"]["aspectRatio"] = aspect;
    return camera;
}
Json orthographic(double xmag, double ymag) {
    return {{"type", "orthographic"},
            {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0.1}, {"zfar", 9}}}};
}
Json lit(int light) {
    return {{"KHR_lights_punctual", {{"light", light}}}};
}

class GltfStageTest : public ::testing::Test {
protected:
    /// The triangle of node 0; node 1, turned by 90 degrees about y and moved, carries node 2, which carries
    /// a camera and lamps.
    static GltfWriter writer() {
        GltfWriter w = triangle();
        w.add("nodes", {{"children", {2, 3, 4}},
                        {"rotation", {0, root_half, 0, root_half}},
                        {"translation", {5, 0, 0}}});
        w.add("nodes", {{"name", "View"}, {"camera", 0}, {"translation", {0, 1, 2}}, {"scale", {3, 3, 3}}});
        w.add("nodes", {{"name", "Lamp"}, {"extensions", lit(0)}, {"translation", {1, 0, 0}}});
        w.add("nodes", {{"extensions", lit(1)}, {"scale", {2, 2, 2}}});
        w.add("nodes",
              {{"name", "Sun"}, {"extensions", lit(2)}, {"rotation", {-root_half, 0, 0, root_half}}});
        w.json["scenes"][0]["nodes"] = {0, 1, 5};
        w.json["cameras"] = Json::array({perspective(pi / 3)});
        w.json["cameras"][0]["name"] = "Camera.001";
        w.json["extensionsUsed"] = {"KHR_lights_punctual"};
        w.json["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "point"},
             {"color", {1, 0.5, 0.25}},
             {"intensity", 683},
             {"name", "bulb"},
             {"range", 3}},
            {{"type", "spot"},
             {"intensity", 1366},
             {"spot", {{"innerConeAngle", pi / 12}, {"outerConeAngle", pi / 6}}}},
            {{"type", "directional"}, {"intensity", 341.5}}};
        return w;
    }
    std::filesystem::path write(const GltfWriter& w, const char* name = "m.glb") const {
        return folder_.file(name, w.glb());
    }
    SceneDescription scene(const std::string& text) const {
        return parse_scene_file("name = \"s\"\n" + text + "[[mesh]]\nshape = \"box\"\n", "s.toml",
                                folder_.path());
    }
    std::string message(const std::string& text) const {
        try {
            pose_at(scene(text), 0);
        } catch (const UserError& error) {
            const std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            EXPECT_NE(what.find(';'), std::string::npos) << what;
            return what;
        }
        return {};
    }
    static void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(a[axis], b[axis], tolerance) << axis;
    }
    static glm::dvec3 view(const Camera& c) { return glm::normalize(c.target - c.position); }

    TemporaryFolder folder_;
};

TEST_F(GltfStageTest, BareModelsShowWhatTheyBring) {
    const SceneDescription d = describe(write(writer()), {});
    const Scene s = build_scene(pose_at(d, 0));
    // A turn by 90 degrees about y takes (x, y, z) to (z, y, -x).
    expect_near(s.camera.position, {5 + 2, 1, 0});
    expect_near(view(s.camera), {-1, 0, 0});
    expect_near(s.camera.up, {0, 1, 0});
    EXPECT_NEAR(s.camera.fov_degrees, 60, 1e-9);
    EXPECT_EQ(s.camera.aperture_radius, 0);
    ASSERT_EQ(s.lights.size(), 3U);
    EXPECT_EQ(s.lights[0].kind, LightKind::directional) << "nearest to the root";
    expect_near(s.lights[0].direction, {0, -1, 0});
    EXPECT_EQ(s.lights[0].radiance, glm::vec3(0.5F));
    EXPECT_EQ(s.lights[0].angular_radius, 0);
    EXPECT_EQ(s.lights[1].kind, LightKind::point);
    expect_near(s.lights[1].position, {5, 0, -1});
    EXPECT_EQ(s.lights[1].radiance, glm::vec3(1, 0.5F, 0.25F)) << "683 cd are 1 W / sr";
    EXPECT_EQ(s.lights[2].kind, LightKind::spot);
    expect_near(s.lights[2].position, {5, 0, 0});
    expect_near(s.lights[2].direction, {-1, 0, 0});
    EXPECT_NEAR(s.lights[2].cone_angle, 30, 1e-9);
    EXPECT_NEAR(s.lights[2].cone_delta, 15, 1e-9);
    EXPECT_EQ(s.lights[2].radiance, glm::vec3(2)) << "a node's scale does not change it";
    EXPECT_EQ(s.sky, glm::vec3(0));
    EXPECT_EQ(s.meshes.size(), 1U) << "no floor";
    expect_same(build_scene(pose_at(parse_scene_file(to_toml(d), "t", {}), 0)), s);
    expect_same(build_scene(parse_scene_file(to_toml(pose_at(d, 0)), "t", {})), s);
}

TEST_F(GltfStageTest, WhatAModelLacksIsPlaced) {
    const Scene bare = load_scene(write(triangle(), "a.glb"));
    GltfWriter w = writer();
    for (auto& node : w.json["nodes"])
        node.erase("extensions");
    const Scene camera = load_scene(write(w, "b.glb"));
    EXPECT_NEAR(camera.camera.fov_degrees, 60, 1e-9);
    EXPECT_EQ(camera.sky, bare.sky);
    ASSERT_EQ(camera.lights.size(), 1U);
    EXPECT_EQ(camera.lights[0].kind, LightKind::rectangle);
    w = writer();
    w.json["nodes"][2].erase("camera");
    const Scene lights = load_scene(write(w, "c.glb"));
    EXPECT_EQ(lights.lights.size(), 3U);
    expect_same(lights.camera, bare.camera);
    EXPECT_EQ(lights.meshes.size(), 2U) << "a floor where the camera is placed";
    w = writer(); // nothing that the scene shows
    w.json["scenes"][0]["nodes"] = {0};
    const Scene hidden = load_scene(write(w, "d.glb"));
    EXPECT_EQ(hidden.camera.fov_degrees, bare.camera.fov_degrees);
    EXPECT_EQ(hidden.lights[0].kind, LightKind::rectangle);
}

TEST_F(GltfStageTest, UpAxesTurnWhatModelsBring) {
    FramingOptions options;
    options.up = Up::z;
    const Scene s = build_scene(pose_at(describe(write(writer()), options), 0));
    expect_near(s.camera.position, {7, 0, -1});
    expect_near(s.camera.up, {0, 0, -1});
    expect_near(s.lights[0].direction, {0, 0, 1});
}

TEST_F(GltfStageTest, ScenesTakeThemFromFiles) {
    write(writer());
    const SceneDescription d =
        scene("[camera]\nfrom = \"m.glb\"\nscale = 2.0\ntranslate = [0.0, 0.0, 3.0]\n"
              "rotate = [0.0, 0.0, 90.0]\naperture_radius = 0.125\nfocus_distance = 9.0\n"
              "[[light]]\nkind = \"point\"\n"
              "[[light]]\nfrom = \"m.glb\"\nscale = 2.0\nlumens_per_watt = 1.0\n"
              "[[light]]\nkind = \"sphere\"\n"
              "[[light]]\nfrom = \"m.glb\"\nname = \"Lamp\"\n");
    const Scene s = build_scene(pose_at(d, 0));
    expect_near(s.camera.position, {-2, 14, 3});
    expect_near(view(s.camera), {0, -1, 0});
    expect_near(s.camera.up, {-1, 0, 0});
    EXPECT_EQ(s.camera.aperture_radius, 0.125);
    EXPECT_EQ(s.camera.focus_distance, 9);
    ASSERT_EQ(s.lights.size(), 6U);
    EXPECT_EQ(s.lights[0].kind, LightKind::point);
    EXPECT_EQ(s.lights[1].radiance, glm::vec3(341.5F)) << "irradiance does not grow with the scene";
    EXPECT_EQ(s.lights[2].radiance.x, 4 * 683.0F);
    expect_near(s.lights[2].position, {10, 0, -2});
    EXPECT_EQ(s.lights[3].radiance.x, 4 * 1366.0F);
    EXPECT_EQ(s.lights[4].kind, LightKind::sphere);
    EXPECT_EQ(s.lights[5].radiance, glm::vec3(1, 0.5F, 0.25F));
    for (const SceneDescription& printed : {d, pose_at(d, 1)}) {
        const SceneDescription again = parse_scene_file(to_toml(printed), "t", {});
        EXPECT_EQ(to_toml(again), to_toml(printed));
        expect_same(build_scene(pose_at(again, 0)), s);
    }
    EXPECT_EQ(build_scene(scene("[[light]]\nfrom = \"m.glb\"\nname = \"bulb\"\n")).lights.size(), 1U)
        << "by the light's own name, too";
}

TEST_F(GltfStageTest, CamerasAreChosenByName) {
    GltfWriter w = writer();
    w.json["cameras"].push_back(perspective(0.5));
    w.json["cameras"].push_back(orthographic(1, 1));
    w.json["nodes"][0]["camera"] = 2;
    w.json["nodes"][0]["name"] = "Plan";
    w.json["nodes"][5]["camera"] = 1;
    write(w);
    const auto fov = [&](const std::string& name) {
        return pose_at(scene("[camera]\nfrom = \"m.glb\"\n" + name), 0).camera.fov_degrees;
    };
    EXPECT_NEAR(fov("name = \"Sun\"\n"), 0.5 * 180 / pi, 1e-9);
    EXPECT_NEAR(fov("name = \"View\"\n"), 60, 1e-9);
    EXPECT_NEAR(fov("name = \"Camera.001\"\n"), 60, 1e-9);
    for (const char* const name : {"", "name = \"Plan\"\n"})
        EXPECT_EQ(pose_at(scene(std::string("[camera]\nfrom = \"m.glb\"\n") + name), 0).camera.projection,
                  Projection::orthographic)
            << "the first, node by node from the root";
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\nname = \"x\"\n").find("s.toml:4:8: "), std::string::npos);
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\nname = \"x\"\n")
                  .find("no camera is named 'x'; there are: Plan, Sun, View"),
              std::string::npos);
    EXPECT_NE(message("[[light]]\nfrom = \"m.glb\"\nname = \"x\"\n")
                  .find("no light is named 'x'; there are: Sun, Lamp, light of node 4"),
              std::string::npos);
    EXPECT_EQ(message("[[light]]\nfrom = \"m.glb\"\nname = \"light of node 4\"\n"), "") << "as it is called";
}

/// What the camera shows is seen in pictures of any shape.
TEST_F(GltfStageTest, NarrowPicturesAreWidened) {
    GltfWriter w = writer();
    w.json["cameras"][0] = perspective(pi / 3, 1.5);
    write(w);
    const auto half = [&](int width, int height) {
        SceneDescription d = scene("[camera]\nfrom = \"m.glb\"\n");
        d.settings.width = width;
        d.settings.height = height;
        return std::tan(0.5 * pi / 180 * pose_at(d, 0).camera.fov_degrees);
    };
    const double stated = std::tan(pi / 6);
    EXPECT_NEAR(half(300, 200), stated, 1e-12);
    EXPECT_NEAR(half(900, 200), stated, 1e-12) << "more is seen at the sides";
    EXPECT_NEAR(half(300, 400), 2 * stated, 1e-12) << "as wide as before";
}

/// xmag and ymag are halves of what is seen (glTF 2.0, 3.10.3.4), which the node's scale of 3 does not
/// change.
TEST_F(GltfStageTest, OrthographicCamerasShowTwiceTheirMagnifications) {
    GltfWriter w = writer();
    w.json["cameras"][0] = orthographic(3, 2);
    w.channel(1, "translation", {0, 2}, {5, 0, 0, 9, 0, 0}, 3);
    const std::string path = write(w);
    const auto height = [&](int width, int rows) {
        SceneDescription d = scene("[camera]\nfrom = \"m.glb\"\nscale = 2.0\n");
        d.settings.width = width;
        d.settings.height = rows;
        return pose_at(d, 0).camera.height;
    };
    EXPECT_EQ(height(300, 200), 8);
    EXPECT_EQ(height(900, 200), 8) << "more is seen at the sides";
    EXPECT_EQ(height(300, 400), 16) << "as wide as before";
    const SceneDescription bare = describe(path, {});
    EXPECT_TRUE(is_animated(bare));
    const SceneDescription stated = scene("[camera]\nfrom = \"m.glb\"\n");
    for (const SceneDescription& d : {bare, stated}) {
        const SceneDescription again = parse_scene_file(to_toml(d), "t", {});
        EXPECT_EQ(to_toml(again), to_toml(d));
        for (const double t : {0.0, 1.0}) {
            const Scene s = build_scene(pose_at(d, t));
            EXPECT_EQ(s.camera.projection, Projection::orthographic);
            EXPECT_DOUBLE_EQ(
                s.camera.height * s.settings.width / s.settings.height,
                s.settings.width > 1.5 * s.settings.height ? 4.0 * s.settings.width / s.settings.height : 6);
            expect_near(s.camera.position, {7 + 2 * t, 1, 0});
            expect_near(view(s.camera), {-1, 0, 0});
            expect_near(s.camera.up, {0, 1, 0});
            EXPECT_EQ(s.camera.aperture_radius, 0);
            expect_same(build_scene(pose_at(again, t)), s);
            expect_same(build_scene(parse_scene_file(to_toml(pose_at(d, t)), "t", {})), s);
        }
    }
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\naperture_radius = 0.5\n")
                  .find("camera.aperture_radius is of a perspective camera"),
              std::string::npos);
}

TEST_F(GltfStageTest, MoveWithTheirNodes) {
    GltfWriter w = writer();
    w.channel(1, "translation", {0, 2}, {5, 0, 0, 9, 0, 0}, 3);
    w.channel(1, "rotation", {0, 2}, {0, root_half, 0, root_half, 0, 1, 0, 0}, 4);
    auto& other = w.json["animations"].emplace_back(w.json["animations"][0]);
    other["name"] = "rise";
    other["channels"] = {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "translation"}}}}};
    const SceneDescription bare = describe(write(w), {});
    EXPECT_TRUE(is_animated(bare));
    // Half-way, by 135 degrees about y: (x, y, z) becomes ((z - x) c, y, (-x - z) c).
    const double c = std::sqrt(0.5);
    for (const SceneDescription& d : {bare, parse_scene_file(to_toml(bare), "t", {})}) {
        MovingScene moving(d);
        for (const double t : {2.0, 1.0, 0.0, 1.0})
            moving.go_to(t);
        const Scene& s = moving.scene();
        expect_near(s.camera.position, {7 + 2 * c, 1, -2 * c});
        expect_near(view(s.camera), {-c, 0, c});
        expect_near(s.lights[1].position, {7 - c, 0, -c});
        expect_near(s.lights[2].direction, {-c, 0, c});
        expect_near(s.lights[0].direction, {0, -1, 0});
        expect_same(s, build_scene(pose_at(d, 1)));
    }
    const std::string camera = "[camera]\nfrom = \"m.glb\"\n", light = "[[light]]\nfrom = \"m.glb\"\n";
    EXPECT_TRUE(is_animated(scene(camera)));
    EXPECT_TRUE(is_animated(scene(light)));
    EXPECT_FALSE(is_animated(scene(light + "name = \"Sun\"\n")));
    EXPECT_FALSE(is_animated(scene(camera + "moment = 1.0\n" + light + "moment = 1.0\n")));
    EXPECT_FALSE(is_animated(scene(camera + "clip = \"rise\"\n")));
    const auto at = [&](const std::string& keys, double t) {
        return pose_at(scene(camera + keys), t).camera.position;
    };
    expect_near(at("moment = 1.0\n", 7), {7 + 2 * c, 1, -2 * c});
    expect_near(at("start = 0.5\nspeed = 0.25\n", 2), {7 + 2 * c, 1, -2 * c});
    expect_near(at("cycle = 4.0\n", 5), {7 + 2 * c, 1, -2 * c});
    expect_near(at("cycle = 4.0\n", 3), {9, 1, -2});
    expect_near(pose_at(scene(light + "clip = \"rise\"\nname = \"Lamp\"\n"), 1).lights[0].position,
                {5, 0, -7});
    const SceneDescription printed = scene(camera + light + "clip = \"rise\"\nstart = 0.25\n");
    const SceneDescription again = parse_scene_file(to_toml(printed), "t", {});
    EXPECT_EQ(to_toml(again), to_toml(printed));
    for (const double t : {0.0, 0.7, 3.0})
        expect_same(build_scene(pose_at(again, t)), build_scene(pose_at(printed, t)));
}

TEST_F(GltfStageTest, FilesWithoutTrianglesWillDo) {
    GltfWriter w = writer();
    w.json["nodes"][0].erase("mesh");
    write(w);
    EXPECT_NEAR(scene("[camera]\nfrom = \"m.glb\"\n").camera.fov_degrees, 60, 1e-9);
}

TEST_F(GltfStageTest, RefusesClearly) {
    using Change = void (*)(GltfWriter&);
    static const auto light = [](GltfWriter& w, int n) -> Json& {
        return w.json["extensions"]["KHR_lights_punctual"]["lights"][static_cast<std::size_t>(n)];
    };
    const std::pair<Change, const char*> cases[] = {
        {[](GltfWriter& w) { w.json["nodes"][2]["camera"] = 1; },
         "node 2 names camera 1, but the file has 1"},
        {[](GltfWriter& w) { w.json["nodes"][2]["camera"] = "x"; },
         "node 2 has camera \"x\", which is no index"},
        {[](GltfWriter& w) { w.json["nodes"][3]["extensions"] = lit(3); },
         "node 3 names light 3, but the file has 3"},
        {[](GltfWriter& w) { w.json.erase("extensions"); }, "names light 2, but the file has 0"},
        {[](GltfWriter& w) { w.json["nodes"][3]["extensions"] = 7; }, "node 3 extensions is no object"},
        {[](GltfWriter& w) { w.json["cameras"] = 7; }, "names camera 0, but the file has 0"},
        {[](GltfWriter& w) { w.json["cameras"][0]["type"] = "fisheye"; }, "camera 0 is of type 'fisheye'"},
        {[](GltfWriter& w) { w.json["cameras"][0]["perspective"].erase("yfov"); },
         "camera 0 perspective has no yfov"},
        {[](GltfWriter& w) { w.json["cameras"][0] = perspective(3.2); }, "has no yfov between 0 and pi"},
        {[](GltfWriter& w) { w.json["cameras"][0] = perspective(-1); }, "has no yfov between 0 and pi"},
        {[](GltfWriter& w) {
             w.json["cameras"][0] = {{"type", "orthographic"}};
         },
         "camera 0 orthographic has no xmag above 0"},
        {[](GltfWriter& w) { w.json["cameras"][0] = orthographic(1, 0); },
         "camera 0 orthographic has no ymag above 0"},
        {[](GltfWriter& w) { w.json["cameras"][0] = orthographic(-1, 1); }, "has no xmag above 0"},
        {[](GltfWriter& w) { w.json["cameras"][0] = orthographic(1, 1e30); },
         "high, which is not from 1e-30 to 1e+30; mend its scale"},
        {[](GltfWriter& w) { light(w, 0)["type"] = "area"; }, "light 0 is of type 'area'"},
        {[](GltfWriter& w) {
             light(w, 0)["color"] = {1, 1};
         },
         "which is not of 3 numbers"},
        {[](GltfWriter& w) { light(w, 0)["intensity"] = "much"; },
         "has intensity \"much\", which is no number"},
        {[](GltfWriter& w) { light(w, 1)["spot"]["outerConeAngle"] = 0; }, "outerConeAngle of 0"},
        {[](GltfWriter& w) {
             w.json["nodes"][2]["scale"] = {0, 0, 0};
         },
         "the node of the camera has no direction"},
        {[](GltfWriter& w) {
             w.json["nodes"][1]["translation"] = {1e31, 0, 0};
         },
         "lies beyond 1e+30"},
    };
    for (const auto& [change, cause] : cases) {
        GltfWriter w = writer();
        change(w);
        write(w);
        const std::string found = message("[camera]\nfrom = \"m.glb\"\n[[light]]\nfrom = \"m.glb\"\n");
        EXPECT_NE(found.find(cause), std::string::npos) << cause << "\n" << found;
        EXPECT_NE(found.find("m.glb: "), std::string::npos) << found;
    }
    write(triangle());
    folder_.file("o.obj", "v 0 0 0\n");
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\n").find("its scene has no camera; give"),
              std::string::npos);
    EXPECT_NE(message("[[light]]\nfrom = \"m.glb\"\n").find("its scene has no light; give"),
              std::string::npos);
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\nclip = \"x\"\n").find("no animation is named 'x'"),
              std::string::npos);
    EXPECT_NE(message("[camera]\nfrom = \"o.obj\"\n").find("'o.obj' brings no camera"), std::string::npos);
    EXPECT_NE(message("[camera]\nfrom = \"n.glb\"\n").find("no such file"), std::string::npos);
    write(writer());
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\nfov = 40.0\n").find("camera.fov"), std::string::npos);
    EXPECT_NE(message("[[light]]\nfrom = \"m.glb\"\nkind = \"point\"\n").find("light.kind"),
              std::string::npos);
    EXPECT_NE(message("[camera]\nfrom = \"m.glb\"\nstart = 1.0\nmoment = 1.0\n").find("leave one out"),
              std::string::npos);
}

} // namespace
} // namespace razor
