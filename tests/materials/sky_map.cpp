// Skies that maps show: sampled as often as their density says, seen where they are, and their light is the
// integral over them.
#include "razor/frame/sky_distribution.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/target_functions.h"
#include "tests/materials/floor.h"
#include "tests/materials/plain_surface.h"
#include "tests/materials/skies.h"
#include "tests/materials/sky_kernel.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace razor::test {

RAZOR_TEST_FUNCTION(sky, const SkyArrays&)

namespace {

using glm::dvec3;
using std::numbers::pi;

using Target = TargetFunction<const SkyArrays&>;

struct Map {
    const char* name;
    Texture texture;
};
std::vector<Map> maps() {
    const auto hard = [](double u, double v) { return morning(u, v, 0.02, 60000); };
    return {{"morning", sky_texture(64, 32, [](double u, double v) { return morning(u, v, 0.2, 20); })},
            {"sun", sky_texture(300, 150, hard)},
            {"larger than what is sampled", sky_texture(1500, 40, hard)},
            {"tall", sky_texture(3, 50, hard)},
            {"one texel", sky_texture(1, 1, [](double, double) { return glm::vec3(0.25F); })},
            {"one texel of many", sky_texture(128, 64, [](double u, double v) {
                 return glm::vec3(std::abs(u - 0.7) < 0.004 && std::abs(v - 0.6) < 0.008 ? 60000 : 0);
             })}};
}

/// The record of a map's distribution, in memory of its own.
struct Sampled {
    explicit Sampled(const Texture& texture) : d(sky_distribution(*texture.pyramid)) {
        const auto step = [](int n) {
            return n < 2 ? 0 : static_cast<int>(std::bit_floor(static_cast<unsigned>(n - 1)));
        };
        record.turn = 0.37F;
        record.columns = d.columns;
        record.rows = d.rows;
        record.column_step = step(d.columns);
        record.row_step = step(d.rows);
        record.heights.set(d.heights.data());
        record.row_sums.set(d.row_sums.data());
        record.cell_sums.set(d.cell_sums.data());
        record.row_density.set(d.row_density.data());
    }
    SkyDistribution d;
    SkyRecord record{};
};

TEST(SkyMap, ChancesAddUpAndLeaveNothingOut) {
    for (const Map& map : maps()) {
        const SkyDistribution d = sky_distribution(*map.texture.pyramid);
        ASSERT_GT(d.rows, 0) << map.name;
        EXPECT_LE(d.columns, most_sky_columns);
        EXPECT_LE(d.rows, most_sky_rows);
        double all = 0;
        for (int y = 0; y < d.rows; ++y) {
            const auto row = static_cast<std::size_t>(y);
            const double solid_angle = 2 * pi * (double{d.heights[row]} - d.heights[row + 1]) / d.columns;
            for (int x = 0; x < d.columns; ++x) {
                const std::size_t cell =
                    row * static_cast<std::size_t>(d.columns + 1) + static_cast<std::size_t>(x);
                const double chance = double{d.cell_sums[cell + 1]} - d.cell_sums[cell];
                const double density = chance * d.row_density[row];
                EXPECT_GT(density, 0.9 * even_share / (4 * pi)) << map.name << ' ' << x << ' ' << y;
                all += density * solid_angle;
            }
        }
        EXPECT_NEAR(all, 1, 1e-5) << map.name;
    }
    EXPECT_EQ(sky_distribution(*sky_texture(8, 4, [](double, double) { return glm::vec3(0); }).pyramid).rows,
              0);
}

TEST(SkyMap, DirectionsComeAsOftenAsTheirDensitySays) {
    constexpr int samples = 1 << 17, rings = 16, sectors = 32;
    for (const Map& map : maps())
        for (const Target& target : sky_of_targets()) {
            Sampled sky(map.texture);
            std::vector<float> u(samples), v(samples), to(3 * samples), density(samples), there(samples);
            std::mt19937 random(11);
            for (int i = 0; i < samples; ++i) {
                u[static_cast<std::size_t>(i)] = static_cast<float>(random() >> 8U) / 16777216.0F;
                v[static_cast<std::size_t>(i)] = static_cast<float>(random() >> 8U) / 16777216.0F;
            }
            target.run({samples, &sky.record, u.data(), v.data(), to.data(), density.data(), there.data()});
            // The mean of 1 / density over a part of the sphere is its solid angle; bins by the chance that
            // they have.
            std::vector<double> found(rings * sectors, 0), squares(found.size(), 0);
            std::vector<int> count(found.size(), 0);
            int apart = 0;
            for (std::size_t i = 0; i < samples; ++i) {
                const dvec3 d(to[i], to[samples + i], to[2 * samples + i]);
                ASSERT_NEAR(glm::length(d), 1, 1e-5) << map.name;
                const double ring = std::clamp((d.y + 1) / 2 * rings, 0.0, rings - 1.0);
                const double sector = (std::atan2(d.z, d.x) / (2 * pi) + 0.5) * sectors;
                const std::size_t bin = static_cast<std::size_t>(ring) * sectors +
                                        std::min(static_cast<std::size_t>(sector), std::size_t{sectors - 1});
                ++count[bin];
                found[bin] += 1 / double{density[i]};
                squares[bin] += 1 / (double{density[i]} * density[i]);
                // What is next to a cell's border may fall on its other side.
                apart += std::abs(density[i] - there[i]) > 1e-4 * density[i] ? 1 : 0;
            }
            EXPECT_LT(apart, samples / 500) << map.name << ' ' << target.name;
            double chi_square = 0, few = 0, few_squares = 0, few_bins = 0, d = 0;
            const auto add = [&](double sum, double of_squares, double bins) {
                const double mean = sum / samples, expect = bins * 4 * pi / (rings * sectors);
                chi_square +=
                    (mean - expect) * (mean - expect) / ((of_squares / samples - mean * mean) / samples);
                ++d;
            };
            for (std::size_t b = 0; b < found.size(); ++b) {
                if (count[b] >= 20) {
                    add(found[b], squares[b], 1);
                    continue;
                }
                few += found[b]; // together
                few_squares += squares[b];
                ++few_bins;
            }
            if (few_bins > 0)
                add(few, few_squares, few_bins);
            const double z = (std::cbrt(chi_square / d) - (1 - 2 / (9 * d))) / std::sqrt(2 / (9 * d));
            EXPECT_LT(z, 6) << map.name << ' ' << target.name << ": chi-square " << chi_square << " of " << d;
        }
}

// Looking around in a map of few texels, cameras see which is where, however it is turned.
TEST(SkyMap, IsSeenWhereItIs) {
    for (const double rotation : {0.0, 90.0, -400.0}) {
        Scene scene = scene_of(cube_cage(), 16);
        scene.meshes[0].points = {{90, 90, 90}, {91, 90, 90}, {91, 91, 90}, {90, 91, 90},
                                  {90, 90, 91}, {91, 90, 91}, {91, 91, 91}, {90, 91, 91}};
        scene.lights.clear();
        scene.sky = {2, 1, 0.5F};
        set_sky(scene, sky_texture(16, 8, [](double u, double v) { return glm::vec3(u, v, 1 - u); }),
                rotation);
        scene.settings.width = scene.settings.height = 16;
        scene.settings.samples = 64;
        scene.camera.fov_degrees = 2;
        scene.camera.position = {0, 0, 0};
        std::mt19937 random(5);
        for (int k = 0; k < 12; ++k) {
            const auto number = [&] { return static_cast<double>(random()) / 0x1p31 - 1; };
            const dvec3 to = glm::normalize(dvec3(number(), number(), number()));
            scene.camera.target = to;
            scene.camera.up = std::abs(to.y) > 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
            const dvec3 seen = mean_colour(scene, native_targets().back()->name),
                        is = sky_radiance(scene, to);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c], is[c], 0.02) << rotation << ", " << to.x << ' ' << to.y << ' ' << to.z;
        }
    }
}

