// Maps of sheen: what they say is as if it were stated, where it is the same; nothing reflects more than it
// gets, whatever they say; and only what has them has arrays and tables for them.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"
#include "tests/materials/plain_surface.h"
#include "tests/materials/skies.h"

#include "razor/frame/frame.h"
#include "razor/native/render.h"
#include "razor/scene/textures/shared_exponent.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// A torus of velvet under a sky and a lamp, with texture coordinates from 0 to 1 and a picture as texture 0.
Scene velvet(const std::function<glm::vec4(double, double)>& picture) {
    const int rings = 9, sides = 6;
    Mesh m = torus_cage(rings, sides);
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sides; ++j)
            m.texcoords.emplace_back(static_cast<float>(i) / rings, static_cast<float>(j) / sides);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
                m.face_texcoords.push_back((i + di) * (sides + 1) + j + dj);
    Scene s = scene_of(m, 64);
    s.textures = {rgba_texture(64, 64, picture)};
    Material& a = s.materials.at(0);
    a.albedo = {0.2F, 0.1F, 0.1F};
    a.sheen = {1, 0.75F, 0.5F};
    a.sheen_roughness = 0.75F;
    a.sheen_map.texture = a.sheen_roughness_map.texture = 0;
    s.sky = glm::vec3(0.5F);
    s.settings = {
        .width = 64, .height = 64, .samples = 4, .light_samples = 2, .sky_samples = 2, .bounces = 0};
    return s;
}

RenderResult rendered(const Scene& scene, const std::string& target = native_targets().back()->name) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    return render_native(scene, options);
}

/// Root mean square of the colours' differences, by that of the second's.
double rms(const Film& a, const Film& b) {
    double sum = 0, all = 0;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t p = 0; p < a.pixel_count(); ++p) {
            const double x = a.find(name)->values[p], y = b.find(name)->values[p];
            sum += (x - y) * (x - y);
            all += y * y;
        }
    EXPECT_GT(all, 0);
    return std::sqrt(sum / all);
}

/// The largest difference of any colour of any pixel, by the largest colour.
double difference(const Film& a, const Film& b) {
    double most = 0, largest = 0;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t p = 0; p < a.pixel_count(); ++p) {
            const double x = a.find(name)->values[p], y = b.find(name)->values[p];
            most = std::max(most, std::abs(x - y));
            largest = std::max({largest, x, y});
        }
    EXPECT_GT(largest, 0);
    return most / largest;
}

glm::vec4 decoded(const glm::vec4& texel) {
    return {unpack_shared_exponent(pack_shared_exponent(glm::vec3(texel))),
            unpack_shared_exponent(pack_shared_exponent(glm::vec3(texel.w))).x};
}

TEST(SheenMaps, ConstantOnesAreFactors) {
    const glm::vec4 texel(0.8F, 0.61F, 0.3F, 0.57F), known = decoded(texel);
    for (const Shading shading : {Shading::grids, Shading::hits}) {
        Scene mapped = velvet([&](double, double) { return texel; });
        mapped.settings.shading = shading;
        Scene stated = mapped;
        Material& m = stated.materials[0];
        m.sheen *= glm::vec3(known);
        m.sheen_roughness *= known.w;
        m.sheen_map.texture = m.sheen_roughness_map.texture = -1;
        Scene none = stated;
        none.materials[0].sheen = glm::vec3(0);
        const Film want = rendered(stated).film;
        EXPECT_GT(difference(rendered(none).film, want), 0.05);
        EXPECT_LT(difference(rendered(mapped).film, want), 2e-6);
    }
}

