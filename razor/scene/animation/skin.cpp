#include "razor/scene/animation/skin.h"

#include <algorithm>
#include <numeric>

namespace razor {
namespace {

/// Below, above or alike (0), in any fixed order of points.
class PointOrder {
public:
    explicit PointOrder(const Skin& skin) : skin_(skin) {}

    int compare(int i, int j) const {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        if (const int order = compare(skin_.points[a], skin_.points[b]))
            return order;
        for (const std::vector<glm::dvec3>& target : skin_.targets)
            if (const int order = compare(target[a], target[b]))
                return order;
        const auto of_a = skin_.influences_of(a), of_b = skin_.influences_of(b);
        if (of_a.size() != of_b.size())
            return of_a.size() < of_b.size() ? -1 : 1;
        for (std::size_t k = 0; k < of_a.size(); ++k) {
            if (of_a[k].joint != of_b[k].joint)
                return of_a[k].joint < of_b[k].joint ? -1 : 1;
            if (of_a[k].weight != of_b[k].weight)
                return of_a[k].weight < of_b[k].weight ? -1 : 1;
        }
        return 0;
    }

private:
    static int compare(const glm::dvec3& a, const glm::dvec3& b) {
        for (int axis = 0; axis < 3; ++axis)
            if (a[axis] != b[axis])
                return a[axis] < b[axis] ? -1 : 1;
        return 0;
    }

    const Skin& skin_;
};

} // namespace

void Skin::append_influences(std::span<const Influence> of_point) {
    if (first.empty())
        first.push_back(0);
    const std::size_t begin = influences.size();
    double sum = 0;
    for (const Influence& influence : of_point) {
        sum += influence.weight;
        if (influence.weight > 0)
            influences.push_back(influence);
    }
    if (influences.size() == begin)
        influences.push_back({of_point.empty() ? 0 : of_point.front().joint, sum = 1});
    const auto mine = influences.begin() + static_cast<std::ptrdiff_t>(begin);
    std::for_each(mine, influences.end(), [sum](Influence& influence) { influence.weight /= sum; });
    std::sort(mine, influences.end(), [](const Influence& a, const Influence& b) {
        return a.joint != b.joint ? a.joint < b.joint : a.weight < b.weight;
    });
    first.push_back(influences.size());
}

void pose(const Skin& skin, const SkeletonPose& skeleton, std::span<glm::dvec3> result) {
    const std::vector<double>& weights = skeleton.weights[static_cast<std::size_t>(skin.node)];
    std::copy(skin.points.begin(), skin.points.end(), result.begin());
    for (std::size_t t = 0; t < std::min(skin.targets.size(), weights.size()); ++t)
        if (weights[t] != 0)
            for (std::size_t i = 0; i < result.size(); ++i)
                result[i] += weights[t] * skin.targets[t][i];
    if (skin.joints.empty()) {
        const Affine& world = skeleton.world[static_cast<std::size_t>(skin.node)];
        std::transform(result.begin(), result.end(), result.begin(), world);
        return;
    }
    std::vector<Affine> from_mesh;
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
        from_mesh.push_back(skeleton.world[static_cast<std::size_t>(skin.joints[j])] * skin.inverse_bind[j]);
    for (std::size_t i = 0; i < result.size(); ++i) {
        glm::dvec3 blend{0};
        for (const Influence& influence : skin.influences_of(i))
            blend += influence.weight * from_mesh[static_cast<std::size_t>(influence.joint)](result[i]);
        result[i] = blend;
    }
}

std::vector<int> first_alike(const Skin& skin) {
    std::vector<int> order(skin.points.size()), alike(skin.points.size());
    std::iota(order.begin(), order.end(), 0);
    const PointOrder points(skin);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const int c = points.compare(a, b);
        return c != 0 ? c < 0 : a < b;
    });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool again = k > 0 && points.compare(order[k - 1], order[k]) == 0;
        alike[static_cast<std::size_t>(order[k])] =
            again ? alike[static_cast<std::size_t>(order[k - 1])] : order[k];
    }
    return alike;
}

Skin gather(const Skin& skin, std::span<const int> points) {
    Skin result;
    result.node = skin.node;
    result.joints = skin.joints;
    result.inverse_bind = skin.inverse_bind;
    result.targets.resize(skin.targets.size());
    if (!skin.first.empty())
        result.first.push_back(0);
    for (const int point : points) {
        const auto i = static_cast<std::size_t>(point);
        result.points.push_back(skin.points[i]);
        for (std::size_t t = 0; t < skin.targets.size(); ++t)
            result.targets[t].push_back(skin.targets[t][i]);
        if (!skin.first.empty()) {
            const auto influences = skin.influences_of(i);
            result.influences.insert(result.influences.end(), influences.begin(), influences.end());
            result.first.push_back(result.influences.size());
        }
    }
    return result;
}

} // namespace razor
