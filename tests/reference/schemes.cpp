#include "tests/reference/schemes.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace razor::reference {

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}
constexpr double infinity = std::numeric_limits<double>::infinity();

class OneSoup final : public Tracer {
public:
    explicit OneSoup(Soup soup) : soup_(std::move(soup)) {}
    Hits trace(const Ray& ray) const override { return hits(ray, soup_); }
    const Soup* soup() const override { return &soup_; }

private:
    Soup soup_;
};

/// Places a soup's points at their level, each rectangle by itself.
Soup draw_discrete(const Levels& levels, const std::vector<std::pair<Rectangle, int>>& parts) {
    Soup soup;
    std::vector<std::vector<int>> numbers(at(levels.top()) + 1,
                                          std::vector<int>(at(levels.vertex_count()), -1));
    for (const auto& [area, level] : parts) {
        const std::vector<glm::dvec3>& positions = levels.discrete(level);
        PointOf point = [&, &of_level = numbers[at(level)]](int v) {
            int& number = of_level[at(v)];
            if (number < 0) {
                number = static_cast<int>(soup.points.size());
                soup.points.push_back(positions[at(v)]);
            }
            return number;
        };
        draw(levels, area, true, point, soup);
    }
    return soup;
}

/// The level whose weights, rounded, are the lowest not to vanish.
int rounded_level(const View& view, double footprint, int top) {
    int k = 0;
    while (k < top && view.transition.weight(k, footprint) < 0.5)
        ++k;
    return k;
}

Soup discrete_blocks(const Structures& s, const View& view) {
    std::vector<std::pair<Rectangle, int>> parts;
    std::vector<int> pending = s.blocks.roots();
    while (!pending.empty()) {
        const Block& b = s.blocks.blocks()[at(pending.back())];
        pending.pop_back();
        int wanted =
            b.box.empty() ? b.area.level : rounded_level(view, least_footprint(view, b.box), s.levels.top());
        if (b.area.level == 0 || wanted >= b.area.level)
            parts.emplace_back(b.area, b.children.empty() ? b.area.level : std::max(b.area.level, wanted));
        else
            pending.insert(pending.end(), b.children.begin(), b.children.end());
    }
    return draw_discrete(s.levels, parts);
}

Soup discrete_patches(const Structures& s, const View& view) {
    std::vector<std::pair<Rectangle, int>> parts;
    for (int p = 0; p < static_cast<int>(s.levels.patches().size()); ++p) {
        const Patch& patch = s.levels.patches()[at(p)];
        Box box;
        for (int v : patch.grid)
            box.include(s.levels.vertices()[at(v)].anchor);
        int level = rounded_level(view, least_footprint(view, box), s.levels.top());
        parts.emplace_back(
            Rectangle{p, std::min(level, patch.coarsest()), 0, 0, 1 << patch.nu, 1 << patch.nv}, level);
    }
    return draw_discrete(s.levels, parts);
}

class Projected final : public Tracer {
public:
    Projected(const Structures& s, const View& view) : s_(s), view_(view) {}
    Hits trace(const Ray& ray) const override {
        View view = view_;
        view.direction = ray.direction;
        return hits(ray, recursive_soup(s_, Surface(s_.levels, view)));
    }

private:
    const Structures& s_;
    View view_;
};

/// Equations 1-6, one pair of levels after the other.
class Paper final : public Tracer {
public:
    Paper(const Structures& s, const View& view, bool printed) : s_(s), view_(view), printed_(printed) {
        growth_ = std::min(view.footprint.growth, view.footprint.cap);
    }

