#include "razor/survey/kd_leaf_at.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

class Search {
public:
    Search(const FrameHeader& frame, const glm::vec3& point, std::int32_t block)
        : frame_(frame), point_(point), block_(block) {}

    /// Whether a leaf below the node lists the block: then it is `found`.
    bool below(std::int32_t number, KdLeaf at) {
        const KdNode& node = frame_.nodes.get()[number];
        if (node.state.word == node_inner) {
            ++at.depth;
            const float over = point_[node.axis] - node.split;
            const std::int32_t upper = over >= 0 ? 1 : 0;
            return below(node.link + upper, at) ||
                   (std::abs(over) <= slack_ && below(node.link + 1 - upper, at));
        }
        if (node.state.word != node_leaf) // no ray came there
            return false;
        const ItemList* list =
            node.link < 0 ? nullptr : reinterpret_cast<const ItemList*>(frame_.lists.get() + node.link);
        const bool right = list != nullptr && lists(*list);
        if (!right && list != nullptr && list->finer >= 0)
            return below(list->finer, {at.depth, at.finer + 1});
        if (right || found.depth < 0)
            found = at;
        return right;
    }

    KdLeaf found;

private:
    bool lists(const ItemList& list) const {
        const auto* items = reinterpret_cast<const std::int32_t*>(&list) + item_list_words;
        return std::find(items, items + list.count, -1 - block_) != items + list.count;
    }

    const FrameHeader& frame_;
    const glm::vec3 point_;
    const std::int32_t block_;
    const float slack_ = frame_.reach * (12.0F / 16777216.0F); // as the kernels': see position_slack()
};

} // namespace

KdLeaf kd_leaf_at(const FrameHeader& frame, int worker, const glm::vec3& point, std::int32_t block) {
    Search search(frame, point, block);
    search.below(frame.trees.get()[frame.workers.get()[worker].tree].root, {0, 0});
    return search.found;
}

} // namespace razor
