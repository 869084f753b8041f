// MD3 and glTF models played by scene files.
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/models/md3_reader.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

namespace razor {
namespace {

class ModelsInMotion : public ::testing::Test {
protected:
    SceneDescription scene(const std::string& keys) const {
        return parse_scene_file("[[mesh]]\n" + keys, "s.toml", folder_.path());
    }
    std::string message(const std::string& keys) const {
        try {
            scene(keys);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }
    /// Printed and read again it is the same at all moments, and so are its poses.
    static void expect_prints(const SceneDescription& scene) {
        for (const SceneDescription& s : {scene, pose_at(scene, 0.75)}) {
            const SceneDescription again = parse_scene_file(to_toml(s), "t.toml", {});
            EXPECT_EQ(to_toml(again), to_toml(s));
            for (const double t : {0.0, 0.3, 0.75, 2.0})
                expect_same(build_scene(pose_at(again, t)), build_scene(pose_at(s, t)));
        }
    }

    TemporaryFolder folder_;
};

TEST_F(ModelsInMotion, Md3FramesArePlayed) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    for (Md3SurfaceData& s : surfaces) { // frames 2 and 3: twice and four times frame 1
        s.frame_steps.push_back(s.frame_steps[1]);
        s.frame_steps.push_back(s.frame_steps[1]);
        for (std::size_t f : {2U, 3U})
            for (auto& p : s.frame_steps[f])
                for (int& x : p)
                    x *= f == 2 ? 2 : 4;
    }
    const std::string bytes = write_md3(surfaces, 4);
    folder_.file("imp.MD3", bytes);
    const Md3Model model = parse_md3(bytes, "imp");
    const SceneDescription s = scene("file = \"imp.MD3\"\nframe_rate = 2\ncycle = 2\nspeed = 2\n");
    EXPECT_EQ(s.meshes[0].name, "imp");
    EXPECT_EQ(s.meshes[0].playback.frames, std::pair(0, 3));
    EXPECT_TRUE(is_animated(s));
    const auto points = [](const SceneDescription& d, double t) {
        return build_scene(pose_at(d, t)).meshes[0].points;
    };
    for (int n = 0; n < 9; ++n)
        EXPECT_EQ(points(s, n / 4.0), model.frames[static_cast<std::size_t>(n % 4)]) << n;
    EXPECT_EQ(points(s, 0.625)[0], 0.5 * (model.frames[2][0] + model.frames[3][0]));
    EXPECT_EQ(build_scene(pose_at(s, 0.625)).meshes[0].rest, model.cage.points);
    const SceneDescription part = scene("file = \"imp.MD3\"\nframes = [2, 3]\nframe_rate = 1\n");
    EXPECT_EQ(points(part, 0), model.frames[2]);
    EXPECT_EQ(points(part, 5), model.frames[3]);
    EXPECT_EQ(build_scene(pose_at(part, 0)).meshes[0].rest, model.cage.points);
    const SceneDescription still = scene("file = \"imp.MD3\"\nframes = [1, 1]\n");
    EXPECT_FALSE(is_animated(still));
    EXPECT_EQ(build_scene(still).meshes[0].points, model.frames[1]);
    for (const SceneDescription* d : {&s, &part, &still})
        expect_prints(*d);
    EXPECT_NE(message("file = \"imp.MD3\"\nframe_rate = 2\ninterpolation = \"smooth\"\ncycle = 1\n")
                  .find("frames 0 to 3, 2 a second, of which the last is at 1.5 s of a cycle of 1 s"),
              std::string::npos)
        << "of points and tags alike";
    EXPECT_NE(message("file = \"imp.MD3\"\nframes = [2, 4]\n")
                  .find("imp.MD3: has no frame 4; give frames from 0 to 3"),
              std::string::npos);
    EXPECT_NE(message("file = \"imp.MD3\"\nclip = \"run\"\n").find("clip in a mesh whose file has no clips"),
              std::string::npos);
}

TEST_F(ModelsInMotion, ClipsArePlayed) {
    GltfWriter w = triangle();
    w.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, 3);
    auto rise = w.json["animations"][0];
    rise["name"] = "rise";
    rise["samplers"][0]["output"] = w.floats({0, 0, 0, 0, 8, 0}, 3);
    w.json["animations"].push_back(rise);
    folder_.file("m.gltf", w.text());
    folder_.file("still.gltf", triangle().text());
    const auto corner = [](const SceneDescription& d, double t) {
        return build_scene(pose_at(d, t)).meshes[0].points[0];
    };
    const SceneDescription first = scene("file = \"m.gltf\"\n");
    EXPECT_EQ(first.meshes[0].playback.clip, "clip 0");
    EXPECT_EQ(corner(first, 0.25), glm::dvec3(0.25, 0, 0));
    const SceneDescription named = scene("file = \"m.gltf\"\nclip = \"rise\"\ncycle = 1\nstart = 0.5\n");
    EXPECT_TRUE(is_animated(named));
    EXPECT_EQ(corner(named, 0.25), glm::dvec3(0, 6, 0));
    EXPECT_EQ(corner(named, 0.75), glm::dvec3(0, 2, 0));
    // One file, two clips: nothing is mixed up by reading it once.
    const SceneDescription both =
        scene("file = \"m.gltf\"\nclip = \"rise\"\n[[mesh]]\nfile = \"m.gltf\"\n[[mesh]]\nfile = "
              "\"m.gltf\"\nclip = \"rise\"\nspeed = 0.5\n");
    EXPECT_EQ(build_scene(pose_at(both, 0.5)).meshes[0].points[0], glm::dvec3(0, 4, 0));
    EXPECT_EQ(build_scene(pose_at(both, 0.5)).meshes[1].points[0], glm::dvec3(0.5, 0, 0));
    EXPECT_EQ(build_scene(pose_at(both, 0.5)).meshes[2].points[0], glm::dvec3(0, 2, 0));
    EXPECT_EQ(both.meshes[0].motion, both.meshes[2].motion);
    EXPECT_FALSE(is_animated(scene("file = \"still.gltf\"\n")));
    for (const SceneDescription& d : {first, named, both, scene("file = \"still.gltf\"\n")})
        expect_prints(d);
    EXPECT_NE(
        message("file = \"m.gltf\"\nframes = [0, 1]\n").find("frames in a mesh whose file has no frames"),
        std::string::npos);
    EXPECT_NE(message("file = \"m.gltf\"\nclip = \"run\"\n").find("s.toml:3:"), std::string::npos);
    EXPECT_NE(message("file = \"m.gltf\"\nclip_file = \"none.glb\"\n").find("s.toml:3:"), std::string::npos);
}

} // namespace
} // namespace razor