Material material(float metallic, float roughness, float coat) {
    Material m;
    m.name = "tested";
    m.albedo = {0.8F, 0.5F, 0.2F};
    m.metallic = metallic;
    m.roughness = roughness;
    m.specular = 1;
    m.coat = coat;
    m.coat_roughness = 0.25F;
    return m;
}

/// Over the upper half of a map's sky.
dvec3 reflected(const Scene& scene, const Material& m, double angle) {
    const PlainSurface plain(m);
    constexpr int rings = 400, sectors = 1200;
    dvec3 sum(0);
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            const double z = (i + 0.5) / rings, s = std::sqrt(1 - z * z), phi = 2 * pi * (j + 0.5) / sectors;
            const dvec3 l(s * std::cos(phi), s * std::sin(phi), z);
            sum += plain.reflectance(view_at(angle), l) * sky_radiance(scene, to_scene(l)) * z;
        }
    return sum * (2 * pi / (rings * sectors));
}

// Whether samples of the map find it, or bounces, or both.
TEST(SkyMap, LightIsTheIntegralOverTheMap) {
    for (const double brightness : {20.0, 2000.0})
        for (const auto& [m, bounces] : {std::pair{material(0, 1, 0), 0},
                                         {material(0, 0.4F, 1), 1},
                                         {material(1, 0.2F, 0), 1},
                                         {material(1, 0.5F, 1), 1},
                                         {material(1, 0.6F, 0), 0}})
            for (const int sky_samples : {1, 4}) {
                Scene scene = seen_floor(m, 40);
                scene.sky = {1, 0.5F, 0.8F};
                set_sky(
                    scene,
                    sky_texture(128, 64, [&](double u, double v) { return morning(u, v, 0.15, brightness); }),
                    30);
                scene.settings.samples = 256;
                scene.settings.sky_samples = sky_samples;
                scene.settings.bounces = bounces;
                const dvec3 all = reflected(scene, m, 40);
                for (const KernelTable* target : best_target()) {
                    dvec3 error;
                    const dvec3 seen = mean_colour(scene, target->name, &error);
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(seen[c], all[c], 0.005 * all[c] + 3 * error[c])
                            << target->name << ": roughness " << m.roughness << ", metallic " << m.metallic
                            << ", " << bounces << " bounces, " << sky_samples << " samples, brightness "
                            << brightness;
                    EXPECT_LT(error.x, 0.03 * all.x) << "noise hides mistakes";
                }
            }
}

