// Where a scene lies and how large it is: rays from inside closed meshes never escape, and cost what they
// cost anywhere.
#include "razor/frame/scene_geometry.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"
#include "tests/robustness/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace razor::test {
namespace {

struct Outcome {
    int escapes = 0;
    Effort effort;
};

/// Of `count` rays from points inside the mesh `mesh` of the scene.
Outcome from_inside(const Scene& scene, int mesh, const KernelTable& target, int count) {
    Frame frame(scene, {});
    Tracer tracer(frame, count);
    frame.build_all(target);
    Oracle oracle(frame, std::strcmp(target.name, "sse4") != 0);
    std::vector<Triangle> around;
    for (const Triangle& t : oracle.triangles())
        if (t.instance == mesh)
            around.push_back(t);
    RayMaker make(around, oracle.origins(), 11);
    std::vector<Point> starts;
    for (int tries = 0; starts.size() < 8 && tries < 3000; ++tries) {
        Point p = make.random_point();
        if (oracle.inside(p))
            starts.push_back(p);
    }
    if (starts.empty())
        return {count, {}};
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const Point& from = starts[static_cast<std::size_t>(i / 32) % starts.size()];
        rays.push_back({from, i % 4 != 0 ? make.direction_at_feature(from) : make.random_direction()});
    }
    Outcome out;
    std::vector<Hit> hits;
    out.effort = effort_of(frame, target, rays.size(), [&] { hits = tracer.closest(target, rays); });
    for (const Hit& h : hits)
        out.escapes += h.patch < 0 ? 1 : 0;
    return out;
}

Mesh placed(Mesh mesh, double scale, const glm::dvec3& offset) {
    for (glm::dvec3& p : mesh.points)
        p = p * scale + offset;
    return mesh;
}

class Placement : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(Placement, NoRayEscapes) {
    auto [scale, offset] = GetParam();
    for (const Mesh& mesh : {stretched(urchin_cage()), bilinear(stretched(urchin_cage()))}) {
        const Scene scene =
            scene_of(placed(mesh, scale, glm::dvec3(offset, -0.7 * offset, 0.3 * offset)), 60);
        for (const KernelTable* target : all_targets()) {
            const int count = target == native_targets().back() ? 20000 : 2000;
            const Outcome here = from_inside(scene, 0, *target, count);
            const std::string what = std::string(target->name) + ' ' + mesh.name;
            EXPECT_EQ(here.escapes, 0) << what;
            if (scale == 1 && offset == 0)
                continue;
            const Outcome usual = from_inside(scene_of(mesh, 60), 0, *target, 2000);
            expect_at_most(1.1, usual.effort, here.effort, what);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(ScalesAndOffsets, Placement,
                         testing::Values(std::pair(1.0, 0.0), std::pair(1.0, 1e3), std::pair(1.0, 1e5),
                                         std::pair(1.0, 1e6), std::pair(1e-12, 0.0), std::pair(1e-6, 0.0),
                                         std::pair(1e6, 0.0), std::pair(1e12, 0.0)),
                         [](const auto& place) {
                             auto power = [](double x) {
                                 return x == 0 ? std::string("0")
                                               : "1e" + std::to_string(std::lround(std::log10(x)));
                             };
                             std::string name =
                                 "scale_" + power(place.param.first) + "_offset_" + power(place.param.second);
                             for (char& c : name)
                                 c = c == '-' ? 'm' : c;
                             return name;
                         });

/// The origin of a mesh is where single precision can put it (a compiler that drops the rounding fails here).
TEST(Placement, MeshesThatOnlyLieSomewhereAreNotMoved) {
    Scene scene;
    for (const glm::dvec3& at :
         {glm::dvec3(0.1, 0.42, -0.5), glm::dvec3(-2.1, 1e3, 0.25), glm::dvec3(1e-4, 0.7, 1e5)})
        scene.meshes.push_back(placed(torus_cage(9, 6), 1.1, at));
    const SceneGeometry geometry = locate_scene(scene, std::vector<bool>(scene.meshes.size(), true));
    ASSERT_EQ(geometry.instances.size(), scene.meshes.size());
    for (const Instance& i : geometry.instances)
        EXPECT_FALSE(i.moved()) << i.mesh;
}

TEST(Placement, SizesOfTenMillionToOne) {
    Scene scene = scene_of(stretched(torus_cage(9, 6)), 60);
    Mesh large = placed(bilinear(cube_cage()), 1e7, glm::dvec3(0));
    large.edge_length = 1e6;
    scene.meshes.push_back(large);
    for (const KernelTable* target : native_targets())
        EXPECT_EQ(from_inside(scene, 0, *target, target == native_targets().back() ? 4000 : 200).escapes, 0)
            << target->name;
}

} // namespace
} // namespace razor::test
