#include "razor/scene/graph/hierarchy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace razor {
namespace {

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

constexpr int cell_bits = 21;

/// The lowest 21 bits, two zeros between neighbours.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1fffffU;
    x = (x | x << 32U) & 0x001f00000000ffffU;
    x = (x | x << 16U) & 0x001f0000ff0000ffU;
    x = (x | x << 8U) & 0x100f00f00f00f00fU;
    x = (x | x << 4U) & 0x10c30c30c30c30c3U;
    return (x | x << 2U) & 0x1249249249249249U;
}

} // namespace

HierarchyGrid::HierarchyGrid(const Box& all) {
    if (all.empty()) {
        return;
    }
    origin = all.centre();
    const double extent = largest(all.high - all.low);
    if (!(extent > 0)) {
        return;
    }
    exponent = std::ilogb(extent) + 1;
    const double step = std::ldexp(1.0, exponent - 3);
    for (int k = 0; k < 3; ++k) {
        origin[k] = std::round(origin[k] / step) * step + 0.0; // no zero is negative
    }
}

int Hierarchy::Key::digit(int n) const {
    if (n < size_digits) {
        return static_cast<int>(size >> 3U * static_cast<unsigned>(size_digits - 1 - n)) & 7;
    }
    n -= size_digits;
    if (n < cell_digits) {
        return static_cast<int>(cell >> 3U * static_cast<unsigned>(cell_digits - 1 - n) & 7U);
    }
    n -= cell_digits;
    return static_cast<int>(instance >> 3U * static_cast<unsigned>(instance_digits - 1 - n)) & 7;
}

int Hierarchy::first_difference(const Key& a, const Key& b) {
    if (a.size != b.size) {
        return size_digits - 1 - (std::bit_width(a.size ^ b.size) - 1) / 3;
    }
    if (a.cell != b.cell) {
        return size_digits + cell_digits - 1 - (static_cast<int>(std::bit_width(a.cell ^ b.cell)) - 1) / 3;
    }
    return digits - 1 - (std::max(static_cast<int>(std::bit_width(a.instance ^ b.instance)), 1) - 1) / 3;
}

Hierarchy::Key Hierarchy::key_of(std::int32_t instance, const Box& box) const {
    Key key;
    const double extent = largest(box.high - box.low);
    // Sizes within a factor of four are alike, in whatever unit; exponents of doubles reach from -1074 to
    // 1024.
    key.size = static_cast<std::uint32_t>((extent > 0 ? std::ilogb(extent) - grid_.exponent + 2200 : 0) / 2);
    const glm::dvec3 place = box.centre() - grid_.origin;
    for (int k = 0; k < 3; ++k) {
        const double cell = std::floor(std::ldexp(place[k], cell_bits - 1 - grid_.exponent));
        constexpr double half = 1U << (cell_bits - 1U);
        key.cell |= spread(static_cast<std::uint64_t>(std::clamp(cell + half, 0.0, 2 * half - 1)))
                    << static_cast<unsigned>(2 - k);
    }
    key.instance = static_cast<std::uint32_t>(instance);
    return key;
}

const Hierarchy::Key& Hierarchy::key_at(std::int32_t node) const {
    const HierarchyNode& n = nodes_[at(node)];
    return n.instance >= 0 ? keys_[at(n.instance)] : blocks_[at(block_at(node))].key;
}

Hierarchy::Hierarchy(std::span<const Box> boxes, const std::vector<bool>& drawn)
    : nodes_(1), keys_(boxes.size()), node_of_(boxes.size(), -1), is_touched_(1, false) {
    Box all;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (drawn[i]) {
            all.add(boxes[i]);
        }
    }
    grid_ = HierarchyGrid(all);
    touch(0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (drawn[i]) {
            insert(static_cast<std::int32_t>(i), boxes[i]);
        }
    }
    refit();
}

bool Hierarchy::move(std::span<const Moved> moved) {
    for (const auto& [instance, bounds] : moved) {
        const std::int32_t node = node_of_[at(instance)];
        if (node < 0) {
            continue;
        }
        nodes_[at(node)].bounds = bounds;
        touch(node);
        if (node > 0) {
            open(block_of(node));
        }
    }
    refit(); // the box of everything, whatever tree it is of
    if (HierarchyGrid(bounds()) != grid_) {
        return false;
    }
    for (const auto& [instance, bounds] : moved) {
        const Key key = key_of(instance, bounds);
        const Key& before = keys_[at(instance)];
        if (node_of_[at(instance)] >= 0 && (key.cell != before.cell || key.size != before.size)) {
            remove(instance);
            insert(instance, bounds);
        }
    }
    refit();
    return true;
}

std::vector<std::int32_t> Hierarchy::take_touched() {
    for (const std::int32_t node : touched_) {
        is_touched_[at(node)] = false;
    }
    std::sort(touched_.begin(), touched_.end());
    return std::exchange(touched_, {});
}

void Hierarchy::touch(std::int32_t node) {
    if (!is_touched_[at(node)]) {
        is_touched_[at(node)] = true;
        touched_.push_back(node);
    }
}

