// Animations of glTF files beside closed forms.
#include "razor/scene/error.h"
#include "razor/scene/models/gltf_reader.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor {
namespace {

constexpr float root_half = 0.70710678F;
constexpr double single = 1e-6; // what is stored in single precision

GltfModel read(const GltfWriter& writer, const std::string& clip = "", double cycle = 0) {
    const TemporaryFolder folder;
    return read_gltf(folder.file("m.gltf", writer.text()), clip, cycle);
}

void expect_points(const Mesh& mesh, const std::vector<glm::dvec3>& expected, double tolerance = single) {
    ASSERT_EQ(mesh.points.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(mesh.points[i][axis], expected[i][axis], tolerance) << i << " " << axis;
}

TEST(GltfMotion, NodesTakeTheirMeshesAlong) {
    GltfWriter w = triangle();
    w.json["nodes"][0]["translation"] = {0, 0, 7};
    w.add("nodes", {{"children", {0}}, {"scale", {2, 1, 1}}});
    w.json["scenes"][0]["nodes"] = {1};
    w.channel(0, "translation", {1, 3}, {0, 0, 0, 4, 0, 0}, 3);
    w.channel(1, "rotation", {1, 3}, {0, 0, 0, 1, 0, 0, -root_half, -root_half}, 4); // 90 degrees
    const GltfModel model = read(w);
    expect_points(*model.cage, {{0, 0, 7}, {2, 0, 7}, {0, 1, 7}});
    ASSERT_TRUE(model.motion);
    EXPECT_EQ(model.motion->length(), 3);
    EXPECT_EQ(model.clips, std::vector<std::string>{"clip 0"});
    expect_points(*model.motion->at(0), {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
    const double c = std::sqrt(0.5); // half-way: 2 to the right, turned by 45 degrees
    expect_points(*model.motion->at(2), {{4 * c, 4 * c, 0}, {6 * c, 6 * c, 0}, {4 * c - c, 4 * c + c, 0}});
    expect_points(*model.motion->at(99), {{0, 8, 0}, {0, 10, 0}, {-1, 8, 0}});
    EXPECT_EQ(model.motion->at(2)->rest, model.cage->points);
    EXPECT_EQ(model.motion->at(2)->face_vertices, model.cage->face_vertices);
    EXPECT_TRUE(model.cage->rest.empty());
}

/// A strip of 2 by 3 points along y, bound to a shoulder at the origin and an elbow at (0, 1, 0); the middle
/// follows both.
GltfWriter arm() {
    GltfWriter w;
    const int points = w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0}, 3);
    const int joints = w.accessor<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, //
                                                 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0},
                                                4);
    // The sums are 1, 2, 4, 4, 0.5 and 1.
    const int weights =
        w.floats({1, 0, 0, 0, 2, 0, 0, 0, 2, 2, 0, 0, 2, 2, 0, 0, 0.5F, 0, 0, 0, 0, 1, 0, 0}, 4);
    const int indices = w.accessor<std::uint16_t>({0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4}, 1);
    const int bind = w.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1, //
                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                              16);
    w.add("meshes", {{"primitives",
                      {{{"attributes", {{"POSITION", points}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                        {"indices", indices}}}}});
    w.add("nodes", {{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}, {"scale", {-1, 1, 1}}});
    w.add("nodes", {{"children", {2}}});
    w.add("nodes", {{"translation", {0, 1, 0}}});
    w.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
    w.json["scenes"][0]["nodes"] = {0, 1};
    return w;
}

TEST(GltfMotion, AnArmBends) {
    GltfWriter w = arm();
    w.channel(2, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, root_half, root_half}, 4);
    const GltfModel model = read(w);
    // The node that has the mesh is 100 to the right and mirrored: that counts for nothing.
    expect_points(*model.cage, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 2, 0}, {0, 2, 0}});
    EXPECT_EQ(model.cage->face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5}));
    // Bent by 90 degrees about (0, 1, 0): (x, y) of the lower arm becomes (1 - y, 1 + x).
    expect_points(*model.motion->at(1),
                  {{0, 0, 0}, {1, 0, 0}, {0.5, 1.5, 0}, {0, 1, 0}, {-1, 2, 0}, {-1, 1, 0}});
}

TEST(GltfMotion, InverseBindMatricesMayBeLeftOut) {
    GltfWriter w = arm();
    w.json["skins"][0].erase("inverseBindMatrices");
    expect_points(*read(w).cage, {{0, 0, 0}, {1, 0, 0}, {1, 1.5, 0}, {0, 1.5, 0}, {1, 3, 0}, {0, 3, 0}});
}