// A matte floor needs no materials' records, and reflects the map all the same; a map that shows one radiance
// everywhere is a sky without one.
TEST(SkyMap, OfOneRadianceIsTheSkyWithoutIt) {
    for (const float metallic : {0.0F, 1.0F}) {
        Material m;
        m.albedo = {0.8F, 0.5F, 0.2F};
        m.metallic = metallic;
        m.roughness = 0.3F;
        Scene plain = seen_floor(m, 50);
        plain.sky = {1, 2, 3};
        plain.settings.samples = 256;
        plain.settings.bounces = 1;
        Scene mapped = plain;
        mapped.sky = {2, 4, 6};
        set_sky(mapped, sky_texture(5, 3, [](double, double) { return glm::vec3(0.5F); }));
        for (const KernelTable* target : best_target()) {
            dvec3 error;
            const dvec3 one = mean_colour(plain, target->name),
                        other = mean_colour(mapped, target->name, &error);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(one[c], other[c], 0.003 * one[c] + 3 * error[c])
                    << target->name << ", metallic " << metallic;
        }
    }
}

TEST(SkyMap, BlackIsNoLight) {
    Scene scene = scene_of(torus_cage(6, 5), 24);
    scene.lights.clear();
    scene.sky = glm::vec3(1);
    set_sky(scene, sky_texture(8, 4, [](double, double) { return glm::vec3(0); }));
    const dvec3 seen = mean_colour(scene, native_targets().back()->name);
    EXPECT_EQ(seen, dvec3(0));
}

} // namespace
} // namespace razor::test
