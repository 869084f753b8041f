#include "analysis/study/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace analysis {
namespace {

/// A key without its section, and its value: short enough for legends.
std::string short_setting(const std::string& key, const Value& value, Unit unit) {
    const auto number = number_of(value);
    return fmt::format("{} {}", key.substr(key.rfind('.') + 1),
                       number && unit == Unit::bytes ? short_text(*number, unit) : plain_text(value));
}

Unit unit_of(const std::string& key) {
    return key.ends_with("size_bytes") ? Unit::bytes : Unit::plain;
}

/// What tells a point from others but for one knob.
std::string others_text(const Point& point, const std::vector<std::string>& knobs, const std::string& but) {
    std::string out;
    for (const std::string& key : knobs)
        if (const auto found = point.settings.find(key); key != but && found != point.settings.end())
            out += (out.empty() ? "" : ", ") + short_setting(key, found->second, unit_of(key));
    return out.empty() ? "all points" : out;
}

} // namespace

std::vector<Spread> spreads_of(const std::vector<CollectedPoint>& points, const Figure& figure) {
    std::vector<Spread> out;
    for (const CollectedPoint& point : points) {
        const Spread s = spread_of(point.samples(figure.name));
        out.push_back(figure.more_is_better ? negated(s) : s);
    }
    return out;
}

std::string place_text(const Place& place) {
    return !place.known() ? "-"
           : place.sure() ? fmt::format("{}", place.best)
                          : fmt::format("{}-{}", place.best, place.worst);
}

Ranking ranking_of(const std::vector<CollectedPoint>& points, const std::vector<std::string>& knobs,
                   const Figure& figure) {
    Ranking out{figure, {}, {}, {}};
    const std::vector<Spread> better = spreads_of(points, figure);
    out.places = rank(better);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (out.places[i].known())
            out.order.push_back(i);
    std::stable_sort(out.order.begin(), out.order.end(),
                     [&](std::size_t a, std::size_t b) { return better[a].median < better[b].median; });
    std::vector<Response> responses;
    for (const CollectedPoint& point : points)
        if (point.point.rival.empty())
            responses.push_back({&point.point.settings, spread_of(point.samples(figure.name))});
    out.ratios = sensitivities(responses, knobs);
    // The strongest first.
    std::stable_sort(out.ratios.begin(), out.ratios.end(), [](const Sensitivity& a, const Sensitivity& b) {
        const auto strength = [](const Sensitivity& s) {
            return std::max(s.ratio.median, 1 / s.ratio.median);
        };
        return strength(a) > strength(b);
    });
    return out;
}

RatioChart Ranking::chart() const {
    RatioChart out;
    out.label = figure.label + ": ratio, all other settings the same";
    for (const Sensitivity& one : ratios)
        out.bars.push_back({fmt::format("{}: {} to {}", one.knob, plain_text(one.from), plain_text(one.to)),
                            one.ratio.median, one.ratio.least, one.ratio.most, one.sure == 0});
    return out;
}

std::string Ranking::verdict(const std::vector<CollectedPoint>& points,
                             const std::vector<std::string>& knobs) const {
    if (order.empty())
        return fmt::format(
            "Points are not ranked by {}: none has {} runs, and fewer say too little of noise; "
            "write seeds = {}.",
            figure.name, least_ranked_runs, least_ranked_runs);
    const std::size_t first = order.front();
    const auto tied = std::count_if(places.begin(), places.end(), [](const Place& p) { return p.best == 1; });
    const std::string best = settings_text(points[first].point, knobs);
    if (tied == 1)
        return fmt::format("Best by {}: {}, each of whose runs is better than all others'.", figure.name,
                           best);
    return fmt::format("{} points may be the best by {}: their runs differ by no more than noise moves them. "
                       "The best median is that of {}.",
                       tied, figure.name, best);
}

Curve curve_of(const std::vector<CollectedPoint>& points, const std::vector<std::string>& knobs,
               const CurveRequest& request, const std::string& label) {
    Curve out{request, {}};
    out.chart.x = {request.x, unit_of(request.x), false};
    out.chart.y = {label, Unit::plain, false};
    struct Mark {
        double x;
        Spread y;
    };
    std::vector<std::pair<std::string, std::vector<Mark>>> lines; // in the points' order
    for (const CollectedPoint& point : points) {
        const auto found = point.point.settings.find(request.x);
        const auto x = found == point.point.settings.end() ? std::nullopt : number_of(found->second);
        const Spread y = spread_of(point.samples(request.y));
        if (!x || y.count == 0 || !point.point.rival.empty())
            continue;
        const std::string name = others_text(point.point, knobs, request.x);
        auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.first == name; });
        if (line == lines.end())
            line = lines.insert(line, {name, {}});
        line->second.push_back({*x, y});
    }
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (auto& [name, marks] : lines) {
        std::stable_sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
        LineChart::Series& series = out.chart.series.emplace_back();
        series.name = name;
        for (const Mark& mark : marks) {
            series.points.emplace_back(mark.x, mark.y.median);
            series.errors.push_back(std::max(mark.y.most - mark.y.median, mark.y.median - mark.y.least));
            low = std::min(low, mark.x);
            high = std::max(high, mark.x);
        }
    }
    out.chart.x.logarithmic = low > 0 && high / low >= 4;
    return out;
}

std::vector<std::string> curve_knobs(const std::vector<CollectedPoint>& points,
                                     const std::vector<std::string>& knobs) {
    std::vector<std::string> out;
    for (const std::string& knob : knobs) {
        std::set<double> values;
        bool numbers = true;
        for (const CollectedPoint& point : points)
            if (const auto found = point.point.settings.find(knob); found != point.point.settings.end()) {
                const auto number = number_of(found->second);
                numbers = numbers && number.has_value();
                values.insert(number.value_or(0));
            }
        if (numbers && values.size() >= 3)
            out.push_back(knob);
    }
    return out;
}

} // namespace analysis
