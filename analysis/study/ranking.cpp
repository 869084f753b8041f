#include "analysis/study/ranking.h"

#include <algorithm>

namespace analysis {

bool surely_below(const Spread& a, const Spread& b) {
    return a.count >= least_ranked_runs && b.count >= least_ranked_runs && a.most < b.least;
}

std::vector<Place> rank(std::span<const Spread> points) {
    std::vector<double> least, most; // of all that have a place, rising
    for (const Spread& p : points)
        if (p.count >= least_ranked_runs) {
            least.push_back(p.least);
            most.push_back(p.most);
        }
    std::sort(least.begin(), least.end());
    std::sort(most.begin(), most.end());
    std::vector<Place> out(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].count < least_ranked_runs)
            continue;
        const auto below = std::lower_bound(most.begin(), most.end(), points[i].least) - most.begin();
        const auto above = least.end() - std::upper_bound(least.begin(), least.end(), points[i].most);
        out[i] = {static_cast<std::size_t>(below) + 1, least.size() - static_cast<std::size_t>(above)};
    }
    return out;
}

Spread negated(const Spread& s) {
    return {s.count, -s.median, -s.most, -s.least, -s.mean, s.half_width};
}

} // namespace analysis
