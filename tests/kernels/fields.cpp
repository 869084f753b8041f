// Rays that each ask for a level of detail of their own, against the surface that they see by definition;
// from inside closed meshes none may escape. RAZOR_WATERTIGHT_RAYS: how many a scene (200000; a tenth of that
// on sse4).
#include "razor/check/escapes.h"
#include "razor/check/field_surface.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace razor::test {
namespace {

std::size_t rays_wanted() {
    const char* text = std::getenv("RAZOR_WATERTIGHT_RAYS");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 200'000;
}

/// A target edge length from below the finest level to beyond the coarsest, and a growth of either sign; half
/// of them through a lens, in focus on a plane through the surface or elsewhere.
void ask(RayMaker& make, float edge_length, Ray& ray) {
    constexpr float growths[] = {-0.25F, -0.05F, 0, 0, 0.001F, 0.01F, 0.05F, 0.25F, 0.25F};
    ray.base = edge_length * std::exp2(make.uniform(-1, 8));
    ray.growth = growths[make.pick(9)];
    ray.slope = {};
    if (make.pick(2) == 0)
        return;
    const Point axis = make.random_direction(), focus = make.random_point();
    constexpr float cap = gradation_cap; // which kernels hold growth to, but not a slope
    const float slope = make.pick(3) == 0 ? cap : cap * std::exp2(make.uniform(-4, 0));
    ray.growth = std::clamp(ray.growth, slope - cap, cap - slope);
    float along = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        ray.slope[k] = slope * axis[k];
        along += ray.slope[k] * (focus[k] - ray.origin[k]);
    }
    if (make.pick(4) != 0)
        ray.base = -along;
}

class Fields : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        scene_ = named_scene(GetParam());
        if (!scene_)
            GTEST_SKIP() << "the shared scenes are not there";
        scene_->scene.settings.lod = Lod::recursive;
    }
    std::vector<Point> inside_points(const Oracle& oracle, RayMaker& make, std::size_t count) const {
        std::vector<Point> starts;
        for (int tries = 0; starts.size() < count && tries < 2000; ++tries) {
            Point p = make.random_point();
            if (oracle.inside(p))
                starts.push_back(p);
        }
        return starts;
    }
    std::optional<NamedScene> scene_;
};

TEST_P(Fields, HitsAreOnTheSurfaceByDefinition) {
    for (const KernelTable* target : native_targets()) {
        if (target != native_targets().back() && target->name != std::string("sse4"))
            continue; // the others have the same bits
        Frame frame(scene_->scene, {});
        constexpr int batch = 512;
        Tracer tracer(frame, batch);
        frame.build_all(*target);
        const FieldSurface surface(frame);
        const Oracle oracle(frame, target->name != std::string("sse4"));
        RayMaker make(oracle.triangles(), oracle.origins(), 6);
        const float edge = frame.header().instances.get()[0].edge_length;
        const std::size_t wanted = std::clamp<std::size_t>(6'000'000 / surface.vertices(), 64, batch);
        std::vector<Ray> rays;
        while (rays.size() < wanted) {
            Ray r = rays.size() % 3 == 0 ? make.random_ray() : make.at_edge();
            r.t_max = 3.0e38F;
            ask(make, edge, r);
            rays.push_back(r);
        }
        const std::vector<Hit> hits = tracer.closest(*target, rays);
        const std::vector<bool> any = tracer.any(*target, rays);
        std::size_t between = 0, met = 0, wrong = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SeenSurface seen(surface, rays[i]);
            if (i % 4 == 0)
                between += seen.between();
            EXPECT_EQ(any[i], hits[i].patch >= 0) << target->name << ", ray " << i;
            const auto possible = seen.crossings(rays[i], hit_roundings);
            const auto certain = seen.crossings(rays[i], -hit_roundings);
            bool right = hits[i].patch < 0 && certain.empty();
            if (hits[i].patch >= 0) {
                ++met;
                const double t = hits[i].t;
                for (const auto& c : possible)
                    right = right || std::abs(c.t - t) <= c.slack;
                right = right && (certain.empty() || t <= certain.front().t + certain.front().slack);
            }
            if (!right && ++wrong <= 3)
                ADD_FAILURE() << target->name << ", ray " << i << ": base " << rays[i].base / edge
                              << " edges, growth " << rays[i].growth << ": hit at "
                              << (hits[i].patch < 0 ? -1.0F : hits[i].t) << ", expected "
                              << (certain.empty() ? -1.0 : certain.front().t) << " or "
                              << (possible.empty() ? -1.0 : possible.front().t);
        }
        EXPECT_EQ(wrong, 0U) << target->name;
        EXPECT_GT(met, rays.size() / 10);
        EXPECT_GT(between, 0U) << "no vertex was between two places: nothing was tried";
    }
}

