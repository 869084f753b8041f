// Cages at their limits: points of many faces, sharpness beside its ends, slivers, faces without area, twice
// the same face, edges of more than two faces, bow ties: all faces are drawn, bodies stay closed, and rays
// cost what their like do.
//
// Seen to fail: a face left out of poles of more than 64 (as a hole), in AreClosedUnderBothSchemes.
#include "tests/kernels/cages.h"
#include "razor/check/escapes.h"
#include "tests/kernels/targets.h"
#include "tests/robustness/effort.h"

#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace razor::test {
namespace {

/// Two poles over a ring of `valence` points, closed: triangles.
Mesh bipyramid(int valence) {
    Mesh m;
    m.name = "bipyramid";
    m.points = {{0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < valence; ++i) {
        const double a = 2 * std::numbers::pi * i / valence;
        m.points.emplace_back(std::cos(a), std::sin(a), 0);
    }
    for (int i = 0; i < valence; ++i)
        for (const bool top : {true, false}) {
            const int a = 2 + i, b = 2 + (i + 1) % valence;
            m.face_sizes.push_back(3);
            for (const int p : {top ? 0 : 1, top ? a : b, top ? b : a})
                m.face_vertices.push_back(p);
        }
    return m;
}

/// No ray from inside escapes, and none hits what is not there by the surface's definition, where `compared`.
/// Returns the steps of a ray, of which half aim at vertices.
double expect_closed(const Mesh& mesh, const KernelTable& target, const std::string& what,
                     bool compared = true) {
    Scene scene = scene_of(mesh, 30);
    scene.settings.lod = Lod::recursive;
    Frame frame(scene, {});
    check::EscapeOptions options;
    options.rays = &target == native_targets().back() ? 4000 : 400;
    options.rays_an_origin = 200;
    options.compared = compared ? 40 : 0;
    const check::EscapeReport r = check::shoot_from_inside(frame, target, Lod::recursive, options);
    EXPECT_GT(r.origins, 0) << what;
    EXPECT_EQ(r.escapes, 0) << what;
    EXPECT_EQ(r.different, 0) << what;
    return Effort{r.rays, steps(frame.statistics().counters)}.steps_a_ray();
}

/// Of rays from inside a cube without creases.
double usual_steps(const KernelTable& target, bool smooth) {
    return expect_closed(smooth ? cube_cage() : bilinear(cube_cage()), target, target.name);
}

class Poles : public testing::TestWithParam<int> {};

TEST_P(Poles, AreClosedUnderBothSchemes) {
    const int valence = GetParam();
    for (const KernelTable* target : targets_with(true))
        for (const Mesh& mesh : {bipyramid(valence), bilinear(bipyramid(valence))})
            EXPECT_LT(expect_closed(mesh, *target, std::string(target->name) + ' ' + std::to_string(valence)),
                      20 + 4 * valence) // rays at a pole meet all that do
                << target->name << ' ' << valence;
}

INSTANTIATE_TEST_SUITE_P(Valences, Poles, testing::Values(3, 24, 64, 65, 100, 360),
                         [](const auto& valence) { return std::to_string(valence.param); });

TEST(Cages, OfAnySharpnessAreClosed) {
    for (const KernelTable* target : targets_with(true))
        for (const float sharpness : {0.001F, 9.99F, 10.0F, 1e30F}) {
            Mesh cube = cube_cage();
            // A net at one point: its three edges, each less sharp, and the point itself.
            cube.creases = {{0, 1, sharpness}, {0, 2, 0.5F * sharpness}, {0, 4, 0.25F * sharpness}};
            cube.corners = {{0, sharpness}};
            EXPECT_LT(
                expect_closed(cube, *target, std::string(target->name) + ' ' + std::to_string(sharpness)),
                2.5 * usual_steps(*target, true))
                << target->name << ' ' << sharpness;
        }
}

/// A cube one of whose sides is a millionth of the others.
TEST(Cages, OfSliversAreClosed) {
    for (const KernelTable* target : targets_with(true))
        for (Mesh mesh : {cube_cage(), bilinear(cube_cage())}) {
            for (glm::dvec3& p : mesh.points)
                p.x *= p.y > 0 ? 1e-6 : 1;
            // Bounds of roundings are those of rounder triangles: nothing is compared.
            EXPECT_LT(expect_closed(mesh, *target, target->name, false),
                      2.5 * usual_steps(*target, mesh.scheme != Scheme::bilinear))
                << target->name;
        }
}

/// Pictures of what no body is: they end, and are finite.
TEST(Cages, ThatAreNoSurfaceGiveFinitePictures) {
    Mesh twice = cube_cage();
    for (int repeat = 0; repeat < 2; ++repeat)
        for (std::size_t i = 0; i < 4; ++i) // the first face again: three faces at its edges, then four
            twice.face_vertices.push_back(twice.face_vertices[i]);
    twice.face_sizes.insert(twice.face_sizes.end(), {4, 4});
    Mesh flat = cube_cage();
    for (glm::dvec3& p : flat.points)
        p.x = p.y > 0 ? 0.5 : 0.5 + 1e-300; // no face has an area
    Mesh tie = cube_cage();
    std::swap(tie.face_vertices[1], tie.face_vertices[2]); // crosswise, and edges of opposite windings
    Mesh lone = cube_cage();
    lone.points.emplace_back(50, 50, 50);
    Mesh turned = cube_cage();
    std::reverse(turned.face_vertices.begin() + 4, turned.face_vertices.begin() + 8);
    for (const Mesh& cage : {twice, flat, tie, lone, turned})
        for (const Mesh& mesh : {cage, bilinear(cage)})
            for (const KernelTable* target : targets_with(true)) {
                const RenderResult r = render_native(scene_of(mesh, 10), {.threads = 1, .kernels = target});
                int seen = 0;
                for (std::size_t i = 0; i < r.film.pixel_count(); ++i) {
                    seen += std::isfinite(r.film.find("depth.Z")->values[i]) ? 1 : 0;
                    for (const char* name : {"R", "G", "B", "normal.X", "normal.Y", "normal.Z"})
                        ASSERT_TRUE(std::isfinite(r.film.find(name)->values[i]))
                            << target->name << ' ' << name;
                }
                if (&cage != &flat && cage.points.back().x < 50 && cage.points[0].x != cage.points[3].x) {
                    EXPECT_GT(seen, 20) << target->name;
                }
            }
}

} // namespace
} // namespace razor::test
