// The scene graph made flat, beside plain recursion in extended precision, in any shape a graph can have.
#include "tests/scene/graph_matrices.h"
#include "tests/scene/random_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace razor {
namespace {

/// What a graph draws, by plain recursion.
struct Drawn {
    int mesh = 0, level_offset = 0, material = -1;
    Real rate = 1;
    Matrix world{};
};
void draw(const SceneGraph& graph, std::size_t group, const Drawn& above, std::vector<Drawn>& all) {
    for (const Placement& p : graph.groups[group].placements) {
        for (int i = 0; i < p.copies.x; ++i) {
            for (int j = 0; j < p.copies.y; ++j) {
                for (int k = 0; k < p.copies.z; ++k) {
                    Matrix copy = matrix_of(p.local);
                    copy[0][3] += static_cast<Real>(i) * p.spacing.x;
                    copy[1][3] += static_cast<Real>(j) * p.spacing.y;
                    copy[2][3] += static_cast<Real>(k) * p.spacing.z;
                    const Drawn here{p.mesh, above.level_offset + p.level_offset,
                                     p.material >= 0 ? p.material : above.material, above.rate * p.rate,
                                     product(above.world, copy)};
                    if (p.group >= 0) {
                        draw(graph, static_cast<std::size_t>(p.group), here, all);
                    } else {
                        all.push_back(here);
                    }
                }
            }
        }
    }
}

TEST(FlatGraph, DrawsWhatPlainRecursionDraws) {
    Random random(4);
    std::size_t compared = 0;
    for (int round = 0; round < 300; ++round) {
        const SceneGraph graph = random_graph(random, random.whole(1, 6), 3);
        std::vector<Drawn> expected;
        draw(graph, 0, {0, 0, -1, 1, diagonal(1, 1, 1)}, expected);
        std::vector<Box> boxes;
        for (int m = 0; m < 3; ++m) {
            boxes.push_back({});
            for (int i = 0; i < 4; ++i) {
                boxes.back().add(random.vector(-2, 2));
            }
        }
        const FlatGraph flat = flatten(graph, boxes);
        ASSERT_EQ(flat.instances.size(), expected.size());

        // In one order, by where a point lands that no two send to the same place.
        const auto key = [](const auto& p) { return p[0] + Real{1.37L} * p[1] + Real{2.11L} * p[2]; };
        const glm::dvec3 probe(0.31, 0.57, 0.83);
        std::sort(expected.begin(), expected.end(), [&](const Drawn& a, const Drawn& b) {
            return key(image(a.world, probe)) < key(image(b.world, probe));
        });
        std::vector<std::size_t> order(flat.instances.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto world = [&](std::size_t i) -> const Affine& {
            return flat.nodes[static_cast<std::size_t>(flat.instances[i].node)].world;
        };
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return key(world(a)(probe)) < key(world(b)(probe)); });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const FlatInstance& got = flat.instances[order[i]];
            const Drawn& want = expected[i];
            EXPECT_EQ(got.mesh, want.mesh);
            EXPECT_EQ(got.material, want.material);
            EXPECT_NEAR(got.rate, static_cast<double>(want.rate), 1e-14 * got.rate);
            const double largest = singular_values(world(order[i]).linear).x;
            EXPECT_NEAR(got.scale, largest, 2e-12 * largest);
            EXPECT_EQ(got.level_offset,
                      want.level_offset - static_cast<int>(std::lround(std::log2(largest))));
            const Box& bounds = flat.nodes[static_cast<std::size_t>(got.node)].bounds;
            const Real size = size_of(want.world, 0, 3) * 8 + size_of(want.world, 3, 1);
            const Box& box = boxes[static_cast<std::size_t>(got.mesh)];
            for (int sample = 0; sample < 20; ++sample) {
                glm::dvec3 p;
                for (int k = 0; k < 3; ++k) { // corners among them
                    const int where = random.whole(0, 3);
                    p[k] = where == 0   ? box.low[k]
                           : where == 1 ? box.high[k]
                                        : random.uniform(box.low[k], box.high[k]);
                }
                const Vector q = image(want.world, p);
                const glm::dvec3 mapped = world(order[i])(p);
                for (int k = 0; k < 3; ++k) {
                    const Real x = q[static_cast<std::size_t>(k)];
                    ASSERT_NEAR(static_cast<double>(mapped[k] - x), 0, static_cast<double>(size * 1e-13L));
                    ASSERT_TRUE(bounds.low[k] <= mapped[k] && mapped[k] <= bounds.high[k]);
                    ASSERT_TRUE(bounds.low[k] <= x && x <= bounds.high[k]);
                }
                ++compared;
            }
        }
        for (std::size_t n = 1; n < flat.nodes.size(); ++n) {
            const FlatNode& node = flat.nodes[n];
            const FlatNode& parent = flat.nodes[static_cast<std::size_t>(node.parent)];
            ASSERT_TRUE(parent.bounds.contains(node.bounds));
            ASSERT_LT(node.parent, static_cast<int>(n));
            ASSERT_TRUE(parent.first_child <= static_cast<int>(n) &&
                        static_cast<int>(n) < parent.first_child + parent.child_count);
        }
    }
    EXPECT_GT(compared, 50000U);
}

