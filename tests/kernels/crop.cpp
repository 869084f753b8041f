// A part of a picture is the same, bit for bit, as in the whole of it, and costs no more than its tiles.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace razor::test {
namespace {

struct Cropped {
    Film film;
    FrameStatistics statistics;
};

Cropped render(Scene scene, const KernelTable& kernels, const Crop& crop) {
    scene.settings.crop = crop;
    Frame frame(scene, {});
    frame.render(kernels, 0);
    return {frame.film(), frame.statistics()};
}

TEST(Crop, IsAPartOfThePicture) {
    Scene scene = named_scene("urchin_stretched")->scene;
    Settings& s = scene.settings;
    s.width = 70; // the last tiles of rows and columns are no whole ones
    s.height = 52;
    s.samples = 2;
    s.light_samples = s.sky_samples = 2;
    s.edge_pixels = 2;
    s.seed = 3;
    struct Case {
        Crop crop;
        int tiles;
        std::int64_t pixels; // of them
    };
    const Case cases[] = {
        {{0, 0, 70, 52}, 20, 70L * 52}, {{16, 32, 32, 16}, 2, 512},  {{15, 31, 2, 2}, 4, 1024},
        {{17, 3, 40, 30}, 9, 48L * 48}, {{69, 51, 1, 1}, 1, 6L * 4}, {{40, 0, 30, 52}, 12, 38L * 52},
    };
    for (const KernelTable* kernels : all_targets()) {
        SCOPED_TRACE(kernels->name);
        const Cropped whole = render(scene, *kernels, {});
        for (const Case& c : cases) {
            SCOPED_TRACE(testing::Message() << c.crop.x << ' ' << c.crop.y << ' ' << c.crop.width);
            const Cropped part = render(scene, *kernels, c.crop);
            ASSERT_EQ(part.film.width, c.crop.width);
            ASSERT_EQ(part.film.height, c.crop.height);
            ASSERT_EQ(part.film.planes.size(), whole.film.planes.size());
            for (const Plane& plane : whole.film.planes) {
                const float* got = part.film.find(plane.name)->values.data();
                for (int y = 0; y < c.crop.height; ++y, got += c.crop.width) {
                    const float* row = plane.values.data() + (c.crop.y + y) * s.width + c.crop.x;
                    ASSERT_TRUE(std::equal(row, row + c.crop.width, got)) << plane.name << " row " << y;
                }
            }
            scene.settings.crop = c.crop;
            EXPECT_EQ(screen_tiles(scene.settings), c.tiles);
            scene.settings.crop = {};
            const bool timed = std::strcmp(kernels->name, "simulated") != 0;
            EXPECT_EQ(part.statistics.tiles, timed ? c.tiles : 0);
            EXPECT_EQ(part.statistics.by_kind.kind[kind_camera].rays, c.pixels * s.samples);
        }
    }
}

} // namespace
} // namespace razor::test
