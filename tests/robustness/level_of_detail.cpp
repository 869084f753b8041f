// Levels of detail at their limits: what rays ask for grows by next to nothing or by more than is kept, is
// nothing at all, or differs by all levels within one packet.
//
// Seen to fail: levels that are not blended (Lod::discrete in place of recursive).
#include "razor/check/escapes.h"
#include "razor/check/field_surface.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"
#include "tests/robustness/effort.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

constexpr Lod scene_levels = Lod::recursive;

/// Whose rays see levels of their own.
Scene recursive(const char* name) {
    Scene scene = named_scene(name)->scene;
    scene.settings.lod = scene_levels;
    return scene;
}

/// Rays from inside hit the surface by its definition: also where the origin lies so near to it that
/// footprints of all sizes are asked for, and with a footprint of 0; they cost what rays to the finest level
/// do.
TEST(LevelOfDetail, AsksOfAnySizeHitWhatTheyDefine) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"}) {
        const Scene scene = recursive(name);
        for (const KernelTable* target : targets_with(true)) {
            const bool best = target == native_targets().back();
            double usual = 0; // steps of a ray, where all see the finest level: the first of these
            for (const double growth : {0.0, 1e-6, 0.125, 10.0})
                for (const double base : {0.0, 1.0, 40.0}) {
                    Frame frame(scene, {});
                    check::EscapeOptions options;
                    options.rays = best ? 1000 : 100;
                    options.rays_an_origin = 50;
                    options.compared = best ? 50 : 5;
                    options.growth = growth;
                    options.base = base;
                    options.seed = 7;
                    const check::EscapeReport r =
                        check::shoot_from_inside(frame, *target, Lod::recursive, options);
                    EXPECT_GT(r.origins, 0) << target->name;
                    EXPECT_EQ(r.escapes, 0) << target->name << ' ' << name << ' ' << growth << ' ' << base;
                    EXPECT_EQ(r.different, 0) << target->name << ' ' << name << ' ' << growth << ' ' << base;
                    const double a_ray = Effort{r.rays, steps(frame.statistics().counters)}.steps_a_ray();
                    usual = usual == 0 ? a_ray : usual;
                    EXPECT_LT(a_ray, 2.5 * usual)
                        << target->name << ' ' << name << ' ' << growth << ' ' << base;
                }
        }
    }
}

constexpr int levels = 14;

/// Rays at features of a mesh, of which each asks for 2^(i mod 14) finest edges.
std::vector<Ray> of_all_levels(const Oracle& oracle, double edge, int count) {
    RayMaker make(oracle.triangles(), oracle.origins(), 5);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Ray r = make.random_ray();
        r.direction = make.direction_at_feature(r.origin);
        r.base = static_cast<float>(std::ldexp(edge, i % levels));
        r.growth = 0;
        rays.push_back(r);
    }
    return rays;
}

TEST(LevelOfDetail, OfOnePacketDoNotDisturbEachOther) {
    for (const char* name : {"urchin_stretched", "torus_bilinear"})
        for (const KernelTable* target : targets_with(true)) {
            Frame frame(recursive(name), {});
            Tracer tracer(frame, 64);
            frame.build_all(*target);
            const Oracle oracle(frame, true);
            const double edge = std::ldexp(1.0, check::FieldSurface(frame).finest_level());
            const std::vector<Ray> rays = of_all_levels(oracle, edge, 8 * levels * 4);
            int hit = 0;
            for (std::size_t first = 0; first < rays.size(); first += 56) {
                const std::vector<Ray> together(rays.begin() + static_cast<std::ptrdiff_t>(first),
                                                rays.begin() + static_cast<std::ptrdiff_t>(first + 56));
                const std::vector<Hit> hits = tracer.closest(*target, together);
                for (std::size_t i = 0; i < together.size(); ++i) {
                    const Hit alone = tracer.closest(*target, {together[i]}).front();
                    // The axis that rays are sheared along is the packet's: the last bits depend on it, and
                    // so does which side of an edge a ray at that edge is on.
                    ASSERT_EQ(hits[i].patch < 0, alone.patch < 0) << target->name << ' ' << first + i;
                    if (alone.patch >= 0) {
                        ++hit;
                        ASSERT_NEAR(hits[i].t, alone.t, 1e-4F * alone.t + 1e-5F)
                            << target->name << ' ' << first + i;
                    }
                }
            }
            EXPECT_GT(hit, static_cast<int>(rays.size()) / 4);
        }
}

} // namespace
} // namespace razor::test
