// The hierarchy over instances, kept and made anew, and its records of single precision.
#include "tests/scene/graph_matrices.h"
#include "tests/scene/random_graph.h"

#include "razor/scene/graph/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace razor {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

/// What is below the root, in order, without the numbers of nodes.
std::vector<HierarchyNode> in_order(const Hierarchy& tree) {
    std::vector<HierarchyNode> all;
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        HierarchyNode node = tree.nodes()[at(open.back())];
        open.pop_back();
        for (std::int32_t k = node.child_count; k-- > 0;) {
            open.push_back(node.first_child + k);
        }
        node.first_child = 0;
        all.push_back(node);
    }
    return all;
}

/// Every instance that is drawn is below the root once; boxes hold what is below, and no more; nodes have 2
/// to 8 children; nodes that are nobody's are empty.
void check(const Hierarchy& tree, const std::vector<Box>& boxes, const std::vector<bool>& drawn) {
    std::vector<int> seen(boxes.size(), 0);
    std::vector<bool> used(tree.nodes().size(), false);
    std::vector<std::int32_t> open{0}, order;
    while (!open.empty()) {
        const std::int32_t n = open.back();
        open.pop_back();
        order.push_back(n);
        ASSERT_FALSE(used[at(n)]);
        used[at(n)] = true;
        const HierarchyNode& node = tree.nodes()[at(n)];
        if (node.instance >= 0) {
            ++seen[at(node.instance)];
            ASSERT_EQ(node.child_count, 0);
            ASSERT_EQ(node.bounds, boxes[at(node.instance)]);
            continue;
        }
        ASSERT_GE(node.child_count, 2);
        ASSERT_LE(node.child_count, most_children);
        Box bounds;
        for (std::int32_t k = 0; k < node.child_count; ++k) {
            open.push_back(node.first_child + k);
            bounds.add(tree.nodes()[at(node.first_child + k)].bounds);
        }
        ASSERT_EQ(node.bounds, bounds);
    }
    for (std::size_t n = 0; n < used.size(); ++n) {
        ASSERT_TRUE(used[n] || tree.nodes()[n] == HierarchyNode{}) << n;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
        ASSERT_EQ(seen[i], drawn[i] ? 1 : 0);
    }
    ASSERT_LE(tree.nodes().size(), Hierarchy::node_limit(boxes.size()));
}

Box box_about(const glm::dvec3& centre, const glm::dvec3& size) {
    return {centre - size / 2.0, centre + size / 2.0};
}

Box random_box(Random& random) {
    const double spread = random.whole(0, 2) == 0 ? 0 : 10; // some at one place
    return box_about(spread * random.vector(-1, 1),
                     random.whole(0, 5) == 0 ? glm::dvec3(0) : random.scale(2) * random.vector(0, 1));
}

TEST(Hierarchy, HoldsEveryInstanceOnce) {
    Random random(11);
    for (int round = 0; round < 200; ++round) {
        std::vector<Box> boxes;
        std::vector<bool> drawn;
        for (int i = random.whole(1, 200); i > 0; --i) {
            boxes.push_back(random_box(random));
            drawn.push_back(round % 2 == 0 || random.whole(0, 2) != 0);
        }
        drawn[0] = true;
        check(Hierarchy(boxes, drawn), boxes, drawn);
    }
}

