#include "analysis/plots/ratio_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace analysis {
namespace {

constexpr double width = 860, left = 330, right = 90, top = 14, bottom = 46, row = 26;
constexpr const char *ink = "#333333", *grid = "#dddddd", *less = "#0072b2", *more = "#d55e00",
                     *neither = "#bbbbbb";

/// Ratios that an axis from `low` to `high` is marked at: about eight at most, 1 among them.
std::vector<double> marks(double low, double high) {
    constexpr std::array<double, 10> steps = {1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2, 4, 10, 100};
    double step = steps.back();
    for (const double one : steps)
        if ((std::log(high) - std::log(low)) / std::log(one) <= 8) {
            step = one;
            break;
        }
    std::vector<double> out;
    const double first = std::ceil(std::log(low) / std::log(step) - 1e-9);
    for (double e = first; std::pow(step, e) <= high * (1 + 1e-9); e += 1)
        out.push_back(std::pow(step, e));
    return out;
}

} // namespace

Svg RatioChart::drawing() const {
    double low = 1 / 1.02, high = 1.02;
    for (const Bar& bar : bars) {
        low = std::min({low, bar.low, bar.median});
        high = std::max({high, bar.high, bar.median});
    }
    const double margin = std::pow(high / low, 0.03); // so that ranges end within the axis
    low /= margin;
    high *= margin;
    const double y1 = top + row * static_cast<double>(bars.size());
    Svg out(width, y1 + bottom);
    const auto at = [&](double ratio) {
        return left +
               (width - right - left) * (std::log(ratio) - std::log(low)) / (std::log(high) - std::log(low));
    };
    for (const double mark : marks(low, high)) {
        out.line(at(mark), top, at(mark), y1, grid);
        out.text(at(mark), y1 + 15, fmt::format("{:.3g}", mark), Svg::Anchor::middle, 11);
    }
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const Bar& bar = bars[i];
        const double y = top + row * static_cast<double>(i), middle = y + row / 2;
        const auto [from, to] = std::minmax({at(1), at(bar.median)});
        out.text(left - 8, middle + 4, bar.name, Svg::Anchor::end, 11);
        out.rectangle(from, y + 5, std::max(to - from, 0.5), row - 10,
                      bar.faint        ? neither
                      : bar.median < 1 ? less
                                       : more,
                      fmt::format("{}: {:.4g} [{:.4g} .. {:.4g}]", bar.name, bar.median, bar.low, bar.high));
        out.line(at(bar.low), middle, at(bar.high), middle, ink, 1.5);
        for (const double end : {bar.low, bar.high})
            out.line(at(end), middle - 4, at(end), middle + 4, ink, 1.5);
        out.text(width - right + 8, middle + 4, fmt::format("{:.3g}", bar.median), Svg::Anchor::start, 11);
    }
    out.line(at(1), top, at(1), y1, ink);
    out.text((left + width - right) / 2, y1 + 34, label, Svg::Anchor::middle);
    return out;
}

} // namespace analysis