TEST_P(Fields, NoRayEscapes) {
    if (!scene_->closed)
        GTEST_SKIP() << "an open surface";
    constexpr int batch = 8192;
    for (const KernelTable* target : native_targets()) {
        if (target != native_targets().back() && target->name != std::string("sse4"))
            continue;
        Frame frame(scene_->scene, {});
        Tracer tracer(frame, batch);
        frame.build_all(*target);
        const Oracle oracle(frame, target->name != std::string("sse4"));
        const FieldSurface surface(frame);
        RayMaker make(oracle.triangles(), oracle.origins(), 7);
        const float edge = frame.header().instances.get()[0].edge_length;
        // What an origin is inside of depends on what it asks for.
        struct Start {
            Ray ray;
        };
        std::vector<Start> starts;
        for (const Point& p : inside_points(oracle, make, 48)) {
            Ray r{p, make.random_direction()};
            ask(make, edge, r);
            bool inside = true;
            for (int i = 0; i < 3; ++i) {
                r.direction = make.random_direction();
                inside = inside && SeenSurface(surface, r).crossings(r, 0).size() % 2 == 1;
            }
            if (inside)
                starts.push_back({r});
        }
        ASSERT_GT(starts.size(), 12U);
        std::size_t escapes = 0;
        const std::size_t wanted = target == native_targets().back() ? rays_wanted() : rays_wanted() / 10;
        for (std::size_t done = 0; done < wanted; done += batch) {
            std::vector<Ray> rays;
            const Start& start = starts[done / batch % starts.size()];
            for (int i = 0; i < batch; ++i) {
                Ray r =
                    i % 64 < 48
                        ? start.ray
                        : starts[static_cast<std::size_t>(make.pick(static_cast<int>(starts.size())))].ray;
                r.direction = i % 4 != 0 ? make.direction_at_feature(r.origin) : make.random_direction();
                rays.push_back(r);
            }
            const std::vector<Hit> hits = tracer.closest(*target, rays);
            for (std::size_t i = 0; i < rays.size(); ++i)
                escapes += hits[i].patch < 0 ? 1 : 0;
        }
        EXPECT_EQ(escapes, 0U) << target->name;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Fields, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

/// Where what decides about a block's border lies several blocks away.
TEST(FieldsOfTaperedPatches, HitsAreOnTheSurfaceByDefinition) {
    Scene scene = scene_of(tapered_cage(), 200);
    scene.settings.lod = Lod::recursive;
    for (const KernelTable* target : native_targets()) {
        if (target != native_targets().back() && target->name != std::string("sse4"))
            continue;
        Frame frame(scene, {});
        EscapeOptions options;
        const int rays = target == native_targets().back() ? 6000 : 600;
        options.rays = options.compared = rays;
        options.rays_an_origin = 200;
        const EscapeReport r = shoot_from_inside(frame, *target, Lod::recursive, options);
        EXPECT_EQ(r.escapes, 0) << target->name;
        EXPECT_EQ(r.different, 0) << target->name;
        EXPECT_GT(r.compared, rays / 2) << target->name;
    }
}

/// Blocks beside an edge longer than they are, of which only an end moves.
TEST(FieldsOfTaperedPatches, SidesFollowTheEndsOfLongEdges) {
    Scene scene = scene_of(tapered_cage(), 200);
    scene.settings.lod = Lod::recursive;
    Ray ray{{0.095508866F, 0.301232249F, 0.0439132117F}, {-0.0954149738F, 0.993086338F, -0.0683777109F}};
    ray.base = 0.0006183511F;
    ray.slope = {-0.0380168483F, -0.0511012301F, 0.0491570942F};
    for (const KernelTable* target : native_targets()) {
        Frame frame(scene, {});
        Tracer tracer(frame, 64);
        frame.build_all(*target);
        const FieldSurface surface(frame);
        const auto seen = SeenSurface(surface, ray).crossings(ray, 0);
        Ray anchored = ray;
        anchored.slope = {};
        anchored.base = least_target_edge;
        const auto finest = SeenSurface(surface, anchored).crossings(anchored, 0);
        ASSERT_FALSE(seen.empty() || finest.empty());
        ASSERT_GT(std::abs(seen.front().t - finest.front().t), 1e-4);
        EXPECT_NEAR(tracer.closest(*target, {ray}).front().t, seen.front().t, 1e-5) << target->name;
    }
}

/// Beside a coarse block the vertices of a finer one are means, rounded; rays are aimed at them. Rounding
/// once let one of some ten thousand through.
TEST(FieldsOfNeighbours, NoRayPassesBetweenLevels) {
    std::optional<Mesh> mesh = shared_mesh("spot/spot_control_mesh.obj");
    Scene scene = mesh ? scene_of(*mesh, 20) : named_scene("torus_stretched")->scene;
    scene.settings.lod = Lod::recursive;
    Frame frame(scene, {});
    EscapeOptions options;
    options.rays = 200'000;
    options.growth = 0.02;
    options.base = 1.9;
    const EscapeReport r = shoot_from_inside(frame, *native_targets().back(), Lod::recursive, options);
    EXPECT_EQ(r.escapes, 0);
}

} // namespace
} // namespace razor::test
