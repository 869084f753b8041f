// Rays from inside closed meshes: none may escape. RAZOR_WATERTIGHT_RAYS: how many a scene (200000;
// a tenth of that on sse4).
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace razor::test {
namespace {

std::size_t rays_wanted() {
    const char* text = std::getenv("RAZOR_WATERTIGHT_RAYS");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 200'000;
}

class Watertight : public testing::TestWithParam<std::string> {};

TEST_P(Watertight, NoRayEscapes) {
    std::optional<NamedScene> scene = named_scene(GetParam());
    if (!scene)
        GTEST_SKIP() << "the shared scenes are not there";
    ASSERT_TRUE(scene->closed);
    constexpr int batch = 8192;
    for (const KernelTable* target : native_targets()) {
        if (target != native_targets().back() && target->name != std::string("sse4"))
            continue; // the others have the same bits
        Frame frame(scene->scene, {});
        Tracer tracer(frame, batch);
        frame.build_all(*target);
        Oracle oracle(frame, target->name != std::string("sse4"));
        RayMaker make(oracle.triangles(), oracle.origins(), 3);
        std::vector<Point> starts;
        for (int tries = 0; starts.size() < 24 && tries < 2000; ++tries) {
            Point p = make.random_point();
            if (oracle.inside(p))
                starts.push_back(p);
        }
        ASSERT_EQ(starts.size(), 24U);
        std::size_t escapes = 0;
        std::size_t wanted = target == native_targets().back() ? rays_wanted() : rays_wanted() / 10;
        for (std::size_t done = 0; done < wanted; done += batch) {
            std::vector<Ray> rays;
            const Point& start = starts[done / batch % starts.size()];
            for (int i = 0; i < batch; ++i) {
                // A packet's neighbours differ little, as a camera's do, or not at all.
                const Point& from = i % 64 < 48 ? start : starts[static_cast<std::size_t>(make.pick(24))];
                Point way = i % 4 != 0 ? make.direction_at_feature(from) : make.random_direction();
                rays.push_back({from, way});
            }
            std::vector<Hit> hits = tracer.closest(*target, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (hits[i].patch >= 0)
                    continue;
                ++escapes;
                if (escapes <= 3)
                    ADD_FAILURE() << target->name << ": "
                                  << (oracle.closest(rays[i]).patch >= 0
                                          ? "the tree misses what brute force hits"
                                          : "there is a hole");
            }
        }
        EXPECT_EQ(escapes, 0U) << target->name;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Watertight,
                         testing::Values("cube", "torus_stretched", "urchin", "urchin_stretched",
                                         "torus_bilinear", "cube_bilinear_stretched", "urchin_bilinear",
                                         "spot", "female_generic"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
