// Where the parts of frame memory lie that every worker has: in regions of their own, none beginning at
// another's place within 64 KiB, so that no set of a cache and no bank of memory is everybody's busiest.
#include "tests/kernels/cages.h"

#include "razor/frame/frame.h"
#include "razor/frame/scratch.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace razor::test {
namespace {

struct Part {
    std::string structure;
    int owner;
    const void* begin;
    std::size_t bytes;
};

std::vector<Part> parts(Frame& frame, int trees) {
    const FrameHeader& h = frame.header();
    std::vector<Part> all;
    for (int w = 0; w < frame.workers(); ++w) {
        const WorkerRecord& r = h.workers.get()[w];
        all.push_back({"stack", w, r.stack.get(), stack_floats * sizeof(float)});
        all.push_back({"packets", w, r.packets.get(), packet_floats * sizeof(float)});
        all.push_back({"grids", w, h.grids.get() + r.grid_next,
                       static_cast<std::size_t>(r.grid_end - r.grid_next) * sizeof(Line)});
        all.push_back({"item lists", w, h.lists.get() + r.list_next,
                       static_cast<std::size_t>(r.list_end - r.list_next) * sizeof(Line)});
        all.push_back({"kd nodes", w, h.nodes.get() + r.node_next,
                       static_cast<std::size_t>(r.node_end - r.node_next) * sizeof(KdNode)});
    }
    for (int t = 0; t < trees; ++t)
        all.push_back({"grids", t, h.trees.get()[t].patches.get(),
                       static_cast<std::size_t>(h.patch_count) * sizeof(OpenPatch)});
    return all;
}

TEST(Colours, NoTwoWorkersBeginAlike) {
    for (int workers : {1, 8, 32, 512}) {
        std::vector<int> table(static_cast<std::size_t>(workers));
        for (int w = 0; w < workers; ++w)
            table[static_cast<std::size_t>(w)] = w / 2;
        const int trees = (workers + 1) / 2;
        Frame frame(scene_of(cube_cage(), 4), {.workers = workers, .tree_of_worker = table});
        isa::address_space& memory = frame.memory();
        std::map<std::pair<std::string, bool>, std::set<std::uint64_t>> begins;
        std::map<std::uint64_t, std::uint64_t> ranges; // begin to end
        int i = 0;
        for (const Part& part : parts(frame, trees)) {
            const std::uint64_t begin = memory.offset(part.begin);
            const isa::region* region = memory.find(begin);
            ASSERT_NE(region, nullptr);
            EXPECT_EQ(region->structure, part.structure);
            EXPECT_EQ(region->owner, part.owner);
            EXPECT_LE(begin + part.bytes, region->end);
            EXPECT_EQ(begin % line_bytes, 0U);
            EXPECT_TRUE(ranges.emplace(begin, begin + part.bytes).second);
            const bool of_a_tree = i++ >= 5 * workers;
            EXPECT_TRUE(begins[std::make_pair(part.structure, of_a_tree)]
                            .insert(begin % isa::address_space::granule)
                            .second)
                << part.structure << " of " << part.owner << " of " << workers;
        }
        std::uint64_t last = 0;
        for (const auto& [begin, end] : ranges) {
            EXPECT_GE(begin, last) << "two parts overlap";
            last = end;
        }
    }
}

} // namespace
} // namespace razor::test
