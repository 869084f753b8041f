// Ray and path differentials against finite differences of traced rays in double precision, and against
// closed forms; what follows from them for shadow rays on a convex shape.
#include "tests/kernels/cages.h"
#include "tests/kernels/differentials_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/frame/frame.h"
#include "razor/frame/view.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace razor::test {

RAZOR_TEST_FUNCTION(differentials, const DifferentialArrays&)

namespace {

using glm::dvec3;

using Target = TargetFunction<const DifferentialArrays&>;

/// A camera ray, a surface through its point at distance t, and what lights and lenses need.
struct Case {
    dvec3 d, film_x, film_y; // as FrameHeader has them
    double t = 1;
    dvec3 normal{0, 0, 1};
    dvec3 lens_x{1, 0, 0}, lens_y{0, 1, 0};
    double base = 0, spacing = 1, cosine = 1, inverse_distance = 1;
    double square_u = 0, square_v = 0;
};
struct Result {
    dvec3 direction_x, direction_y, origin_x, origin_y;
    double across, moved_across, lens_across, parallel_across, growth_to_area, growth_to_sky;
    double disk_x, disk_y;
};

std::vector<Result> run(const Target& target, const std::vector<Case>& cases) {
    const std::size_t width = RAZOR_WIDTH, n = (cases.size() + width - 1) / width * width;
    std::vector<std::vector<float>> arrays;
    arrays.reserve(32);
    const auto room = [&](std::size_t values) { return arrays.emplace_back(values * n, 1.0F).data(); };
    const auto one = [&](double Case::*member) {
        float* a = room(1);
        for (std::size_t i = 0; i < cases.size(); ++i)
            a[i] = static_cast<float>(cases[i].*member);
        return a;
    };
    const auto three = [&](dvec3 Case::*member) {
        float* a = room(3);
        for (std::size_t i = 0; i < cases.size(); ++i)
            for (int k = 0; k < 3; ++k)
                a[i + static_cast<std::size_t>(k) * n] = static_cast<float>((cases[i].*member)[k]);
        return a;
    };
    DifferentialArrays a;
    a.count = static_cast<int>(n);
    a.d = three(&Case::d);
    a.film_x = three(&Case::film_x);
    a.film_y = three(&Case::film_y);
    a.t = one(&Case::t);
    a.normal = three(&Case::normal);
    a.lens_x = three(&Case::lens_x);
    a.lens_y = three(&Case::lens_y);
    a.base = one(&Case::base);
    a.spacing = one(&Case::spacing);
    a.cosine = one(&Case::cosine);
    a.inverse_distance = one(&Case::inverse_distance);
    a.square_u = one(&Case::square_u);
    a.square_v = one(&Case::square_v);
    for (float** out : {&a.disk_x, &a.disk_y})
        *out = room(1);
    for (float** out : {&a.direction_x, &a.direction_y, &a.origin_x, &a.origin_y})
        *out = room(3);
    for (float** out : {&a.across, &a.moved_across, &a.lens_across, &a.parallel_across, &a.growth_to_area,
                        &a.growth_to_sky})
        *out = room(1);
    target.run(a);
    std::vector<Result> results;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto vec = [&](const float* v) { return dvec3(v[i], v[i + n], v[i + 2 * n]); };
        results.push_back({vec(a.direction_x), vec(a.direction_y), vec(a.origin_x), vec(a.origin_y),
                           a.across[i], a.moved_across[i], a.lens_across[i], a.parallel_across[i],
                           a.growth_to_area[i], a.growth_to_sky[i], a.disk_x[i], a.disk_y[i]});
    }
    return results;
}

