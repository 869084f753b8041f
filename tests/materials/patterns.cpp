// Patterns against their definitions in double precision, without filters and averaged over what rays ask
// for; where objects go, patterns go with them; bumps bend normals as slopes say.
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"
#include "tests/materials/plain_pattern.h"

#include "razor/scene/error.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace razor::test {
namespace {

using glm::dvec3;

constexpr std::array kinds{PatternKind::checker,    PatternKind::bricks, PatternKind::noise,
                           PatternKind::turbulence, PatternKind::marble, PatternKind::wood};

/// A floor without texture coordinates, y up, each of whose pixels looks straight down at a square of
/// `asked`.
Scene floor_with(const Pattern& pattern, double asked) {
    Scene s = seen_floor({}, 0);
    s.textures.resize(1);
    s.textures[0].name = "pattern";
    s.textures[0].pattern = pattern;
    s.materials[0].albedo = {1, 1, 1};
    s.materials[0].albedo_map.texture = 0;
    s.camera.projection = Projection::orthographic;
    s.settings.width = s.settings.height = 24;
    s.settings.samples = 1;
    s.camera.height = asked * s.settings.height;
    s.camera.position = {0, 10, 0};
    s.camera.target = {0, 0, 0};
    s.camera.up = {0, 0, -1};
    return s;
}

struct Seen {
    std::vector<double> value;
    std::vector<dvec3> place, normal;
};
Seen look(const Scene& scene) {
    RenderOptions options;
    options.threads = 1;
    options.isa = native_targets().back()->name;
    const Film film = render_native(scene, options).film;
    Seen seen;
    const int n = scene.settings.width;
    const double step = scene.camera.height / n;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto p = static_cast<std::size_t>(j * n + i);
            seen.value.push_back(double{film.find("albedo.R")->values[p]});
            seen.place.emplace_back(scene.camera.position.x + (i + 0.5 - n / 2.0) * step, 0,
                                    scene.camera.position.z + (j + 0.5 - n / 2.0) * step);
            seen.normal.emplace_back(film.find("normal.X")->values[p], film.find("normal.Y")->values[p],
                                     film.find("normal.Z")->values[p]);
        }
    return seen;
}

// With one sample a pixel in a pixel so small that its place does not matter.
TEST(Patterns, AreWhatTheirDefinitionsSay) {
    std::mt19937 random(5);
    const auto next = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    for (const PatternKind kind : kinds) {
        int off = 0, seen = 0;
        for (int n = 0; n < 40; ++n) {
            Pattern p{.kind = kind, .size = std::exp2(2 * next()), .octaves = 1 + n % 3};
            p.amount = kind == PatternKind::bricks ? 0.1F : 0.7F;
            Scene scene = floor_with(p, 1e-6 * p.size);
            // Mesh coordinates: the floor is `height` above its object's plane.
            const dvec3 middle{7 * next(), 0.37 * p.size, 7 * next()};
            scene.graph.groups = {
                {"scene",
                 {{.name = "floor", .mesh = 0, .local = {.translate = {0, -middle.y, 0}}, .material = 0}}}};
            for (dvec3& point : scene.meshes[0].points)
                point.y += middle.y;
            scene.camera.position = {middle.x, 10, middle.z};
            scene.camera.target = {middle.x, 0, middle.z};
            const Seen s = look(scene);
            ++seen;
            const double expected = plain_value(p, middle / p.size);
            off += std::abs(s.value[12 * 24 + 12] - expected) > 2e-3;
        }
        // Filters are a thousandth of a cell wide: steps may be as near.
        EXPECT_LE(off, kind == PatternKind::checker || kind == PatternKind::bricks ? 1 : 0)
            << static_cast<int>(kind) << " of " << seen;
    }
}

