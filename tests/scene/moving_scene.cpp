// A scene that goes from moment to moment against the same scene posed by itself.
#include "tests/scene/same_scene.h"

#include "razor/scene/animation/moving_scene.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace razor {
namespace {

constexpr std::string_view text = R"(
    [animation]
    rate = 10
    [camera]
    position = [0, 0, 9]
    [[camera.key]]
    time = 0
    position = [0, 0, 9]
    [[camera.key]]
    time = 1
    position = [0, 3, 9]
    [[light]]
    corner = [0, 5, 0]
    [[light.key]]
    time = 0
    radiance = 1
    [[light.key]]
    time = 1
    radiance = 3
    [[mesh]]
    name = "floor"
    shape = "plane"
    [[mesh]]
    name = "a"
    shape = "box"
    [[mesh]]
    name = "flag"
    shape = "plane"
    [[mesh.deform]]
    kind = "wave"
    axis = [1, 0, 0]
    direction = [0, 1, 0]
    amount = 0.3
    wavelength = 0.7
    period = 1.7
    [[group]]
    name = "g"
    [[group.object]]
    mesh = "a"
    [[group.object]]
    mesh = "a"
    interpolation = "step"
    [[group.object.key]]
    time = 0
    translate = [3, 0, 0]
    [[group.object.key]]
    time = 0.5
    translate = [4, 0, 0]
    [[object]]
    mesh = "a"
    [[object]]
    group = "g"
    [[object.key]]
    time = 0
    rotate = [0, 0, 0]
    [[object.key]]
    time = 1
    rotate = [0, 90, 0]
    [[object]]
    mesh = "flag"
    translate = [0, 7, 0]
)";

TEST(MovingScene, IsThePosedSceneAtEachMoment) {
    const SceneDescription moving = parse_scene_file(text, "s.toml", {});
    MovingScene scene(moving);
    for (const int frame : {0, 1, 2, 2, 4, 5, 9, 3, 20, 21, 0}) {
        SCOPED_TRACE(frame);
        scene.go_to_frame(frame);
        const SceneDescription expected = pose_of_frame(moving, frame);
        EXPECT_EQ(to_toml(scene.description()), to_toml(expected));
        const Scene built = build_scene(expected);
        expect_same(scene.scene(), built);
        ASSERT_EQ(scene.scene().graph.groups.size(), built.graph.groups.size());
        for (std::size_t g = 0; g < built.graph.groups.size(); ++g) {
            const std::vector<Placement>& mine = scene.scene().graph.groups[g].placements;
            ASSERT_EQ(mine.size(), built.graph.groups[g].placements.size());
            for (std::size_t i = 0; i < mine.size(); ++i) {
                const Placement& placement = built.graph.groups[g].placements[i];
                EXPECT_EQ(mine[i].mesh, placement.mesh);
                EXPECT_EQ(mine[i].local.rotate, placement.local.rotate);
                EXPECT_EQ(mine[i].local.translate, placement.local.translate);
            }
        }
    }
}

TEST(MovingScene, NamesWhatIsOther) {
    MovingScene scene(parse_scene_file(text, "s.toml", {}));
    scene.go_to(0);
    EXPECT_EQ(scene.changes(), nullptr);
    const auto names = [&](double seconds) {
        scene.go_to(seconds);
        return *scene.changes();
    };
    const PlacementName turns{0, 2}, steps{1, 1}; // behind the floor, which no object places, and a box
    SceneChanges changes = names(0.25);
    EXPECT_EQ(changes.placements, std::vector{turns});
    EXPECT_EQ(changes.meshes, std::vector{2});
    EXPECT_EQ(scene.scene().graph.groups[0].placements[2].local.rotate.y, 22.5);
    changes = names(0.25);
    EXPECT_TRUE(changes.placements.empty());
    EXPECT_TRUE(changes.meshes.empty());
    changes = names(2); // at rest again but for what steps and waves
    EXPECT_EQ(changes.placements, (std::vector{turns, steps}));
    changes = names(3);
    EXPECT_TRUE(changes.placements.empty());
    EXPECT_EQ(changes.meshes, std::vector{2});
}

TEST(MovingScene, GoesOnAfterAnImpossibleMoment) {
    const SceneDescription moving =
        parse_scene_file("[[mesh]]\nname = \"a\"\nshape = \"box\"\n[[object]]\nmesh = \"a\"\n"
                         "[[object.key]]\ntime = 0\nscale = 1\n[[object.key]]\ntime = 4\n"
                         "scale = 2\n[camera]\nposition = [0, 0, 4]\n[[camera.key]]\ntime = 0\n"
                         "position = [0, 0, 4]\n[[camera.key]]\ntime = 2\nposition = [0, 0, -4]\n",
                         "s.toml", {});
    MovingScene scene(moving);
    scene.go_to(0);
    EXPECT_THROW(scene.go_to(1), UserError); // the camera is where it looks
    scene.go_to(2);
    EXPECT_EQ(scene.changes(), nullptr) << "of what was there before nobody knows";
    expect_same(scene.scene(), build_scene(pose_at(moving, 2)));
}

} // namespace
} // namespace razor
