// What became of a frame's memory budget: counted on the host, whenever something is dropped.
#pragma once

#include "isa/services.h"
#include "razor/frame/duplicates.h"
#include "razor/frame/inventory.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

namespace razor {

/// Of all trees. Figures of what was made count it as often as it was.
struct BudgetStatistics {
    std::uint64_t budget_bytes = 0; // 0: no budget, and all else is 0
    std::int64_t peak_bytes = 0;    // of the arenas and their tables, trees at their own peaks summed
    std::int64_t drops = 0;         // how often memory was dropped
    std::int64_t dropped_nodes = 0, dropped_patches = 0, dropped_blocks = 0, dropped_bytes = 0;
    std::int64_t made_nodes = 0, made_patches = 0, made_blocks = 0;
    std::int64_t made_grid_bytes = 0, made_node_bytes = 0, made_list_bytes = 0;
    /// Made once more after they were dropped.
    std::int64_t regenerated_nodes = 0, regenerated_patches = 0, regenerated_blocks = 0;
    std::int64_t waits = 0;           // of a worker, for others, before it could render
    std::int64_t restarted_tiles = 0; // found no memory left
    std::int64_t tiles_alone = 0;     // rendered while the others waited, in an empty arena
    Duplicates duplicates;            // of what the trees ever held
};

class BudgetLog final : public isa::memory_log {
public:
    BudgetLog(const FrameHeader& header, std::vector<const TreeBudget*> trees, std::uint64_t budget_bytes);
    /// Nothing has happened.
    void clear();
    void dropping(std::int32_t arena, std::int32_t last) override;
    void note(std::int32_t event) override;
    /// No worker may run.
    BudgetStatistics statistics() const;

private:
    /// What a tree has dropped.
    struct Tree {
        Inventory dropped;                               // each key once
        std::int64_t nodes = 0, patches = 0, blocks = 0; // dropped, as often as they were
        std::int64_t drops = 0;
        std::int64_t peak_grains = 0;
        std::size_t sorted = 0; // of the dropped keys, when they were last sorted
    };
    static std::int64_t used_grains(const TreeBudget& tree);

    const FrameHeader& header_;
    std::vector<const TreeBudget*> budgets_;
    std::uint64_t budget_bytes_;
    std::vector<Tree> trees_;
    std::array<std::atomic<std::int64_t>, budget_events> events_{};
};

} // namespace razor
