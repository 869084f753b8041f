#include "razor/frame/light_tree.h"

#include "razor/frame/light_records.h"
#include "razor/scene/graph/box.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace razor {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// Directions within an angle of an axis.
struct Cone {
    dvec3 axis{0, 0, 1};
    double angle = pi;
};

/// The smallest that holds both, if they are not all directions.
Cone unite(const Cone& a, const Cone& b) {
    const double between = std::atan2(glm::length(glm::cross(a.axis, b.axis)), glm::dot(a.axis, b.axis));
    if (std::min(between + b.angle, pi) <= a.angle)
        return a;
    if (std::min(between + a.angle, pi) <= b.angle)
        return b;
    const double angle = (a.angle + between + b.angle) / 2;
    const dvec3 about = glm::cross(a.axis, b.axis);
    if (angle >= pi || glm::dot(about, about) == 0)
        return {};
    const double turn = angle - a.angle;
    const dvec3 side = glm::normalize(glm::cross(glm::normalize(about), a.axis));
    return {glm::normalize(a.axis * std::cos(turn) + side * std::sin(turn)), angle};
}

struct Bounds {
    Box box;
    Cone normals;
    double emission = 0; // angle
    double power = 0;

    void add(const Bounds& b) {
        if (power == 0) {
            *this = b;
            return;
        }
        box.add(b.box);
        normals = unite(normals, b.normals);
        emission = std::max(emission, b.emission);
        power += b.power;
    }
};

struct Item {
    Bounds bounds;
    int light;
    dvec3 middle() const { return (bounds.box.low + bounds.box.high) * 0.5; }
};

Bounds bounds_of(const Light& l, const dvec3& origin) {
    Bounds b;
    const double bright = (double{l.radiance.x} + l.radiance.y + l.radiance.z) / 3;
    b.emission = pi / 2;
    b.power = bright;
    const dvec3 at = l.position - origin;
    switch (l.kind) {
    case LightKind::rectangle: {
        const dvec3 corner = l.corner - origin, normal = glm::cross(l.edge_u, l.edge_v);
        for (const dvec3& p : {corner, corner + l.edge_u, corner + l.edge_v, corner + l.edge_u + l.edge_v})
            b.box.add(p);
        b.normals = {glm::normalize(normal), 0};
        b.power *= glm::length(normal);
        return b;
    }
    case LightKind::disk: {
        const dvec3 normal = glm::normalize(l.direction);
        const dvec3 reach = l.radius * glm::sqrt(glm::max(dvec3(1) - normal * normal, dvec3(0)));
        b.box.add(at - reach);
        b.box.add(at + reach);
        b.normals = {normal, 0};
        b.power *= pi * l.radius * l.radius;
        return b;
    }
    case LightKind::sphere:
        b.box.add(at - dvec3(l.radius));
        b.box.add(at + dvec3(l.radius));
        b.power *= pi * l.radius * l.radius;
        return b;
    case LightKind::spot:
        b.box.add(at);
        b.normals = {glm::normalize(l.direction), glm::radians(l.cone_angle - l.cone_delta)};
        b.emission = glm::radians(l.cone_delta);
        return b;
    case LightKind::point:
    case LightKind::directional:
        b.box.add(at);
        return b;
    }
    return b;
}

/// What lights in these bounds cost (Conty Estevez & Kulla 2018, equation 1), but for the box's shape.
double cost(const Bounds& b) {
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
        Bounds all;
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

    std::size_t divide(std::size_t first, std::size_t end, const Bounds& all, int depth) {
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
            std::array<Bounds, buckets> of;
            for (std::size_t i = first; i < end; ++i)
                of[static_cast<std::size_t>(bucket_of(items_[i], axis))].add(items_[i].bounds);
            for (int split = 1; split < buckets; ++split) {
                Bounds low, high;
                for (int k = 0; k < buckets; ++k)
                    if (const Bounds& b = of[static_cast<std::size_t>(k)]; b.power > 0)
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

bool has_place(const Light& light) {
    return light.kind != LightKind::directional;
}

std::vector<LightNode> light_tree(std::span<const Light> lights, const dvec3& origin) {
    std::vector<Item> items;
    for (std::size_t i = 0; i < lights.size(); ++i)
        items.push_back({bounds_of(lights[i], origin), static_cast<int>(i)});
    return items.empty() ? std::vector<LightNode>{} : std::move(Builder(std::move(items)).nodes);
}

} // namespace razor
