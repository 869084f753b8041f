// Bad rays have a defined answer and cost little: at most 2.5 times the steps and operations of good ones.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"
#include "tests/robustness/effort.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace razor::test {
namespace {

constexpr int count = 1024;
constexpr float infinity = std::numeric_limits<float>::infinity();

class BadRays : public testing::TestWithParam<std::string> {
protected:
    struct Family {
        std::string name;
        std::function<Ray(RayMaker&)> make;
        bool answered; // has hits to compare with
    };
    static std::vector<Family> families() {
        auto with_range = [](float low, float high) {
            return [=](RayMaker& m) {
                Ray r = m.random_ray();
                r.t_min = low;
                r.t_max = high;
                return r;
            };
        };
        auto in_a_plane =
            [](RayMaker& m) { // an axis-parallel plane through a vertex, where splits like to be
                Ray r = m.along_axis();
                r.direction[0] += r.direction[0] == 0 ? 1e-7F : 0;
                return r;
            };
        auto denormal = [](RayMaker& m) {
            Ray r = m.along_axis();
            for (float& d : r.direction)
                d = d == 0 ? 1e-42F : d;
            return r;
        };
        return {{"axis parallel", [](RayMaker& m) { return m.along_axis(); }, true},
                {"grazing", in_a_plane, true},
                {"denormal components", denormal, true},
                {"from the surface", [](RayMaker& m) { return m.from_surface(); }, true},
                {"tiny range", with_range(0, 1e-30F), true},
                {"huge range", with_range(-3e38F, infinity), true},
                {"empty range", with_range(1, 0), false},
                {"not a ray", [](RayMaker& m) { return m.not_a_ray(); }, false}};
    }
};

TEST_P(BadRays, AreAnsweredAndCheap) {
    Scene scene = named_scene(GetParam())->scene;
    for (const KernelTable* target : targets_with(true)) {
        Frame frame(scene, {});
        Tracer tracer(frame, count);
        frame.build_all(*target);
        Oracle oracle(frame, true);
        RayMaker make(oracle.triangles(), oracle.origins(), 21);
        auto cost = [&](const std::vector<Ray>& rays) {
            return effort_of(frame, *target, rays.size(), [&] { tracer.closest(*target, rays); });
        };
        std::vector<Ray> good;
        for (int i = 0; i < count; ++i) {
            Ray r = make.random_ray();
            r.direction = make.direction_at_feature(r.origin);
            good.push_back(r);
        }
        const Effort usual = cost(good);
        for (const Family& family : families()) {
            std::vector<Ray> rays;
            for (int i = 0; i < count; ++i)
                rays.push_back(family.make(make));
            expect_at_most(2.5, usual, cost(rays), std::string(target->name) + ": " + family.name);
            std::vector<Hit> hits = tracer.closest(*target, rays);
            const std::vector<int> axes = shear_axes(rays, target->width);
            for (std::size_t i = 0; i < rays.size(); i += family.answered ? 16 : 1)
                ASSERT_EQ(hits[i], family.answered ? oracle.closest(rays[i], axes[i]) : Hit{})
                    << target->name << ": " << family.name << ' ' << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BadRays,
                         testing::Values("cube", "urchin_stretched", "torus_bilinear", "default"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
