#include "razor/frame/inventory.h"

#include "razor/frame/scratch.h"

namespace razor {
namespace {

/// SplitMix64's finalizer (Steele, Lea & Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

/// Of what lies a step on from a node: its lower child, its upper, what is finer.
std::uint64_t step(std::uint64_t key, std::uint64_t way) {
    return mixed(key * 3 + way + 0x9e3779b97f4a7c15U);
}

std::int64_t list_bytes(const ItemList& list) {
    return (std::int64_t{list.stride} * 7 + 15) / 16 * line_bytes + std::int64_t{sizeof(ItemList)};
}

class Walk {
public:
    Walk(const FrameHeader& header, std::int32_t last, Inventories& all)
        : header_(header), last_(last), all_(all) {}

    void nodes(const TreeRecord& tree, bool old) {
        struct Entry {
            std::int32_t number;
            std::uint64_t key;
            bool old;
        };
        std::vector<Entry> open{{tree.root, 1, old}};
        of(old).node_bytes += std::int64_t{sizeof(KdNode)};
        while (!open.empty()) {
            Entry e = open.back();
            open.pop_back();
            const KdNode& node = header_.nodes.get()[e.number];
            std::int32_t state = node.state.word;
            if (state < 0) {
                const auto& anchor = reinterpret_cast<const Anchor&>(header_.nodes.get()[-1 - state]);
                if ((anchor.list & anchor_refines) == 0)
                    count_list(anchor.list >> 2, e.old);
                e.old = e.old || anchor.use <= last_;
                of(e.old).node_bytes += std::int64_t{sizeof(Anchor)};
                state = node_inner + (anchor.list & anchor_leaf);
            }
            Inventory& in = of(e.old);
            if (state == node_inner) {
                in.nodes.push_back(e.key);
                ++in.inner_nodes;
                in.node_bytes += 2 * std::int64_t{sizeof(KdNode)};
                open.push_back({node.link, step(e.key, 0), e.old});
                open.push_back({node.link + 1, step(e.key, 1), e.old});
                continue;
            }
            if (state == node_unsplit) {
                ++in.unsplit_nodes;
                if (node.axis == 0)
                    count_list(node.link, e.old);
                continue;
            }
            in.nodes.push_back(e.key);
            ++in.leaves;
            if (node.link < 0)
                continue;
            const std::int32_t finer = count_list(node.link, e.old);
            if (finer >= 0) {
                in.node_bytes += std::int64_t{sizeof(KdNode)};
                open.push_back({finer, step(e.key, 2), e.old});
            }
        }
    }

    void groups(const WorkerBudget& worker, bool all_old) {
        for (std::int32_t number = worker.groups; number >= 0;) {
            const auto& group = reinterpret_cast<const BlockGroup&>(header_.nodes.get()[number]);
            Inventory& in = of(all_old || group.use <= last_);
            const std::int32_t blocks = children_in(group.shape), lines = lines_between(group.shape);
            in.node_bytes += std::int64_t{sizeof(BlockGroup)};
            in.grid_bytes += std::int64_t{blocks} * lines * line_bytes;
            for (std::int32_t i = 0; i < blocks; ++i)
                count_block(in, group.line + i * lines);
            number = group.next;
        }
    }

private:
    Inventory& of(bool old) { return old ? all_.old : all_.used; }
    std::int32_t count_list(std::int32_t line, bool old) {
        const auto& list = *reinterpret_cast<const ItemList*>(header_.lists.get() + line);
        of(old).list_bytes += list_bytes(list);
        return list.finer;
    }
    void count_block(Inventory& in, std::int32_t line) {
        const auto& block = *reinterpret_cast<const BlockHeader*>(header_.grids.get() + line);
        const auto patch = static_cast<std::uint64_t>(block.patch);
        const std::uint64_t key = (patch << 32U | static_cast<std::uint64_t>(block.level) << 27U) +
                                  static_cast<std::uint64_t>(block.number);
        if (block.parent < 0)
            in.patches.push_back(patch);
        if (block.made.word == ready)
            in.blocks.push_back(key);
        if (block.normals_at != 0 && block.normals.word == ready)
            in.normals.push_back(key);
        if (block.seen.word == ready)
            in.grid_bytes +=
                (std::int64_t{header_.slot_floats} * 4 + line_bytes - 1) / line_bytes * line_bytes;
    }

    const FrameHeader& header_;
    std::int32_t last_;
    Inventories& all_;
};

} // namespace

Inventories take_inventory(const FrameHeader& header, int tree, std::int32_t last) {
    const TreeRecord& record = header.trees.get()[tree];
    Inventories all;
    Walk walk(header, last, all);
    const WorkerRecord* const workers = header.workers.get();
    bool all_old = false;
    int count = 1;
    for (int w = 0; w < count; ++w) {
        const WorkerBudget& worker = *workers[w].budget.get();
        const TreeBudget& budget = *worker.tree.get();
        count = budget.frame_workers;
        if (workers[w].tree != tree)
            continue;
        all_old = last > budget.epoch + (budget.cursor.word >> budget.epoch_log2);
        walk.groups(worker, all_old);
    }
    if (record.root_state.word == ready)
        walk.nodes(record, all_old);
    return all;
}

} // namespace razor
