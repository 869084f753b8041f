// The tree cut by level against a tree a level: frames whose rays all take one level (`fixed:K`) have
// kd-trees of that level's blocks and of nothing else. Rays that ask the tree of all levels for level K must
// find the same.
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

/// The coarsest level that every patch of a frame has.
int last_common_level(Frame& frame) {
    const OpenPatch* open = frame.header().trees.get()[0].patches.get();
    int level = 100;
    for (int p = 0; p < frame.header().patch_count; ++p)
        if (!blocks_of(frame, p).empty())
            level = std::min(level, block_at(frame, open[p].root).header->level);
    return level;
}

class TreeALevel : public testing::TestWithParam<std::string> {};

TEST_P(TreeALevel, FindsTheSame) {
    const std::optional<NamedScene> named = named_scene(GetParam());
    Scene scene = named->scene;
    scene.settings.lod = Lod::recursive;
    scene.meshes[0].edge_length /= 2; // so that all patches have several levels
    const KernelTable* target = native_targets().back();
    Frame all(scene, {});
    Tracer tracer(all, 4096);
    all.build_all(*target);
    const Oracle oracle(all, true);
    RayMaker make(oracle.triangles(), oracle.origins(), 17);
    std::vector<Ray> rays;
    while (rays.size() < 4096) {
        Ray r = make.random_ray();
        if (rays.size() % 2 == 0)
            r.direction = make.direction_at_feature(r.origin);
        rays.push_back(r);
    }
    const double edge = all.header().instances.get()[0].edge_length;
    std::size_t levels_apart = 0;
    std::vector<Hit> finer;
    const int last = last_common_level(all);
    ASSERT_GE(last, 2);
    for (int level = 0; level <= last; ++level) {
        Scene one = scene;
        one.settings.lod = {Lod::fixed, level};
        Frame only(one, {});
        Tracer plain(only, 4096);
        std::vector<Ray> asking = rays;
        for (Ray& r : asking)
            r.base = static_cast<float>(std::ldexp(edge, level));
        const std::vector<Hit> expected = plain.closest(*target, rays);
        const std::vector<Hit> got = tracer.closest(*target, asking);
        std::size_t hits = 0, wrong = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            hits += expected[i].patch >= 0 ? 1 : 0;
            wrong += got[i] == expected[i] ? 0 : 1;
            levels_apart += level > 0 && got[i].t != finer[i].t ? 1 : 0;
        }
        EXPECT_EQ(wrong, 0U) << target->name << " level " << level;
        EXPECT_GT(hits, 400U);
        finer = got;
    }
    EXPECT_GT(levels_apart, 400U); // else they are no levels
}

INSTANTIATE_TEST_SUITE_P(Scenes, TreeALevel, testing::Values("cube", "torus_stretched", "torus_bilinear"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
