// What pictures' files say of their camera and of where they lie in the whole, beside the rays that made
// them.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"
#include "razor/frame/view.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace razor::test {
namespace {

using glm::dvec3;

/// (x, y, z, 1) times the matrix, divided by w.
dvec3 times(const dvec3& p, const std::array<float, 16>& m) {
    double out[4];
    for (std::size_t k = 0; k < 4; ++k)
        out[k] = p.x * double{m[k]} + p.y * double{m[4 + k]} + p.z * double{m[8 + k]} + double{m[12 + k]};
    return dvec3(out[0], out[1], out[2]) / out[3];
}

TEST(PictureCamera, SaysWhereTheRaysOfAPixelGo) {
    for (const bool orthographic : {false, true})
        for (const double unit : {1.0, 0x1p40}) { // the frame has another
            Scene scene = scene_of(cube_cage(), 8);
            for (dvec3& p : scene.meshes[0].points)
                p *= unit;
            scene.meshes[0].edge_length *= unit;
            scene.lights.clear();
            scene.camera.position = dvec3(3, 2, 4) * unit;
            scene.camera.target = dvec3(0.2, 0.1, 0) * unit;
            scene.camera.up = {0.3, 1, 0};
            scene.camera.height = 2.5 * unit;
            if (orthographic)
                scene.camera.projection = Projection::orthographic;
            scene.settings.width = 40;
            scene.settings.height = 24;
            scene.settings.crop = {7, 5, 11, 13};
            Frame frame(scene, {});
            EXPECT_EQ(frame.unit() == 1, unit == 1);
            const Film film = frame.film();
            EXPECT_EQ(film.window, (PictureWindow{7, 5, 40, 24}));
            ASSERT_TRUE(film.camera.has_value());
            EXPECT_EQ(*film.camera, picture_camera(scene.camera, scene.settings));
            const FrameHeader& h = frame.header();
            const auto vec = [](const float(&v)[3]) { return dvec3(v[0], v[1], v[2]); };
            const dvec3 position = frame.origin() + frame.unit() * vec(h.camera);
            const dvec3 forward = glm::normalize(scene.camera.target - scene.camera.position);
            std::mt19937 random(7);
            std::uniform_real_distribution<double> part(0, 1);
            double last = -2;
            for (int n = 0; n < 100; ++n) {
                const double x = 40 * part(random), y = 24 * part(random), depth = (1 + 0.1 * n) * unit;
                const dvec3 on_film = vec(h.film_corner) + vec(h.film_x) * x + vec(h.film_y) * y;
                const dvec3 p = orthographic ? position + on_film * frame.unit() + forward * depth
                                             : position + on_film * depth;
                const dvec3 ndc = times(p, film.camera->world_to_ndc);
                EXPECT_NEAR(ndc.x, x / 40, 2e-6);
                EXPECT_NEAR(ndc.y, y / 24, 2e-6);
                EXPECT_GT(ndc.z, orthographic ? 0 : last);
                last = ndc.z;
                const dvec3 seen = times(p, film.camera->world_to_camera);
                EXPECT_NEAR(seen.z / depth, 1, 2e-6);
                EXPECT_EQ(seen.x < 0, x < 20);
                EXPECT_EQ(seen.y > 0, y < 12);
            }
            EXPECT_NEAR(film.camera->screen_width, orthographic ? 1 : 40 * glm::length(vec(h.film_x)), 1e-6);
            scene.settings.crop = {0, 0, 40, 24};
            EXPECT_FALSE(Frame(scene, {}).film().window.has_value());
        }
}

} // namespace
} // namespace razor::test
