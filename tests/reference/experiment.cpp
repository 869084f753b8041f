#include "tests/reference/experiment.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace razor::reference {

namespace {

constexpr double same_distance = 1e-9;

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}
int pick(std::mt19937& random, std::size_t n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
}

/// Whether a triangle of the finest level is part of another.
bool part_of(const Triangle& whole, const Triangle& fine) {
    if (whole.patch != fine.patch)
        return false;
    double size = std::ldexp(1.0, whole.level);
    double i = (fine.i + (fine.which == 0 ? 2.0 : 1.0) / 3 - whole.i) / size;
    double j = (fine.j + (fine.which == 0 ? 1.0 : 2.0) / 3 - whole.j) / size;
    return i > 0 && i < 1 && j > 0 && j < 1 && (j > i) == (whole.which == 1);
}

/// The nearest crossing with t > 0, where pairs that coincide but for rounding do not count: a ray that
/// touches an edge crosses both its faces or neither. Infinity: none.
double nearest_unpaired(const Ray& ray, const Soup& soup) {
    std::vector<double> t;
    for (const Crossing& c : crossings(ray, soup))
        if (c.t > 0)
            t.push_back(c.t);
    std::sort(t.begin(), t.end());
    for (std::size_t i = 0; i < t.size(); i += 2)
        if (i + 1 == t.size() || t[i + 1] - t[i] > same_distance)
            return t[i];
    return std::numeric_limits<double>::infinity();
}

bool same_unpaired(const Ray& ray, const Soup& a, const Soup& b) {
    double p = nearest_unpaired(ray, a);
    double q = nearest_unpaired(ray, b);
    return p == q || std::abs(p - q) <= same_distance;
}

/// The highest level that p_k(v) is blended from.
int reach(const Surface& s, int v, int k) {
    const Vertex& vertex = s.levels().vertices()[at(v)];
    if (vertex.index < k)
        return std::max(reach(s, vertex.parents[0], k), reach(s, vertex.parents[1], k));
    return s.weight(v, k) == 1 ? k : reach(s, v, k + 1);
}

BlockCounts count_blocks(const Structures& s, const View& view) {
    Surface surface(s.levels, view);
    BlockCounts c;
    c.origins = 1;
    std::vector<int> cut = s.blocks.cut(view);
    std::vector<int> pending = s.blocks.roots();
    std::vector<bool> drawn(s.blocks.blocks().size());
    for (int b : cut)
        drawn[at(b)] = true;
    while (!pending.empty()) {
        int b = pending.back();
        pending.pop_back();
        ++c.visited;
        if (!drawn[at(b)])
            pending.insert(pending.end(), s.blocks.blocks()[at(b)].children.begin(),
                           s.blocks.blocks()[at(b)].children.end());
    }
    for (int b : cut) {
        const Rectangle& area = s.blocks.blocks()[at(b)].area;
        int step = 1 << area.level;
        int highest = area.level;
        for (int j = area.j; j <= area.j_end; j += step)
            for (int i = area.i; i <= area.i_end; i += step)
                highest = std::max(
                    highest, reach(surface, s.levels.patches()[at(area.patch)].vertex(i, j), area.level));
        ++c.drawn;
        c.morphing += highest > area.level;
        c.levels += highest - area.level;
        c.deepest = std::max(c.deepest, long{highest - area.level});
        c.triangles += 2L * ((area.i_end - area.i) / step) * ((area.j_end - area.j) / step);
    }
    c.finest = static_cast<long>(s.by_level[0].size());
    return c;
}

} // namespace

void Counts::add(const Counts& c) {
    rays += c.rays;
    escapes += c.escapes;
    uneven += c.uneven;
    astray += c.astray;
    other += c.other;
    open += c.open;
}

void BlockCounts::add(const BlockCounts& c) {
    origins += c.origins;
    visited += c.visited;
    drawn += c.drawn;
    morphing += c.morphing;
    levels += c.levels;
    deepest = std::max(deepest, c.deepest);
    triangles += c.triangles;
    finest += c.finest;
}

Levels make_levels(const Setting& s) {
    LevelOptions options;
    options.e0 = s.e0;
    options.largest = s.largest;
    if (s.random_exponents) {
        std::mt19937 random(s.seed);
        for (int i = 0; i < 997; ++i)
            options.exponents.push_back(pick(random, at(s.largest) + 1));
    }
    return {make_case(s.scene), options};
}

