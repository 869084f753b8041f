// What is counted for each kind of ray.
#include "tests/kernels/cages.h"

#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace razor::test {
namespace {

RenderStatistics statistics(Scene scene, int light_samples, int sky_samples) {
    scene.settings.lod = Lod::fixed; // rays of one kind then ask for nothing that another kind's change
    scene.settings.width = 20;
    scene.settings.height = 12;
    scene.settings.samples = 2;
    scene.settings.light_samples = light_samples;
    scene.settings.sky_samples = sky_samples;
    RenderOptions options;
    options.threads = 1;
    return render_native(scene, options).statistics;
}

// A kind of ray that is left out counts nothing, and the others go the same ways without it.
TEST(Statistics, KindsOfRaysAreToldApart) {
    const Scene scene = named_scene("default")->scene;
    const FrameStatistics all = statistics(scene, 3, 5).frame;
    const FrameStatistics light = statistics(scene, 3, 0).frame;
    const FrameStatistics sky = statistics(scene, 0, 5).frame;
    const FrameStatistics camera = statistics(scene, 0, 0).frame;
    const auto same = [](const FrameStatistics& a, const FrameStatistics& b, RayKind k) {
        SCOPED_TRACE(kind_names[k]);
        const Counters& one = a.by_kind.kind[k];
        const Counters& other = b.by_kind.kind[k];
        EXPECT_EQ(one.rays, other.rays);
        EXPECT_EQ(one.packets, other.packets);
        EXPECT_EQ(one.groups, other.groups);
        // What they visit depends on what others have built and found before.
    };
    same(camera, all, kind_camera);
    same(light, all, kind_camera);
    same(light, all, kind_light);
    same(sky, all, kind_sky);
    same(light, camera, kind_sky);
    same(sky, camera, kind_light);
    for (const RayKind k : {kind_light, kind_sky})
        for_each_counter(camera.by_kind.kind[k],
                         [](const char* name, std::int64_t n) { EXPECT_EQ(n, 0) << name; });

    const std::int64_t hits = all.counters.camera_hits;
    EXPECT_EQ(all.by_kind.kind[kind_camera].rays, 20 * 12 * 2);
    EXPECT_GT(all.by_kind.kind[kind_light].rays, 0);
    EXPECT_LE(all.by_kind.kind[kind_light].rays, 3 * hits);
    EXPECT_GT(all.by_kind.kind[kind_sky].rays, 5 * hits / 2);
    EXPECT_LE(all.by_kind.kind[kind_sky].rays, 5 * hits);
    // In their tiles camera rays leave something for the others to open.
    EXPECT_EQ(camera.by_kind.kind[kind_camera].patches_opened, camera.counters.patches_opened);
    EXPECT_GE(all.counters.patches_opened, camera.counters.patches_opened);
    EXPECT_LT(all.by_kind.kind[kind_camera].patches_opened, camera.counters.patches_opened);
    EXPECT_GT(all.by_kind.kind[kind_sky].patches_opened, 0);
    EXPECT_EQ(all.by_kind.kind[kind_none].rays, 0);
    EXPECT_EQ(all.by_kind.kind[kind_none].node_visits, 0);
}

TEST(Statistics, AreWrittenByKind) {
    const RenderStatistics s = statistics(named_scene("torus_bilinear")->scene, 3, 5);
    const nlohmann::ordered_json json = s;
    const auto& kinds = json.at("counters_by_kind");
    ASSERT_EQ(kinds.size(), 5U);
    for (const auto& [name, total] : json.at("counters").items()) {
        std::int64_t sum = 0;
        for (const auto& kind : kinds)
            sum += kind.at(name).get<std::int64_t>();
        EXPECT_EQ(total, sum) << name;
    }
    EXPECT_EQ(json.at("utilisation").size(), 4U);
    for (const std::string kind : {"camera", "light", "sky"}) {
        const auto rays = kinds.at(kind).at("rays").get<double>();
        const auto packets = kinds.at(kind).at("packets").get<double>();
        EXPECT_DOUBLE_EQ(json.at("utilisation").at(kind + "_packets"), rays / (packets * s.width_lanes));
    }
}

} // namespace
} // namespace razor::test
