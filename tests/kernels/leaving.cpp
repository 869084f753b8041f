// Rays that leave a surface: convex bodies do not shadow themselves, whatever the levels of detail, and
// shadows begin where bodies touch. Whole pictures, so that it is the renderer's own rays that are tried.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace razor::test {
namespace {

Mesh scaled(Mesh mesh, const glm::dvec3& by, const char* name) {
    for (glm::dvec3& p : mesh.points)
        p *= by;
    mesh.name = name;
    return mesh;
}

/// Upright, of `sides` quads between two polygons.
Mesh prism(int sides) {
    Mesh m;
    m.name = "prism";
    for (int i = 0; i < sides; ++i) {
        const double a = 2 * std::numbers::pi * i / sides;
        m.points.emplace_back(std::cos(a), -1, std::sin(a));
        m.points.emplace_back(std::cos(a), 1, std::sin(a));
    }
    for (int i = 0; i < sides; ++i) {
        const int next = (i + 1) % sides;
        m.face_sizes.push_back(4);
        for (int v : {2 * i, 2 * i + 1, 2 * next + 1, 2 * next})
            m.face_vertices.push_back(v);
    }
    for (int end = 0; end < 2; ++end) {
        m.face_sizes.push_back(sides);
        for (int i = 0; i < sides; ++i)
            m.face_vertices.push_back(2 * (end == 0 ? i : sides - 1 - i) + end);
    }
    return m;
}

Mesh convex(const std::string& name) {
    if (name == "ball")
        return cube_cage();
    if (name == "ellipsoid")
        return scaled(cube_cage(), {1, 0.4, 2}, "ellipsoid");
    if (name == "cylinder")
        return prism(12);
    if (name == "beam") // of long triangles, where distances along rays round by more than points do
        return scaled(bilinear(cube_cage()), {0.5, 0.5, 12}, "beam");
    return bilinear(cube_cage());
}

/// Shadow rays of a picture, and those that arrive at a sky of radiance 1 from a surface of albedo 1.
struct Counted {
    std::int64_t shot = 0;
    double arrived = 0;
};
Counted count(const Scene& scene) {
    const RenderResult r = render_native(scene, RenderOptions{});
    const Plane& red = *r.film.find("R");
    const Plane& depth = *r.film.find("depth.Z");
    Counted c;
    for (std::size_t i = 0; i < red.values.size(); ++i)
        if (std::isfinite(depth.values[i]))
            c.arrived += double{red.values[i]} * scene.settings.sky_samples;
    c.shot = r.statistics.frame.by_kind.kind[kind_sky].rays;
    return c;
}

class Leaving : public testing::TestWithParam<std::string> {};

TEST_P(Leaving, ConvexBodiesDoNotShadowThemselves) {
    std::int64_t shot = 0;
    double kept = 0;
    for (const double edges : {30.0, 300.0})                    // of the finest level, across
        for (const double edge_pixels : {0.7, 4.0, 15.0, 60.0}) // what camera rays ask for
            for (const int samples : {4, 64})                   // fewer spread wider: growth
                for (const double away : {1.0, 3.0}) {
                    Scene s = scene_of(convex(GetParam()), edges);
                    s.lights.clear();
                    s.sky = glm::vec3(1);
                    s.materials[0].albedo = glm::vec3(1);
                    s.camera.position *= away;
                    s.settings.lod = Lod::recursive;
                    s.settings.width = s.settings.height = 48;
                    s.settings.edge_pixels = edge_pixels;
                    s.settings.sky_samples = samples;
                    const Counted c = count(s);
                    EXPECT_NEAR(c.arrived, static_cast<double>(c.shot), 0.5)
                        << edges << " edges, " << edge_pixels << " pixels an edge, " << samples
                        << " samples, " << away << " times as far";
                    shot += c.shot;
                    kept += c.arrived;
                }
    EXPECT_GT(shot, 20'000);
    RecordProperty("shadow_rays", std::to_string(shot));
    RecordProperty("arrived", std::to_string(std::llround(kept)));
}

INSTANTIATE_TEST_SUITE_P(Bodies, Leaving, testing::Values("ball", "ellipsoid", "cylinder", "box", "beam"),
                         [](const auto& name) { return name.param; });

/// A ball on a plane, and a low light behind it: what lies before the ball is dark up to where they touch.
TEST(LeavingContact, ShadowsBeginWhereBodiesTouch) {
    for (const double edge_pixels : {1.0, 8.0, 30.0}) {
        Scene s = scene_of(cube_cage(), 200);
        Mesh plane;
        plane.name = "plane";
        plane.scheme = Scheme::bilinear;
        // The limit of a face centre: (16 x 1 + 4 x 4 x 3/4 + 4 x 5/9) / 36 of its height.
        const Mesh& cube = s.meshes[0];
        double low = 0;
        for (const glm::dvec3& p : cube.points)
            low = std::min(low, p.y);
        const double touch = low * 68 / 81;
        plane.points = {{-20, touch, -20}, {20, touch, -20}, {20, touch, 20}, {-20, touch, 20}};
        plane.face_sizes = {4};
        plane.face_vertices = {0, 3, 2, 1};
        s.meshes.push_back(plane);
        s.lights[0].corner = {-0.05, 0.3, -15};
        s.lights[0].edge_u = {0.1, 0, 0};
        s.lights[0].edge_v = {0, 0.1, 0};
        s.sky = glm::vec3(0);
        s.camera.position = {0, touch + 0.35, 3};
        s.camera.target = {0, touch, 0.3};
        s.camera.fov_degrees = 25;
        s.settings.lod = Lod::recursive;
        s.settings.width = s.settings.height = 96;
        s.settings.edge_pixels = edge_pixels;
        s.settings.light_samples = 4;
        const RenderResult r = render_native(s, RenderOptions{});
        const Plane& red = *r.film.find("R");
        const Plane& depth = *r.film.find("depth.Z");
        const Plane& up = *r.film.find("normal.Y");
        // The middle column, from below: the plane before the ball, then the ball.
        int plane_pixels = 0;
        for (int y = 95; y >= 0; --y)
            for (int x = 47; x <= 48; ++x) {
                const auto i = static_cast<std::size_t>(y * 96 + x);
                if (!std::isfinite(depth.values[i]) || up.values[i] < 0.999F)
                    continue;
                ++plane_pixels;
                EXPECT_LT(red.values[i], 1e-4)
                    << "light leaks at pixel " << x << ", " << y << ", " << edge_pixels << " pixels an edge";
            }
        EXPECT_GT(plane_pixels, 20);
    }
}

} // namespace
} // namespace razor::test
