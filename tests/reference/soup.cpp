#include "tests/reference/soup.h"

#include <algorithm>
#include <map>

namespace razor::reference {

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

class Drawer {
public:
    Drawer(const Levels& levels, const Rectangle& r, const PointOf& point, Soup& soup)
        : levels_(levels), patch_(levels.patches()[at(r.patch)]), r_(r), step_(1 << r.level), point_(point),
          soup_(soup) {}

    void quads() {
        for (int j = r_.j; j < r_.j_end; j += step_)
            for (int i = r_.i; i < r_.i_end; i += step_) {
                int p00 = corner(i, j);
                int p10 = corner(i + step_, j);
                int p11 = corner(i + step_, j + step_);
                int p01 = corner(i, j + step_);
                add({p00, p10, p11}, i, j, 0, false);
                add({p00, p11, p01}, i, j, 1, false);
            }
    }

    void close() {
        for (int i = r_.i; i < r_.i_end; i += step_) {
            close_edge(0, i, r_.j);
            close_edge(2, i, r_.j_end);
        }
        for (int j = r_.j; j < r_.j_end; j += step_) {
            close_edge(1, r_.i_end, j);
            close_edge(3, r_.i, j);
        }
    }

private:
    int corner(int i, int j) { return point_(patch_.vertex(i, j)); }
    void add(std::array<int, 3> points, int i, int j, int which, bool sliver) {
        soup_.triangles.push_back({points, r_.patch, r_.level, i, j, which, sliver});
    }

    /// The edge of length step_ that begins at (i, j), on side s of the rectangle.
    void close_edge(int s, int i, int j) {
        bool along_u = s % 2 == 0;
        int quad_i = s == 1 ? i - step_ : i;
        int quad_j = s == 2 ? j - step_ : j;
        auto sliver = [&](int a, int b, int c) {
            if (a != b)
                add({point_(a), point_(b), point_(c)}, quad_i, quad_j, s / 2, true);
        };
        const std::array<int, 4> border{0, 1 << patch_.nu, 1 << patch_.nv, 0};
        if ((along_u ? j : i) != border[at(s)]) { // a line inside the patch: down to its finest steps
            auto on_line = [&](int n) { return along_u ? patch_.vertex(i + n, j) : patch_.vertex(i, j + n); };
            for (int n = 1; n < step_; ++n)
                sliver(on_line(0), on_line(n), on_line(n + 1));
            return;
        }
        const Patch::Side& side = patch_.sides[at(s)];
        const Curve& curve = levels_.curves()[at(side.curve)];
        int first = side.begin + (along_u ? i : j) * side.step;
        int last = first + step_ * side.step;
        if (last < first)
            std::swap(first, last);
        int piece = 1 << (curve.depth - curve.exponent);
        auto on_curve = [&](int n) { return curve.vertices[at(n)]; };
        if (last - first <= piece) // part of an edge of level 0, or all of it
            sliver(on_curve(first / piece * piece), on_curve(first), on_curve(last));
        else
            for (int n = first + piece; n < last; n += piece)
                sliver(on_curve(first), on_curve(n), on_curve(n + piece));
    }

    const Levels& levels_;
    const Patch& patch_;
    Rectangle r_;
    int step_;
    const PointOf& point_;
    Soup& soup_;
};

} // namespace

void draw(const Levels& levels, const Rectangle& r, bool close, const PointOf& point, Soup& soup) {
    Drawer drawer(levels, r, point, soup);
    drawer.quads();
    if (close)
        drawer.close();
}

std::vector<Triangle> draw_level(const Levels& levels, int k, bool close) {
    Soup soup;
    for (int p = 0; p < static_cast<int>(levels.patches().size()); ++p) {
        const Patch& patch = levels.patches()[at(p)];
        Rectangle all{p, std::min(k, patch.coarsest()), 0, 0, 1 << patch.nu, 1 << patch.nv};
        draw(
            levels, all, close, [](int v) { return v; }, soup);
    }
    return soup.triangles;
}

int open_edges(const Soup& soup) {
    using Key = std::array<double, 3>;
    std::map<Key, int> number;
    std::vector<int> id;
    for (const glm::dvec3& p : soup.points)
        id.push_back(number.try_emplace({p.x, p.y, p.z}, static_cast<int>(number.size())).first->second);
    std::map<std::pair<int, int>, int> count;
    for (const Triangle& t : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            int a = id[at(t.points[k])];
            int b = id[at(t.points[(k + 1) % 3])];
            if (a != b)
                ++count[std::minmax(a, b)];
        }
    int open = 0;
    for (const auto& [edge, n] : count)
        open += n % 2;
    return open;
}

} // namespace razor::reference
