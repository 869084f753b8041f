#include "tests/reference/walk.h"

#include <algorithm>

namespace razor::reference {

namespace {
std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}
} // namespace

Blocks::Blocks(const Levels& levels, int side, Anchors anchors)
    : levels_(levels), side_(side), anchors_(anchors) {
    for (int p = 0; p < static_cast<int>(levels.patches().size()); ++p) {
        const Patch& patch = levels.patches()[at(p)];
        int level = patch.coarsest();
        int last_u = 1 << patch.nu;
        int last_v = 1 << patch.nv;
        int length = side << level;
        for (int j = 0; j < last_v; j += length)
            for (int i = 0; i < last_u; i += length)
                roots_.push_back(
                    add({p, level, i, j, std::min(i + length, last_u), std::min(j + length, last_v)}));
    }
}

int Blocks::add(const Rectangle& area) {
    int number = static_cast<int>(blocks_.size());
    blocks_.push_back({area, box_of(area), {}});
    if (area.level == 0)
        return number;
    int length = side_ << (area.level - 1);
    std::vector<int> children;
    for (int j = area.j; j < area.j_end; j += length)
        for (int i = area.i; i < area.i_end; i += length)
            children.push_back(add({area.patch, area.level - 1, i, j, std::min(i + length, area.i_end),
                                    std::min(j + length, area.j_end)}));
    blocks_[at(number)].children = children;
    return number;
}

Box Blocks::box_of(const Rectangle& area) const {
    const Patch& patch = levels_.patches()[at(area.patch)];
    std::vector<int> pending;
    for (int j = area.j; j <= area.j_end; ++j)
        for (int i = area.i; i <= area.i_end; ++i)
            pending.push_back(patch.vertex(i, j));
    Box box;
    while (!pending.empty()) {
        const Vertex& v = levels_.vertices()[at(pending.back())];
        pending.pop_back();
        bool finer = v.index >= 0 && v.index < area.level;
        bool kept = v.index >= area.level && levels_.displaced();
        if (finer || (kept && anchors_ == Anchors::deciding))
            box.include(v.anchor);
        if (v.index < area.level && anchors_ == Anchors::deciding)
            pending.insert(pending.end(), v.parents.begin(), v.parents.end());
    }
    return box;
}

double least_footprint(const View& view, const Box& box) {
    bool narrows = std::min(view.footprint.growth, view.footprint.cap) < 0;
    return view.footprint.at(narrows ? box.furthest(view.origin) : box.nearest(view.origin));
}

std::vector<int> Blocks::cut(const View& view) const {
    std::vector<int> drawn;
    std::vector<int> pending = roots_;
    while (!pending.empty()) {
        int number = pending.back();
        pending.pop_back();
        const Block& b = blocks_[at(number)];
        bool stands = b.area.level == 0 || b.box.empty() ||
                      view.transition.gone(b.area.level - 1, least_footprint(view, b.box));
        if (stands)
            drawn.push_back(number);
        else
            pending.insert(pending.end(), b.children.begin(), b.children.end());
    }
    return drawn;
}

Soup draw_cut(const Blocks& blocks, const Surface& surface, const std::vector<int>& cut) {
    const Levels& levels = surface.levels();
    Soup soup;
    std::vector<std::vector<int>> numbers(at(levels.top()) + 1,
                                          std::vector<int>(at(levels.vertex_count()), -1));
    for (int b : cut) {
        const Rectangle& area = blocks.blocks()[at(b)].area;
        PointOf point = [&](int v) {
            int& number = numbers[at(area.level)][at(v)];
            if (number < 0) {
                number = static_cast<int>(soup.points.size());
                soup.points.push_back(surface.position(v, area.level));
            }
            return number;
        };
        draw(levels, area, true, point, soup);
    }
    return soup;
}

} // namespace razor::reference