/// Camera rays of a view, over the whole film and, slanted, beyond.
std::vector<Case> random_cases(unsigned seed, std::size_t n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    Camera camera;
    camera.position = {1, 2, 3};
    camera.fov_degrees = 70;
    const View v = view_of(camera);
    std::vector<Case> cases;
    while (cases.size() < n) {
        Case c;
        c.film_x = v.right * 0.01;
        c.film_y = v.up * -0.01;
        c.d = v.forward + v.right * (any(random) * 1.2) + v.up * (any(random) * 0.7);
        c.t = std::exp2(4 * any(random));
        c.normal = {any(random), any(random), any(random)};
        c.lens_x = v.right * (0.3 * std::exp2(any(random)));
        c.lens_y = v.up * 0.1 + v.right * (0.1 * any(random));
        // As seen from a point of the lens: the focus is nearer or further than t.
        c.d *= std::exp2(3 * any(random));
        c.film_x *= glm::dot(c.d, v.forward);
        c.film_y *= glm::dot(c.d, v.forward);
        if (std::abs(glm::dot(glm::normalize(c.normal), glm::normalize(c.d))) > 0.1)
            cases.push_back(c);
    }
    return cases;
}

/// Where a ray from `origin` along d meets the plane that the case's ray meets at distance t.
dvec3 on_plane(const Case& c, const dvec3& origin, const dvec3& d) {
    const dvec3 p = glm::normalize(c.d) * c.t;
    return origin + d * (glm::dot(p - origin, c.normal) / glm::dot(d, c.normal));
}

double apart(const dvec3& a, const dvec3& b) {
    return glm::length(a - b) / std::max(glm::length(b), 1e-30);
}

double parallelogram(const dvec3& x, const dvec3& y, const dvec3& direction) {
    return std::sqrt(std::abs(glm::dot(glm::cross(x, y), direction)));
}

constexpr double h = 1e-5;    // of a step: central differences are then exact to 1e-10 or so
constexpr double near = 2e-5; // what single precision leaves; cancellation in transfer() costs a digit

TEST(Differentials, OfAPinholeAreFiniteDifferences) {
    const std::vector<Case> cases = random_cases(1, 4096);
    for (const Target& target : differentials_of_targets()) {
        const std::vector<Result> results = run(target, cases);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Case& c = cases[i];
            const auto direction = [&](double x, double y) {
                return glm::normalize(c.d + c.film_x * x + c.film_y * y);
            };
            const auto hit = [&](double x, double y) { return on_plane(c, dvec3(0), direction(x, y)); };
            const dvec3 unit = glm::normalize(c.d);
            const dvec3 dx = (direction(h, 0) - direction(-h, 0)) / (2 * h);
            const dvec3 dy = (direction(0, h) - direction(0, -h)) / (2 * h);
            const dvec3 px = (hit(h, 0) - hit(-h, 0)) / (2 * h);
            const dvec3 py = (hit(0, h) - hit(0, -h)) / (2 * h);
            const Result& r = results[i];
            ASSERT_LT(apart(r.direction_x, dx), near) << target.name << ", case " << i;
            ASSERT_LT(apart(r.direction_y, dy), near) << target.name << ", case " << i;
            ASSERT_LT(apart(r.origin_x, px), 10 * near) << target.name << ", case " << i;
            ASSERT_LT(apart(r.origin_y, py), 10 * near) << target.name << ", case " << i;
            // Across the ray, whatever is hit.
            const double expected = parallelogram(px, py, unit);
            ASSERT_NEAR(r.across / expected, 1, near) << target.name << ", case " << i;
            ASSERT_NEAR(r.moved_across / expected, 1, 20 * near) << target.name << ", case " << i;
        }
    }
}

TEST(Differentials, OfAnOrthographicCameraAreFiniteDifferences) {
    const std::vector<Case> cases = random_cases(3, 1024);
    for (const Target& target : differentials_of_targets()) {
        const std::vector<Result> results = run(target, cases);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Case& c = cases[i];
            const auto hit = [&](double x, double y) {
                return on_plane(c, c.film_x * x + c.film_y * y, c.d);
            };
            const dvec3 px = (hit(h, 0) - hit(-h, 0)) / (2 * h);
            const dvec3 py = (hit(0, h) - hit(0, -h)) / (2 * h);
            ASSERT_NEAR(results[i].parallel_across / parallelogram(px, py, glm::normalize(c.d)), 1, near)
                << target.name << ", case " << i;
        }
    }
}

