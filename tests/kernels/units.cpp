// In which units a scene is stated makes no difference: powers of two change no bit, whatever leaves a frame
// is in the scene's units again.
#include "razor/check/convergence.h"
#include "razor/check/escapes.h"
#include "razor/frame/diced_mesh.h"
#include "razor/frame/unit.h"
#include "razor/native/render.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace razor::test {
namespace {

/// The scene as it reads if its author counts in units of 1/factor.
Scene restated(Scene scene, double factor) {
    for (Mesh& mesh : scene.meshes) {
        for (glm::dvec3& p : mesh.points)
            p = {p.x * factor, p.y * factor, p.z * factor};
        mesh.edge_length *= factor;
    }
    for (Group& group : scene.graph.groups)
        for (Placement& p : group.placements) {
            p.spacing *= factor;
            p.local.translate *= factor;
            if (p.local.matrix)
                p.local.matrix->translation *= factor;
        }
    for (Light& light : scene.lights)
        for (glm::dvec3* v : {&light.corner, &light.edge_u, &light.edge_v})
            *v *= factor;
    std::vector<Camera*> cameras{&scene.camera};
    if (scene.dicing_camera)
        cameras.push_back(&*scene.dicing_camera);
    for (Camera* camera : cameras) {
        for (glm::dvec3* v : {&camera->position, &camera->target})
            *v *= factor;
        camera->aperture_radius *= factor;
        camera->focus_distance *= factor;
        camera->height *= factor;
    }
    return scene;
}

/// Everything that has a length: what is placed, nested and in arrays, a light, lenses, a dicing camera.
std::vector<Scene> scenes() {
    std::vector<Scene> all;
    all.push_back(small_default_scene(64, 64));
    all.back().settings.lod = Lod::recursive;
    all.push_back(instances_of(urchin_cage(), 60));
    all.back().settings.lod = Lod::recursive;
    Placement& array = all.back().graph.groups[0].placements[0];
    array.copies = {2, 1, 2};
    array.spacing = {-0.7, 0, 0.9};
    all.push_back(scene_of(stretched(torus_cage(9, 6)), 60));
    all.back().settings.lod = Lod::recursive;
    all.back().camera.aperture_radius = 0.05;
    all.back().camera.focus_distance = 2.7;
    all.back().dicing_camera = all.back().camera;
    all.back().dicing_camera->position *= 1.25;
    all.push_back(scene_of(bilinear(stretched(urchin_cage())), 60));
    all.back().meshes[0].edge_length = 0; // from the camera
    all.back().settings.lod = Lod::paper;
    for (Scene& scene : all)
        scene.settings.width = scene.settings.height = 64;
    return all;
}

RenderResult rendered(const Scene& scene) {
    RenderOptions options;
    options.threads = 1;
    return render_native(scene, options);
}

/// Number of values that are not those of `film`, depth times `factor`.
std::size_t differences(const Film& restated, const Film& film, double factor) {
    std::size_t n = 0;
    for (std::size_t p = 0; p < film.planes.size(); ++p) {
        const Plane &one = restated.planes[p], &other = film.planes[p];
        const double times = other.name == "depth.Z" ? factor : 1;
        for (std::size_t i = 0; i < other.values.size(); ++i)
            n += std::bit_cast<std::uint32_t>(one.values[i]) !=
                         std::bit_cast<std::uint32_t>(static_cast<float>(other.values[i] * times))
                     ? 1
                     : 0;
    }
    return n;
}

/// Everything that is counted. Of `paper`, levels' numbers decide which blended blocks are kept.
std::vector<std::int64_t> counts(const FrameStatistics& s, const Scene& scene) {
    std::vector<std::int64_t> all{s.inner_nodes, s.leaves, s.grid_bytes, s.node_bytes, s.list_bytes};
    for (Counters c : s.by_kind.kind) {
        if (scene.settings.lod == Lod::paper)
            c.blended_blocks = 0;
        for_each_counter(c, [&](const char*, std::int64_t n) { all.push_back(n); });
    }
    return all;
}

/// 2^k: in the range where frames keep the unit, about its ends, and far outside.
constexpr int powers[] = {-90, -40, -16, -12, -3, 6, 19, 23, 40, 90};

TEST(Units, PowersOfTwoChangeNoBit) {
    for (const Scene& scene : scenes()) {
        const RenderResult expected = rendered(scene);
        std::size_t hits = 0;
        for (const float depth : expected.film.find("depth.Z")->values)
            hits += std::isfinite(depth) ? 1 : 0;
        EXPECT_GT(hits, 200U) << scene.name;
        for (const int k : powers) {
            const double factor = std::ldexp(1.0, k);
            const RenderResult result = rendered(restated(scene, factor));
            EXPECT_EQ(differences(result.film, expected.film, factor), 0U) << scene.name << ", 2^" << k;
            EXPECT_EQ(counts(result.statistics.frame, scene), counts(expected.statistics.frame, scene))
                << scene.name << ", 2^" << k;
        }
    }
}

/// Other units round the scene's numbers anew, and target edges to another power of two: the surface is met
/// within an edge's sagitta of where it was, but at silhouettes and in creases.
TEST(Units, OfAnySizeGiveThePicture) {
    for (const Scene& scene : scenes()) {
        const RenderResult expected = rendered(scene);
        for (const double unit : {1e-28, 1e-12, 1e-9, 1e9, 1e12, 1e28}) {
            const RenderResult result = rendered(restated(scene, unit));
            // The same, brought to where frames keep the unit by a power of two: no bit differs.
            const double power = std::ldexp(1.0, std::ilogb(unit));
            const RenderResult near = rendered(restated(restated(scene, unit), 1 / power));
            EXPECT_EQ(differences(result.film, near.film, power), 0U) << scene.name << ", " << unit;
            EXPECT_EQ(counts(result.statistics.frame, scene), counts(near.statistics.frame, scene));
            const std::vector<float>& depth = result.film.find("depth.Z")->values;
            const std::vector<float>& right = expected.film.find("depth.Z")->values;
            std::size_t off = 0;
            for (std::size_t i = 0; i < depth.size(); ++i) {
                const double there = right[i] * unit;
                off += depth[i] == there || std::abs(depth[i] - there) <= 0.01 * there ? 0 : 1;
            }
            EXPECT_LE(off, depth.size() / 50) << scene.name << ", " << unit;
        }
    }
}

TEST(Units, AreKeptInTheMiddleAndChosenOutside) {
    Scene cube = scene_of(cube_cage(), 4);
    double side = 0;
    for (const glm::dvec3& p : cube.meshes[0].points)
        side = std::max(side, 2 * std::abs(p.x));
    for (const int k : {-10, -8, 0, 8, 17})
        EXPECT_EQ(frame_unit(restated(cube, std::ldexp(1 / side, k))), 1) << k;
    for (const int k : {-200, -60, -11, 21, 60, 99}) {
        const double factor = std::ldexp(1 / side, k);
        // Bounds are a little larger than points.
        EXPECT_EQ(frame_unit(restated(cube, factor)), std::ldexp(1.0, k - 9)) << k;
    }
    // Cameras and lights may be far away, until their squares overflow.
    cube.camera.position = {0, 0, 1e12};
    EXPECT_EQ(frame_unit(cube), 1);
    cube.camera.position = {0, 0, 1e25};
    EXPECT_EQ(frame_unit(cube), std::ldexp(1.0, std::ilogb(1e25) - 50));
    cube.camera.position = {0, 0, 5};
    cube.lights[0].corner = {0, 1e25, 0};
    EXPECT_EQ(frame_unit(cube), std::ldexp(1.0, std::ilogb(1e25) - 50));
}

/// Watts a steradian go with the square of lengths, which alone may be no float.
TEST(Units, OfIntensitiesAreSquares) {
    for (const LightKind kind : {LightKind::point, LightKind::spot}) {
        Scene scene = scene_of(cube_cage(), 4);
        scene.lights.assign(1, Light{});
        scene.lights[0].kind = kind;
        scene.lights[0].radiance = {std::ldexp(0.75F, -60), 0, 3};
        const double factor = std::ldexp(1.0, 70);
        const glm::vec3 large = scaled(scene, factor).lights[0].radiance;
        EXPECT_EQ(large.x, std::ldexp(0.75F, 80));
        EXPECT_EQ(large.y, 0);
        EXPECT_TRUE(std::isfinite(large.z)) << "the largest that there is";
        EXPECT_EQ(scaled(scaled(scene, factor), 1 / factor).lights[0].radiance.x, scene.lights[0].radiance.x);
    }
}

TEST(Units, OfDicedMeshesAreTheScenes) {
    const Scene scene = instances_of(stretched(urchin_cage()), 30);
    const auto diced = [](const Scene& s) {
        Frame frame(s, {});
        frame.dice_all(*native_targets().back());
        return diced_mesh(frame);
    };
    const std::vector<DicedInstance> expected = diced(scene);
    for (const int k : {-40, 40}) {
        const std::vector<DicedInstance> got = diced(restated(scene, std::ldexp(1.0, k)));
        ASSERT_EQ(got.size(), expected.size());
        for (std::size_t n = 0; n < got.size(); ++n) {
            EXPECT_EQ(got[n].face_sizes, expected[n].face_sizes);
            EXPECT_EQ(got[n].normals, expected[n].normals);
            ASSERT_EQ(got[n].points.size(), expected[n].points.size());
            for (std::size_t i = 0; i < got[n].points.size(); ++i)
                ASSERT_EQ(got[n].points[i], expected[n].points[i] * std::ldexp(1.0, k)) << i;
        }
    }
}

TEST(Units, OfChecksAreTheScenes) {
    Scene scene = scene_of(stretched(torus_cage(24, 12)), 200);
    scene.settings.lod = Lod::discrete; // with holes
    const KernelTable& target = *native_targets().back();
    const auto shot = [&](const Scene& s) {
        Frame frame(s, {});
        check::EscapeOptions options;
        options.rays = 30000;
        return check::shoot_from_inside(frame, target, Lod::discrete, options);
    };
    const auto measured = [&](const Scene& s) {
        check::ConvergenceOptions options;
        options.rays = 1000;
        return check::measure_convergence(s, target, options);
    };
    const check::EscapeReport escapes = shot(scene);
    const check::ConvergenceReport convergence = measured(scene);
    ASSERT_GT(escapes.escaped.size(), 0U);
    ASSERT_TRUE(convergence.converges());
    for (const int k : {-40, 40}) {
        const double factor = std::ldexp(1.0, k);
        const check::EscapeReport r = shot(restated(scene, factor));
        EXPECT_EQ(r.escapes, escapes.escapes);
        EXPECT_EQ(r.holes, escapes.holes);
        ASSERT_EQ(r.escaped.size(), escapes.escaped.size());
        for (std::size_t i = 0; i < r.escaped.size(); ++i) {
            const check::BadRay &one = r.escaped[i], &other = escapes.escaped[i];
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_EQ(one.ray.origin[axis], std::ldexp(other.ray.origin[axis], k));
            EXPECT_EQ(one.ray.direction, other.ray.direction);
            EXPECT_EQ(one.ray.base, std::ldexp(other.ray.base, k));
            EXPECT_EQ(one.ray.growth, other.ray.growth);
            EXPECT_EQ(one.t, other.t);
            EXPECT_EQ(one.expected, other.expected < 0 ? -1 : other.expected * factor);
        }
        const check::ConvergenceReport c = measured(restated(scene, factor));
        ASSERT_EQ(c.steps.size(), convergence.steps.size());
        for (std::size_t i = 0; i < c.steps.size(); ++i) {
            EXPECT_EQ(c.steps[i].edge, convergence.steps[i].edge * factor);
            EXPECT_EQ(c.steps[i].median_error, convergence.steps[i].median_error * factor);
        }
        EXPECT_NEAR(c.order, convergence.order, 1e-9);
    }
}

} // namespace
} // namespace razor::test