// Where textures have other values elsewhere, tables have rows: their ends are exact, too.
TEST(SheenMaps, PartsOfOneValueAreFactors) {
    const float bands[] = {0.4F, 0.57F, 1};
    for (const int band : {0, 1, 2})
        for (const Shading shading : {Shading::grids, Shading::hits}) {
            Scene mapped = velvet([&](double u, double) {
                return glm::vec4(1, 1, 1, bands[std::min(static_cast<int>(3 * u), 2)]);
            });
            mapped.settings.shading = shading;
            Material& m = mapped.materials[0];
            m.sheen_map.texture = -1;
            m.sheen_roughness_map.scale = {0.05F, 1};
            m.sheen_roughness_map.offset = {(static_cast<float>(band) + 0.5F) / 3, 0};
            Scene stated = mapped;
            stated.materials[0].sheen_roughness *= decoded(glm::vec4(bands[band])).w;
            stated.materials[0].sheen_roughness_map.texture = -1;
            const double apart = difference(rendered(mapped).film, rendered(stated).film);
            fmt::print("  band {}: {:.2g}\n", band, apart);
            EXPECT_LT(apart, band == 1 ? 2e-3 : 2e-5) << band;
        }
}

TEST(SheenMaps, RoughnessIsOpacityOrGreen) {
    const auto wave = [](double u, double v) {
        return static_cast<float>(0.5 + 0.4 * std::cos(4 * pi * (u + v)));
    };
    const Scene by_opacity = velvet([&](double u, double v) { return glm::vec4(1, 1, 1, wave(u, v)); });
    Scene by_green = velvet([&](double u, double v) { return glm::vec4(0, wave(u, v), 0.2, 1); });
    by_green.materials[0].sheen_map.texture = -1;
    Scene without = by_green;
    without.materials[0].sheen_roughness_map.texture = -1;
    const Film want = rendered(by_opacity).film;
    // Each number has a mantissa of its own only where it is the largest of three.
    EXPECT_LT(difference(rendered(by_green).film, want), 1e-3);
    EXPECT_GT(difference(rendered(without).film, want), 0.02);
}

// Sheen is found at vertices with everything else, as fine as they lie.
TEST(SheenMaps, AreFoundAtVertices) {
    double before = 1;
    for (const double edge_pixels : {4.0, 2.0, 1.0}) {
        Scene scene = velvet([](double u, double v) {
            const auto wave = [](double x) { return 0.5 + 0.45 * std::cos(2 * pi * x); };
            return glm::vec4(wave(u), wave(2 * v), 0.5, wave(2 * u + v));
        });
        scene.settings.edge_pixels = edge_pixels;
        scene.settings.samples = 16;
        const RenderResult grids = rendered(scene);
        const Counters& c = grids.statistics.frame.counters;
        EXPECT_GT(c.grid_evaluations, 0);
        EXPECT_EQ(c.shading_evaluations, c.grid_evaluations);
        scene.settings.shading = Shading::hits;
        const RenderResult hits = rendered(scene);
        EXPECT_EQ(hits.statistics.frame.counters.grid_evaluations, 0);
        const double apart = rms(grids.film, hits.film);
        fmt::print("  edges of {} pixels: {:.4f}\n", edge_pixels, apart);
        EXPECT_GT(apart, 0);
        EXPECT_LT(apart, before);
        before = apart;
    }
    EXPECT_LT(before, 0.01);
}

/// A point of a floor, where a roughness of 0 to 1 says that.
Scene floor_of(const Material& base, double angle, float roughness) {
    Scene s = seen_floor(base, angle);
    s.meshes[0].texcoords = {{0, 0}};
    s.meshes[0].face_texcoords = {0, 0, 0, 0};
    s.textures = {rgba_texture(256, 1, [](double u, double) { return glm::vec4(1, 1, 1, u); })};
    s.textures[0].wrap_u = Wrap::clamp;
    s.materials[0].sheen_roughness = 1;
    s.materials[0].sheen_roughness_map = {.texture = 0, .offset = {roughness, 0.5F}};
    s.sky = glm::vec3(1);
    s.settings.bounces = 1;
    return s;
}