TEST(GltfMotion, AllSetsOfWeightsCount) {
    GltfWriter w = triangle();
    const int zeros = w.accessor(std::vector<std::uint16_t>(12, 0), 4);
    const int ones = w.accessor(std::vector<std::uint16_t>(12, 1), 4);
    const std::vector<std::uint8_t> quarter{64, 0, 0, 0, 64, 0, 0, 0, 64, 0, 0, 0},
        rest{191, 0, 0, 0, 191, 0, 0, 0, 191, 0, 0, 0};
    auto& attributes = w.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = zeros;
    attributes["WEIGHTS_0"] = w.accessor(quarter, 4, true);
    attributes["JOINTS_1"] = ones;
    attributes["WEIGHTS_1"] = w.accessor(rest, 4, true);
    w.json["nodes"][0]["skin"] = w.add("skins", {{"joints", {1, 2}}});
    w.add("nodes", {{"translation", {255, 0, 0}}});
    w.add("nodes", {{"translation", {0, 255, 0}}});
    expect_points(*read(w).cage, {{64, 191, 0}, {65, 191, 0}, {64, 192, 0}}, 1e-12);
}

TEST(GltfMotion, MorphTargetsAreAddedBeforeSkinning) {
    GltfWriter w = triangle();
    w.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", w.floats({0, 0, 2, 0, 0, 0, 0, 0, 0}, 3)}},
        {{"POSITION", w.floats({0, 0, 0, 4, 0, 0, 0, 0, 0}, 3)}}};
    w.json["meshes"][0]["weights"] = {0.5, 0};
    w.channel(0, "weights", {0, 2}, {0, 0, 1, -1}, 1);
    w.json["nodes"][0]["scale"] = {10, 1, 1};
    GltfModel model = read(w);
    expect_points(*model.cage, {{0, 0, 1}, {10, 0, 0}, {0, 1, 0}});
    expect_points(*model.motion->at(1), {{0, 0, 1}, {-10, 0, 0}, {0, 1, 0}});
    w.json["nodes"][0]["weights"] = {0, 1}; // instead of the mesh's
    expect_points(*read(w).cage, {{0, 0, 0}, {50, 0, 0}, {0, 1, 0}});
}

TEST(GltfMotion, StepsAndCubicSplines) {
    GltfWriter w = triangle();
    w.channel(0, "translation", {0, 1, 2}, {0, 0, 0, 5, 0, 0, 6, 0, 0}, 3, "STEP");
    w.channel(0, "scale", {0, 2}, {9, 9, 9, 1, 1, 1, 2, 0, 0, -1, 0, 0, 3, 1, 1, 9, 9, 9}, 3, "CUBICSPLINE");
    const auto motion = read(w).motion;
    EXPECT_EQ(motion->at(0.999)->points[0].x, 0);
    EXPECT_EQ(motion->at(1)->points[0].x, 5);
    // Half-way: mean of the values 1 and 3, and (slope in - slope out) times length / 8.
    EXPECT_NEAR(motion->at(1)->points[1].x - 5, 2 + (2 - -1) * 2.0 / 8, single);
}

TEST(GltfMotion, IsAFunctionOfTimeThatCycles) {
    GltfWriter w = arm();
    w.channel(2, "rotation", {0, 1, 2}, {0, 0, 0, 1, 0, 0, root_half, root_half, 0.6F, 0, 0, 0.8F}, 4);
    const auto once = read(w).motion, cyclic = read(w, "", 4).motion;
    for (const double t : {0.0, 0.25, 1.0, 1.75, 3.5}) {
        const auto pose = cyclic->at(t);
        cyclic->at(0.123);
        EXPECT_EQ(pose->points, cyclic->at(t)->points);
        EXPECT_EQ(pose->points, once->at(t)->points);
        for (const int turns : {-2, 1, 5})
            EXPECT_EQ(pose->points, cyclic->at(t + 4 * turns)->points);
    }
    EXPECT_EQ(once->at(400)->points, once->at(2)->points);
    EXPECT_NE(cyclic->at(400)->points, once->at(2)->points);
    EXPECT_THROW(read(w, "", -1), UserError);
}

TEST(GltfMotion, ClipsAreChosenByName) {
    GltfWriter w = triangle();
    EXPECT_FALSE(read(w).motion);
    EXPECT_THROW(read(w, "walk"), UserError);
    w.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, 3);
    auto walk = w.json["animations"][0];
    walk["name"] = "walk";
    walk["samplers"][0]["interpolation"] = "STEP";
    w.json["animations"].push_back(walk);
    w.add("nodes", {{"name", "another"}});
    w.json["animations"].push_back(walk);
    w.json["animations"][2]["name"] = "elsewhere";
    w.json["animations"][2]["channels"][0]["target"]["node"] = 1;
    const GltfModel model = read(w, "walk");
    EXPECT_EQ(model.clips, (std::vector<std::string>{"clip 0", "walk", "elsewhere"}));
    EXPECT_EQ(model.motion->at(0.5)->points[0].x, 0);
    EXPECT_EQ(read(w).motion->at(0.5)->points[0].x, 0.5);
    EXPECT_EQ(read(w, "clip 0").motion->at(0.5)->points[0].x, 0.5);
    EXPECT_FALSE(read(w, "elsewhere").motion) << "moves nothing of the cage";
    try {
        read(w, "run");
        ADD_FAILURE();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("m.gltf: no animation is named 'run'; there are: clip 0, walk, elsewhere"),
                  std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace razor
