// Which lines of memory tracing touches.
#include "tests/kernels/cages.h"
#include "tests/survey/reference.h"

#include "razor/frame/ray_kinds.h"
#include "razor/native/targets.h"
#include "razor/recording/touched_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace razor::test {
namespace {

Scene small_scene() {
    Scene scene = named_scene("urchin_stretched")->scene;
    scene.settings.lod = Lod::recursive;
    return scene;
}

RenderOptions measured() {
    RenderOptions options;
    options.touched = [lines = std::make_shared<TouchedLines>()](Frame& frame, const SeeArguments& packet) {
        return lines->measure(frame, packet);
    };
    return options;
}

TEST(Touched, AreWholeLinesOfKindsOfMemory) {
    const Scene scene = small_scene();
    const LayerSet asked = layers({LayerGroup::bytes, LayerGroup::steps, LayerGroup::pick});
    const Film film = surveyed(scene, asked, measured()).film;
    const auto value = [&](const char* name, std::size_t i) { return film.find(name)->at(i); };
    bool grids = false;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double lines = value("bytes.touched", i) * 32 / 64; // of a packet of 32 rays
        EXPECT_EQ(lines, std::round(lines));
        EXPECT_LE(value("bytes.tree", i) + value("bytes.grids", i), value("bytes.touched", i));
        // Four nodes are in a line, so as many lines as a quarter of them at least, if none comes twice; and
        // no more lines of nodes and lists than are looked at.
        EXPECT_GT(value("bytes.tree", i), 0);
        EXPECT_LE(value("bytes.grids", i) > 0 ? 1 : 0, value("steps.boxes", i) > 0 ? 1 : 0);
        if (value("pick.mesh", i) >= 0) {
            EXPECT_GT(value("bytes.grids", i), 0);
            grids = true;
        }
    }
    EXPECT_TRUE(grids);
}

TEST(Touched, AreTheSameEachTimeAndGrowWithTheScene) {
    Scene scene = small_scene();
    const LayerSet asked = layers({LayerGroup::bytes});
    const auto mean = [&] {
        const Film film = surveyed(scene, asked, measured()).film;
        const std::vector<float>& values = film.find("bytes.grids")->values;
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    const double fine = mean();
    EXPECT_EQ(fine, mean());
    scene.settings.edge_pixels *= 8; // larger triangles
    scene.meshes[0].edge_length *= 8;
    EXPECT_LT(mean(), fine);
}

TEST(Touched, LinesCountOnce) {
    LineSet set;
    const auto at = [](std::uintptr_t address) { return reinterpret_cast<const void*>(address); };
    set.add(at(0x10000), 4);
    set.add(at(0x1003c), 4);
    EXPECT_EQ(set.lines().size(), 1U);
    set.add(at(0x1003c), 8); // and the next
    EXPECT_EQ(set.lines().size(), 2U);
    set.add(at(0x10080), 129); // three lines
    EXPECT_EQ(set.lines().size(), 5U);
    set.add(at(0x10000 + 4096 * 64), 4); // of the same lowest bits
    set.add(at(0x10000), 4);
    EXPECT_EQ(set.lines().size(), 6U);
    set.clear();
    set.add(at(0x10000), 4);
    EXPECT_EQ(set.lines().size(), 1U);
}

TEST(Touched, NothingByNoRay) {
    const Scene scene = small_scene();
    Frame frame(scene, {});
    TouchedLines lines;
    const SeeArguments nothing;
    EXPECT_EQ(lines.measure(frame, nothing).all, 0);
}

/// Simulated kernels see what native ones do, so that what they touch is what those do.
TEST(Touched, PacketsAreTheNativeOnes) {
    const Scene scene = small_scene();
    Frame frame(scene, {});
    const KernelTable& native = *native_targets().back();
    ASSERT_EQ(native.width, simulated::kernels.width);
    frame.render(native, 0);
    const auto planes = [&](const KernelTable& kernels) {
        SurveyOptions options;
        options.layers = layers({LayerGroup::pick, LayerGroup::steps, LayerGroup::patch});
        options.kernels = &kernels;
        Film film(scene.settings.width, scene.settings.height);
        EXPECT_TRUE(survey(frame, shown_part(scene.settings), options, film));
        return film;
    };
    const Film a = planes(native), b = planes(simulated::kernels);
    for (const Plane& plane : a.planes) {
        EXPECT_EQ(plane.values, b.find(plane.name)->values) << plane.name;
        EXPECT_EQ(plane.ids, b.find(plane.name)->ids) << plane.name;
    }
}

} // namespace
} // namespace razor::test