TEST(FlatGraph, BoundsAreTightToo) {
    const SceneGraph graph{{{"root", {place(0, {.scale = {2, 3, 4}, .translate = {10, 20, 30}})}}}};
    const Box box = flatten(graph, std::vector<Box>{unit_box}).nodes[0].bounds;
    for (int k = 0; k < 3; ++k) {
        const double half = 2 + k;
        EXPECT_NEAR(box.low[k], 10 * (k + 1) - half, 8.0 / 255);
        EXPECT_NEAR(box.high[k], 10 * (k + 1) + half, 8.0 / 255);
    }
}

TEST(FlatGraph, LevelOffsetIsScaleRoundedToAPowerOfTwo) {
    const auto level = [](const Transform& t, int stated = 0) {
        Placement p = place(0, t);
        p.level_offset = stated;
        return flatten(SceneGraph{{{"root", {p}}}}, std::vector<Box>{unit_box}).instances[0];
    };
    EXPECT_EQ(level({}).level_offset, 0);
    for (int k = -39; k <= 39; ++k) {
        EXPECT_EQ(level(scaled(std::ldexp(1.0, k))).level_offset, -k);
        EXPECT_EQ(level(scaled(std::ldexp(1.0, k))).scale, std::ldexp(1.0, k));
        EXPECT_EQ(level(scaled(std::ldexp(1.41, k))).level_offset, -k);
        EXPECT_EQ(level(scaled(std::ldexp(1.42, k))).level_offset, -k - 1);
        EXPECT_EQ(level(scaled(std::ldexp(-1.42, k))).level_offset, -k - 1) << "mirrored";
    }
    EXPECT_EQ(level({.scale = {1, 8, 0.5}}).level_offset, -3) << "the largest";
    // Shear (x, y) -> (x + 3 y, y): the largest singular value is (3 + sqrt(13)) / 2 = 3.30.
    EXPECT_EQ(level({.matrix = Affine{glm::dmat3(1, 0, 0, 3, 1, 0, 0, 0, 1), {}}}).level_offset, -2);
    EXPECT_NEAR(level({.matrix = Affine{glm::dmat3(1, 0, 0, 3, 1, 0, 0, 0, 1), {}}}).scale,
                (3 + std::sqrt(13.0)) / 2, 1e-14);
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const FlatInstance turned = level({.rotate = random.vector(-400, 400)});
        EXPECT_EQ(turned.level_offset, 0);
        EXPECT_EQ(turned.scale, 1) << "turning leaves no rounding";
    }
    EXPECT_EQ(level(scaled(4), 5).level_offset, 3) << "stated ones are added";
}

TEST(FlatGraph, NestsDeeply) {
    // 200,000 groups in one another, each moving by 1/8 and turning by 90 degrees about y.
    constexpr int depth = 200000;
    SceneGraph graph;
    for (int g = 0; g < depth; ++g) {
        Transform t;
        t.translate = {0.125, 0.125, 0};
        t.rotate = {0, 90, 0};
        graph.groups.push_back({"g", {g + 1 < depth ? place_group(g + 1, t) : place(0, t)}});
    }
    const FlatGraph flat = flatten(graph, std::vector<Box>{unit_box});
    ASSERT_EQ(flat.instances.size(), 1U);
    const Affine& world = flat.nodes.back().world;
    EXPECT_EQ(world.linear, glm::dmat3(1)) << "a multiple of four quarter turns";
    EXPECT_EQ(world.translation, glm::dvec3(0, 0.125 * depth, 0));
    EXPECT_LT(path_of(flat, graph, static_cast<int>(flat.nodes.size()) - 1).size(), 100U);
}

