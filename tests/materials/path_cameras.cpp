// Pictures by cameras with a lens and without perspective against paths that are followed one by one in
// double.
#include "razor/scene/words.h"
#include "tests/materials/compare_paths.h"
#include "tests/materials/room.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace razor::test {
namespace {

/// Surfaces near and far, of many edges.
Scene deep_room() {
    Scene s = room();
    s.meshes.push_back(box("near", {0.7, 0, 1.4}, {0.5, 0.9, 0.5}, 25, 3));
    s.meshes.push_back(box("far", {-1.6, 0, -1.6}, {0.9, 1.5, 0.6}, 10, 3));
    s.meshes.push_back(ball("ball", {-0.2, 0.5, 0.2}, 0.5, 4));
    s.materials.push_back(named("box", {0.2F, 0.7F, 0.3F}));
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.3F;
    s.materials[1].emission = {0.3F, 0.6F, 0.9F}; // bright behind what is dark
    s.materials[2].albedo = {0.1F, 0.05F, 0.05F};
    s.settings.diffuse_bounces = 1;
    return s;
}

/// The same, dark, and each surface glowing by itself: nothing but what lies where on the film is left to
/// chance.
Scene glowing_room() {
    Scene s = deep_room();
    s.lights.clear();
    s.sky = {0, 0, 0};
    s.settings.bounces = s.settings.diffuse_bounces = 0;
    for (std::size_t m = 0; m < s.materials.size(); ++m) {
        s.materials[m].metallic = 0;
        s.materials[m].albedo = {0, 0, 0};
        s.materials[m].emission = {m % 2 == 0 ? 3.0F : 0.1F, m == 3 ? 4.0F : 0.2F, m == 4 ? 0.1F : 1.0F};
    }
    return s;
}

// Blocks of pixels see what filters take from beyond them.
TEST(PathsOfCameras, WideFilters) {
    for (const FilterKind kind : {FilterKind::box, FilterKind::triangle, FilterKind::gaussian,
                                  FilterKind::mitchell, FilterKind::lanczos}) {
        Scene s = glowing_room();
        s.name = fmt::format("filter {}", word_of(filter_words, kind));
        s.settings.filter = preset_filter(kind);
        s.settings.filter.radius = {6, 4};
        s.settings.filter.sigma = 2;
        s.settings.filter.c = 0.9; // far below 0
        s.settings.filter.tau = 4;
        // Of a windowed sinc blocks see little but its ripples.
        const int more = kind == FilterKind::lanczos ? 32 : 8;
        s.settings.samples *= more;
        const PlainPicture want = expect_same_picture(s, 200 * more);
        Scene pixels = s, narrower = s;
        pixels.settings.filter = {};
        narrower.settings.filter.radius = {3, 4};
        expect_other_picture(want, pixels);
        if (kind != FilterKind::lanczos) // of which the ends are near 0
            expect_other_picture(want, narrower);
    }
}

TEST(PathsOfCameras, ThinLens) {
    for (const double focus : {0.0, 3.2}) { // on the target, and before it
        Scene s = deep_room();
        s.name = focus > 0 ? "thin lens, near in focus" : "thin lens";
        s.camera.aperture_radius = 0.6;
        s.camera.focus_distance = focus;
        const PlainPicture want = expect_same_picture(s, 320);
        Scene pinhole = s, further = s;
        pinhole.camera.aperture_radius = 0;
        further.camera.focus_distance = 9;
        expect_other_picture(want, pinhole);
        expect_other_picture(want, further);
    }
}

TEST(PathsOfCameras, Orthographic) {
    Scene s = deep_room();
    s.name = "orthographic";
    s.camera.projection = Projection::orthographic;
    s.camera.height = 3.4;
    const PlainPicture want = expect_same_picture(s, 160);
    Scene larger = s, perspective = s;
    larger.camera.height = 3.6;
    perspective.camera.projection = Projection::perspective;
    expect_other_picture(want, larger);
    expect_other_picture(want, perspective);
}

} // namespace
} // namespace razor::test
