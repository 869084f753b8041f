// Several rectangle lights: each has shadow rays and sample points of its own, and they add up.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include "razor/frame/view.h"
#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;

/// A block on a floor, flat everywhere, under three lights of all sizes; one level, so that what rays of one
/// light open does not matter to another's.
Scene lit_block() {
    Scene s = scene_of(bilinear(cube_cage()), 6);
    Mesh floor;
    floor.name = "floor";
    floor.scheme = Scheme::bilinear;
    floor.points = {{-9, -0.9, -9}, {-9, -0.9, 9}, {9, -0.9, 9}, {9, -0.9, -9}};
    floor.face_sizes = {4};
    floor.face_vertices = {0, 1, 2, 3};
    floor.edge_length = 4;
    s.meshes.push_back(floor);
    s.sky = glm::vec3(0);
    s.lights = {{{-1, 4, -1}, {1.5, 0, 0}, {0, 0, 1.5}, {9, 1, 2}},
                {{4, 1, 2}, {0, 0.02, 0}, {0.01, 0, -0.02}, {900, 3000, 100}},
                {{-5, 3, 4}, {1, 0, 1}, {-1, 2, 1}, {1, 2, 12}}};
    for (Light& light : s.lights) // they look at the block
        if (glm::dot(glm::cross(light.edge_u, light.edge_v), light.corner) > 0)
            std::swap(light.edge_u, light.edge_v);
    s.camera.position = {2.5, 2.5, 4};
    s.camera.target = {0, -0.3, 0};
    s.settings = {
        .lod = Lod::fixed, .width = 40, .height = 40, .samples = 1, .light_samples = 3, .sky_samples = 0};
    return s;
}

RenderResult rendered(const Scene& scene) {
    RenderOptions options;
    options.threads = 1;
    return render_native(scene, options);
}

std::int64_t light_rays(const RenderResult& result) {
    return result.statistics.frame.by_kind.kind[kind_light].rays;
}

constexpr const char* colours[] = {"R", "G", "B"};

TEST(Lights, AddUp) {
    const Scene all = lit_block();
    const RenderResult together = rendered(all);
    std::vector<RenderResult> alone;
    std::int64_t rays = 0;
    for (std::size_t l = 0; l < all.lights.size(); ++l) {
        Scene one = all;
        for (std::size_t other = 0; other < all.lights.size(); ++other)
            if (other != l)
                one.lights[other].radiance = glm::vec3(0);
        alone.push_back(rendered(one));
        EXPECT_GT(light_rays(alone.back()), 300) << "of light " << l;
        rays += light_rays(alone.back());
    }
    EXPECT_EQ(light_rays(together), rays);
    for (const char* colour : colours) {
        const std::vector<float>& sum = together.film.find(colour)->values;
        std::size_t lit = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            double parts = 0;
            for (const RenderResult& one : alone)
                parts += one.film.find(colour)->values[i];
            EXPECT_NEAR(sum[i], parts, 4e-7 * parts);
            lit += parts > 0 ? 1 : 0;
        }
        EXPECT_GT(lit, sum.size() / 4);
    }
}

// One without radiance is as if it were not there, but for the numbers of those behind it.
TEST(Lights, OneWithoutRadianceCostsNoRays) {
    Scene with = lit_block();
    with.lights.resize(2);
    Scene without = with;
    with.lights.push_back({{0, 5, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}});
    const RenderResult dark = rendered(with), none = rendered(without);
    EXPECT_EQ(light_rays(dark), light_rays(none));
    for (const char* colour : colours)
        EXPECT_EQ(dark.film.find(colour)->values, none.film.find(colour)->values);
    for (Light& light : with.lights)
        light.radiance = glm::vec3(0);
    EXPECT_EQ(light_rays(rendered(with)), 0);
    without.settings.light_samples = 0;
    EXPECT_EQ(light_rays(rendered(without)), 0);
}

// A light cut into 64 pieces gives the same light, with less noise than it has in one piece.
TEST(Lights, PiecesOfALightGiveItsLight) {
    Scene whole = lit_block();
    whole.lights = {{{-3, 4, -3}, {6, 0, 0}, {0, 0, 6}, {2, 2, 2}}};
    Scene pieces = whole;
    pieces.lights.clear();
    constexpr int side = 8;
    for (int i = 0; i < side * side; ++i) {
        Light piece = whole.lights[0];
        piece.edge_u /= side;
        piece.edge_v /= side;
        piece.corner += piece.edge_u * double(i % side) + piece.edge_v * double(i / side);
        pieces.lights.push_back(piece);
    }
    whole.settings.samples = pieces.settings.samples = 1;
    pieces.settings.light_samples = 1;
    whole.settings.light_samples = 64;
    const RenderResult one = rendered(whole), many = rendered(pieces);
    EXPECT_NEAR(static_cast<double>(light_rays(many)), static_cast<double>(light_rays(one)),
                0.01 * static_cast<double>(light_rays(one)));
    const std::vector<float>& a = one.film.find("G")->values;
    const std::vector<float>& b = many.film.find("G")->values;
    double sum = 0, difference = 0, squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i];
        difference += b[i] - a[i];
        squares += (b[i] - a[i]) * (b[i] - a[i]);
    }
    const double mean = sum / static_cast<double>(a.size());
    EXPECT_GT(mean, 0.1);
    EXPECT_LT(std::abs(difference / sum), 2e-3);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(a.size())), 0.05 * mean);
}