View make_view(const Setting& s, const glm::dvec3& origin) {
    View view;
    view.origin = origin;
    view.footprint = {s.w0 * s.e0, s.growth, 0.01 * s.e0, s.cap};
    view.transition = {s.e0, 1, s.part};
    return view;
}

std::vector<glm::dvec3> inner_points(const Levels& levels, const PointMaker& make, int count,
                                     std::mt19937& random) {
    std::vector<Soup> soups;
    for (int k = 0; k <= levels.top(); ++k)
        soups.push_back(discrete_soup(levels, k));
    std::vector<glm::dvec3> points;
    for (int tries = 0; static_cast<int>(points.size()) < count; ++tries) {
        if (tries > 100 * count)
            throw std::logic_error("too few points are inside at every level");
        glm::dvec3 p = make(random);
        bool inside = true;
        for (const Soup& soup : soups)
            for (int k = 0; k < 3; ++k)
                inside = inside && hits({p, random_direction(random)}, soup).count % 2 == 1;
        if (inside)
            points.push_back(p);
    }
    return points;
}

glm::dvec3 aim(const glm::dvec3& origin, const Soup& soup, std::mt19937& random) {
    unsigned kind = random() % 4;
    if (kind < 2)
        return random_direction(random);
    const Triangle& t = soup.triangles[at(pick(random, soup.triangles.size()))];
    glm::dvec3 a = soup.points[at(t.points[random() % 3])];
    glm::dvec3 b = soup.points[at(t.points[random() % 3])];
    glm::dvec3 d = (kind == 2 ? a : glm::mix(a, b, uniform(random))) - origin;
    double size = length(d);
    return size > 0 ? d / size : random_direction(random);
}

Result run(const Setting& setting, const std::vector<std::string>& schemes) {
    Levels levels = make_levels(setting);
    Structures structures(levels, setting.side);
    std::mt19937 random(setting.seed);
    int outside = setting.origins / 4;
    std::vector<glm::dvec3> origins =
        inner_points(levels, make_case(setting.scene).inside, setting.origins - outside, random);
    for (int i = 0; i < outside; ++i)
        origins.push_back((2 + uniform(random)) * random_direction(random));
    Result result;
    for (int o = 0; o < setting.origins; ++o) {
        bool inside = o < setting.origins - outside;
        View view = make_view(setting, origins[at(o)]);
        std::unique_ptr<Tracer> reference = make_tracer("recursive", structures, view);
        std::vector<Ray> rays;
        std::vector<Hits> expected;
        for (int i = 0; i < setting.rays; ++i) {
            rays.push_back({view.origin, setting.aimed ? aim(view.origin, *reference->soup(), random)
                                                       : random_direction(random)});
            expected.push_back(reference->trace(rays.back()));
        }
        result.blocks.add(count_blocks(structures, view));
        for (const std::string& name : schemes) {
            std::unique_ptr<Tracer> tracer = make_tracer(name, structures, view);
            Counts c;
            if (tracer->soup() != nullptr)
                c.open = open_edges(*tracer->soup());
            for (std::size_t i = 0; i < rays.size(); ++i) {
                Hits h = tracer->trace(rays[i]);
                const Hits& e = expected[i];
                ++c.rays;
                bool hit = h.nearest.triangle >= 0;
                bool should = e.nearest.triangle >= 0;
                c.escapes += inside && !hit;
                c.uneven += (h.count % 2 == 1) != inside;
                if (!hit && !should)
                    continue;
                double off = hit && should ? std::abs(h.nearest.t - e.nearest.t)
                                           : std::numeric_limits<double>::infinity();
                bool same = off <= same_distance;
                if (!same && tracer->soup() != nullptr)
                    same = same_unpaired(rays[i], *tracer->soup(), *reference->soup());
                if (!same && hit && should && tracer->soup() != nullptr)
                    same = part_of(tracer->soup()->triangles[at(h.nearest.triangle)],
                                   reference->soup()->triangles[at(e.nearest.triangle)]);
                c.other += !same;
                c.astray += !same && off > 4 * std::max(view.footprint.at(e.nearest.t), setting.e0);
            }
            result.schemes[name].add(c);
        }
    }
    return result;
}

} // namespace razor::reference
