// A part of a picture is the same, bit for bit, as in the whole of it, and costs no more than its tiles.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
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

struct Touched {
    int tiles;
    std::int64_t pixels; // of them
};

/// The tiles of the whole picture that a part shares a pixel with, looked for pixel by pixel.
Touched tiles_touched(const Settings& s, const Crop& crop) {
    const int across = s.width / tile_side + 1;
    const auto tile_of = [&](int x, int y) { return y / tile_side * across + x / tile_side; };
    std::set<int> tiles;
    for (int y = crop.y; y < crop.y + crop.height; ++y)
        for (int x = crop.x; x < crop.x + crop.width; ++x)
            tiles.insert(tile_of(x, y));
    Touched touched{.tiles = static_cast<int>(tiles.size()), .pixels = 0};
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            touched.pixels += tiles.contains(tile_of(x, y)) ? 1 : 0;
    return touched;
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
    const Crop crops[] = {{0, 0, 70, 52},
                          {2 * tile_side, 4 * tile_side, 4 * tile_side, 2 * tile_side},
                          {2 * tile_side - 1, 4 * tile_side - 1, 2, 2}, // the corners of four tiles
                          {17, 3, 40, 30},
                          {69, 51, 1, 1},
                          {40, 0, 30, 52}};
    ASSERT_NE(s.width % tile_side, 0);
    ASSERT_NE(s.height % tile_side, 0);
    for (const KernelTable* kernels : all_targets()) {
        SCOPED_TRACE(kernels->name);
        const Cropped whole = render(scene, *kernels, {});
        for (const Crop& crop : crops) {
            SCOPED_TRACE(testing::Message() << crop.x << ' ' << crop.y << ' ' << crop.width);
            const Touched touched = tiles_touched(s, crop);
            const Cropped part = render(scene, *kernels, crop);
            ASSERT_EQ(part.film.width, crop.width);
            ASSERT_EQ(part.film.height, crop.height);
            ASSERT_EQ(part.film.planes.size(), whole.film.planes.size());
            for (const Plane& plane : whole.film.planes) {
                const float* got = part.film.find(plane.name)->values.data();
                for (int y = 0; y < crop.height; ++y, got += crop.width) {
                    const float* row = plane.values.data() + (crop.y + y) * s.width + crop.x;
                    ASSERT_TRUE(std::equal(row, row + crop.width, got)) << plane.name << " row " << y;
                }
            }
            scene.settings.crop = crop;
            EXPECT_EQ(screen_tiles(scene.settings), touched.tiles);
            scene.settings.crop = {};
            const bool timed = std::strcmp(kernels->name, "simulated") != 0;
            EXPECT_EQ(part.statistics.tiles, timed ? touched.tiles : 0);
            EXPECT_EQ(part.statistics.by_kind.kind[kind_camera].rays, touched.pixels * s.samples);
        }
    }
}

} // namespace
} // namespace razor::test