// Whatever moved in whatever order, the tree is that of the boxes as they are; and what take_touched() does
// not name is as it was.
TEST(Hierarchy, KeptIsAsMadeAnew) {
    Random random(5);
    int kept = 0, anew = 0;
    for (int round = 0; round < 60; ++round) {
        const int count = round % 6 == 0 ? random.whole(1, 4) : random.whole(5, 300);
        std::vector<Box> boxes;
        std::vector<bool> drawn;
        for (int i = 0; i < count; ++i) {
            boxes.push_back(random_box(random));
            drawn.push_back(round % 3 != 0 || i == 0 || random.whole(0, 3) != 0);
        }
        Hierarchy tree(boxes, drawn);
        for (int step = 0; step < 30; ++step) {
            tree.take_touched();
            const std::vector<HierarchyNode> before = tree.nodes();
            std::vector<Hierarchy::Moved> moved;
            for (int n = random.whole(0, 3); n > 0; --n) {
                const int i = random.whole(0, count - 1);
                Box& box = boxes[at(i)];
                const glm::dvec3 by = (random.whole(0, 1) == 0 ? 1e-7 : 2.0) * random.vector(-1, 1);
                switch (random.whole(0, 3)) {
                case 0:
                    box = random_box(random);
                    break;
                case 1:
                    box = box_about(box.centre(), 3.0 * (box.high - box.low));
                    break;
                default:
                    box = {box.low + by, box.high + by};
                    break;
                }
                moved.push_back({i, box});
            }
            for (Hierarchy::Moved& m : moved) { // what moved twice has one place
                m.bounds = boxes[at(m.instance)];
            }
            const Hierarchy fresh(boxes, drawn);
            if (!tree.move(moved)) {
                ASSERT_FALSE(fresh.grid() == tree.grid());
                tree = fresh;
                ++anew;
                continue;
            }
            ++kept;
            ASSERT_TRUE(fresh.grid() == tree.grid());
            check(tree, boxes, drawn);
            ASSERT_EQ(in_order(tree), in_order(fresh)) << round << " " << step;
            const std::vector<std::int32_t> touched = tree.take_touched();
            for (std::size_t n = 0; n < before.size(); ++n) {
                if (!std::binary_search(touched.begin(), touched.end(), static_cast<std::int32_t>(n))) {
                    ASSERT_EQ(tree.nodes()[n], before[n]);
                }
            }
        }
    }
    EXPECT_GT(kept, 800);
    EXPECT_GT(anew, 20);
}

TEST(Hierarchy, OfAnArrayIsShallowAndApart) {
    std::vector<Box> boxes;
    for (int i = 0; i < 100; ++i) {
        for (int k = 0; k < 100; ++k) {
            boxes.push_back(box_about({3.0 * i, 0, 3.0 * k}, glm::dvec3(2)));
        }
    }
    Hierarchy tree(boxes, std::vector<bool>(boxes.size(), true));
    check(tree, boxes, std::vector<bool>(boxes.size(), true));
    EXPECT_LT(in_order(tree).size(), 10000U * 8 / 5);
    const HierarchyNode& root = tree.nodes()[0];
    double area = 0;
    for (std::int32_t k = 0; k < root.child_count; ++k) {
        const Box& box = tree.nodes()[at(root.first_child + k)].bounds;
        area += (box.high.x - box.low.x) * (box.high.z - box.low.z);
    }
    EXPECT_LT(area, 300 * 300) << "children do not overlap";
    // One that moves within its cell touches what is above it alone.
    tree.take_touched();
    ASSERT_TRUE(
        tree.move(std::vector<Hierarchy::Moved>{{5050, box_about({150 + 1e-6, 0, 150}, glm::dvec3(2))}}));
    EXPECT_LE(tree.take_touched().size(), 8U);
}

TEST(GraphRecords, HoldTheDoubleOnes) {
    Random random(7);
    for (int round = 0; round < 2000; ++round) {
        HierarchyNode node{random_box(random), 7, random.whole(0, 1) == 0 ? 3 : 0, -1};
        node.instance = node.child_count > 0 ? -1 : 5;
        const glm::dvec3 origin = random.vector(-1, 1) * random.scale(6);
        const GraphNodeRecord r = pack(node, origin);
        for (int k = 0; k < 3; ++k) {
            const Real low = static_cast<Real>(node.bounds.low[k]) - origin[k];
            const Real high = static_cast<Real>(node.bounds.high[k]) - origin[k];
            const Real slack = std::max(std::abs(low), std::abs(high)) * 2.6e-6L;
            ASSERT_LE(static_cast<Real>(r.low[k]), low);
            ASSERT_GE(static_cast<Real>(r.high[k]), high);
            ASSERT_GE(static_cast<Real>(r.low[k]), low - (slack + 1e-30L));
            ASSERT_LE(static_cast<Real>(r.high[k]), high + (slack + 1e-30L));
        }
        EXPECT_EQ(r.child_count, node.child_count);
        EXPECT_EQ(r.first_child, 7);
        EXPECT_EQ(r.instance, node.instance);
    }
    const GraphNodeRecord nobody = pack({}, {1, 2, 3});
    EXPECT_EQ(nobody.instance, -1);
    EXPECT_EQ(nobody.child_count, 0);
}

} // namespace
} // namespace razor