TEST(FlatGraph, ManyCopiesAreQuick) {
    SceneGraph graph{{{"root", {place_group(1)}}, {"tile", {}}}};
    graph.groups[0].placements[0].copies = {100, 1, 100};
    graph.groups[0].placements[0].spacing = {2, 1, 3};
    for (int i = 0; i < 100; ++i) {
        graph.groups[1].placements.push_back(place(0, {.translate = {0.01 * i, 0, 0}}));
    }
    const auto start = std::chrono::steady_clock::now();
    const FlatGraph flat = flatten(graph, std::vector<Box>{unit_box});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(flat.instances.size(), 1000000U);
    EXPECT_LT(seconds, 20) << "a million";
    EXPECT_EQ(flat.nodes[static_cast<std::size_t>(flat.instances.back().node)].world.translation,
              glm::dvec3(0.01 * 99 + 198, 0, 297));
}

TEST(FlatGraph, RefitFollowsWhatMoved) {
    Random random(6);
    const std::vector<Box> boxes(3, unit_box);
    for (int round = 0; round < 50; ++round) {
        SceneGraph graph = random_graph(random, 5, 3);
        FlatGraph flat = flatten(graph, boxes);
        for (Group& group : graph.groups) {
            for (Placement& p : group.placements) {
                p.local = random.transform(1);
            }
        }
        refit(flat, graph, boxes);
        const FlatGraph fresh = flatten(graph, boxes);
        ASSERT_EQ(flat.nodes.size(), fresh.nodes.size());
        for (std::size_t n = 0; n < fresh.nodes.size(); ++n) {
            EXPECT_EQ(flat.nodes[n].world, fresh.nodes[n].world);
            EXPECT_EQ(flat.nodes[n].bounds, fresh.nodes[n].bounds);
        }
        for (std::size_t i = 0; i < fresh.instances.size(); ++i) {
            EXPECT_EQ(flat.instances[i].level_offset, fresh.instances[i].level_offset);
            EXPECT_EQ(flat.instances[i].scale, fresh.instances[i].scale);
        }
    }
}

TEST(FlatGraph, FollowsWhatMovedAlone) {
    Random random(23);
    for (int round = 0; round < 100; ++round) {
        SceneGraph graph = random_graph(random, random.whole(1, 6), 3);
        std::vector<Box> boxes(3, unit_box);
        FlatGraph flat = flatten(graph, boxes);
        const FlatIndex index(flat, graph, 3);
        for (int step = 0; step < 4; ++step) {
            const FlatGraph before = flat;
            std::vector<PlacementName> moved;
            for (int n = random.whole(0, 3); n > 0; --n) {
                const int group = random.whole(0, static_cast<int>(graph.groups.size()) - 1);
                std::vector<Placement>& all = graph.groups[static_cast<std::size_t>(group)].placements;
                const int which = random.whole(0, static_cast<int>(all.size()) - 1);
                all[static_cast<std::size_t>(which)].local = random.transform(1);
                moved.push_back({group, which});
            }
            std::vector<int> meshes;
            if (random.whole(0, 2) == 0) {
                meshes = {random.whole(0, 2)};
                boxes[static_cast<std::size_t>(meshes[0])].high += random.vector(0, 1);
            }
            const std::vector<std::int32_t> others = follow(flat, index, graph, boxes, moved, meshes);
            const FlatGraph fresh = flatten(graph, boxes);
            ASSERT_EQ(flat.instances.size(), fresh.instances.size());
            for (std::size_t i = 0; i < flat.instances.size(); ++i) {
                const FlatInstance& a = flat.instances[i];
                const FlatInstance& b = fresh.instances[i];
                const FlatNode& leaf = flat.nodes[static_cast<std::size_t>(a.node)];
                const FlatNode& other = fresh.nodes[static_cast<std::size_t>(b.node)];
                ASSERT_EQ(leaf.world.linear, other.world.linear);
                ASSERT_EQ(leaf.world.translation, other.world.translation);
                ASSERT_EQ(leaf.bounds, other.bounds);
                ASSERT_EQ(a.scale, b.scale);
                ASSERT_EQ(a.level_offset, b.level_offset);
                const bool named =
                    std::binary_search(others.begin(), others.end(), static_cast<std::int32_t>(i));
                const bool same = before.nodes[static_cast<std::size_t>(a.node)].bounds == leaf.bounds;
                ASSERT_TRUE(named || same);
            }
        }
    }
}

} // namespace
} // namespace razor
