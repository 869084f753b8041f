#include "analysis/plots/scatter_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace analysis {
namespace {

constexpr double width = 860, height = 480, left = 80, right = 210, top = 14, bottom = 46;
constexpr const char *ink = "#333333", *grid = "#dddddd", *faint = "#eeeeee", *front_colour = "#999999";

/// A logarithmic axis.
struct Span {
    double low = 0, high = 0; // decimal logarithms
    bool any = false;

    void take(double value) {
        if (!(value > 0) || !std::isfinite(value))
            return;
        const double at = std::log10(value);
        low = any ? std::min(low, at) : at;
        high = any ? std::max(high, at) : at;
        any = true;
    }
    /// Somewhat more than the values, and never nothing.
    void widen() {
        const double more = std::max(0.06 * (high - low), 0.05);
        low -= more;
        high += more;
    }
    double operator()(double value, double from, double to) const {
        return from +
               (to - from) * std::clamp((std::log10(std::max(value, 1e-300)) - low) / (high - low), 0.0, 1.0);
    }
    /// Multiples 1 to 9 of powers of ten, and whether each is to be named: powers, and 2 and 5 where the axis
    /// is short. Where less than two of them lie on it, round numbers that are equally far apart.
    std::vector<std::pair<double, bool>> ticks() const {
        std::vector<std::pair<double, bool>> out;
        const bool few = high - low < 2;
        for (int e = static_cast<int>(std::floor(low)); e <= static_cast<int>(std::ceil(high)); ++e)
            for (int m = 1; m <= 9; ++m) {
                const double at = m * std::pow(10, e);
                const double log = std::log10(at);
                if (log >= low && log <= high)
                    out.emplace_back(at, m == 1 || (few && (m == 2 || m == 5)) || high - low < 0.6);
            }
        const auto named = [](const auto& tick) { return tick.second; };
        return std::count_if(out.begin(), out.end(), named) < 2 ? even_ticks() : out;
    }
    std::vector<std::pair<double, bool>> even_ticks() const {
        std::vector<std::pair<double, bool>> out;
        const double from = std::pow(10, low), to = std::pow(10, high);
        const double least = (to - from) / 5, power = std::pow(10, std::floor(std::log10(least)));
        double step = 10 * power;
        for (const int m : {5, 2, 1})
            if (m * power >= least)
                step = m * power;
        for (double at = std::ceil(from / step) * step; at <= to; at += step)
            out.emplace_back(at, true);
        return out;
    }
};

/// A name of several settings on lines of its own, each as long as there is room for.
std::vector<std::string> legend_lines(std::string_view name) {
    constexpr std::size_t most = 30;
    std::vector<std::string> lines;
    while (name.size() > most) {
        const std::size_t comma = name.rfind(", ", most - 1);
        if (comma == std::string_view::npos) {
            lines.push_back(cut(name, most));
            return lines;
        }
        lines.emplace_back(name.substr(0, comma + 1));
        name.remove_prefix(comma + 2);
    }
    lines.emplace_back(name);
    return lines;
}

std::string tick_text(double value) {
    return value >= 1e-3 && value < 1e4 ? fmt::format("{:.4g}", value) : fmt::format("{:.3g}", value);
}

bool is_shown(const ScatterChart::Mark& m) {
    return m.x > 0 && m.y > 0 && std::isfinite(m.x) && std::isfinite(m.y);
}

} // namespace

bool ScatterChart::empty() const {
    return std::none_of(series.begin(), series.end(), [](const Series& s) {
        return std::any_of(s.marks.begin(), s.marks.end(), is_shown);
    });
}

Svg ScatterChart::drawing() const {
    Span xs, ys;
    for (const Series& s : series)
        for (const Mark& m : s.marks)
            if (is_shown(m)) {
                for (const double x : {m.x, m.x_low, m.x_high})
                    xs.take(x);
                for (const double y : {m.y, m.y_low, m.y_high})
                    ys.take(y);
            }
    xs.widen();
    ys.widen();
    const double x0 = left, x1 = width - right, y0 = top, y1 = height - bottom;
    const auto sx = [&](double x) { return xs(x, x0, x1); };
    const auto sy = [&](double y) { return ys(y, y1, y0); };
    Svg out(width, height);
    for (const auto& [at, named] : xs.ticks()) {
        out.line(sx(at), y0, sx(at), y1, named ? grid : faint);
        if (named)
            out.text(sx(at), y1 + 15, tick_text(at), Svg::Anchor::middle, 11);
    }
    for (const auto& [at, named] : ys.ticks()) {
        out.line(x0, sy(at), x1, sy(at), named ? grid : faint);
        if (named)
            out.text(x0 - 6, sy(at) + 4, tick_text(at), Svg::Anchor::end, 11);
    }
    out.text((x0 + x1) / 2, y1 + 34, x_label, Svg::Anchor::middle);
    out.text(16, (y0 + y1) / 2, y_label, Svg::Anchor::middle, 12, -90);
    std::vector<std::pair<double, double>> steps;
    for (const auto& [x, y] : front) {
        if (!steps.empty())
            steps.emplace_back(sx(x), steps.back().second);
        steps.emplace_back(sx(x), sy(y));
    }
    out.polyline(steps, front_colour);
    double legend = top;
    for (std::size_t i = 0; i < series.size(); ++i) {
        std::vector<std::pair<double, double>> line;
        for (const Mark& m : series[i].marks)
            if (is_shown(m))
                line.emplace_back(sx(m.x), sy(m.y));
        if (line.size() > 1)
            out.polyline(line, colour(i), series[i].dashed);
        for (const Mark& m : series[i].marks) {
            if (!is_shown(m))
                continue;
            if (m.x_low > 0 && m.x_high > m.x_low)
                out.line(sx(m.x_low), sy(m.y), sx(m.x_high), sy(m.y), colour(i));
            if (m.y_high > m.y_low)
                out.line(sx(m.x), sy(std::max(m.y_low, 1e-300)), sx(m.x), sy(m.y_high), colour(i));
            out.circle(sx(m.x), sy(m.y), 4, m.filled ? colour(i) : "white", colour(i), m.name);
        }
        out.rectangle(x1 + 14, legend, 11, 11, colour(i));
        for (const std::string& text : legend_lines(series[i].name)) {
            out.text(x1 + 30, legend + 10, text, Svg::Anchor::start, 11);
            legend += 13;
        }
        legend += 4;
    }
    out.line(x0, y1, x1, y1, ink);
    out.line(x0, y0, x0, y1, ink);
    return out;
}

} // namespace analysis
