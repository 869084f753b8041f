// Pictures of an orthographic camera against closed forms, what its rays ask for, and that none of them slips
// through a surface.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/frame.h"
#include "razor/frame/view.h"
#include "razor/native/visible.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

constexpr Lod all_lods[] = {Lod::recursive, Lod::discrete, Lod::patch, Lod::paper,
                            Lod::camera,    Lod::object,   Lod::fixed};

Film rendered(const Scene& scene, const KernelTable& kernels = *native_targets().back()) {
    Frame frame(scene, {});
    frame.render(kernels, 0);
    return frame.film();
}

void make_orthographic(Camera& camera, double height) {
    camera.projection = Projection::orthographic;
    camera.height = height;
}

/// x in [-1.3, 0.9], y in [-0.55, 0.7], leaning away from the camera: z = -5 - x / 2.
Scene leaning_board() {
    Mesh m;
    m.name = "board";
    m.scheme = Scheme::bilinear;
    m.points = {{-1.3, -0.55, -4.35}, {0.9, -0.55, -5.45}, {0.9, 0.7, -5.45}, {-1.3, 0.7, -4.35}};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    Scene s;
    s.name = m.name;
    s.meshes = {m};
    s.materials = {{.name = "white", .albedo = glm::vec3(1)}};
    s.camera.position = {0, 0, 1};
    s.camera.target = {0, 0, 0};
    make_orthographic(s.camera, 2);
    s.settings.width = 32;
    s.settings.height = 20;
    s.settings.samples = 256;
    return s;
}

double overlap(double begin, double end, double low, double high) {
    return std::max(std::min(end, high) - std::max(begin, low), 0.0);
}

TEST(Orthographic, PixelsShowWhatLiesStraightAhead) {
    Scene scene = leaning_board();
    const double pixel = 2.0 / 20;
    for (const Lod lod : all_lods) {
        scene.settings.lod = lod;
        const Film film = rendered(scene);
        const std::vector<float>&albedo = film.find("albedo.R")->values,
              &depth = film.find("depth.Z")->values;
        for (int row = 0; row < 20; ++row)
            for (int column = 0; column < 32; ++column) {
                const auto i = static_cast<std::size_t>(row * 32 + column);
                const double x = (column - 16) * pixel, y = (9 - row) * pixel;
                const double across = overlap(x, x + pixel, -1.3, 0.9) / pixel;
                const double up = overlap(y, y + pixel, -0.55, 0.7) / pixel;
                const double covered = across * up;
                // What is wholly in or out is so of every sample; a sequence of 256 in a rectangle: 4 / 256.
                const bool whole = covered < 1e-9 || covered > 1 - 1e-9;
                ASSERT_NEAR(albedo[i], covered, whole ? 1e-6 : 0.016) << row << ' ' << column;
                if (covered > 1 - 1e-9) {
                    ASSERT_NEAR(depth[i], 6 + (x + pixel / 2) / 2, 1e-3) << row << ' ' << column;
                } else if (covered < 1e-9) {
                    ASSERT_TRUE(std::isinf(depth[i])) << row << ' ' << column;
                }
            }
        // Each shows sqrt(1.25) of its own area, edge pixels included.
        const VisibleSurface seen = visible_surface(film, scene.camera, scene.settings);
        EXPECT_NEAR(seen.squares / static_cast<double>(seen.pixels), std::sqrt(1.25), 1e-5);
    }
}

