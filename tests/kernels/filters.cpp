// Reconstruction filters: the tables that samples are drawn by beside the filters' integrals, where samples
// come to lie, and pictures of an edge beside its convolution.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/filter_table.h"
#include "razor/frame/frame.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

std::vector<Filter> filters() {
    std::vector<Filter> all;
    for (const FilterKind kind : {FilterKind::box, FilterKind::triangle, FilterKind::gaussian,
                                  FilterKind::mitchell, FilterKind::lanczos})
        all.push_back(preset_filter(kind));
    all[0].radius = {1, 0.75};
    all[1].radius = {1.5, 2};
    all[3].radius = {2, 1.25};
    all.push_back(preset_filter(FilterKind::mitchell)); // a cubic B-spline: nowhere negative
    all.back().b = 1;
    all.back().c = 0;
    return all;
}

std::string name_of(const Filter& f) {
    return std::to_string(static_cast<int>(f.kind)) + ", b " + std::to_string(f.b);
}

/// Of one axis' factor, or of its absolute value, by the middles of many small steps.
double integral(const Filter& f, int axis, double begin, double end, bool absolute = false,
                int steps = 2000) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double value = filter_at(f, axis, begin + (end - begin) * (i + 0.5) / steps);
        sum += absolute ? std::abs(value) : value;
    }
    return sum * (end - begin) / steps;
}

TEST(Filters, HaveTheValuesOfTheirFormulas) {
    const std::vector<Filter> f = filters();
    EXPECT_EQ(filter_at(f[0], 0, 0.99), 1);
    EXPECT_EQ(filter_at(f[0], 0, 1.01), 0);
    EXPECT_EQ(filter_at(f[1], 1, 0.5), 1.5);
    EXPECT_NEAR(filter_at(f[2], 0, 0), 1 - std::exp(-4.5), 1e-15); // three deviations
    EXPECT_NEAR(filter_at(f[2], 0, 1.5), 0, 1e-15);
    EXPECT_NEAR(filter_at(f[3], 0, 0), 8.0 / 9, 1e-15);
    EXPECT_NEAR(filter_at(f[3], 0, 1), 1.0 / 18, 1e-15); // B / 6
    EXPECT_NEAR(filter_at(f[3], 0, -2), 0, 1e-15);
    EXPECT_EQ(filter_at(f[4], 0, 0), 1);
    EXPECT_NEAR(filter_at(f[4], 0, -2), 0, 1e-15);
    EXPECT_NEAR(filter_at(f[4], 1, 1.5),
                std::sin(1.5 * M_PI) / (1.5 * M_PI) * std::sin(0.5 * M_PI) / (0.5 * M_PI), 1e-15);
}

TEST(Filters, TablesHoldTheirIntegrals) {
    for (const Filter& f : filters()) {
        const FilterTable table = tabulate(f);
        ASSERT_EQ(table.bins.size(), 2U * filter_bins);
        EXPECT_EQ(table.weighted,
                  f.kind == FilterKind::lanczos || (f.kind == FilterKind::mitchell && f.b < 1));
        for (const int axis : {0, 1}) {
            const double radius = f.radius[axis], all = integral(f, axis, -radius, radius);
            const FilterBin* bin = table.bins.data() + axis * filter_bins;
            double weights = 0, at = 0.5 - radius;
            for (int i = 0; i < filter_bins; ++i, ++bin) {
                ASSERT_NEAR(bin->from, at, 2e-6) << name_of(f);
                at = double{bin->from} + double{bin->width};
                const double part = integral(f, axis, bin->from - 0.5, at - 0.5, false, 200) / all;
                ASSERT_NEAR(bin->weight / filter_bins, part, 3e-6) << name_of(f) << ", bin " << i;
                // Of one sign: what is negative in it does not cancel what is not.
                ASSERT_NEAR(std::abs(part), integral(f, axis, bin->from - 0.5, at - 0.5, true, 200) / all,
                            3e-6);
                weights += bin->weight;
            }
            EXPECT_NEAR(at, 0.5 + radius, 2e-6);
            EXPECT_NEAR(weights / filter_bins, 1, 1e-5) << name_of(f);
        }
    }
}

