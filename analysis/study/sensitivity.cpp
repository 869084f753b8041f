#include "analysis/study/sensitivity.h"

#include "analysis/study/ranking.h"

#include <map>
#include <optional>
#include <utility>

namespace analysis {
namespace {

/// The extreme values of a knob that any point has, measured or not; nothing where there are not two.
std::optional<std::pair<Value, Value>> extremes(std::span<const Response> points, const std::string& knob) {
    std::optional<std::pair<Value, Value>> out;
    for (const Response& point : points) {
        const auto found = point.settings->find(knob);
        if (found == point.settings->end())
            continue;
        const Value& value = found->second;
        if (!out) {
            out = {value, value};
            continue;
        }
        const auto number = number_of(value), low = number_of(out->first), high = number_of(out->second);
        if (!number || !low || !high) // of words, the first met and the last one that is another
            out->second = value != out->first ? value : out->second;
        else if (*number < *low)
            out->first = value;
        else if (*number > *high)
            out->second = value;
    }
    return out && out->first != out->second ? out : std::nullopt;
}

} // namespace

std::vector<Sensitivity> sensitivities(std::span<const Response> points,
                                       const std::vector<std::string>& knobs) {
    std::vector<Sensitivity> out;
    for (const std::string& knob : knobs) {
        const auto ends = extremes(points, knob);
        if (!ends)
            continue;
        std::map<std::string, std::pair<const Spread*, const Spread*>> pairs; // by all other settings
        for (const Response& point : points) {
            const auto found = point.settings->find(knob);
            if (found == point.settings->end() || point.figure.count == 0)
                continue;
            Settings others = *point.settings;
            others.erase(knob);
            if (found->second == ends->first)
                pairs[toml_text(others)].first = &point.figure;
            else if (found->second == ends->second)
                pairs[toml_text(others)].second = &point.figure;
        }
        Sensitivity one{knob, ends->first, ends->second, {}, 0};
        std::vector<double> ratios;
        for (const auto& [others, pair] : pairs) {
            const auto [from, to] = pair;
            if (from == nullptr || to == nullptr || !(from->median > 0) || !(to->median > 0))
                continue;
            ratios.push_back(to->median / from->median);
            one.sure += surely_below(*from, *to) || surely_below(*to, *from) ? 1 : 0;
        }
        one.ratio = spread_of(ratios);
        if (!ratios.empty())
            out.push_back(std::move(one));
    }
    return out;
}

} // namespace analysis