void Hierarchy::open(std::int32_t block) {
    Block& b = blocks_[at(block)];
    if (!b.open) {
        b.open = true;
        open_[static_cast<std::size_t>(b.depth)].push_back(block);
    }
}

/// Whoever looks for the instance or the children finds them at `node` from now on.
void Hierarchy::put(std::int32_t node, const HierarchyNode& value) {
    nodes_[at(node)] = value;
    touch(node);
    if (value.instance >= 0) {
        node_of_[at(value.instance)] = node;
    } else if (value.child_count > 0) {
        blocks_[at(block_at(node))].owner = node;
    }
}

std::int32_t Hierarchy::new_block(std::int32_t owner, int depth, const Key& key) {
    std::int32_t block = 0;
    if (free_blocks_.empty()) {
        block = static_cast<std::int32_t>(blocks_.size());
        blocks_.emplace_back();
        nodes_.resize(nodes_.size() + most_children);
        is_touched_.resize(nodes_.size(), false);
        for (int k = 0; k < most_children; ++k) {
            touch(1 + block * most_children + k);
        }
    } else {
        block = free_blocks_.back();
        free_blocks_.pop_back();
    }
    blocks_[at(block)] = {owner, depth, key, false};
    return block;
}

/// Children are in the order of their digits.
void Hierarchy::insert_child(std::int32_t node, const HierarchyNode& child, const Key& key) {
    const std::int32_t block = block_at(node);
    const int depth = blocks_[at(block)].depth;
    const std::int32_t first = nodes_[at(node)].first_child;
    std::int32_t to = first + nodes_[at(node)].child_count++;
    for (; to > first && key_at(to - 1).digit(depth) > key.digit(depth); --to) {
        put(to, HierarchyNode(nodes_[at(to - 1)]));
    }
    put(to, child);
    touch(node);
    open(block);
}

void Hierarchy::insert(std::int32_t instance, const Box& box) {
    const Key key = key_of(instance, box);
    keys_[at(instance)] = key;
    const HierarchyNode leaf{box, 0, 0, instance};
    std::int32_t node = 0;
    for (;;) {
        const HierarchyNode there = nodes_[at(node)];
        if (there.instance < 0 && there.child_count == 0) {
            put(node, leaf); // the first of all
            return;
        }
        const Key other = key_at(node);
        const int depth = first_difference(key, other);
        if (there.instance >= 0 || depth < blocks_[at(block_at(node))].depth) {
            const std::int32_t block = new_block(node, depth, key);
            nodes_[at(node)] = {there.bounds, 1 + block * most_children, 0, -1};
            insert_child(node, there, other);
            insert_child(node, leaf, key);
            return;
        }
        const int inner = blocks_[at(block_at(node))].depth;
        const std::int32_t end = there.first_child + there.child_count;
        std::int32_t child = there.first_child;
        while (child < end && key_at(child).digit(inner) != key.digit(inner)) {
            ++child;
        }
        if (child == end) {
            insert_child(node, leaf, key);
            return;
        }
        node = child;
    }
}

void Hierarchy::remove(std::int32_t instance) {
    const std::int32_t node = std::exchange(node_of_[at(instance)], -1);
    if (node == 0) {
        put(0, {});
        return;
    }
    const std::int32_t block = block_of(node);
    const std::int32_t owner = blocks_[at(block)].owner;
    const std::int32_t first = nodes_[at(owner)].first_child;
    const std::int32_t last = first + --nodes_[at(owner)].child_count;
    for (std::int32_t to = node; to < last; ++to) {
        put(to, HierarchyNode(nodes_[at(to + 1)]));
    }
    put(last, {});
    touch(owner);
    if (last - first > 1) {
        open(block);
        return;
    }
    put(owner, HierarchyNode(nodes_[at(first)])); // the only one left stands for all
    put(first, {});
    blocks_[at(block)].owner = -1;
    free_blocks_.push_back(block);
    if (owner > 0) {
        open(block_of(owner));
    }
}

void Hierarchy::refit() {
    for (std::size_t depth = open_.size(); depth-- > 0;) {
        for (const std::int32_t block : std::exchange(open_[depth], {})) {
            Block& b = blocks_[at(block)];
            if (!b.open || b.depth != static_cast<int>(depth)) {
                continue; // it is another one's by now, and listed there
            }
            b.open = false;
            if (b.owner < 0) {
                continue;
            }
            HierarchyNode& owner = nodes_[at(b.owner)];
            Box bounds;
            for (std::int32_t k = 0; k < owner.child_count; ++k) {
                bounds.add(nodes_[at(owner.first_child + k)].bounds);
            }
            if (std::memcmp(&bounds, &owner.bounds, sizeof(Box)) == 0) { // zeros have signs
                continue;
            }
            owner.bounds = bounds;
            touch(b.owner);
            if (b.owner > 0) {
                open(block_of(b.owner));
            }
        }
    }
}

} // namespace razor