// From afar each pixel shows the mean of its square, not a point of it.
TEST(Patterns, AreSeenThroughWhatRaysAskFor) {
    for (const PatternKind kind : kinds)
        for (const double cells : {2.0, 5.0, 40.0}) {
            Pattern p{.kind = kind, .size = 0.125, .octaves = 4};
            p.amount = kind == PatternKind::bricks ? 0.1F : 0.5F;
            const double asked = cells * p.size;
            Scene scene = floor_with(p, asked);
            scene.settings.edge_pixels = 1;
            const Seen s = look(scene);
            double sum = 0, point = 0;
            const int n = 24;
            for (std::size_t k = 0; k < s.value.size(); ++k) {
                double mean = 0;
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < n; ++i) {
                        const dvec3 within((i + 0.5) / n - 0.5, 0, (j + 0.5) / n - 0.5);
                        mean += plain_value(p, (s.place[k] + asked * within) / p.size);
                    }
                mean /= n * n;
                sum += std::pow(s.value[k] - mean, 2);
                point += std::pow(plain_value(p, s.place[k] / p.size) - mean, 2);
            }
            const double rms = std::sqrt(sum / double(s.value.size())),
                         of_points = std::sqrt(point / double(s.value.size()));
            fmt::print("  pattern {}, {} cells a pixel: off by {:.4f}, points by {:.4f}\n",
                       static_cast<int>(kind), cells, rms, of_points);
            // A ray's place in its pixel is by chance; what it sees there is as wide as the pixel.
            EXPECT_LT(rms, 0.7 * of_points) << static_cast<int>(kind) << ' ' << cells;
            if (cells > 10) {
                EXPECT_LT(rms, 0.08) << static_cast<int>(kind); // 24 points a side are no more exact
            }
        }
}

TEST(Patterns, GoWithTheirObjects) {
    for (const bool mirrored : {false, true}) {
        Pattern p{.kind = PatternKind::noise, .size = 0.5, .octaves = 2};
        Scene scene = floor_with(p, 1e-4);
        const Transform local{
            .scale = {mirrored ? -3.0 : 3.0, 3, 3}, .rotate = {0, 35, 0}, .translate = {1, 0.2, -2}};
        scene.graph.groups = {{"scene", {{.name = "floor", .mesh = 0, .local = local, .material = 0}}}};
        const Affine world = to_affine(local);
        for (const dvec3& at : {dvec3(0.3, 0, 0.1), dvec3(-1.4, 0, 2.2), dvec3(5, 0, 5)}) {
            const dvec3 seen = world.linear * at + world.translation;
            scene.camera.position = seen + dvec3(0, 10, 0);
            scene.camera.target = seen;
            EXPECT_NEAR(look(scene).value[12 * 24 + 12], plain_value(p, at / p.size), 3e-3) << mirrored;
        }
    }
}

TEST(Patterns, NeedCoordinatesOnlyIfTheyAreOfThose) {
    Scene scene = floor_with({.kind = PatternKind::checker, .space = PatternSpace::texture}, 0.1);
    EXPECT_THROW(look(scene), UserError);
    scene.textures[0].pattern->space = PatternSpace::object;
    EXPECT_NO_THROW(look(scene));
}

// A floor whose heights are waves: normals are those of the waves, however the object is turned and scaled.
TEST(Bumps, BendNormalsAsTheirSlopesSay) {
    constexpr double height = 0.05;
    for (const bool mirrored : {false, true})
        for (const double scale : {1.0, 4.0}) {
            Pattern p{.kind = PatternKind::marble, .octaves = 1};
            p.amount = 0; // sin(2 pi x)
            Scene scene = floor_with(p, 0.01 * scale);
            Material& m = scene.materials[0];
            m.albedo_map = {};
            m.bump_map.texture = 0;
            m.bump = static_cast<float>(height);
            const Transform local{.scale = {mirrored ? -scale : scale, scale, scale}, .rotate = {0, 20, 0}};
            scene.graph.groups = {{"scene", {{.name = "floor", .mesh = 0, .local = local, .material = 0}}}};
            const glm::dmat3 back = glm::inverse(to_affine(local).linear);
            const dvec3 along = glm::normalize(to_affine(local).linear[0]); // of the object's x
            const Seen s = look(scene);
            double worst = 0;
            for (std::size_t k = 0; k < s.value.size(); ++k) {
                const double x = (back * s.place[k]).x, turn = 2 * std::numbers::pi;
                const double slope = height * 0.5 * turn * std::cos(turn * x);
                const dvec3 expected = glm::normalize(dvec3(0, 1, 0) - slope * along);
                worst = std::max(worst, glm::distance(s.normal[k], expected));
            }
            EXPECT_LT(worst, 0.02) << mirrored << ' ' << scale; // differences over half a pixel, a pixel off
        }
}

TEST(Bumps, OfNoHeightBendNothing) {
    Scene scene = floor_with({.kind = PatternKind::noise}, 0.1);
    scene.materials[0].albedo_map = {};
    scene.materials[0].bump_map.texture = 0;
    for (const dvec3& n : look(scene).normal)
        EXPECT_LT(glm::distance(n, dvec3(0, 1, 0)), 1e-6);
}

} // namespace
} // namespace razor::test