TEST(Orthographic, ABallIsASharpDiskAtAnyDistance) {
    // The limit of an octahedron-like cage would be no sphere: a finely cut one of flat quads, radius 1.
    constexpr int rings = 48, sides = 96;
    Mesh m;
    m.name = "ball";
    m.scheme = Scheme::bilinear;
    const auto point = [](int ring, int side) {
        const double a = 3.14159265358979323846 * ring / rings, b = 2 * 3.14159265358979323846 * side / sides;
        return glm::dvec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
    };
    for (int ring = 1; ring < rings; ++ring)
        for (int side = 0; side < sides; ++side)
            m.points.push_back(point(ring, side));
    m.points.push_back(point(0, 0));
    m.points.push_back(point(rings, 0));
    const int top = (rings - 1) * sides;
    for (int ring = 0; ring < rings; ++ring)
        for (int side = 0; side < sides; ++side) {
            const int next = (side + 1) % sides, above = (ring - 1) * sides, below = ring * sides;
            std::vector<int> face{above + side, above + next, below + next, below + side};
            if (ring == 0)
                face = {top, below + next, below + side};
            else if (ring == rings - 1)
                face = {above + side, above + next, top + 1};
            m.face_sizes.push_back(static_cast<int>(face.size()));
            m.face_vertices.insert(m.face_vertices.end(), face.begin(), face.end());
        }
    Scene scene = scene_of(m, 100);
    scene.materials = {{.name = "white", .albedo = glm::vec3(1)}};
    scene.settings.lod = Lod::recursive;
    scene.settings.width = scene.settings.height = 48;
    scene.settings.samples = 16;
    scene.settings.light_samples = scene.settings.sky_samples = 0;
    for (const double distance : {1.5, 40.0}) {
        scene.camera.target = {0, 0, 0};
        scene.camera.position = glm::normalize(glm::dvec3(1, 2, 3)) * distance;
        make_orthographic(scene.camera, 2.4);
        const Film film = rendered(scene);
        const auto& albedo = film.find("albedo.R")->values;
        double sum = 0;
        for (const float a : albedo)
            sum += a;
        const double disk = 3.14159265358979323846 / (2.4 * 2.4) * 48 * 48; // pixels
        EXPECT_NEAR(sum / disk, 1, 0.004) << distance;                      // facets cut off up to 0.2 %
        for (int row = 0; row < 48; ++row)
            for (int column = 0; column < 48; ++column) {
                const double x = (column + 0.5) / 20 - 1.2, y = (row + 0.5) / 20 - 1.2;
                const float a = albedo[static_cast<std::size_t>(row * 48 + column)];
                if (std::hypot(x, y) < 0.96) {
                    EXPECT_NEAR(a, 1, 1e-6);
                } else if (std::hypot(x, y) > 1.04) {
                    EXPECT_EQ(a, 0);
                }
            }
    }
}

TEST(Orthographic, RaysAskForAPixelEverywhere) {
    Scene scene = scene_of(torus_cage(12, 8), 400);
    scene.settings.width = 48;
    scene.settings.height = 40;
    scene.settings.edge_pixels = 1.5;
    scene.settings.light_samples = scene.settings.sky_samples = 0;
    scene.settings.lod = Lod::recursive;
    make_orthographic(scene.camera, 3);
    scene.camera.aperture_radius = 0.5; // it has no lens
    const CameraField f = camera_field(scene.camera, scene.settings);
    EXPECT_DOUBLE_EQ(f.base, 1.5 * 3 / 40);
    EXPECT_EQ(f.slope, 0);
    EXPECT_EQ(f.growth, 0);
    const glm::dvec3 way = scene.camera.position - scene.camera.target;
    const auto made = [&](double distance, double height) {
        scene.camera.position = scene.camera.target + way * distance;
        scene.camera.height = height;
        Frame frame(scene, {});
        EXPECT_EQ(frame.header().focus, 0);
        frame.render(*native_targets().back(), 0);
        return static_cast<double>(frame.statistics().counters.triangles_made);
    };
    const double near = made(1, 3), far = made(30, 3), large = made(1, 0.75 * 3), small = made(1, 3 * 4);
    EXPECT_NEAR(far / near, 1, 0.01);
    EXPECT_LT(4 * small, near);
    EXPECT_GT(large, near); // the same part of it in more detail, less of it around
    // A dicing camera: whatever looks.
    scene.dicing_camera = scene.camera;
    make_orthographic(*scene.dicing_camera, 3);
    scene.camera = Camera{};
    std::int64_t diced[2];
    for (int k = 0; k < 2; ++k) {
        scene.camera.position = k == 0 ? glm::dvec3(0, 1, 5) : glm::dvec3(3, 40, 1);
        scene.dicing_camera->position = k == 0 ? glm::dvec3(0, 1, 5) : glm::dvec3(7, 9, 80);
        Frame frame(scene, {});
        frame.dice_all(*native_targets().back());
        diced[k] = frame.statistics().counters.triangles_made;
    }
    EXPECT_EQ(diced[0], diced[1]);
}