TEST(Filters, AreRefusedWhereTheyCannotBeDrawn) {
    Filter f = preset_filter(FilterKind::lanczos);
    f.tau = 0.03;
    EXPECT_THROW(tabulate(f), UserError);
}

/// A board z = slope . (x, y) - 9 that fills the film of an orthographic camera, whose pixels are one unit.
Scene board(double slope_x, double slope_y, int width, int height) {
    Mesh m;
    m.name = "board";
    m.scheme = Scheme::bilinear;
    for (const auto& [x, y] : {std::pair{-99, -99}, {99, -99}, {99, 99}, {-99, 99}})
        m.points.emplace_back(x, y, x * slope_x + y * slope_y - 9);
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    Scene s;
    s.name = m.name;
    s.meshes = {m};
    s.materials = {{.name = "white", .albedo = glm::vec3(1)}};
    s.camera.position = {0, 0, 100};
    s.camera.target = {0, 0, 0};
    s.camera.projection = Projection::orthographic;
    s.camera.height = height;
    s.settings.width = width;
    s.settings.height = height;
    s.settings.samples = 1;
    return s;
}

Film rendered(const Scene& scene, const KernelTable& kernels = *native_targets().back()) {
    Frame frame(scene, {});
    frame.render(kernels, 0);
    return frame.film();
}

/// Of so many classes, a multiple of how far that may be by chance.
double chi_square(const std::vector<double>& places, const Filter& f, int axis) {
    constexpr int classes = 32;
    const double radius = f.radius[axis], all = integral(f, axis, -radius, radius, true);
    std::vector<int> counts(classes);
    for (const double x : places) {
        EXPECT_LE(std::abs(x), radius + 1e-3);
        ++counts[static_cast<std::size_t>(std::clamp((x / radius + 1) / 2 * classes, 0.0, classes - 1.0))];
    }
    double sum = 0;
    int degrees = -1;
    for (int i = 0; i < classes; ++i) {
        const double begin = radius * (2.0 * i / classes - 1), end = begin + 2 * radius / classes;
        const double expected =
            integral(f, axis, begin, end, true) / all * static_cast<double>(places.size());
        if (expected < 5)
            continue;
        sum += (counts[static_cast<std::size_t>(i)] - expected) *
               (counts[static_cast<std::size_t>(i)] - expected) / expected;
        ++degrees;
    }
    return (sum - degrees) / std::sqrt(2.0 * degrees);
}

/// The depth of a leaning board tells where a pixel's one sample lies.
TEST(Filters, SamplesLieAsTheFilterSays) {
    constexpr int side = 96;
    for (const Filter& f : filters())
        for (const int axis : {0, 1}) {
            Scene scene = board(axis == 0 ? 0.5 : 0, axis == 0 ? 0 : 0.5, side, side);
            scene.settings.filter = f;
            const Film film = rendered(scene);
            const auto& depth = film.find("depth.Z")->values;
            std::vector<double> places;
            for (int row = 0; row < side; ++row)
                for (int column = 0; column < side; ++column) {
                    const double at = (109 - depth[static_cast<std::size_t>(row * side + column)]) * 2;
                    const double middle = axis == 0 ? column + 0.5 - side / 2.0 : side / 2.0 - row - 0.5;
                    places.push_back(axis == 0 ? at - middle : middle - at);
                }
            EXPECT_LT(chi_square(places, f, axis), 4) << name_of(f) << ", axis " << axis;
            for (double& place : places)
                place *= 0.93;
            EXPECT_GT(chi_square(places, f, axis), 8) << name_of(f) << ": the test cannot tell";
        }
}

