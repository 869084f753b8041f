#include "razor/scene/graph/hierarchy.h"

#include <algorithm>
#include <array>
#include <deque>
#include <utility>

namespace razor {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

using Members = std::vector<std::int32_t>; // nodes of the flat graph

class Builder {
public:
    Builder(const FlatGraph& flat, const std::vector<bool>& drawn) : flat_(flat), shown_(flat.nodes.size()) {
        for (std::size_t n = flat.nodes.size(); n-- > 0;) {
            const FlatNode& node = flat.nodes[n];
            if (node.instance >= 0) {
                shown_[n] = drawn[at(node.instance)];
            }
            if (shown_[n] && node.parent >= 0) {
                shown_[at(node.parent)] = true;
            }
        }
    }

    std::vector<HierarchyNode> build() {
        nodes_.emplace_back();
        settle(0, {0});
        while (!open_.empty()) {
            const auto [node, members] = std::move(open_.front());
            open_.pop_front();
            add_children(node, members);
        }
        for (std::size_t n = nodes_.size(); n-- > 0;) {
            for (std::int32_t k = 0; k < nodes_[n].child_count; ++k) {
                nodes_[n].bounds.add(nodes_[at(nodes_[n].first_child + k)].bounds);
            }
        }
        return std::move(nodes_);
    }

private:
    Members shown_children(std::int32_t flat_node) const {
        const FlatNode& node = flat_.nodes[at(flat_node)];
        Members members;
        for (std::int32_t k = 0; k < node.child_count; ++k) {
            if (shown_[at(node.first_child + k)]) {
                members.push_back(node.first_child + k);
            }
        }
        return members;
    }

    /// The node stands for these members: for the only one's own members, if it is a group.
    void settle(std::int32_t node, Members members) {
        while (members.size() == 1) {
            const std::int32_t instance = flat_.nodes[at(members.front())].instance;
            if (instance >= 0) {
                nodes_[at(node)].instance = instance;
                nodes_[at(node)].bounds = flat_.nodes[at(members.front())].bounds;
                return;
            }
            members = shown_children(members.front());
        }
        open_.emplace_back(node, std::move(members));
    }

    void add_children(std::int32_t node, const Members& members) {
        std::vector<Members> parts{members};
        if (members.size() > most_children) {
            for (int halves = 1; halves < most_children; halves *= 2) {
                std::vector<Members> finer;
                for (Members& part : parts) {
                    std::array<Members, 2> both = halve(std::move(part));
                    finer.insert(finer.end(), std::make_move_iterator(both.begin()),
                                 std::make_move_iterator(both.end()));
                }
                parts = std::move(finer);
            }
        } else {
            parts.clear();
            for (const std::int32_t member : members) {
                parts.push_back({member});
            }
        }
        std::erase_if(parts, [](const Members& part) { return part.empty(); });
        const auto first = static_cast<std::int32_t>(nodes_.size());
        nodes_[at(node)].first_child = first;
        nodes_[at(node)].child_count = static_cast<std::int32_t>(parts.size());
        nodes_.resize(nodes_.size() + parts.size());
        for (std::size_t k = 0; k < parts.size(); ++k) {
            settle(first + static_cast<std::int32_t>(k), std::move(parts[k]));
        }
    }

    std::array<Members, 2> halve(Members members) const {
        if (members.size() < 2) {
            return {std::move(members), Members{}};
        }
        Box centres;
        for (const std::int32_t member : members) {
            centres.add(flat_.nodes[at(member)].bounds.centre());
        }
        const glm::dvec3 extent = centres.high - centres.low;
        int axis = extent.y > extent.x ? 1 : 0;
        axis = extent.z > extent[axis] ? 2 : axis;
        const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
        std::nth_element(members.begin(), middle, members.end(), [&](std::int32_t a, std::int32_t b) {
            const double place = flat_.nodes[at(a)].bounds.centre()[axis];
            const double other = flat_.nodes[at(b)].bounds.centre()[axis];
            return place != other ? place < other : a < b;
        });
        Members upper(middle, members.end());
        members.erase(middle, members.end());
        return {std::move(members), std::move(upper)};
    }

    const FlatGraph& flat_;
    std::vector<bool> shown_; // nodes with anything to see below
    std::vector<HierarchyNode> nodes_;
    std::deque<std::pair<std::int32_t, Members>> open_;
};

} // namespace

std::vector<HierarchyNode> build_hierarchy(const FlatGraph& flat, const std::vector<bool>& drawn) {
    return Builder(flat, drawn).build();
}

} // namespace razor
