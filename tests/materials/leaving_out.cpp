// Scenes that need less run kernels that do less, and show the same, to the last bit.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/skies.h"

#include "razor/frame/frame.h"
#include "razor/native/render.h"
#include "razor/scene/scene_file.h"

#include <gtest/gtest.h>

#include <string>

namespace razor::test {
namespace {

RenderResult rendered(const Scene& scene, const std::string& target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    return render_native(scene, options);
}

void expect_same(const Film& a, const Film& b, const std::string& what) {
    for (const char* name : {"R", "G", "B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "albedo.R"})
        EXPECT_EQ(a.find(name)->values, b.find(name)->values) << what << ", " << name;
}

class LeavingOut : public testing::TestWithParam<const char*> {};

TEST_P(LeavingOut, ShowsTheSame) {
    Scene scene = load_scene(std::string(RAZOR_SOURCE_DIR) + "/configs/scenes/" + GetParam() + ".toml");
    scene.settings.width = 64;
    scene.settings.height = 40;
    Scene everything = scene;
    everything.settings.everything = true;
    for (const KernelTable* target : scene.name == "default" ? native_targets() : best_target()) {
        const RenderResult own = rendered(scene, target->name);
        const RenderResult all = rendered(everything, target->name);
        EXPECT_EQ(own.statistics.frame.look, look_matte);
        EXPECT_EQ(all.statistics.frame.look, look_glossy_mapped);
        expect_same(own.film, all.film, target->name);
        EXPECT_EQ(all.statistics.frame.by_kind.kind[kind_bounce].rays, 0);
        EXPECT_EQ(own.statistics.frame.counters.rays, all.statistics.frame.counters.rays);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, LeavingOut,
                         testing::Values("default", "lights", "courtyard", "interior", "forest", "showcase"),
                         [](const auto& info) { return std::string(info.param); });

// A map of the sky, seen and by its light, on matte surfaces.
TEST(LeavingOut, UnderAMappedSkyToo) {
    Scene scene = load_scene(std::string(RAZOR_SOURCE_DIR) + "/configs/scenes/default.toml");
    scene.settings.width = 64;
    scene.settings.height = 40;
    scene.sky = {0.3, 0.7, 1.1};
    set_sky(scene, sky_texture(32, 16, [](double u, double v) { return morning(u, v, 0.3, 20); }), 40);
    Scene everything = scene;
    everything.settings.everything = true;
    for (const KernelTable* target : native_targets()) {
        const RenderResult own = rendered(scene, target->name);
        EXPECT_EQ(own.statistics.frame.look, look_mapped);
        EXPECT_GT(own.statistics.frame.by_kind.kind[kind_sky].rays, 0);
        expect_same(own.film, rendered(everything, target->name).film, target->name);
    }
}

// Materials that nothing has do not count, nor do textures of such.
TEST(LeavingOut, UnusedMaterialsAreLeftOut) {
    Scene scene = scene_of(cube_cage(), 4);
    Material glass;
    glass.name = "glass";
    glass.specular = glass.transmission = 1;
    glass.albedo_map.texture = 0;
    scene.materials = {scene.materials.empty() ? Material{} : scene.materials[0], glass};
    scene.textures.push_back({});
    Frame frame(scene, {});
    EXPECT_EQ(frame.plan().look, look_matte);
    EXPECT_EQ(frame.statistics().texture_bytes, 0);
    EXPECT_EQ(frame.header().materials.get(), nullptr);
    EXPECT_EQ(frame.header().texels.get(), nullptr);
}

} // namespace
} // namespace razor::test
