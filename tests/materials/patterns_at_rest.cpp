// Patterns stay on surfaces that change their shape: a sheet whose points at rest are its texture coordinates
// shows a pattern of points as it shows the same pattern of texture coordinates, which the surface carries by
// other means, wherever its points go.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace razor::test {
namespace {

/// A sheet of quads, one of which is two triangles and one four about a point, that has been bent, stretched
/// and folded. `size`: of the pattern's cells.
Mesh bent_sheet(Scheme scheme, double size) {
    constexpr int columns = 7, rows = 6;
    Mesh m;
    m.name = "sheet";
    m.scheme = scheme;
    m.face_varying = FaceVaryingInterpolation::none; // as points are
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            m.rest.emplace_back(0.3 * i + 0.05 * std::sin(3.0 * j), 0.3 * j + 0.07 * std::cos(2.0 * i), 0);
    const auto corner = [](int i, int j) { return j * (columns + 1) + i; };
    const auto face = [&m](std::initializer_list<int> corners) {
        m.face_sizes.push_back(static_cast<int>(corners.size()));
        m.face_vertices.insert(m.face_vertices.end(), corners);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const int a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
            if (i == 2 && j == 3) {
                face({a, b, c});
                face({a, c, d});
            } else if (i == 4 && j == 1) {
                const auto middle = static_cast<int>(m.rest.size());
                m.rest.push_back((m.rest[static_cast<std::size_t>(a)] + m.rest[static_cast<std::size_t>(c)]) /
                                 2.0);
                for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}})
                    face({p, q, middle});
            } else {
                face({a, b, c, d});
            }
        }
    for (glm::dvec3& p : m.rest) {
        m.texcoords.emplace_back(p.x, p.y);
        p.z = size / 4; // where patterns of texture coordinates lie
        const double turn = 1.3 * p.x;
        m.points.emplace_back(std::sin(turn) + 0.2 * p.y * p.y, p.y * (0.4 + 0.5 * p.x),
                              0.8 * std::cos(turn) + 0.3 * std::sin(3 * p.y));
    }
    m.face_texcoords = m.face_vertices;
    return m;
}

/// The sheet as it is, and turned over, stretched and moved.
Scene sheets(Scheme scheme, PatternKind kind, PatternSpace space, double size = 0.4) {
    Scene s = scene_of(bent_sheet(scheme, size), 60);
    s.settings.width = s.settings.height = 64;
    s.settings.samples = 4;
    s.graph.groups = {
        {"scene",
         {{.name = "one", .mesh = 0, .local = {}, .material = 0},
          {.name = "other",
           .mesh = 0,
           .local = {.scale = {-0.6, 0.8, 0.5}, .rotate = {20, 40, 5}, .translate = {1.4, 0.3, 0.4}},
           .material = 0}}}};
    s.textures.resize(1);
    s.textures[0].name = "pattern";
    s.textures[0].pattern = Pattern{.kind = kind, .space = space, .size = size, .octaves = 2};
    s.textures[0].pattern->low = {0.1F, 0.2F, 0.3F};
    s.textures[0].pattern->high = {0.9F, 0.6F, 1.0F};
    s.materials[0].albedo = {1, 1, 1};
    s.materials[0].albedo_map.texture = 0;
    return s;
}

Film picture(const Scene& scene, const char* target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    return render_native(scene, options).film;
}

/// Root mean square of the difference of what planes named so say.
double difference(const Film& a, const Film& b, const std::string& prefix) {
    double sum = 0;
    std::size_t count = 0;
    for (const Plane& plane : a.planes)
        if (plane.name.starts_with(prefix))
            for (std::size_t p = 0; p < plane.values.size(); ++p, ++count)
                sum += std::pow(double{plane.values[p]} - double{b.find(plane.name)->values[p]}, 2);
    EXPECT_GT(count, 0U) << prefix;
    return std::sqrt(sum / static_cast<double>(count));
}

class PatternsAtRest : public testing::TestWithParam<std::tuple<Scheme, Lod>> {};

TEST_P(PatternsAtRest, AreWhereTextureCoordinatesAre) {
    const auto [scheme, lod] = GetParam();
    const char* target = native_targets().back()->name;
    for (const PatternKind kind : {PatternKind::checker, PatternKind::noise})
        for (const Shading shading : {Shading::grids, Shading::hits, Shading::diced}) {
            Scene by_points = sheets(scheme, kind, PatternSpace::object),
                  by_texture = sheets(scheme, kind, PatternSpace::texture);
            by_points.settings.lod = by_texture.settings.lod = lod;
            by_points.settings.shading = by_texture.settings.shading = shading;
            const Film expected = picture(by_texture, target);
            EXPECT_LT(difference(picture(by_points, target), expected, "albedo"), 1e-4)
                << static_cast<int>(kind);
            // Without points at rest patterns swim: this test would see it.
            by_points.meshes[0].rest.clear();
            EXPECT_GT(difference(picture(by_points, target), expected, "albedo"), 0.03);
        }
}
INSTANTIATE_TEST_SUITE_P(, PatternsAtRest,
                         testing::Combine(testing::Values(Scheme::catmull_clark, Scheme::bilinear),
                                          testing::Values(Lod::recursive, Lod::discrete, Lod::patch,
                                                          Lod::paper, Lod::camera, Lod::fixed)));

// Slopes are taken along the surface at rest, by whatever two ways: as differences over half of what rays ask
// for, so that the nearer pixels look, the less it matters by which.
TEST(BumpsAtRest, BendNormalsAsThoseOfTextureCoordinatesDo) {
    for (const Scheme scheme : {Scheme::catmull_clark, Scheme::bilinear}) {
        double before = 1;
        for (const int width : {64, 256}) {
            std::array<Film, 3> films;
            for (std::size_t k = 0; k < 3; ++k) {
                Scene s = sheets(scheme, PatternKind::noise,
                                 k == 1 ? PatternSpace::texture : PatternSpace::object, 1.5);
                s.settings.width = s.settings.height = width;
                s.settings.samples = 1;
                s.settings.edge_pixels = 1;
                s.materials[0].albedo_map = {};
                s.materials[0].bump_map.texture = 0;
                s.materials[0].bump = k == 2 ? 0 : 0.5F;
                films[k] = picture(s, native_targets().back()->name);
            }
            const double off = difference(films[0], films[1], "normal"),
                         bent = difference(films[0], films[2], "normal");
            fmt::print("  {} pixels: normals are bent by {:.4f}, and differ by {:.4f}\n", width, bent, off);
            EXPECT_GT(bent, 0.02);
            EXPECT_LT(off / bent, 0.5 * before);
            before = off / bent;
        }
        EXPECT_LT(before, 0.08);
    }
}

TEST(TargetsAtRest, ShowTheSame) {
    const Scene scene = sheets(Scheme::catmull_clark, PatternKind::noise, PatternSpace::object);
    const Film best = picture(scene, native_targets().back()->name);
    for (const KernelTable* target : native_targets()) {
        const double off = difference(picture(scene, target->name), best, "albedo");
        EXPECT_LE(off, std::string(target->name) == "sse4" ? 1e-3 : 0) << target->name;
    }
}

} // namespace
} // namespace razor::test