// How densely samples lie, which levels of detail follow from, is each light's own.
TEST(Lights, SamplesAreAsFarApartAsTheirLightsAreLarge) {
    Scene scene = lit_block();
    scene.settings.samples = 5;
    scene.settings.edge_pixels = 2;
    scene.lights[0].radiance = glm::vec3(0);
    Frame frame(scene, {});
    const FrameHeader& h = frame.header();
    ASSERT_EQ(h.light_count, 2);
    for (int n = 0; n < 2; ++n) {
        const Light& light = scene.lights[static_cast<std::size_t>(n) + 1];
        const LightRecord& record = h.lights.get()[n];
        const double area = glm::length(glm::cross(light.edge_u, light.edge_v));
        EXPECT_FLOAT_EQ(record.spacing, static_cast<float>(2 * std::sqrt(area / (3 * 5))));
        EXPECT_EQ(record.samples, 3);
        EXPECT_EQ(record.dimension, 5 + n);
    }
}

/// The points that razor/kernels/sampling.h says samples have, written again.
struct Sampler {
    static std::uint32_t scramble(std::uint32_t x) {
        const std::uint32_t state = x * 747796405U + 2891336453U;
        const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
        return (word >> 22U) ^ word;
    }
    static glm::dvec2 point(std::uint32_t pixel, std::uint32_t sample, std::uint32_t dimension) {
        const std::uint32_t seed = scramble(pixel + 0x9e3779b9U * dimension);
        if (dimension != dimension_film && dimension != dimension_lens) {
            sample ^= seed;
            for (const unsigned bits : {12U, 8U, 5U, 3U, 2U, 1U})
                sample ^= (sample >> bits) * (scramble(seed) | 1U) >> (32 - bits);
        }
        const std::uint32_t x = sample * 3242174889U + seed, y = sample * 2447445414U + scramble(seed);
        return {(x >> 8U) / 16777216.0, (y >> 8U) / 16777216.0};
    }
};

// Every pixel by its definition: the hit from its depth, a point of each light a sample, brute force for what
// is in between.
TEST(Lights, EqualSumsOverTheirSamples) {
    const Scene scene = lit_block();
    for (const KernelTable* target : targets_with(true)) {
        Frame frame(scene, {});
        frame.render(*target, 0);
        Frame built(scene, {});
        built.build_all(*target);
        const Oracle oracle(built, true);
        const FrameHeader& h = frame.header();
        const float* film = h.film.get();
        const auto pixels = static_cast<std::size_t>(h.width * h.height);
        const dvec3 origin = frame.origin();
        std::size_t hits = 0, same = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            const double depth = film[film_depth * pixels + i];
            if (!std::isfinite(depth))
                continue;
            const auto pixel = static_cast<std::uint32_t>(i);
            const glm::dvec2 place = Sampler::point(pixel, 0, 1);
            dvec3 d(0), n(0);
            for (int k = 0; k < 3; ++k) {
                d[k] = h.film_corner[k] + h.film_x[k] * (static_cast<double>(i % 40) + place.x) +
                       h.film_y[k] * (static_cast<double>(i / 40) + place.y);
                n[k] = film[(film_normal + static_cast<std::size_t>(k)) * pixels + i];
            }
            const dvec3 p = scene.camera.position + glm::normalize(d) * depth + 1e-5 * n;
            dvec3 sum(0);
            for (std::size_t l = 0; l < scene.lights.size(); ++l) {
                const Light& light = scene.lights[l];
                const dvec3 across = glm::cross(light.edge_u, light.edge_v);
                for (std::uint32_t s = 0; s < 3; ++s) {
                    const std::uint32_t dimension = l == 0 ? 2 : 4 + static_cast<std::uint32_t>(l);
                    const glm::dvec2 at = Sampler::point(pixel, s, dimension);
                    const dvec3 way = light.corner + at.x * light.edge_u + at.y * light.edge_v - p;
                    const double distance = glm::length(way);
                    const dvec3 to = way / distance;
                    if (glm::dot(n, to) <= 0 || glm::dot(across, to) >= 0)
                        continue;
                    Ray ray;
                    const dvec3 from = p - origin;
                    for (std::size_t k = 0; k < 3; ++k) {
                        ray.origin[k] = static_cast<float>(from[static_cast<int>(k)]);
                        ray.direction[k] = static_cast<float>(to[static_cast<int>(k)]);
                    }
                    ray.t_min = 0;
                    ray.t_max = static_cast<float>(distance * (1 - 1e-5));
                    if (oracle.closest(ray).patch >= 0)
                        continue;
                    sum += dvec3(light.radiance) * (glm::dot(n, to) * -glm::dot(across, to) /
                                                    (distance * distance * 3 * std::numbers::pi));
                }
            }
            ++hits;
            bool all = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const double expected = sum[static_cast<int>(k)] * film[(film_albedo + k) * pixels + i];
                all = all && std::abs(film[k * pixels + i] - expected) <= 1e-4 * expected + 1e-6;
            }
            same += all ? 1 : 0;
        }
        EXPECT_GT(hits, 800U) << target->name;
        EXPECT_GE(same, hits - hits / 100) << target->name << ": rays that graze edges may go either way";
    }
}

} // namespace
} // namespace razor::test
