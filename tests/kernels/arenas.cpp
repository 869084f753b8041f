// Arenas never grow: a frame that does not fit says so in one clear line, from every worker, and nobody
// hangs.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <string>

namespace razor::test {
namespace {

std::string failure(FrameOptions options) {
    Scene scene = scene_of(torus_cage(32, 16), 400);
    scene.settings.width = scene.settings.height = 64;
    std::string message;
    for (const KernelTable* target : {native_targets().front(), native_targets().back()}) {
        Frame frame(scene, options);
        try {
            run_workers(frame, *target);
            return "";
        } catch (const UserError& error) {
            message = error.what();
        }
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_NE(message.find("--edge-pixels"), std::string::npos) << message;
    }
    return message;
}

class Arenas : public testing::TestWithParam<int> {
protected:
    FrameOptions options(int share) const {
        return {.workers = GetParam(), .tree_of_worker = tree_groups(GetParam(), share)};
    }
};

TEST_P(Arenas, FullOfGrids) {
    for (int share : {0, 1}) {
        FrameOptions o = options(share);
        o.grid_bytes = 1 << 16;
        EXPECT_NE(failure(o).find("grids"), std::string::npos);
    }
}

TEST_P(Arenas, FullOfPages) {
    for (int share : {0, 1}) {
        FrameOptions o = options(share);
        o.page_bytes = 1 << 16;
        EXPECT_NE(failure(o).find("limit weights"), std::string::npos);
    }
}

TEST_P(Arenas, FullOfItemLists) {
    for (int share : {0, 1}) {
        FrameOptions o = options(share);
        o.list_bytes = 1 << 16;
        EXPECT_NE(failure(o).find("item lists"), std::string::npos);
    }
}

TEST_P(Arenas, FullOfNodes) {
    // 65536 bytes are 4096 nodes: more rays and shared work do not help one worker's tree of its own.
    FrameOptions o = options(1);
    o.node_bytes = 1 << 16;
    Scene scene = scene_of(torus_cage(64, 64), 3000);
    Frame frame(scene, o);
    try {
        frame.build_all(*native_targets().back());
        ADD_FAILURE() << "the tree fits in " << frame.statistics().node_bytes << " bytes";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("nodes"), std::string::npos);
    }
}

TEST_P(Arenas, ThatAreJustLargeEnoughDo) {
    FrameOptions o = options(0);
    o.grid_bytes = o.list_bytes = o.node_bytes = 1 << 26;
    EXPECT_EQ(failure(o), "");
}

INSTANTIATE_TEST_SUITE_P(Workers, Arenas, testing::Values(1, 5),
                         [](const auto& workers) { return std::to_string(workers.param) + "_workers"; });

} // namespace
} // namespace razor::test
