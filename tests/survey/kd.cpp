// The leaf of the kd-tree in which a ray ended.
#include "tests/kernels/cages.h"
#include "tests/survey/reference.h"

#include "razor/native/targets.h"
#include "razor/survey/kd_leaf_at.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace razor::test {
namespace {

/// What is known of leaves, found from the root over all nodes.
struct Leaves {
    int least = 1000, most = -1;
    int most_finer = -1;
};
void visit(const FrameHeader& h, int number, int depth, int finer, Leaves& out) {
    const KdNode& node = h.nodes.get()[number];
    if (node.state.word == node_inner) {
        visit(h, node.link, depth + 1, finer, out);
        visit(h, node.link + 1, depth + 1, finer, out);
    } else if (node.state.word == node_leaf && node.link >= 0) {
        const auto& list = *reinterpret_cast<const ItemList*>(h.lists.get() + node.link);
        out.least = std::min(out.least, depth);
        out.most = std::max(out.most, depth);
        out.most_finer = std::max(out.most_finer, finer);
        if (list.finer >= 0)
            visit(h, list.finer, depth, finer + 1, out);
    }
}

TEST(KdLeaf, IsOneOfTheTree) {
    Scene scene = named_scene("instances")->scene;
    scene.settings.lod = Lod::recursive;
    scene.settings.edge_pixels = 1;
    scene.settings.width = scene.settings.height = 48;
    Frame frame(scene, {});
    const std::vector<const KernelTable*> targets = native_targets();
    frame.render(*targets.back(), 0);
    Film film = frame.film();
    SurveyOptions options;
    options.layers = layers({LayerGroup::kd, LayerGroup::pick});
    options.kernels = targets.back();
    ASSERT_TRUE(survey(frame, shown_part(scene.settings), options, film));
    Leaves leaves;
    visit(frame.header(), frame.header().trees.get()->root, 0, 0, leaves);
    const Plane &depth = *film.find("kd.depth"), &finer = *film.find("kd.finer"),
                &mesh = *film.find("pick.mesh");
    float most = -1;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        if (mesh.at(i) < 0) {
            EXPECT_EQ(depth.values[i], -1);
            continue;
        }
        EXPECT_GE(depth.values[i], leaves.least);
        EXPECT_LE(depth.values[i], leaves.most);
        EXPECT_GE(finer.values[i], 0);
        EXPECT_LE(finer.values[i], leaves.most_finer);
        most = std::max(most, depth.values[i]);
    }
    EXPECT_GT(most, leaves.least); // not all in one
}

/// A tree made by hand: x = 1 divides the root, z = 2 the upper half of it, of which the lower leaf has finer
/// blocks.
class SmallTree : public ::testing::Test {
protected:
    SmallTree() {
        nodes_[0] = {{node_inner}, 1, 0, 1};
        nodes_[1] = {{node_unsplit}, 0, 0, -1};
        nodes_[2] = {{node_inner}, 2, 2, 3};
        nodes_[3] = {{node_leaf}, 0, 0, 0};
        nodes_[4] = {{node_leaf}, 0, 0, -1};
        nodes_[5] = {{node_leaf}, 0, 0, 4};
        list(0, 70, 5);
        list(4, 71, -1);
        workers_[0].tree = 0;
        trees_[0].root = 0;
        header_.nodes.set(nodes_);
        header_.lists.set(lists_);
        header_.workers.set(workers_);
        header_.trees.set(trees_);
        header_.reach = 1;
    }
    void list(int line, int block, int finer) {
        auto& l = *reinterpret_cast<ItemList*>(lists_ + line);
        l.count = l.in_cell = 1;
        l.stride = 16;
        l.finer = finer;
        lists_[line + 2].word[0] = -1 - block;
    }
    KdLeaf at(const glm::vec3& point, int block) { return kd_leaf_at(header_, 0, point, block); }

    FrameHeader header_{};
    KdNode nodes_[6]{};
    Line lists_[8]{};
    WorkerRecord workers_[1]{};
    TreeRecord trees_[1]{};
};

TEST_F(SmallTree, HasTheLeafThatListsTheBlock) {
    EXPECT_EQ(at({5, 0, 1}, 70).depth, 2);
    EXPECT_EQ(at({5, 0, 1}, 70).finer, 0);
    EXPECT_EQ(at({5, 0, 1}, 71).depth, 2);
    EXPECT_EQ(at({5, 0, 1}, 71).finer, 1);
    EXPECT_EQ(at({5, 0, 3}, 70).depth, 2) << "an empty leaf, where no other is near";
    EXPECT_EQ(at({0, 0, 1}, 70).depth, -1) << "no leaf at all";
}

TEST_F(SmallTree, EndsWhereNoRayWentOnToFinerBlocks) {
    nodes_[5].state.word = node_unsplit;
    EXPECT_EQ(at({5, 0, 1}, 71).depth, 2);
    EXPECT_EQ(at({5, 0, 1}, 71).finer, 0);
}

TEST_F(SmallTree, LooksBesideAPlaneThatThePointLiesOn) {
    EXPECT_EQ(at({1 - 2e-7F, 0, 1}, 71).finer, 1);
    EXPECT_EQ(at({5, 0, 2}, 71).finer, 1);
    EXPECT_EQ(at({5, 0, 2.1F}, 71).finer, 0);
}

} // namespace
} // namespace razor::test
