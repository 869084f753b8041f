// Rays against brute force over all triangles; lazy against eager trees.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace razor::test {
namespace {

std::vector<Ray> all_kinds_of_rays(RayMaker& make, std::size_t count) {
    std::vector<Ray> rays;
    while (rays.size() < count) {
        for (int i = 0; i < 40; ++i)
            rays.push_back(make.random_ray());
        for (int i = 0; i < 40; ++i)
            rays.push_back(make.at_vertex());
        for (int i = 0; i < 40; ++i)
            rays.push_back(make.at_edge());
        for (int i = 0; i < 30; ++i)
            rays.push_back(make.along_axis());
        for (int i = 0; i < 30; ++i)
            rays.push_back(make.from_surface());
        for (int i = 0; i < 30; ++i)
            rays.push_back(make.odd_range());
        for (int i = 0; i < 20; ++i)
            rays.push_back(make.not_a_ray());
    }
    std::vector<Ray> mixed = rays; // packets of all kinds at once
    for (std::size_t i = mixed.size(); i > 1; --i)
        std::swap(mixed[i - 1], mixed[static_cast<std::size_t>(make.pick(static_cast<int>(i)))]);
    rays.insert(rays.end(), mixed.begin(), mixed.end());
    return rays;
}

std::string text(const Hit& h) {
    char line[160];
    std::snprintf(line, sizeof line, "patch %d triangle %d t %a u %a v %a", h.patch, h.triangle,
                  static_cast<double>(h.t), static_cast<double>(h.u), static_cast<double>(h.v));
    return line;
}
std::string text(const Ray& r) {
    char line[240];
    std::snprintf(line, sizeof line, "from %a %a %a along %a %a %a in [%a, %a]",
                  static_cast<double>(r.origin[0]), static_cast<double>(r.origin[1]),
                  static_cast<double>(r.origin[2]), static_cast<double>(r.direction[0]),
                  static_cast<double>(r.direction[1]), static_cast<double>(r.direction[2]),
                  static_cast<double>(r.t_min), static_cast<double>(r.t_max));
    return line;
}

void expect_same_hits(const std::vector<Ray>& rays, const std::vector<Hit>& expected,
                      const std::vector<Hit>& got, const std::string& what) {
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (got[i] == expected[i])
            continue;
        if (++wrong <= 3)
            ADD_FAILURE() << what << ", ray " << i << ' ' << text(rays[i]) << "\n  expected "
                          << text(expected[i]) << "\n  got      " << text(got[i]);
    }
    EXPECT_EQ(wrong, 0) << what << ": wrong hits of " << rays.size();
}

class BruteForce : public testing::TestWithParam<std::string> {};

TEST_P(BruteForce, HitsAreIdentical) {
    std::optional<NamedScene> scene = named_scene(GetParam());
    if (!scene)
        GTEST_SKIP() << "the shared scenes are not there";
    for (bool fused : {true, false}) {
        std::vector<const KernelTable*> targets = targets_with(fused);
        if (targets.empty())
            continue;
        Frame reference(scene->scene, {});
        reference.build_all(*targets.front());
        Oracle oracle(reference, fused);
        const std::vector<Triangle>& triangles = oracle.triangles();
        RayMaker make(triangles, oracle.origins(), 1);
        std::vector<Ray> rays =
            all_kinds_of_rays(make, std::clamp<std::size_t>(10'000'000 / triangles.size(), 230, 1000));
        std::vector<Hit> expected;
        std::vector<bool> expected_any;
        int hits = 0;
        const std::vector<int> axes = shear_axes(rays, targets.front()->width);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            expected.push_back(oracle.closest(rays[i], axes[i]));
            expected_any.push_back(expected.back().patch >= 0);
            hits += expected.back().patch >= 0 ? 1 : 0;
        }
        EXPECT_GT(hits, static_cast<int>(rays.size()) / 10);
        int hanging = 0;
        for (const Triangle& t : triangles)
            for (const FlatEdge& e : t.edge)
                hanging += e.hang > 0 ? 1 : 0;
        if (scene->name.find("stretched") != std::string::npos) {
            EXPECT_GT(hanging, 200);
        }
        for (const KernelTable* target : targets) {
            Frame frame(scene->scene, {});
            Tracer tracer(frame, static_cast<int>(rays.size()));
            expect_same_hits(rays, expected, tracer.closest(*target, rays), target->name);
            EXPECT_EQ(tracer.any(*target, rays), expected_any) << target->name;
            frame.build_all(*target);
            EXPECT_EQ(frame.statistics().unsplit_nodes, 0) << target->name;
            expect_same_hits(rays, expected, tracer.closest(*target, rays),
                             std::string(target->name) + ", eager tree");
            // The geometry too, whatever order it was opened in.
            std::vector<Triangle> mine = triangles_of(frame);
            ASSERT_EQ(mine.size(), triangles.size()) << target->name;
            for (std::size_t i = 0; i < mine.size(); ++i)
                ASSERT_EQ(std::memcmp(&mine[i], &triangles[i], sizeof(Triangle)), 0)
                    << target->name << ", triangle " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BruteForce, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
