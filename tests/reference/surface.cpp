#include "tests/reference/surface.h"

#include "tests/reference/distance.h"

#include <glm/geometric.hpp>

namespace razor::reference {

double View::footprint_at(const glm::dvec3& anchor) const {
    glm::dvec3 d = anchor - origin;
    if (direction)
        return footprint.at(std::max(glm::dot(d, *direction), 0.0));
    return footprint.at(length(d));
}

glm::dvec3 blend(double w, const glm::dvec3& v, const glm::dvec3& c) {
    return w == 1 ? v : c + w * (v - c);
}

Surface::Surface(const Levels& levels, const View& view)
    : levels_(levels), view_(view), p_(static_cast<std::size_t>(levels.top()) + 1) {
    for (int k = levels.top(); k >= 0; --k) {
        std::vector<glm::dvec3>& p = p_[static_cast<std::size_t>(k)];
        for (int v = 0; v < levels.vertex_count(); ++v) {
            const Vertex& vertex = levels.vertices()[static_cast<std::size_t>(v)];
            if (vertex.index < k)
                p.push_back(0.5 * (p[static_cast<std::size_t>(vertex.parents[0])] +
                                   p[static_cast<std::size_t>(vertex.parents[1])]));
            else if (k == levels.top())
                p.push_back(levels.position(v, k));
            else
                p.push_back(blend(weight(v, k), levels.position(v, k), position(v, k + 1)));
        }
    }
}

double Surface::weight(int v, int k) const {
    if (k >= levels_.top())
        return 1;
    return view_.weight(k, levels_.vertices()[static_cast<std::size_t>(v)].anchor);
}

} // namespace razor::reference