/// White on one side of a line, black under a white sky on the other.
TEST(Filters, AnEdgeIsItsConvolution) {
    constexpr int width = 24, height = 16;
    for (const Filter& f : filters())
        for (const int axis : {0, 1}) {
            Scene scene = board(0, 0, width, height);
            for (glm::dvec3& p : scene.meshes[0].points)
                p[axis] = std::min(p[axis], 0.3);
            scene.sky = glm::vec3(1);
            scene.settings.sky_samples = 0;
            scene.settings.filter = f;
            scene.settings.samples = 256;
            const Film film = rendered(scene);
            const auto &albedo = film.find("albedo.G")->values, &beauty = film.find("G")->values;
            const double radius = f.radius[axis], all = integral(f, axis, -radius, radius);
            // Independent samples of weights whose squares' mean is over^2 would be off by over / 16; a
            // sequence is by less, and where none counts negative by no more than a few of its 256. The
            // table's own error, within its 512 bins, is less than that.
            double over = 1;
            for (const int a : {0, 1})
                over *= integral(f, a, -f.radius[a], f.radius[a], true) /
                        integral(f, a, -f.radius[a], f.radius[a]);
            const double bound = tabulate(f).weighted ? over / 16 : 6.0 / 256;
            std::vector<double> along(width + height), expected(width + height);
            for (int row = 0; row < height; ++row)
                for (int column = 0; column < width; ++column) {
                    const auto i = static_cast<std::size_t>(row * width + column);
                    const auto line = static_cast<std::size_t>(axis == 0 ? column : row);
                    const double middle = axis == 0 ? column + 0.5 - width / 2.0 : height / 2.0 - row - 0.5;
                    const double ahead = std::clamp(0.3 - middle, -radius, radius);
                    expected[line] = integral(f, axis, -radius, ahead) / all; // filters are even
                    along[line] += albedo[i] / (axis == 0 ? height : width);
                    ASSERT_NEAR(albedo[i], expected[line], bound) << name_of(f) << ", axis " << axis;
                    ASSERT_NEAR(beauty[i], 1 - expected[line], bound) << name_of(f) << ", axis " << axis;
                }
            // What all pixels of a line along the edge have in common.
            for (std::size_t line = 0; line < along.size(); ++line)
                EXPECT_NEAR(along[line], expected[line], bound / 4)
                    << name_of(f) << ", axis " << axis << ", line " << line;
        }
}

TEST(Filters, WhatIsEvenStaysSo) {
    for (const Filter& f : filters())
        for (const int samples : {1, 3, 4}) {
            Scene scene = board(0, 0, 20, 20);
            scene.settings.filter = f;
            scene.settings.samples = samples;
            const Film film = rendered(scene);
            for (const float a : film.find("albedo.R")->values)
                ASSERT_NEAR(a, 1, 3e-6) << name_of(f) << ", " << samples << " samples";
            for (const float d : film.find("depth.Z")->values)
                ASSERT_NEAR(d, 109, 1e-4);
            for (const float z : film.find("normal.Z")->values)
                ASSERT_NEAR(z, 1, 1e-6);
        }
}

TEST(Filters, OfAPixelAreLeftOut) {
    Scene scene = board(0, 0, 8, 8);
    EXPECT_EQ(Frame(scene, {}).header().filter_use, filter_pixel);
    scene.settings.filter = preset_filter(FilterKind::gaussian);
    EXPECT_EQ(Frame(scene, {}).header().filter_use, filter_even);
    scene.settings.filter = preset_filter(FilterKind::lanczos);
    EXPECT_EQ(Frame(scene, {}).header().filter_use, filter_weighted);
}

TEST(Filters, PicturesAreTheSameOnEveryTargetAndInParts) {
    for (const FilterKind kind : {FilterKind::triangle, FilterKind::mitchell}) {
        Scene scene = named_scene("urchin_stretched")->scene;
        scene.settings.filter = preset_filter(kind);
        scene.settings.samples = 6; // packets take two of a pixel together
        scene.settings.height = 27;
        const Film whole = rendered(scene, *targets_with(true).front());
        scene.settings.crop = {5, 7, 20, 9};
        for (const KernelTable* target : targets_with(true)) {
            const Film part = rendered(scene, *target);
            for (const Plane& plane : part.planes)
                for (int y = 0; y < 9; ++y) {
                    const float* row = whole.find(plane.name)->values.data() + (7 + y) * 32 + 5;
                    EXPECT_TRUE(std::equal(row, row + 20, plane.values.data() + y * 20))
                        << target->name << ' ' << plane.name << " row " << y;
                }
        }
    }
}

} // namespace
} // namespace razor::test