TEST(Differentials, OfALensAreFiniteDifferencesAndVanishInFocus) {
    std::vector<Case> cases = random_cases(2, 4096);
    for (std::size_t i = 0; i < cases.size(); i += 8)
        cases[i].t = glm::length(cases[i].d); // in focus
    for (const Target& target : differentials_of_targets()) {
        const std::vector<Result> results = run(target, cases);
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Case& c = cases[i];
            const dvec3 unit = glm::normalize(c.d);
            const auto hit = [&](double x, double y) { // in the plane across the ray
                const dvec3 from = c.lens_x * x + c.lens_y * y, d = glm::normalize(c.d - from);
                return from + d * (glm::dot(unit * c.t - from, unit) / glm::dot(d, unit));
            };
            const dvec3 px = (hit(h, 0) - hit(-h, 0)) / (2 * h);
            const dvec3 py = (hit(0, h) - hit(0, -h)) / (2 * h);
            const double lens = parallelogram(c.lens_x, c.lens_y, unit);
            const double confusion = lens * std::abs(1 - c.t / glm::length(c.d));
            ASSERT_NEAR(results[i].lens_across, confusion, 4 * near * lens * (1 + c.t / glm::length(c.d)))
                << target.name << ", case " << i;
            ASSERT_NEAR(parallelogram(px, py, unit), confusion, 1e-6 * lens);
        }
    }
}

/// Squares about the middle become circles of as large a part of the whole, and every eighth of a turn gets
/// as much.
TEST(Differentials, LensSamplesCoverTheDiskEvenly) {
    constexpr int side = 256;
    std::vector<Case> cases;
    for (int i = 0; i < side * side; ++i) {
        Case c;
        c.square_u = (i % side + 0.5) / side;
        c.square_v = (i / side + 0.5) / side;
        cases.push_back(c);
    }
    cases.emplace_back().square_u = 0.5; // the middle
    cases.back().square_v = 0.5;
    for (const Target& target : differentials_of_targets()) {
        const std::vector<Result> results = run(target, cases);
        std::vector<int> sectors(8);
        double moments[3] = {};
        for (std::size_t i = 0; i + 1 < results.size(); ++i) {
            const double x = results[i].disk_x, y = results[i].disk_y;
            const double from_middle =
                2 * std::max(std::abs(cases[i].square_u - 0.5), std::abs(cases[i].square_v - 0.5));
            ASSERT_NEAR(std::hypot(x, y), from_middle, 1e-6) << target.name;
            const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 1 + 1.0 / 16;
            ++sectors[static_cast<std::size_t>(turn * 8) % 8];
            moments[0] += x * x;
            moments[1] += y * y;
            moments[2] += x * y;
        }
        for (int n : sectors)
            EXPECT_NEAR(n * 8.0 / (side * side), 1, 0.02) << target.name;
        EXPECT_NEAR(moments[0] / (side * side), 0.25, 1e-4) << target.name;
        EXPECT_NEAR(moments[1] / (side * side), 0.25, 1e-4) << target.name;
        EXPECT_NEAR(moments[2] / (side * side), 0, 1e-4) << target.name;
        EXPECT_EQ(results.back().disk_x, 0);
        EXPECT_EQ(results.back().disk_y, 0);
    }
}

