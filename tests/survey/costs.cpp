// What pixels cost: the figures of packets and tiles add up to the frame's.
#include "tests/kernels/cages.h"
#include "tests/survey/reference.h"

#include "razor/native/targets.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace razor::test {
namespace {

double sum(const Film& film, std::string_view name) {
    const std::vector<float>& values = film.find(name)->values;
    return std::accumulate(values.begin(), values.end(), 0.0);
}

Scene lit(int width, int height) {
    Scene scene = named_scene("urchin_stretched")->scene;
    scene.settings.lod = Lod::recursive;
    scene.settings.width = width;
    scene.settings.height = height;
    scene.settings.samples = 2;
    return scene;
}

TEST(Costs, OfPacketsAddUpToWhatTheirRaysCount) {
    const Scene scene = lit(45, 27);
    const KernelTable& kernels = *native_targets().back();
    Frame frame(scene, {});
    frame.render(kernels, 0);
    Film film = frame.film();
    const Counters before = frame.counters(0).kind[kind_camera];
    SurveyOptions options;
    options.layers = layers({LayerGroup::steps});
    options.kernels = &kernels;
    ASSERT_TRUE(survey(frame, shown_part(scene.settings), options, film));
    Counters counted = frame.counters(0).kind[kind_camera];
    counted -= before;
    EXPECT_EQ(counted.rays, 45 * 27);
    EXPECT_GT(counted.quad_tests, 0);
    EXPECT_GT(counted.blended_tests, 0);
    const auto expect = [&](const char* name, std::int64_t n) {
        EXPECT_NEAR(sum(film, name), static_cast<double>(n), 1e-5 * static_cast<double>(n)) << name;
    };
    expect("steps.nodes", counted.node_visits);
    expect("steps.boxes", counted.box_tests);
    expect("steps.blocks", counted.block_tests);
    expect("steps.blended", counted.blended_tests);
    expect("steps.cells", counted.cell_tests);
    expect("steps.quads", counted.quad_tests);
}

void expect_tiles(const Scene& scene, int threads) {
    SCOPED_TRACE(threads);
    RenderOptions options;
    options.threads = threads;
    const LayerSet asked = layers({LayerGroup::packet, LayerGroup::shading, LayerGroup::time});
    const RenderResult r = surveyed(scene, asked, options);
    const CountersByKind& counted = r.statistics.frame.by_kind;
    const Counters all = counted.sum();
    const auto expect = [&](const char* name, std::int64_t n) {
        EXPECT_GT(n, 0) << name;
        EXPECT_NEAR(sum(r.film, name), static_cast<double>(n), 1e-5 * static_cast<double>(n)) << name;
    };
    expect("shading.hits", all.camera_hits + all.bounce_hits);
    expect("shading.shadow_rays", counted.kind[kind_light].rays + counted.kind[kind_sky].rays);
    if (counted.kind[kind_bounce].rays > 0)
        expect("shading.bounces", counted.kind[kind_bounce].rays);
    EXPECT_NEAR(sum(r.film, "time.microseconds"), 1e6 * r.statistics.frame.tile_seconds,
                1e4 * r.statistics.frame.tile_seconds);
    for (const char* name : {"packet.camera", "packet.utilisation"})
        for (const float share : r.film.find(name)->values) {
            EXPECT_GT(share, 0) << name;
            EXPECT_LE(share, 1) << name;
        }
    // Packets of camera rays are full, but for those on the picture's rim.
    EXPECT_EQ(r.film.find("packet.camera")->values[0], 1);
    EXPECT_LT(r.film.find("packet.camera")->values.back(), 1);
    const std::vector<float>& shadow = r.film.find("packet.shadow")->values;
    EXPECT_LE(*std::max_element(shadow.begin(), shadow.end()), 1);
    EXPECT_EQ(*std::min_element(shadow.begin(), shadow.end()), 0); // where nothing is hit
}

TEST(Costs, OfTilesAddUpToTheFrames) {
    for (const int threads : {1, 3})
        expect_tiles(lit(45, 27), threads);
    Scene mirrors = lit(29, 21);
    mirrors.materials[0].metallic = 1;
    mirrors.materials[0].roughness = 0.2F;
    expect_tiles(mirrors, 2);
}

TEST(Costs, OfTilesAreThoseOfAllPasses) {
    const Scene scene = lit(45, 27);
    RenderOptions options;
    options.threads = 1;
    options.passes.samples = 1; // of two
    const RenderResult r = surveyed(scene, layers({LayerGroup::shading}), options);
    EXPECT_EQ(r.statistics.frame.by_kind.kind[kind_camera].rays, 45 * 27 * 2);
    const auto hits = static_cast<double>(r.statistics.frame.counters.camera_hits);
    EXPECT_NEAR(sum(r.film, "shading.hits"), hits, 1e-5 * hits);
}

TEST(Costs, OfATileInPlaceOfAWaitAreItsOwn) {
    CountersByKind counters;
    TileLog log(counters);
    const auto count = [&](int n) { counters.kind[kind_camera].rays += n; };
    count(1000); // between tiles
    log.begun();
    count(1);
    log.begun();
    count(10);
    log.ended(7, 0.25);
    count(2);
    log.ended(3, 0.5);
    count(1000);
    log.begun();
    count(100);
    log.ended(7, 0.5);
    ASSERT_EQ(log.costs().size(), 2U);
    EXPECT_EQ(log.costs().at(3).counters.kind[kind_camera].rays, 3);
    EXPECT_EQ(log.costs().at(7).counters.kind[kind_camera].rays, 110);
    EXPECT_EQ(log.costs().at(7).seconds, 0.75);
}

void expect_equal_planes(const Film& a, const Film& b) {
    for (const Plane& plane : a.planes) {
        EXPECT_EQ(plane.values, b.find(plane.name)->values) << plane.name;
        EXPECT_EQ(plane.ids, b.find(plane.name)->ids) << plane.name;
    }
}

LayerSet all_but_time() {
    return layers({LayerGroup::pick, LayerGroup::lod, LayerGroup::patch, LayerGroup::kd, LayerGroup::steps,
                   LayerGroup::packet, LayerGroup::shading});
}

TEST(Survey, ChangesNoBitOfThePicture) {
    const Scene scene = lit(45, 27);
    expect_equal_planes(surveyed(scene, {}).film, surveyed(scene, all_but_time()).film);
}

/// Boxes in a tree, and with them steps, depend on which ray came first.
LayerSet of_no_tree() {
    return layers(
        {LayerGroup::pick, LayerGroup::lod, LayerGroup::patch, LayerGroup::packet, LayerGroup::shading});
}

TEST(Survey, IsTheSameWhoeverRenders) {
    const Scene scene = lit(45, 27);
    const Film one = surveyed(scene, of_no_tree()).film;
    RenderOptions options;
    options.threads = 3;
    expect_equal_planes(one, surveyed(scene, of_no_tree(), options).film);
    options.share = 1; // trees of their own
    expect_equal_planes(one, surveyed(scene, of_no_tree(), options).film);
}

TEST(Survey, OfAPartIsAPartOfTheWholes) {
    Scene scene = lit(45, 27);
    const Film whole = surveyed(scene, of_no_tree()).film;
    for (const Crop& crop : {Crop{8, 8, 16, 8}, Crop{5, 3, 33, 18}, Crop{44, 26, 1, 1}}) {
        SCOPED_TRACE(crop.x);
        scene.settings.crop = crop;
        const Film part = surveyed(scene, of_no_tree()).film;
        ASSERT_EQ(part.planes.size(), whole.planes.size());
        for (const Plane& plane : whole.planes)
            for (int y = 0; y < crop.height; ++y)
                for (int x = 0; x < crop.width; ++x)
                    ASSERT_EQ(plane.at(static_cast<std::size_t>((crop.y + y) * 45 + crop.x + x)),
                              part.find(plane.name)->at(static_cast<std::size_t>(y * crop.width + x)))
                        << plane.name << ' ' << x << ' ' << y;
    }
}

TEST(Survey, IsTheSameWithinAMemoryBudget) {
    const Scene scene = lit(45, 27);
    const LayerSet asked = layers({LayerGroup::pick, LayerGroup::lod, LayerGroup::patch});
    const Film unbounded = surveyed(scene, asked).film;
    RenderOptions options;
    for (options.memory_bytes = 128 << 10;; options.memory_bytes += 64 << 10)
        try {
            const RenderResult r = surveyed(scene, asked, options);
            EXPECT_GT(r.statistics.budget.drops, 0);
            expect_equal_planes(unbounded, r.film);
            break;
        } catch (const UserError&) { // too little for one tile
            ASSERT_LT(options.memory_bytes, 1 << 20);
        }
}

TEST(Survey, IsOfTheLastFrameOfASequence) {
    Scene scene = lit(45, 27);
    RenderOptions options;
    options.threads = 1;
    options.layers = all_but_time();
    NativeRenderer renderer(scene, options, true);
    renderer.render();
    scene.camera.position.x += 0.1;
    renderer.pose(scene);
    expect_equal_planes(surveyed(scene, all_but_time()).film, renderer.render().film);
}

TEST(Survey, StopsWhenItIsCancelled) {
    const Scene scene = lit(20, 20);
    const std::atomic<bool> cancel = true;
    Frame frame(scene, {});
    Film film(20, 20);
    SurveyOptions options;
    options.layers = layers({LayerGroup::pick});
    options.kernels = native_targets().back();
    options.cancel = &cancel;
    EXPECT_FALSE(survey(frame, shown_part(scene.settings), options, film));
}

} // namespace
} // namespace razor::test
