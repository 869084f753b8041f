// Levels of detail that pixels show, by what their distance asks for.
#include "tests/kernels/cages.h"
#include "tests/survey/reference.h"

#include "razor/frame/view.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace razor::test {
namespace {

/// A torus that reaches from near the camera to far away, fine enough for all of it.
Scene long_torus(Lod lod) {
    Mesh mesh = torus_cage(12, 8);
    for (glm::dvec3& p : mesh.points)
        p.z *= 12;
    Scene scene = scene_of(mesh, 800);
    scene.settings.lod = lod;
    scene.settings.width = scene.settings.height = 40;
    scene.camera.position = {0.6, 2.2, 15};
    scene.camera.target = {0, 0, 4};
    return scene;
}

struct Tally {
    int hits = 0, as_asked = 0;
    std::set<float> levels;
};

/// Nothing is coarser than asked for, nor finer than the instance has.
Tally expect_levels(const Scene& scene) {
    const RenderResult r = surveyed(scene, layers({LayerGroup::lod, LayerGroup::pick}));
    const Pixels at(r.film, scene.settings);
    const Camera& dicing = dicing_camera(scene);
    const CameraField field = camera_field(dicing, scene.settings);
    const View view = view_of(dicing);
    Tally tally;
    for (int y = 0; y < scene.settings.height; ++y)
        for (int x = 0; x < scene.settings.width; ++x) {
            SCOPED_TRACE(testing::Message() << x << ' ' << y);
            const double distance = at("pick.Z", x, y);
            const double level = at("lod.level", x, y), depth = at("lod.depth", x, y);
            if (!std::isfinite(distance)) {
                EXPECT_EQ(level, std::numeric_limits<float>::infinity());
                EXPECT_EQ(depth, -1);
                continue;
            }
            // Levels are the nearest in the logarithm: edges from 2^(k - 1/2) to 2^(k + 1/2).
            const glm::dvec3 way =
                start_of(scene, x, y) + way_through(scene, x, y) * distance - dicing.position;
            const double blur = field.base + field.slope * glm::dot(view.forward, way);
            const double asked = std::log2(std::sqrt(2) * (std::abs(blur) + field.growth * glm::length(way)));
            EXPECT_NEAR(at("lod.asked", x, y), asked, 1e-4);
            if (depth > 0) {
                EXPECT_LE(level, std::floor(asked + 1e-4));
            }
            ++tally.hits;
            tally.as_asked += level == std::floor(asked) ? 1 : 0;
            tally.levels.insert(static_cast<float>(level));
        }
    return tally;
}

TEST(Levels, FollowTheDistance) {
    for (const Lod lod : {Lod::recursive, Lod::discrete, Lod::camera, Lod::patch}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(lod));
        const Tally tally = expect_levels(long_torus(lod));
        EXPECT_GE(tally.hits, 150);
        // What shares a leaf with finer parts is finer, and all of a patch is where it has one level.
        EXPECT_GE(tally.as_asked, tally.hits / (lod == Lod::patch ? 8 : 3));
        EXPECT_GE(tally.levels.size(), 3U);
    }
}

TEST(Levels, FollowTheCircleOfConfusionOfALens) {
    Scene scene = long_torus(Lod::recursive);
    scene.camera.aperture_radius = 0.2;
    scene.camera.focus_distance = 10;
    const Tally tally = expect_levels(scene);
    EXPECT_GE(tally.hits, 150);
}

TEST(Levels, AreTheSameEverywhereForAnOrthographicCamera) {
    Scene scene = long_torus(Lod::discrete);
    scene.camera.projection = Projection::orthographic;
    scene.camera.height = 4;
    const Tally tally = expect_levels(scene);
    EXPECT_GE(tally.hits, 150);
    EXPECT_EQ(tally.as_asked, tally.hits);
}

TEST(Levels, AreMeasuredFromTheDicingCamera) {
    Scene scene = long_torus(Lod::recursive);
    scene.dicing_camera = scene.camera;
    scene.dicing_camera->position = {3, 1, -20};
    const Tally tally = expect_levels(scene);
    EXPECT_GE(tally.hits, 150);
    EXPECT_GE(tally.as_asked, tally.hits / 3);
}

TEST(Levels, AreTheFinestWhereAllRaysAskForIt) {
    const Scene scene = long_torus(Lod::object);
    const RenderResult r = surveyed(scene, layers({LayerGroup::lod}));
    const std::vector<float>& depth = r.film.find("lod.depth")->values;
    EXPECT_EQ(std::count(depth.begin(), depth.end(), 0.0F) + std::count(depth.begin(), depth.end(), -1.0F),
              static_cast<std::ptrdiff_t>(depth.size()));
    EXPECT_GE(std::count(depth.begin(), depth.end(), 0.0F), 150);
    for (const float asked : r.film.find("lod.asked")->values)
        EXPECT_FALSE(std::isfinite(asked));
    // Edges of the length that is stated, to the nearest power of two.
    for (const float level : r.film.find("lod.level")->values)
        if (std::isfinite(level)) {
            EXPECT_NEAR(level, std::log2(scene.meshes[0].edge_length), 0.51);
        }
}

/// The same scene in a unit of which a frame's powers of two would leave single precision: levels are the
/// world's.
TEST(Levels, AreInWorldUnits) {
    Scene scene = long_torus(Lod::recursive);
    const Film film = surveyed(scene, layers({LayerGroup::lod, LayerGroup::pick})).film;
    const double factor = std::ldexp(1.0, 60);
    for (glm::dvec3& p : scene.meshes[0].points)
        p *= factor;
    scene.meshes[0].edge_length *= factor;
    scene.camera.position *= factor;
    scene.camera.target *= factor;
    scene.lights.clear();
    const Film large = surveyed(scene, layers({LayerGroup::lod, LayerGroup::pick})).film;
    const auto value = [](const Film& f, const char* name, std::size_t i) { return f.find(name)->at(i); };
    std::size_t hits = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (!std::isfinite(value(film, "pick.Z", i)) || !std::isfinite(value(large, "pick.Z", i)))
            continue;
        ++hits;
        EXPECT_NEAR(value(large, "lod.asked", i), value(film, "lod.asked", i) + 60, 1e-3);
        EXPECT_NEAR(value(large, "pick.Z", i) / factor, value(film, "pick.Z", i), 1e-2);
        EXPECT_NEAR(value(large, "lod.level", i), value(film, "lod.level", i) + 60, 1.01);
    }
    EXPECT_GE(hits, 150U);
}

} // namespace
} // namespace razor::test