TEST(SheenMaps, ReflectWhatTheirDefinitionDoes) {
    Material felt;
    felt.name = "felt";
    felt.albedo = {0.8F, 0.5F, 0.2F};
    felt.sheen = {1, 0.9F, 0.8F};
    for (const float roughness : {0.15F, 0.33F, 0.58F, 0.91F})
        for (const double angle : {10.0, 45.0, 80.0}) {
            Scene scene = floor_of(felt, angle, roughness);
            scene.settings.samples = 256;
            Material m = felt;
            m.sheen_roughness = roughness;
            const dvec3 expected = PlainSurface(m).reflected(view_at(angle), 256);
            for (const KernelTable* target : best_target()) {
                const dvec3 seen = mean_colour(scene, target->name);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c], expected[c], 0.006 + 0.006 * expected[c])
                        << roughness << " at " << angle << " degrees, " << target->name;
            }
        }
}

TEST(SheenMaps, GiveNoMoreThanTheyGet) {
    for (const float metallic : {0.0F, 1.0F})
        for (const float roughness : {0.0F, 0.21F, 0.33F, 0.91F})
            for (const double angle : {1.0, 75.0, 89.0}) {
                Material white;
                white.name = "white";
                white.albedo = white.sheen = glm::vec3(1);
                white.metallic = metallic;
                white.roughness = 0.3F;
                Scene scene = floor_of(white, angle, roughness);
                scene.settings.samples = 1024; // at grazing angles few find much
                const dvec3 seen = mean_colour(scene, native_targets().back()->name);
                EXPECT_LT(seen.x, 1.003) << metallic << ' ' << roughness << " at " << angle << " degrees";
            }
}

// Colours beyond 1, which pictures of floats may hold, are 1.
TEST(SheenMaps, AreNeverMoreThanAll) {
    Material m;
    m.name = "bright";
    m.sheen_roughness = 0.5F;
    m.sheen = glm::vec3(1);
    Scene scene = floor_of(m, 80, 0.5F);
    const Film want = rendered(scene).film;
    scene.textures.push_back(sky_texture(4, 4, [](double, double) { return glm::vec3(7, 1, 90); }));
    scene.materials[0].sheen_map.texture = 1;
    EXPECT_EQ(rendered(scene).film.find("R")->values, want.find("R")->values);
}

TEST(SheenMaps, OnlyWhatHasThemPays) {
    const auto varied = [](double u, double v) { return glm::vec4(u, v, 0.5, 0.2 + 0.6 * u); };
    const auto frame_of = [](const Scene& scene) { return std::make_unique<Frame>(scene, FrameOptions{}); };
    const auto arrays = [](Frame& f) { return shaded_arrays_in(f.header().instances.get()[0].shading); };
    Scene both = velvet(varied);
    EXPECT_EQ(frame_of(both)->header().sheens, sheen_rows);
    EXPECT_EQ(arrays(*frame_of(both)), 4);
    Scene colour = both;
    colour.materials[0].sheen_roughness_map.texture = -1;
    EXPECT_EQ(frame_of(colour)->header().sheens, sheen_mapped);
    EXPECT_EQ(arrays(*frame_of(colour)), 3);
    Scene plain = colour;
    plain.materials[0].sheen_map.texture = -1;
    EXPECT_EQ(frame_of(plain)->header().sheens, sheen_plain);
    EXPECT_EQ(arrays(*frame_of(plain)), 0);
    Scene black = both;
    black.materials[0].sheen = glm::vec3(0);
    EXPECT_EQ(frame_of(black)->header().sheens, sheen_none);
    EXPECT_EQ(arrays(*frame_of(black)), 0);
    Scene same = velvet([](double u, double v) { return glm::vec4(u, v, 0.5, 0.25); });
    EXPECT_EQ(frame_of(same)->header().sheens, sheen_mapped) << "roughness is the same everywhere";
    EXPECT_EQ(arrays(*frame_of(same)), 3);

    // Kernels for all of it show the same of what has less.
    for (Scene scene : {both, colour, plain, same}) {
        scene.settings.bounces = 2;
        scene.settings.diffuse_bounces = 1;
        scene.settings.width = scene.settings.height = 24;
        Scene everything = scene;
        everything.settings.everything = true;
        const Film own = rendered(scene).film, all = rendered(everything).film;
        for (const Plane& plane : own.planes)
            EXPECT_EQ(plane.values, all.find(plane.name)->values) << plane.name;
    }
}

} // namespace
} // namespace razor::test
