// The hierarchy over a graph's instances, and its records of single precision.
#include "tests/scene/graph_matrices.h"
#include "tests/scene/random_graph.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace razor {
namespace {

/// Every instance that is drawn is below the root once; boxes hold what is below, and no more; nodes have few
/// children, and the tree is as deep as halving makes it.
void check_hierarchy(const FlatGraph& flat, const std::vector<bool>& drawn) {
    const std::vector<HierarchyNode> nodes = build_hierarchy(flat, drawn);
    std::vector<int> seen(flat.instances.size(), 0);
    std::vector<Box> boxes(nodes.size());
    std::vector<int> depth(nodes.size(), 0);
    std::size_t next = 1;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n].instance >= 0) {
            ++seen[static_cast<std::size_t>(nodes[n].instance)];
            ASSERT_EQ(nodes[n].child_count, 0);
            continue;
        }
        ASSERT_GE(nodes[n].child_count, 2);
        ASSERT_LE(nodes[n].child_count, most_children);
        ASSERT_EQ(static_cast<std::size_t>(nodes[n].first_child), next) << "one after the other";
        next += static_cast<std::size_t>(nodes[n].child_count);
        for (int k = 0; k < nodes[n].child_count; ++k) {
            depth.at(static_cast<std::size_t>(nodes[n].first_child + k)) = depth[n] + 1;
        }
    }
    ASSERT_EQ(next, nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;) {
        if (nodes[n].instance >= 0) {
            boxes[n] = flat.nodes[static_cast<std::size_t>(
                                      flat.instances[static_cast<std::size_t>(nodes[n].instance)].node)]
                           .bounds;
        }
        for (int k = 0; k < nodes[n].child_count; ++k) {
            boxes[n].add(boxes[static_cast<std::size_t>(nodes[n].first_child + k)]);
        }
        ASSERT_TRUE(nodes[n].bounds.contains(boxes[n]));
    }
    EXPECT_EQ(nodes[0].bounds, boxes[0]);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i], drawn[i] ? 1 : 0);
    }
}

TEST(Hierarchy, HoldsEveryInstanceOnce) {
    Random random(11);
    for (int round = 0; round < 200; ++round) {
        SceneGraph graph = random_graph(random, random.whole(1, 5), 2);
        graph.groups[0].placements[0].copies.x += random.whole(0, 30); // wide
        const FlatGraph flat = flatten(graph, std::vector<Box>(2, unit_box));
        std::vector<bool> drawn;
        for (std::size_t i = 0; i < flat.instances.size(); ++i) {
            drawn.push_back(round % 2 == 0 || random.whole(0, 2) != 0);
        }
        drawn[0] = true;
        check_hierarchy(flat, drawn);
    }
}

TEST(Hierarchy, OfAnArrayIsShallowAndApart) {
    SceneGraph graph{{{"scene", {place(0)}}}};
    graph.groups[0].placements[0].copies = {100, 1, 100};
    graph.groups[0].placements[0].spacing = {3, 0, 3};
    const FlatGraph flat = flatten(graph, std::vector<Box>(1, unit_box));
    const std::vector<bool> drawn(flat.instances.size(), true);
    check_hierarchy(flat, drawn);
    const std::vector<HierarchyNode> nodes = build_hierarchy(flat, drawn);
    EXPECT_LT(nodes.size(), 10000U * 8 / 5);
    // The root's children are strips of the square: nothing overlaps by more than the boxes' growth.
    for (int k = 0; k < nodes[0].child_count; ++k) {
        const Box& box = nodes[static_cast<std::size_t>(nodes[0].first_child + k)].bounds;
        const glm::dvec3 extent = box.high - box.low;
        EXPECT_LT(extent.x * extent.z, 1.1 * 300 * 300 / 8);
        EXPECT_LT(std::max(extent.x, extent.z), 2.5 * std::min(extent.x, extent.z));
    }
}

/// Members that all lie at one place are told apart by their numbers.
TEST(Hierarchy, ManyInOnePlace) {
    SceneGraph graph{{{"scene", {}}}};
    graph.groups[0].placements.assign(1000, place(0));
    const FlatGraph flat = flatten(graph, std::vector<Box>(1, unit_box));
    check_hierarchy(flat, std::vector<bool>(1000, true));
}

TEST(GraphRecords, HoldTheDoubleOnes) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        SceneGraph graph = random_graph(random, 4, 2);
        graph.groups[0].placements[0].local.translate += random.vector(-1, 1) * random.scale(6);
        const FlatGraph flat = flatten(graph, std::vector<Box>(2, unit_box));
        const glm::dvec3 origin = flat.nodes[0].bounds.centre();
        const std::vector<HierarchyNode> nodes =
            build_hierarchy(flat, std::vector<bool>(flat.instances.size(), true));
        const std::vector<GraphNodeRecord> records = pack(nodes, origin);
        ASSERT_EQ(records.size(), nodes.size());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const GraphNodeRecord& r = records[n];
            for (int k = 0; k < 3; ++k) {
                const Real low = static_cast<Real>(nodes[n].bounds.low[k]) - origin[k];
                const Real high = static_cast<Real>(nodes[n].bounds.high[k]) - origin[k];
                const Real slack = std::max(std::abs(low), std::abs(high)) * 2.6e-6L;
                ASSERT_LE(static_cast<Real>(r.low[k]), low);
                ASSERT_GE(static_cast<Real>(r.high[k]), high);
                ASSERT_GE(static_cast<Real>(r.low[k]), low - (slack + 1e-30L));
                ASSERT_LE(static_cast<Real>(r.high[k]), high + (slack + 1e-30L));
            }
            EXPECT_EQ(r.child_count, nodes[n].child_count);
            EXPECT_EQ(r.first_child, nodes[n].first_child);
            EXPECT_EQ(r.instance, nodes[n].instance);
        }
    }
}

} // namespace
} // namespace razor
