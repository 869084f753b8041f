#include "analysis/study/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace analysis {
namespace {

bool is_known(const Trade& p) {
    return std::isfinite(p.x.median) && std::isfinite(p.y.median);
}

/// By medians.
bool dominates(const Trade& a, const Trade& b) {
    return a.x.median <= b.x.median && a.y.median <= b.y.median &&
           (a.x.median < b.x.median || a.y.median < b.y.median);
}

bool surely_dominates(const Trade& a, const Trade& b) {
    return dominates(a, b) && (a.x.most < b.x.least || a.y.most < b.y.least);
}

} // namespace

std::vector<Standing> pareto(std::span<const Trade> points) {
    std::vector<Standing> out(points.size(), Standing::unknown);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_known(points[i]))
            order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Trade &p = points[a], &q = points[b];
        return p.x.median != q.x.median ? p.x.median < q.x.median : p.y.median < q.y.median;
    });
    // In rising x a point is on the front if its y is below that of all before it; equal ones stand together.
    double best = std::numeric_limits<double>::infinity(), at = best;
    for (const std::size_t i : order) {
        const Trade& p = points[i];
        const bool front = p.y.median < best || (p.y.median == best && p.x.median == at);
        if (p.y.median < best) {
            best = p.y.median;
            at = p.x.median;
        }
        out[i] = front ? Standing::front : Standing::dominated;
    }
    for (const std::size_t i : order) {
        if (out[i] == Standing::front)
            continue;
        const bool sure = std::any_of(order.begin(), order.end(),
                                      [&](std::size_t j) { return surely_dominates(points[j], points[i]); });
        out[i] = sure ? Standing::dominated : Standing::tied;
    }
    return out;
}

} // namespace analysis
