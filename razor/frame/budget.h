// With a memory budget: the records of what can be dropped and made again, as they lie in frame memory.
//
// Grids, kd nodes and item lists of a tree lie in one arena of lines, which never grows: that is the tree's
// share of the budget. Workers take *pieces* of it and fill these. When it is full, its workers leave what
// they render, and one of them drops what was used longest ago. What is left stays where it is; what became
// free is taken again, run by run, from the arena's begin on (after Immix: Blackburn & McKinley, PLDI 2008).
//
// Recency is kept per *epoch*: an epoch is a part of the time in which the arena fills. At its end, nodes
// that can be dropped with all below them (*anchors*) are put to sleep; the first ray that enters one wakes
// it and notes the epoch. Blocks were used when a list that names them or their children was.
#pragma once

#include "razor/frame/layout.h"

namespace razor {

/// Memory is dropped and found again in grains of so many lines.
inline constexpr int grain_log2 = 2;
inline constexpr int grain_lines = 1 << grain_log2;
inline constexpr int records_a_line_log2 = 2; // KdNode, Anchor, BlockGroup
static_assert(sizeof(KdNode) << records_a_line_log2 == line_bytes);

enum AnchorFlags : std::int32_t { anchor_leaf = 1, anchor_refines = 2 };

/// A built node that can be unsplit again. Lies among the nodes.
struct Anchor {
    std::int32_t node;
    std::int32_t list; // line of the item list that it is made from, times 4, and AnchorFlags: what it is;
                       // whether the list is a coarser leaf's, else it is kept for the anchor
    std::int32_t use;  // the last epoch in which it was woken
    std::int32_t next; // that the same worker made or woke in this epoch; -1: none
};
static_assert(sizeof(Anchor) == sizeof(KdNode));

/// Blocks that were made together: the root of a patch, or the children of a block. Lies among the nodes.
struct BlockGroup {
    std::int32_t line;  // of the first block
    std::int32_t shape; // see children_in
    std::int32_t use;   // the last epoch in which some list was used that names one or what is finer
    std::int32_t next;  // that the same worker made; -1: none
};
static_assert(sizeof(BlockGroup) == sizeof(KdNode));

/// Of TreeBudget::gate: how many workers are rendering, and this if one drops memory or waits to.
inline constexpr int gate_closed = 1 << 16;
/// Epochs in the time in which an arena fills: at least so many, less than twice as many.
inline constexpr int epochs_log2 = 3;
/// Nodes whose depth is a multiple of this are anchors.
inline constexpr int anchor_depth_log2 = 3;

struct alignas(line_bytes) TreeBudget {
    isa::shared<std::int32_t> gate;
    std::int32_t padding[15];
    isa::shared<std::int32_t> cursor; // grains before it are taken or in use
    std::int32_t padding2[15];
    // Written while the gate is closed.
    std::int32_t first_line, grains;
    std::int32_t piece;         // grains that a worker takes, if so many lie side by side
    std::int32_t epoch_log2;    // of the grains in one epoch
    std::int32_t workers;       // of this tree ...
    std::int32_t frame_workers; // ... and in all
    std::int32_t tree;
    std::int32_t era;             // one more each time that memory is dropped
    std::int32_t epoch;           // in which it began
    float free_share;             // of the grains when it began
    isa::ref<std::int32_t> marks; // one a grain: the last era that began with it in use
    std::int32_t padding3[4];
};
static_assert(sizeof(TreeBudget) == 3 * line_bytes);

struct alignas(line_bytes) WorkerBudget {
    isa::ref<TreeBudget> tree;
    std::int32_t awake;  // chain of Anchor
    std::int32_t groups; // chain of BlockGroup
    std::int32_t holes;  // chain of free runs: their first words are their lines and the next one's line
    std::int32_t epoch, era;
    std::int32_t tile_grains; // taken in the last tile
    std::int32_t padding[8];
};
static_assert(sizeof(WorkerBudget) == line_bytes);

/// What is counted of it on the host.
enum BudgetEvent : int {
    budget_wait,    // a worker waited for others before it could render
    budget_restart, // a tile was begun again, as there was no memory left
    budget_alone,   // a tile was rendered while the others waited, in an empty arena
    budget_events
};

} // namespace razor
