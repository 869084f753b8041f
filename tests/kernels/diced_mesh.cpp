// Exported meshes: closed where the cage is, the triangles that rays meet, and what the dicing camera asks
// for whatever the camera.
#include "razor/check/escapes.h"
#include "razor/check/field_surface.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/rays.h"
#include "tests/kernels/targets.h"

#include "razor/frame/diced_mesh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace razor::test {
namespace {

using glm::dvec3;

std::vector<DicedInstance> diced(const Scene& scene) {
    Frame frame(scene, {});
    frame.dice_all(*native_targets().back());
    return diced_mesh(frame);
}

/// Directed edges that have no opposite.
std::size_t open_edges(const DicedInstance& m) {
    std::map<std::pair<int, int>, int> balance;
    auto corner = m.corners.begin();
    for (const int size : m.face_sizes) {
        for (int k = 0; k < size; ++k) {
            const int a = corner[k].point, b = corner[(k + 1) % size].point;
            balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
        corner += size;
    }
    return static_cast<std::size_t>(
        std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

struct Polygon {
    std::vector<dvec3> points;
    dvec3 normal{0}; // twice its area long
};
std::vector<Polygon> polygons_of(const DicedInstance& m) {
    std::vector<Polygon> all;
    auto corner = m.corners.begin();
    for (const int size : m.face_sizes) {
        Polygon p;
        for (int k = 0; k < size; ++k)
            p.points.push_back(m.points[static_cast<std::size_t>((corner++)->point)]);
        for (std::size_t k = 1; k + 1 < p.points.size(); ++k)
            p.normal += glm::cross(p.points[k] - p.points[0], p.points[k + 1] - p.points[0]);
        all.push_back(std::move(p));
    }
    return all;
}

void expect_sound(const DicedInstance& m, const std::string& what) {
    for (const dvec3& p : m.points)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << what;
    for (const glm::vec3& n : m.normals)
        ASSERT_NEAR(glm::length(n), 1, 1e-4) << what;
    std::size_t turned = 0, at = 0;
    for (const Polygon& p : polygons_of(m)) {
        for (std::size_t k = 0; k < p.points.size(); ++k, ++at)
            turned +=
                glm::dot(dvec3(m.normals[static_cast<std::size_t>(m.corners[at].normal)]), p.normal) < 0;
    }
    // Of rough facets some lean further over than the smooth surface does.
    EXPECT_LT(turned * 7, m.corners.size()) << what << ": normals that face away from their faces";
}

class DicedMesh : public testing::TestWithParam<std::string> {};

TEST_P(DicedMesh, IsClosedWhereTheCageIs) {
    auto named = named_scene(GetParam());
    if (!named)
        GTEST_SKIP() << "the shared scenes are not there";
    std::size_t inserted = 0;
    for (const Lod lod : {Lod::fixed, Lod::recursive})
        for (const double edge_pixels : {0.5, 3.0}) {
            Scene& scene = named->scene;
            scene.settings.lod = lod;
            scene.settings.edge_pixels = edge_pixels;
            // From beside the surface: all levels at once.
            Scene near = scene;
            near.camera.position = 0.55 * scene.camera.position + 0.45 * scene.camera.target;
            near.camera.fov_degrees = 100;
            for (const DicedInstance& m : diced(near)) {
                const std::string what = GetParam() + (lod == Lod::fixed ? ", fixed, " : ", recursive, ") +
                                         std::to_string(edge_pixels);
                EXPECT_GT(m.face_sizes.size(), 0U) << what;
                expect_sound(m, what);
                if (named->closed) {
                    EXPECT_EQ(open_edges(m), 0U) << what;
                }
                for (const int size : m.face_sizes)
                    inserted += size > 3 ? 1 : 0;
            }
        }
    RecordProperty("faces_with_more_corners", std::to_string(inserted));
}

INSTANTIATE_TEST_SUITE_P(Scenes, DicedMesh, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

/// With levels fixed: the very triangles.
TEST(DicedMeshes, AreTheTrianglesOfTheFrame) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        Scene scene = named_scene(name)->scene;
        scene.settings.lod = Lod::fixed;
        Frame frame(scene, {});
        frame.build_all(*native_targets().back());
        const std::vector<Triangle> triangles = triangles_of(frame);
        const DicedInstance m = diced(scene)[0];
        ASSERT_EQ(m.face_sizes.size(), triangles.size()) << name;
        const std::vector<Point> origins = instance_origins(frame);
        std::vector<dvec3> points = m.points;
        std::sort(points.begin(), points.end(), [](const dvec3& a, const dvec3& b) { return a.x < b.x; });
        double area = 0, exported = 0;
        for (const Polygon& p : polygons_of(m))
            exported += glm::length(p.normal);
        double furthest = 0;
        for (const Triangle& t : triangles) {
            dvec3 v[3];
            for (std::size_t k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) {
                    const auto axis = static_cast<std::size_t>(i);
                    v[k][i] = double{t.vertex[k][axis]} + origins[0][axis] + frame.origin()[i];
                }
            area += glm::length(glm::cross(v[1] - v[0], v[2] - v[0]));
            for (const dvec3& p : v) {
                double nearest = 1e30;
                auto at = std::lower_bound(points.begin(), points.end(), p.x - 1e-5,
                                           [](const dvec3& a, double x) { return a.x < x; });
                for (; at != points.end() && at->x < p.x + 1e-5; ++at)
                    nearest = std::min(nearest, glm::length(*at - p));
                furthest = std::max(furthest, nearest);
            }
        }
        EXPECT_LT(furthest, 2e-6) << name;
        EXPECT_NEAR(exported / area, 1, 1e-6) << name;
    }
}

/// Rays of the camera meet it where they meet what they see by definition.
TEST(DicedMeshes, AreWhatCameraRaysSee) {
    for (const char* name : {"urchin_stretched", "torus_stretched", "cube_bilinear_stretched"}) {
        Scene scene = named_scene(name)->scene;
        scene.settings.lod = Lod::recursive;
        scene.settings.edge_pixels = 2;
        scene.camera.position = 0.6 * scene.camera.position + 0.4 * scene.camera.target;
        Frame frame(scene, {});
        frame.build_all(*native_targets().back());
        const FieldSurface surface(frame);
        const std::vector<Polygon> polygons = polygons_of(diced(scene)[0]);
        const std::vector<Triangle> triangles = triangles_of(frame);
        RayMaker make(triangles, instance_origins(frame), 3);
        const FrameHeader& h = frame.header();
        EXPECT_LT(polygons.size(), triangles.size());
        int met = 0;
        for (int n = 0; n < 60; ++n) {
            Ray ray;
            ray.origin = {h.camera[0], h.camera[1], h.camera[2]};
            ray.direction = n % 2 == 0 ? make.direction_at_feature(ray.origin) : make.random_direction();
            ray.growth = h.camera_growth;
            double t = 1e30;
            const dvec3 o = dvec3(ray.origin[0], ray.origin[1], ray.origin[2]) + frame.origin();
            const dvec3 d(ray.direction[0], ray.direction[1], ray.direction[2]);
            for (const Polygon& p : polygons)
                for (std::size_t k = 1; k + 1 < p.points.size(); ++k) {
                    const dvec3 e1 = p.points[k] - p.points[0], e2 = p.points[k + 1] - p.points[0],
                                s = o - p.points[0], q = glm::cross(d, e2), r = glm::cross(s, e1);
                    const double det = glm::dot(e1, q);
                    if (std::abs(det) < 1e-18)
                        continue;
                    const double u = glm::dot(s, q) / det, v = glm::dot(d, r) / det,
                                 w = glm::dot(e2, r) / det;
                    if (u >= 0 && v >= 0 && u + v <= 1 && w > 0)
                        t = std::min(t, w);
                }
            SeenSurface seen(surface, ray);
            constexpr double roundings = 4 * hit_roundings; // the mesh is written in world coordinates
            const auto possible = seen.crossings(ray, roundings), certain = seen.crossings(ray, -roundings);
            bool right = t > 1e29 && certain.empty();
            for (const auto& c : possible)
                right = right || std::abs(c.t - t) <= c.slack + 1e-5;
            right = right && (certain.empty() || t <= certain.front().t + certain.front().slack + 1e-5);
            EXPECT_TRUE(right) << name << ", ray " << n << ": " << t << " or "
                               << (certain.empty() ? -1.0 : certain.front().t);
            met += t < 1e29 ? 1 : 0;
        }
        EXPECT_GT(met, 15) << name;
    }
}

/// The tessellation stays while the camera moves, if another one dices.
TEST(DicedMeshes, FollowTheDicingCamera) {
    Scene scene = named_scene("urchin")->scene;
    scene.settings.lod = Lod::recursive;
    scene.settings.edge_pixels = 2;
    const std::vector<DicedInstance> own = diced(scene);
    scene.dicing_camera = scene.camera;
    scene.camera.position = 0.5 * scene.camera.position + 0.5 * scene.camera.target;
    const std::vector<DicedInstance> kept = diced(scene);
    EXPECT_EQ(own[0].points, kept[0].points);
    EXPECT_EQ(own[0].face_sizes, kept[0].face_sizes);
    scene.dicing_camera.reset();
    EXPECT_NE(own[0].points, diced(scene)[0].points);
}

// Who writes a mesh may be asked to stop: after no more than a block, or so many faces.
TEST(DicedMeshes, LookWhetherToEnd) {
    struct End {};
    const Scene scene = scene_of(urchin_cage(), 100);
    Frame frame(scene, {});
    frame.dice_all(*native_targets().back());
    std::size_t looks = 0, faces = 0;
    for (const DicedInstance& one : diced_mesh(frame, [&] { ++looks; }))
        faces += one.face_sizes.size();
    EXPECT_GT(faces, 2000U);
    EXPECT_GT(looks, faces / 128);
    const std::size_t all = looks;
    for (const std::size_t last : {std::size_t{1}, all / 2, all}) {
        looks = 0;
        EXPECT_THROW(diced_mesh(frame,
                                [&] {
                                    if (++looks == last)
                                        throw End();
                                }),
                     End);
        EXPECT_EQ(looks, last);
    }
}

} // namespace
} // namespace razor::test
