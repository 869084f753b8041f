#include "razor/frame/budget_log.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace razor {
namespace {

using Keys = std::vector<std::uint64_t>;
constexpr Keys Inventory::*all_keys[] = {&Inventory::nodes, &Inventory::patches, &Inventory::blocks,
                                         &Inventory::normals};

void keep_once(Keys& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

void append(Inventory& to, const Inventory& more) {
    for (Keys Inventory::*keys : all_keys)
        (to.*keys).insert((to.*keys).end(), (more.*keys).begin(), (more.*keys).end());
    to.grid_bytes += more.grid_bytes;
    to.node_bytes += more.node_bytes;
    to.list_bytes += more.list_bytes;
}

std::int64_t size_of(const Keys& keys) {
    return static_cast<std::int64_t>(keys.size());
}

} // namespace

BudgetLog::BudgetLog(const FrameHeader& header, std::vector<const TreeBudget*> trees,
                     std::uint64_t budget_bytes)
    : header_(header), budgets_(std::move(trees)), budget_bytes_(budget_bytes), trees_(budgets_.size()) {}

void BudgetLog::clear() {
    for (Tree& tree : trees_)
        tree = {};
    for (std::atomic<std::int64_t>& event : events_)
        event.store(0, std::memory_order_relaxed);
}

std::int64_t BudgetLog::used_grains(const TreeBudget& tree) {
    const std::int32_t* const marks = tree.marks.get();
    return tree.grains - std::count_if(marks + tree.cursor.word, marks + tree.grains,
                                       [&](std::int32_t mark) { return mark != tree.era; });
}

void BudgetLog::dropping(std::int32_t arena, std::int32_t last) {
    Tree& tree = trees_[static_cast<std::size_t>(arena)]; // one worker at a time
    tree.peak_grains = std::max(tree.peak_grains, used_grains(*budgets_[static_cast<std::size_t>(arena)]));
    const Inventory old = take_inventory(header_, arena, last).old;
    ++tree.drops;
    tree.nodes += size_of(old.nodes);
    tree.patches += size_of(old.patches);
    tree.blocks += size_of(old.blocks);
    append(tree.dropped, old);
    std::size_t keys = 0;
    for (Keys Inventory::*kind : all_keys)
        keys += (tree.dropped.*kind).size();
    if (keys > 2 * tree.sorted) {
        tree.sorted = 0;
        for (Keys Inventory::*kind : all_keys) {
            keep_once(tree.dropped.*kind);
            tree.sorted += (tree.dropped.*kind).size();
        }
    }
}

void BudgetLog::note(std::int32_t event) {
    events_[static_cast<std::size_t>(event)].fetch_add(1, std::memory_order_relaxed);
}

BudgetStatistics BudgetLog::statistics() const {
    BudgetStatistics s;
    s.budget_bytes = budget_bytes_;
    Inventory every; // of all trees
    std::array<std::int64_t, std::size(all_keys)> sum{};
    for (std::size_t t = 0; t < trees_.size(); ++t) {
        const Tree& tree = trees_[t];
        const TreeBudget& budget = *budgets_[t];
        const Inventory now = take_inventory(header_, static_cast<int>(t), before_all).used;
        s.peak_bytes += std::max(tree.peak_grains, used_grains(budget)) * grain_lines * line_bytes +
                        std::int64_t{budget.grains} * 4;
        s.drops += tree.drops;
        s.dropped_nodes += tree.nodes;
        s.dropped_patches += tree.patches;
        s.dropped_blocks += tree.blocks;
        s.dropped_bytes += tree.dropped.grid_bytes + tree.dropped.node_bytes + tree.dropped.list_bytes;
        s.made_nodes += tree.nodes + size_of(now.nodes);
        s.made_patches += tree.patches + size_of(now.patches);
        s.made_blocks += tree.blocks + size_of(now.blocks);
        s.made_grid_bytes += tree.dropped.grid_bytes + now.grid_bytes;
        s.made_node_bytes += tree.dropped.node_bytes + now.node_bytes;
        s.made_list_bytes += tree.dropped.list_bytes + now.list_bytes;
        Inventory ever = tree.dropped;
        append(ever, now);
        for (std::size_t k = 0; k < std::size(all_keys); ++k) {
            keep_once(ever.*all_keys[k]);
            sum[k] += size_of(ever.*all_keys[k]);
        }
        append(every, ever);
    }
    s.regenerated_nodes = s.made_nodes - sum[0];
    s.regenerated_patches = s.made_patches - sum[1];
    s.regenerated_blocks = s.made_blocks - sum[2];
    for (Keys Inventory::*kind : all_keys)
        keep_once(every.*kind);
    s.duplicates.nodes = sum[0] - size_of(every.nodes);
    s.duplicates.patches = sum[1] - size_of(every.patches);
    s.duplicates.blocks = sum[2] - size_of(every.blocks);
    s.duplicates.normals = sum[3] - size_of(every.normals);
    s.waits = events_[budget_wait].load(std::memory_order_relaxed);
    s.restarted_tiles = events_[budget_restart].load(std::memory_order_relaxed);
    s.tiles_alone = events_[budget_alone].load(std::memory_order_relaxed);
    return s;
}

} // namespace razor
