#include "razor/frame/light_tree.h"

#include "razor/frame/light_records.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace razor {
namespace {

using glm::dvec3;
using std::numbers::pi;

struct Item {
    LightBounds bounds;
    int light;
    dvec3 middle() const { return (bounds.box.low + bounds.box.high) * 0.5; }
};

/// What lights in these bounds cost (Conty Estevez & Kulla 2018, equation 1), but for the box's shape.
double cost(const LightBounds& b) {
    const dvec3 d = b.box.high - b.box.low;
    const double o = b.normals.angle, w = std::min(o + b.emission, pi);
    const double angles =
        2 * pi * (1 - std::cos(o)) +
        pi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    return b.power * angles * 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

class Builder {
public:
    explicit Builder(std::vector<Item> items) : items_(std::move(items)) {
        nodes.reserve(2 * items_.size());
        Box all;
        for (const Item& item : items_)
            all.add(item.bounds.box);
        wider_ = glm::length(all.high - all.low);
        build(0, items_.size(), -1, 0);
    }
    std::vector<LightNode> nodes;

private:
    static constexpr int buckets = 12;
    static constexpr int most_uneven = 40; // levels; below, halves have as many lights

    void build(std::size_t first, std::size_t end, int parent, int depth) {
        const std::size_t number = nodes.size();
        LightBounds all;
        for (std::size_t i = first; i < end; ++i)
            all.add(items_[i].bounds);
        LightNode node{};
        // Rays meet boxes in single precision, and flat ones beside their planes.
        const dvec3 room = 1e-5 * (glm::max(glm::abs(all.box.low), glm::abs(all.box.high)) + wider_);
        put(node.low, all.box.low - room);
        put(node.high, all.box.high + room);
        put(node.axis, all.normals.axis);
        node.cos_normals = static_cast<float>(std::cos(all.normals.angle));
        node.cos_emission = static_cast<float>(std::cos(all.emission));
        node.power = static_cast<float>(all.power);
        node.parent = parent;
        node.second = -1 - items_[first].light;
        nodes.push_back(node);
        if (end - first > 1) {
            const std::size_t middle = divide(first, end, all, depth);
            build(first, middle, static_cast<int>(number), depth + 1);
            nodes[number].second = static_cast<std::int32_t>(nodes.size());
            build(middle, end, static_cast<int>(number), depth + 1);
        }
        nodes[number].next = static_cast<std::int32_t>(nodes.size());
    }

    std::size_t divide(std::size_t first, std::size_t end, const LightBounds& all, int depth) {
        Box middles;
        for (std::size_t i = first; i < end; ++i)
            middles.add(items_[i].middle());
        const dvec3 size = all.box.high - all.box.low;
        const double longest = std::max({size.x, size.y, size.z});
        double least = std::numeric_limits<double>::infinity();
        int best_axis = -1, best = 0;
        const auto bucket_of = [&](const Item& item, int axis) {
            const double at =
                (item.middle()[axis] - middles.low[axis]) / (middles.high[axis] - middles.low[axis]);
            return std::clamp(static_cast<int>(at * buckets), 0, buckets - 1);
        };
        for (int axis = 0; axis < 3 && depth < most_uneven; ++axis) {
            if (!(middles.high[axis] > middles.low[axis]))
                continue;
            std::array<LightBounds, buckets> of;
            for (std::size_t i = first; i < end; ++i)
                of[static_cast<std::size_t>(bucket_of(items_[i], axis))].add(items_[i].bounds);
            for (int split = 1; split < buckets; ++split) {
                LightBounds low, high;
                for (int k = 0; k < buckets; ++k)
                    if (const LightBounds& b = of[static_cast<std::size_t>(k)]; b.power > 0)
                        (k < split ? low : high).add(b);
                if (low.power == 0 || high.power == 0)
                    continue;
                const double value = longest / size[axis] * (cost(low) + cost(high));
                if (value < least) {
                    least = value;
                    best_axis = axis;
                    best = split;
                }
            }
        }
        const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto last = items_.begin() + static_cast<std::ptrdiff_t>(end);
        if (best_axis < 0) {
            int axis = 0;
            for (int k = 1; k < 3; ++k)
                if (size[k] > size[axis])
                    axis = k;
            std::stable_sort(begin, last, [axis](const Item& a, const Item& b) {
                return a.middle()[axis] < b.middle()[axis];
            });
            return first + (end - first) / 2;
        }
        const auto middle = std::stable_partition(
            begin, last, [&](const Item& item) { return bucket_of(item, best_axis) < best; });
        return static_cast<std::size_t>(middle - items_.begin());
    }

    std::vector<Item> items_;
    double wider_ = 0; // extent of all
};

} // namespace

std::vector<LightNode> light_tree(std::span<const LightBounds> lights) {
    std::vector<Item> items;
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (lights[i].power > 0)
            items.push_back({lights[i], static_cast<int>(i)});
    return items.empty() ? std::vector<LightNode>{} : std::move(Builder(std::move(items)).nodes);
}

} // namespace razor
