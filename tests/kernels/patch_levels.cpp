// Rays that take each patch at one level, against brute force over the triangles of each patch's level for
// each ray; pictures, on every target.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include "razor/check/escapes.h"
#include "razor/native/render.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <set>
#include <string>

namespace razor::test {
namespace {

/// The least target edge length of the ray in a box (scene coordinates): the least of what grows with the
/// distance and the least of what a lens blurs.
double least_target_in(const Ray& ray, const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 origin(ray.origin[0], ray.origin[1], ray.origin[2]);
    const glm::dvec3 near = glm::max(glm::max(low - origin, origin - high), glm::dvec3(0));
    const glm::dvec3 far = glm::max(origin - low, high - origin);
    const double growth = ray.growth;
    const double grown = growth * glm::length(growth < 0 ? far : near);
    double least = ray.base, most = ray.base;
    for (int k = 0; k < 3; ++k) {
        const double slope = ray.slope[static_cast<std::size_t>(k)];
        const double a = slope * (low[k] - origin[k]), b = slope * (high[k] - origin[k]);
        least += std::min(a, b);
        most += std::max(a, b);
    }
    const double blurred = std::max({least, -most, 0.0});
    return std::max((grown + blurred) * level_rounding, double{least_target_edge});
}

class ByPatch {
public:
    ByPatch(Frame& frame, bool fused) {
        for (int patch = 0; patch < frame.header().patch_count; ++patch) {
            const OpenPatch& open = frame.header().trees.get()[0].patches.get()[patch];
            if (open.state.word != ready)
                continue;
            const BlockHeader& root = *block_at(frame, open.root).header;
            const Point o = instance_origins(frame)[static_cast<std::size_t>(root.instance)];
            Patch p;
            p.absolute = root.absolute - root.level;
            for (int k = 0; k < 3; ++k) {
                p.low[k] = double{root.box_low[k]} + o[static_cast<std::size_t>(k)];
                p.high[k] = double{root.box_high[k]} + o[static_cast<std::size_t>(k)];
            }
            for (int level = 0; level <= root.level; ++level) {
                std::vector<Triangle> triangles;
                for (const BlockView& b : blocks_of(frame, patch, 0, level))
                    add_triangles(b, triangles);
                p.levels.emplace_back(std::move(triangles), instance_origins(frame), fused);
            }
            patches_.push_back(std::move(p));
        }
    }

    /// The hit, and the levels that the ray took; nothing if the choice of one hangs on rounding.
    std::optional<Hit> closest(const Ray& ray, int axis, std::set<int>& taken) const {
        Hit best;
        for (const Patch& p : patches_) {
            const double asked = std::log2(least_target_in(ray, p.low, p.high)) - p.absolute;
            if (std::abs(asked - std::round(asked)) < 1e-4)
                return {};
            const double level = std::clamp(std::floor(asked), 0.0, static_cast<double>(p.levels.size() - 1));
            taken.insert(static_cast<int>(level));
            const Hit h = p.levels[static_cast<std::size_t>(level)].closest(ray, axis);
            if (h.patch >= 0 && (best.patch < 0 || h.t < best.t || (h.t == best.t && h.patch < best.patch)))
                best = h;
        }
        return best;
    }

    bool has_levels() const {
        return std::any_of(patches_.begin(), patches_.end(),
                           [](const Patch& p) { return p.levels.size() > 1; });
    }

private:
    struct Patch {
        int absolute = 0; // of level 0
        glm::dvec3 low{0}, high{0};
        std::vector<Oracle> levels;
    };
    std::vector<Patch> patches_;
};

class PatchLevels : public testing::TestWithParam<std::string> {};

TEST_P(PatchLevels, HitsAreIdentical) {
    std::optional<NamedScene> scene = named_scene(GetParam());
    if (!scene)
        GTEST_SKIP() << "the shared scenes are not there";
    scene->scene.settings.lod = Lod::patch;
    for (bool fused : {true, false}) {
        const std::vector<const KernelTable*> targets = targets_with(fused);
        if (targets.empty())
            continue;
        Frame reference(scene->scene, {});
        reference.build_all(*targets.front());
        const ByPatch expected_of(reference, fused);
        const std::vector<Triangle> triangles = triangles_of(reference);
        RayMaker make(triangles, instance_origins(reference), 11);
        const float edge = reference.header().instances.get()[0].edge_length;
        const std::size_t wanted = std::clamp<std::size_t>(6'000'000 / triangles.size(), 128, 1024);
        std::vector<Ray> rays;
        std::vector<Hit> expected;
        std::size_t hits = 0, several = 0;
        constexpr float growths[] = {-0.1F, 0, 0.01F, 0.05F, 0.125F};
        while (rays.size() < wanted) {
            Ray r = rays.size() % 2 == 0 ? make.random_ray() : make.at_edge();
            r.t_max = 3.0e38F;
            r.base = edge * std::exp2(make.uniform(-1, 6));
            r.growth = growths[make.pick(5)];
            if (make.pick(4) == 0) { // through a lens
                const Point axis = make.random_direction();
                for (std::size_t k = 0; k < 3; ++k)
                    r.slope[k] = 0.1F * axis[k];
                r.growth = std::clamp(r.growth, -0.025F, 0.025F);
            }
            std::set<int> taken;
            if (!expected_of.closest(r, 0, taken))
                continue;
            rays.push_back(r);
            several += taken.size() > 1 ? 1 : 0;
        }
        const std::vector<int> axes = shear_axes(rays, targets.front()->width);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            std::set<int> taken;
            expected.push_back(expected_of.closest(rays[i], axes[i], taken).value());
            hits += expected.back().patch >= 0 ? 1 : 0;
        }
        EXPECT_GT(hits, wanted / 10);
        if (expected_of.has_levels()) {
            EXPECT_GT(several, wanted / 10) << "hardly a ray took patches at several levels";
        }
        for (const KernelTable* target : targets) {
            Frame frame(scene->scene, {});
            Tracer tracer(frame, static_cast<int>(rays.size()));
            const std::vector<Hit> got = tracer.closest(*target, rays);
            const std::vector<bool> any = tracer.any(*target, rays);
            int wrong = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                EXPECT_EQ(any[i], expected[i].patch >= 0) << target->name << ", ray " << i;
                if (!(got[i] == expected[i]) && ++wrong <= 3)
                    ADD_FAILURE() << target->name << ", ray " << i << ": patch " << got[i].patch << " at "
                                  << got[i].t << ", expected " << expected[i].patch << " at "
                                  << expected[i].t;
            }
            EXPECT_EQ(wrong, 0) << target->name << ": wrong hits of " << rays.size();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PatchLevels, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

/// Between patches of different levels there are cracks: that is what the scheme is for showing.
TEST(PatchLevelsOfTorus, RaysEscape) {
    Scene scene = scene_of(stretched(torus_cage(9, 6)), 60);
    scene.settings.lod = Lod::patch;
    Frame frame(scene, {});
    EscapeOptions options;
    options.rays = 100'000;
    options.growth = 0.05;
    options.compared = 100;
    const EscapeReport r = shoot_from_inside(frame, *native_targets().back(), Lod::patch, options);
    EXPECT_GT(r.escapes, 0);
    EXPECT_LT(r.escapes, r.rays / 100);
    EXPECT_EQ(r.compared, 0);
}

} // namespace
} // namespace razor::test
