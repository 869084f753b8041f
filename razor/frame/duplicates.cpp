#include "razor/frame/duplicates.h"

#include "razor/frame/frame_memory.h"

#include <utility>

namespace razor {
namespace {

/// Something that is in each of these places, one a tree that has it.
using Places = std::vector<std::int32_t>;

template <class Word> std::int32_t state_of(const Word& word) {
    return word.word;
}

class Counter {
public:
    explicit Counter(const FrameHeader& header) : header_(header) {}

    void count_nodes(Places roots) {
        std::vector<Places> open{std::move(roots)};
        while (!open.empty()) {
            Places built, lower, upper, finer;
            for (const std::int32_t place : open.back()) {
                const KdNode& node = header_.nodes.get()[place];
                if (state_of(node.state) == node_inner) {
                    lower.push_back(node.link);
                    upper.push_back(node.link + 1);
                } else if (state_of(node.state) == node_leaf && node.link < 0) {
                    // empty
                } else if (state_of(node.state) == node_leaf) {
                    const auto& list = *reinterpret_cast<const ItemList*>(header_.lists.get() + node.link);
                    if (list.finer >= 0)
                        finer.push_back(list.finer);
                } else {
                    continue;
                }
                built.push_back(place);
            }
            open.pop_back();
            sum_.nodes += beyond_first(built);
            push_shared(open, std::move(lower));
            push_shared(open, std::move(upper));
            push_shared(open, std::move(finer));
        }
    }

    /// Lines of the patch's root blocks.
    void count_patch(Places roots) {
        sum_.patches += beyond_first(roots);
        std::vector<Places> open;
        push_shared(open, std::move(roots));
        while (!open.empty()) {
            const Places places = std::move(open.back());
            open.pop_back();
            Places made, normals, parents;
            for (const std::int32_t place : places) {
                const BlockHeader& block = header_of(place);
                if (state_of(block.made) == ready)
                    made.push_back(place);
                if (block.normals_at != 0 && state_of(block.normals) == ready)
                    normals.push_back(place);
                if (state_of(block.children) == ready)
                    parents.push_back(place);
            }
            sum_.blocks += beyond_first(made);
            sum_.normals += beyond_first(normals);
            if (parents.size() < 2)
                continue;
            for (int child = 0; child < children_in(header_of(parents.front()).child_shape); ++child) {
                Places children;
                for (const std::int32_t parent : parents)
                    children.push_back(header_of(parent).child_line +
                                       child * lines_between(header_of(parent).child_shape));
                push_shared(open, std::move(children));
            }
        }
    }

    Duplicates sum() const { return sum_; }

private:
    static std::int64_t beyond_first(const Places& places) {
        return places.size() < 2 ? 0 : static_cast<std::int64_t>(places.size()) - 1;
    }
    static void push_shared(std::vector<Places>& open, Places places) {
        if (places.size() > 1)
            open.push_back(std::move(places));
    }
    const BlockHeader& header_of(std::int32_t line) const {
        return *reinterpret_cast<const BlockHeader*>(header_.grids.get() + line);
    }

    const FrameHeader& header_;
    Duplicates sum_;
};

} // namespace

Duplicates Frame::duplicates() const {
    const Impl& f = *impl_;
    if (f.log)
        return f.log->statistics().duplicates;
    Counter counter(*f.header);
    Places roots;
    for (int t = 0; t < f.trees; ++t) {
        const TreeRecord& tree = f.header->trees.get()[t];
        if (state_of(tree.root_state) == ready)
            roots.push_back(tree.root);
    }
    counter.count_nodes(std::move(roots));
    const auto graph_nodes = static_cast<std::int64_t>(f.geometry.graph.nodes().size());
    for (std::int64_t cluster = 0; cluster < f.clusters && f.trees > 1; ++cluster) {
        std::vector<const OpenPatch*> tables;
        for (int t = 0; t < f.trees; ++t)
            if (f.opened[static_cast<std::size_t>(t)]->is_marked(graph_nodes + cluster))
                tables.push_back(f.header->trees.get()[t].patches.get());
        if (tables.size() < 2)
            continue;
        for (std::int64_t p = 0; p < refit_patches; ++p) {
            Places blocks;
            for (const OpenPatch* table : tables) {
                const OpenPatch& patch = table[cluster * refit_patches + p];
                if (state_of(patch.state) == ready)
                    blocks.push_back(patch.root);
            }
            counter.count_patch(std::move(blocks));
        }
    }
    return counter.sum();
}

} // namespace razor
