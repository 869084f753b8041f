// Builds end, and stay bounded, however the boxes lie.
#include "tests/kernels/cages.h"
#include "tests/kernels/rays.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace razor::test {
namespace {

constexpr int faces = 20000;

/// Separate quads, each of its own four points.
Mesh quads(const std::function<glm::dvec3(int face, int corner)>& point) {
    Mesh m;
    m.name = "quads";
    m.scheme = Scheme::bilinear;
    for (int f = 0; f < faces; ++f) {
        m.face_sizes.push_back(4);
        for (int c = 0; c < 4; ++c) {
            m.face_vertices.push_back(static_cast<int>(m.points.size()));
            m.points.push_back(point(f, c));
        }
    }
    return m;
}

glm::dvec3 unit_square(int corner) {
    return {corner == 1 || corner == 2 ? 1 : 0, corner >= 2 ? 1 : 0, 0};
}

/// At most so many entries of lists, and inner nodes, a face.
void expect_bounded(const Mesh& mesh, double items_a_face, double nodes_a_face, const std::vector<Ray>& rays,
                    const std::vector<int>& patches) {
    for (const KernelTable* target : native_targets()) {
        Frame frame(scene_of(mesh, 1), {});
        Tracer tracer(frame, 64);
        frame.build_all(*target);
        FrameStatistics s = frame.statistics();
        // A node has a list when it is made and another when its patches are opened.
        const double headers = 2.0 * sizeof(ItemList) * static_cast<double>(2 * s.inner_nodes + 1);
        EXPECT_LT(static_cast<double>(s.list_bytes) - headers, items_a_face * faces * 7 * 4) << target->name;
        EXPECT_LT(static_cast<double>(s.inner_nodes), nodes_a_face * faces) << target->name;
        std::vector<Hit> hits = tracer.closest(*target, rays);
        for (std::size_t i = 0; i < rays.size(); ++i)
            EXPECT_EQ(hits[i].patch, patches[i]) << target->name;
    }
}

TEST(KdTree, CoincidentQuads) {
    Mesh mesh = quads([](int, int corner) { return unit_square(corner); });
    // The first of all that lie there is hit.
    // No plane separates them; a few trim the empty space about them.
    expect_bounded(mesh, 8, 10.0 / faces, {{{0.1F, 0.2F, 1}, {0, 0, -1}}, {{2, 0, 1}, {0, 0, -1}}}, {0, -1});
}

/// A hundred thousand quads of one box, no two the same, which no plane parts: what a list may hold is
/// bounded by their number, and the nearest along each diagonal is hit.
TEST(KdTree, EqualBoxes) {
    constexpr int many = 100000;
    Mesh mesh;
    mesh.name = "equal boxes";
    mesh.scheme = Scheme::bilinear;
    for (int f = 0; f < many; ++f) {
        const double middle = 0.1 + 0.8 * f / many; // of two corners' heights; the others are the box'
        for (const glm::dvec3& p :
             {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, middle), glm::dvec3(1, 1, 1), glm::dvec3(0, 1, middle)}) {
            mesh.face_vertices.push_back(static_cast<int>(mesh.points.size()));
            mesh.points.push_back(p);
        }
        mesh.face_sizes.push_back(4);
    }
    Frame frame(scene_of(mesh, 1), {});
    Tracer tracer(frame, 64);
    const KernelTable& target = *native_targets().back();
    frame.build_all(target);
    const FrameStatistics s = frame.statistics();
    EXPECT_LT(s.inner_nodes, 1000);
    EXPECT_LT(static_cast<double>(s.list_bytes), 8.0 * many * 7 * 4);
    std::vector<Ray> rays(1);
    rays[0].origin = {static_cast<float>(1 - 1e-3 - frame.origin().x),
                      static_cast<float>(1e-3 - frame.origin().y), static_cast<float>(5 - frame.origin().z)};
    rays[0].direction = {0, 0, -1};
    EXPECT_EQ(tracer.closest(target, rays)[0].patch, many - 1) << "the highest there";
}

TEST(KdTree, EverythingInOnePlane) {
    Mesh mesh = quads([](int face, int corner) {
        return unit_square(corner) + glm::dvec3(1.5 * (face % 200), 1.5 * (face / 200), 0);
    });
    Frame frame(scene_of(mesh, 1), {});
    std::vector<Ray> rays;
    std::vector<int> patches;
    for (int f = 0; f < faces; f += 797) {
        auto x = static_cast<float>(1.5 * (f % 200) + 0.3 - frame.origin().x);
        auto y = static_cast<float>(1.5 * (f / 200) + 0.6 - frame.origin().y);
        rays.push_back({{x, y, 5}, {0, 0, -1}});
        patches.push_back(f);
    }
    expect_bounded(mesh, 60, 1.5, rays, patches);
}

TEST(KdTree, PointsAndLines) {
    Mesh mesh = quads([](int face, int corner) {
        glm::dvec3 at(std::sin(face), std::cos(1.3 * face), std::sin(0.7 * face));
        return at + glm::dvec3(0, 0, face % 2 == 0 && corner >= 2 ? 0.5 : 0);
    });
    expect_bounded(mesh, 160, 6, {{{0, 0, 5}, {0, 0, -1}}}, {-1});
}

} // namespace
} // namespace razor::test