/// All rays of a frame grow alike; how far that is from what each pixel would ask for.
TEST(Differentials, OneGrowthStandsForAllPixels) {
    struct Film {
        double fov;
        int width, height;
        double least, most; // of a pixel's footprint to the frame's
    };
    for (const Film& f : {Film{35, 96, 96, 0.91, 1.06}, Film{90, 96, 96, 0.60, 1.39},
                          Film{40, 160, 90, 0.75, 1.13}, Film{5, 64, 64, 0.997, 1.003}}) {
        Camera camera;
        camera.fov_degrees = f.fov;
        Settings settings;
        settings.width = f.width;
        settings.height = f.height;
        const View v = view_of(camera);
        const FilmExtent film = film_extent(camera, settings);
        std::vector<Case> cases;
        for (int y = 0; y < f.height; ++y)
            for (int x = 0; x < f.width; ++x) {
                Case c;
                c.film_x = v.right * (2 * film.half_width / f.width);
                c.film_y = v.up * (-2 * film.half_height / f.height);
                c.d = v.forward - v.right * film.half_width + v.up * film.half_height + c.film_x * (x + 0.5) +
                      c.film_y * (y + 0.5);
                cases.push_back(c);
            }
        const double one = pixel_footprint(camera, settings);
        double squares = 0, least = 1e30, most = 0;
        for (const Result& r : run(differentials_of_targets().back(), cases)) {
            squares += r.across * r.across;
            least = std::min(least, r.across / one);
            most = std::max(most, r.across / one);
        }
        EXPECT_NEAR(std::sqrt(squares / static_cast<double>(cases.size())) / one, 1, 1e-3) << f.fov;
        EXPECT_GT(least, f.least) << f.fov;
        EXPECT_LT(most, f.most) << f.fov;
        RecordProperty("least_of_" + std::to_string(static_cast<int>(f.fov)), std::to_string(least));
        RecordProperty("most_of_" + std::to_string(static_cast<int>(f.fov)), std::to_string(most));
    }
}

/// Solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
double solid_angle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    return 2 * std::abs(std::atan2(glm::dot(a, glm::cross(b, c)),
                                   x * y * z + glm::dot(a, b) * z + glm::dot(a, c) * y + glm::dot(b, c) * x));
}

/// The samples' shares make up the light.
TEST(Differentials, FootprintsOfLightSamplesFillTheLight) {
    const dvec3 corner{-1, 2, -0.5}, u{1.5, 0.4, 0}, v{0, 0.3, 2};
    const dvec3 normal = glm::normalize(glm::cross(u, v));
    constexpr int side = 64;
    for (double base : {0.0, 0.01, 3.0}) {
        std::vector<Case> cases;
        std::vector<double> distances;
        for (int i = 0; i < side * side; ++i) {
            const dvec3 p = corner + u * ((i % side + 0.5) / side) + v * ((i / side + 0.5) / side);
            Case c;
            c.base = base;
            c.spacing = std::sqrt(glm::length(glm::cross(u, v))) / side;
            c.inverse_distance = 1 / glm::length(p);
            c.cosine = std::abs(glm::dot(glm::normalize(p), normal));
            cases.push_back(c);
            distances.push_back(glm::length(p));
        }
        const double expected =
            solid_angle(corner, corner + u, corner + u + v) + solid_angle(corner, corner + u + v, corner + v);
        for (const Target& target : differentials_of_targets()) {
            double sum = 0;
            bool falls = false, rises = false;
            const std::vector<Result> results = run(target, cases);
            for (std::size_t i = 0; i < cases.size(); ++i) {
                const double at_light = base + results[i].growth_to_area * distances[i];
                sum += at_light * at_light / (distances[i] * distances[i]);
                falls = falls || results[i].growth_to_area < 0;
                rises = rises || results[i].growth_to_area > 0;
            }
            EXPECT_NEAR(sum / expected, 1, base < 1 ? 1e-3 : 2e-2) << target.name << ", base " << base;
            EXPECT_EQ(falls, base >= 3) << base;
            EXPECT_EQ(rises, base < 3) << base;
        }
    }
}

