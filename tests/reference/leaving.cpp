#include "tests/reference/leaving.h"

#include "tests/reference/distance.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace razor::reference {

namespace {

class Bound {
public:
    Bound(const Levels& levels, const Transition& transition, const Hit& hit, double growth)
        : levels_(levels), transition_(transition), hit_(hit), growth_(growth) {}

    Apart of(int v, int k) const {
        const Vertex& vertex = levels_.vertices()[static_cast<std::size_t>(v)];
        if (vertex.index < k) {
            Apart a = of(vertex.parents[0], k);
            Apart b = of(vertex.parents[1], k);
            return {0.5 * (a.from_level + b.from_level), 0.5 * (a.from_each_other + b.from_each_other)};
        }
        if (k == levels_.top())
            return {0, 0};
        double slack = growth_ * length(vertex.anchor - hit_.point);
        double least = transition_.weight(k, hit_.footprint + slack);
        double most = transition_.weight(k, hit_.footprint - slack);
        if (least == 1)
            return {0, 0};
        auto n = static_cast<std::size_t>(v);
        double step = length(levels_.discrete(k)[n] - levels_.discrete(k + 1)[n]);
        Apart above = of(v, k + 1);
        double reach = above.from_level + step;
        return {(1 - least) * reach, (most - least) * reach + (1 - least) * above.from_each_other};
    }

private:
    const Levels& levels_;
    Transition transition_;
    Hit hit_;
    double growth_;
};

/// The furthest anchor from the hit that p_k(v) is blended from.
double furthest_source(const Surface& s, const Hit& hit, int v, int k) {
    const Vertex& vertex = s.levels().vertices()[static_cast<std::size_t>(v)];
    if (vertex.index < k)
        return std::max(furthest_source(s, hit, vertex.parents[0], k),
                        furthest_source(s, hit, vertex.parents[1], k));
    double here = length(vertex.anchor - hit.point);
    return s.weight(v, k) == 1 ? here : std::max(here, furthest_source(s, hit, v, k + 1));
}

} // namespace

Apart apart(const Levels& levels, const Transition& transition, const Hit& hit, double growth) {
    Bound bound(levels, transition, hit, growth);
    Apart most{0, 0};
    for (int v : hit.vertices) {
        Apart a = bound.of(v, 0);
        most.from_level = std::max(most.from_level, a.from_level);
        most.from_each_other = std::max(most.from_each_other, a.from_each_other);
    }
    return most;
}

double clearance(const Surface& parent, const Hit& hit, const glm::dvec3& normal) {
    double reach = 0;
    for (int v : hit.vertices)
        reach = std::max(reach, furthest_source(parent, hit, v, 0));
    const Levels& levels = parent.levels();
    double height = 0;
    for (std::size_t v = 0; v < levels.vertices().size(); ++v) {
        if (length(levels.vertices()[v].anchor - hit.point) > 2 * reach)
            continue;
        for (int k = 0; k <= levels.top(); ++k)
            height = std::max(height, glm::dot(normal, levels.discrete(k)[v] - hit.point));
    }
    return height;
}

} // namespace razor::reference