TEST(Orthographic, InstancesHaveTheirLevelsFromAPixelsSize) {
    for (const Lod lod : {Lod::object, Lod::fixed}) {
        Scene scene = scene_of(cube_cage(), 10);
        scene.meshes[0].edge_length = 0;
        scene.settings.lod = lod;
        make_orthographic(scene.camera, 4);
        float edges[2];
        for (const int k : {0, 1}) {
            scene.camera.position *= k == 0 ? 1 : 100;
            Frame frame(scene, {});
            edges[k] = frame.header().instances.get()[0].edge_length;
        }
        EXPECT_EQ(edges[0], 0.125F); // 4 / 32
        EXPECT_EQ(edges[1], edges[0]);
    }
}

TEST(Orthographic, NoRayLeavesWhatIsClosed) {
    for (const char* name : {"cube", "urchin_stretched", "cube_bilinear_stretched"}) {
        Scene scene = named_scene(name)->scene;
        Settings& s = scene.settings;
        s.width = s.height = 96;
        s.samples = 4;
        s.light_samples = s.sky_samples = 0;
        const double size = glm::length(scene.camera.position - scene.camera.target) / 1.4;
        int turn = 0;
        for (const Lod lod : all_lods) {
            s.lod = lod;
            scene.camera.position = scene.camera.target; // in the middle
            scene.camera.target += glm::dvec3(std::cos(turn), std::sin(turn * 1.7), std::sin(turn));
            ++turn;
            make_orthographic(scene.camera, 0.03 * size);
            s.edge_pixels = 40; // levels from what a packet covers to what the body does
            const Film film = rendered(scene);
            const auto& depth = film.find("depth.Z")->values;
            const auto open =
                std::count_if(depth.begin(), depth.end(), [](float d) { return std::isinf(d); });
            EXPECT_EQ(open, 0) << name << ", scheme " << static_cast<int>(lod);
            scene.camera.target = scene.camera.position;
        }
    }
}

TEST(Orthographic, PicturesAreTheSameOnEveryTargetAndInParts) {
    for (const Lod lod : {Lod::recursive, Lod::paper}) {
        Scene scene = named_scene("urchin_stretched")->scene;
        scene.settings.lod = lod;
        scene.settings.samples = 2;
        scene.settings.height = 27;
        make_orthographic(scene.camera, 0.6 * glm::length(scene.camera.position - scene.camera.target));
        const std::vector<const KernelTable*> targets = targets_with(true);
        const Film first = rendered(scene, *targets.front());
        scene.settings.crop = {5, 7, 20, 9};
        for (const KernelTable* target : targets) {
            const Film part = rendered(scene, *target);
            for (const Plane& plane : part.planes)
                for (int y = 0; y < 9; ++y) {
                    const float* row = first.find(plane.name)->values.data() + (7 + y) * 32 + 5;
                    EXPECT_TRUE(std::equal(row, row + 20, plane.values.data() + y * 20))
                        << target->name << ' ' << plane.name << " row " << y;
                }
        }
        const auto& depth = first.find("depth.Z")->values;
        EXPECT_GT(std::count_if(depth.begin(), depth.end(), [](float d) { return std::isfinite(d); }), 100);
    }
}

} // namespace
} // namespace razor::test