/// A point light: neighbouring shadow rays meet in it.
TEST(Differentials, FootprintsTowardsAPointAreSimilarTriangles) {
    Case c;
    c.base = 0.25;
    c.spacing = 0;
    c.inverse_distance = 1 / 8.0;
    for (const Target& target : differentials_of_targets())
        EXPECT_FLOAT_EQ(static_cast<float>(run(target, {c})[0].growth_to_area), -0.25F / 8) << target.name;
}

TEST(Differentials, FootprintsOfSkySamplesFillTheHemisphere) {
    constexpr int n = 65536;
    std::vector<Case> cases;
    for (int i = 0; i < n; ++i) {
        Case c;
        c.spacing = std::sqrt(std::numbers::pi / n);
        c.cosine = std::sqrt(1 - (i + 0.5) / n);
        cases.push_back(c);
    }
    for (const Target& target : differentials_of_targets()) {
        double sum = 0;
        for (const Result& r : run(target, cases))
            sum += r.growth_to_sky * r.growth_to_sky;
        EXPECT_NEAR(sum / (2 * std::numbers::pi), 1, 5e-3) << target.name;
    }
}

/// A convex body in the light of one small or large rectangle, at rough levels: nothing of it that faces the
/// whole light may be dark, but where the light is so low that facets lean further.
TEST(Differentials, ConvexShapesDoNotShadowThemselves) {
    Mesh body = cube_cage();
    for (dvec3& p : body.points)
        p *= dvec3(1, 0.7, 1.5);
    for (double size : {1e-3, 0.3, 3.0})
        for (double edge_pixels : {0.5, 2.0, 6.0, 15.0}) {
            Scene scene = scene_of(body, 400);
            scene.meshes[0].edge_length = 0; // by the camera
            Settings& s = scene.settings;
            s.lod = Lod::recursive;
            s.width = s.height = 128;
            s.samples = s.light_samples = 1;
            s.edge_pixels = edge_pixels;
            scene.sky = glm::vec3(0);
            const dvec3 middle = scene.camera.position + dvec3(2, 3, 0);
            const dvec3 to = glm::normalize(scene.camera.target - middle);
            Light light;
            light.edge_u = size * glm::normalize(glm::cross(dvec3(0, 1, 0), to));
            light.edge_v = size * glm::normalize(glm::cross(to, light.edge_u));
            light.corner = middle - 0.5 * light.edge_u - 0.5 * light.edge_v;
            scene.lights = {light};
            Frame frame(scene, {});
            frame.render(*native_targets().back(), 0);
            const FrameHeader& header = frame.header();
            const auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
            const float* film = header.film.get();
            int faces = 0, dark = 0;
            for (std::size_t i = 0; i < pixels; ++i) {
                const double depth = film[film_depth * pixels + i];
                if (!std::isfinite(depth))
                    continue;
                dvec3 d(0), n(0);
                const double x = static_cast<double>(i % 128) + 0.5, y = static_cast<double>(i / 128) + 0.5;
                for (int k = 0; k < 3; ++k) {
                    d[k] = header.film_corner[k] + header.film_x[k] * x + header.film_y[k] * y;
                    n[k] = film[(film_normal + static_cast<std::size_t>(k)) * pixels + i];
                }
                const dvec3 p = scene.camera.position + glm::normalize(d) * depth;
                bool all = true;
                for (int k = 0; k < 4; ++k) {
                    const dvec3 q =
                        light.corner + light.edge_u * double(k % 2) + light.edge_v * double(k / 2);
                    all = all && glm::dot(glm::normalize(q - p), n) > 0.01 + 0.006 * edge_pixels;
                }
                faces += all ? 1 : 0;
                dark += all && film[i] == 0 ? 1 : 0;
            }
            EXPECT_GT(faces, 500) << size;
            EXPECT_EQ(dark, 0) << "a light of " << size << ", edges of " << edge_pixels << " pixels, of "
                               << faces;
        }
}

} // namespace
} // namespace razor::test