    Hits trace(const Ray& ray) const override {
        Hits all;
        int pairs = std::max(s_.levels.top(), 1);
        for (int k = 0; k < pairs; ++k) {
            Stretch stretch = stretch_of(k, pairs);
            if (!(stretch.begin < stretch.end) || stretch.end <= 0)
                continue;
            Soup soup{blended(k, stretch, ray), s_.by_level[at(k)]};
            for (const Crossing& c : crossings(ray, soup)) {
                if (!(c.t > 0 && c.t >= stretch.begin && c.t < stretch.end))
                    continue;
                ++all.count;
                if (all.nearest.triangle < 0 || c.t < all.nearest.t)
                    all.nearest = c;
            }
        }
        return all;
    }

private:
    /// Of the ray: the pair's octave of footprints, and t_s, t_e of its transition.
    struct Stretch {
        double begin, end, ts, te;
    };
    Stretch stretch_of(int k, int pairs) const {
        const Transition& t = view_.transition;
        double low = k == 0 ? -infinity : t.end(k - 1) / t.q;
        double high = k == pairs - 1 ? infinity : t.end(k) / t.q;
        double w0 = view_.footprint.at(0);
        if (growth_ == 0)
            return w0 >= low && w0 < high ? Stretch{-infinity, infinity, 0, 0} : Stretch{0, 0, 0, 0};
        auto where = [&](double footprint) { return (footprint - w0) / growth_; };
        double ts = where(t.begin(k) / t.q);
        double te = where(t.end(k) / t.q);
        return growth_ > 0 ? Stretch{where(low), where(high), ts, te}
                           : Stretch{where(high), where(low), te, ts};
    }
    std::vector<glm::dvec3> blended(int k, const Stretch& stretch, const Ray& ray) const {
        const std::vector<glm::dvec3>& fine = s_.levels.discrete(k);
        const std::vector<glm::dvec3>& coarse = s_.levels.discrete(std::min(k + 1, s_.levels.top()));
        double size = length(ray.direction);
        std::vector<glm::dvec3> points;
        points.reserve(fine.size());
        for (std::size_t v = 0; v < fine.size(); ++v) {
            glm::dvec3 d = fine[v] - ray.origin;
            double t = (d.x * ray.direction.x + d.y * ray.direction.y + d.z * ray.direction.z) / size;
            double b = 0; // of the fine vertex
            if (growth_ == 0) {
                b = view_.transition.weight(k, view_.footprint.at(0));
            } else {
                double x = (std::clamp(t, stretch.ts, stretch.te) - stretch.ts) / (stretch.te - stretch.ts);
                b = x * x * (3 - 2 * x);
                if (!printed_ && growth_ > 0)
                    b = 1 - b;
            }
            points.push_back(blend(b, fine[v], coarse[v]));
        }
        return points;
    }

    const Structures& s_;
    View view_;
    bool printed_;
    double growth_;
};

} // namespace

Structures::Structures(const Levels& l, int side)
    : levels(l), blocks(l, side, Anchors::deciding), finer_boxes(l, side, Anchors::finer),
      finest(draw_level(l, 0, true)) {
    for (int k = 0; k <= l.top(); ++k)
        by_level.push_back(draw_level(l, k, false));
}

const std::vector<std::string>& scheme_names() {
    static const std::vector<std::string> names{"recursive", "projected", "walk",   "finer-box", "unclosed",
                                                "discrete",  "patch",     "camera", "fixed:0",   "fixed:1",
                                                "fixed:2",   "paper",     "printed"};
    return names;
}

Soup recursive_soup(const Structures& s, const Surface& surface) {
    Soup soup{{}, s.finest};
    for (int v = 0; v < s.levels.vertex_count(); ++v)
        soup.points.push_back(surface.position(v, 0));
    return soup;
}

Soup discrete_soup(const Levels& levels, int k) {
    return {levels.discrete(k), draw_level(levels, k, true)};
}

std::unique_ptr<Tracer> make_tracer(const std::string& scheme, const Structures& s, const View& view) {
    auto of = [](Soup soup) { return std::make_unique<OneSoup>(std::move(soup)); };
    if (scheme == "recursive")
        return of(recursive_soup(s, Surface(s.levels, view)));
    if (scheme == "projected")
        return std::make_unique<Projected>(s, view);
    if (scheme == "walk")
        return of(draw_cut(s.blocks, Surface(s.levels, view), s.blocks.cut(view)));
    if (scheme == "finer-box")
        return of(draw_cut(s.finer_boxes, Surface(s.levels, view), s.finer_boxes.cut(view)));
    if (scheme == "unclosed") {
        Soup soup = draw_cut(s.blocks, Surface(s.levels, view), s.blocks.cut(view));
        std::erase_if(soup.triangles, [](const Triangle& t) { return t.sliver; });
        return of(std::move(soup));
    }
    if (scheme == "discrete")
        return of(discrete_blocks(s, view));
    if (scheme == "patch")
        return of(discrete_patches(s, view));
    if (scheme == "camera") {
        View fixed = view;
        fixed.origin = {0.3, 0.2, 2.5};
        return of(recursive_soup(s, Surface(s.levels, fixed)));
    }
    if (scheme.starts_with("fixed:") && scheme.size() == 7 && scheme[6] >= '0' && scheme[6] <= '9')
        return of(discrete_soup(s.levels, std::min(scheme[6] - '0', s.levels.top())));
    if (scheme == "paper" || scheme == "printed")
        return std::make_unique<Paper>(s, view, scheme == "printed");
    throw std::invalid_argument("no scheme is called " + scheme);
}

} // namespace razor::reference
