#include "analysis/plots/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace analysis {
namespace {

constexpr double width = 860, left = 70, right = 190, top = 14, bottom = 46;
constexpr const char *ink = "#333333", *grid = "#dddddd";

/// From a range of values to one of pixels.
class Scale {
public:
    Scale(double low, double high, double from, double to, bool logarithmic)
        : logarithmic_(logarithmic), low_(along(low)), span_(along(high) - along(low)), from_(from), to_(to) {
    }
    double operator()(double value) const {
        const double part = span_ > 0 ? (along(value) - low_) / span_ : 0;
        return from_ + (to_ - from_) * std::clamp(part, 0.0, 1.0);
    }

private:
    double along(double value) const { return logarithmic_ ? std::log2(std::max(value, 1e-300)) : value; }
    bool logarithmic_;
    double low_, span_, from_, to_;
};

void legend(Svg& svg, const std::vector<std::string>& names, double x, double y) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        svg.rectangle(x, y + static_cast<double>(i) * 17, 11, 11, colour(i));
        svg.text(x + 16, y + static_cast<double>(i) * 17 + 10, cut(names[i], 26), Svg::Anchor::start, 11);
    }
}

void x_axis(Svg& svg, const Axis& axis, const Scale& scale, double low, double high, double y0, double y1) {
    for (const double at : ticks(low, high, axis.logarithmic, axis.unit, 9)) {
        svg.line(scale(at), y0, scale(at), y1, grid);
        svg.text(scale(at), y1 + 15, short_text(at, axis.unit), Svg::Anchor::middle, 11);
    }
    svg.text((scale(low) + scale(high)) / 2, y1 + 34, axis.label, Svg::Anchor::middle);
}

} // namespace

std::string short_text(double value, Unit unit) {
    if (unit == Unit::percent)
        return fmt::format("{:.4g} %", 100 * value);
    const double step = unit == Unit::bytes ? 1024 : 1000;
    constexpr const char* binary[] = {" B", " KiB", " MiB", " GiB", " TiB", " PiB", " EiB"};
    constexpr const char* decimal[] = {"", " k", " M", " G", " T", " P", " E"};
    std::size_t n = 0;
    for (; std::abs(value) >= step && n < 6; ++n)
        value /= step;
    return fmt::format("{:.4g}{}", value, unit == Unit::bytes ? binary[n] : decimal[n]);
}

std::vector<double> ticks(double low, double high, bool logarithmic, Unit unit, std::size_t most) {
    std::vector<double> out;
    if (!(high > low))
        return {low};
    if (logarithmic) {
        const double base = unit == Unit::bytes || high / low < 100 ? 2 : 10; // tens would be one or none
        const double first = std::ceil(std::log(low) / std::log(base) - 1e-9),
                     last = std::floor(std::log(high) / std::log(base) + 1e-9);
        const double step = std::max(1.0, std::ceil((last - first + 1) / static_cast<double>(most)));
        for (double e = first; e <= last; e += step)
            out.push_back(std::pow(base, e));
        return out;
    }
    const double least = (high - low) / static_cast<double>(most);
    double step = unit == Unit::bytes ? std::exp2(std::ceil(std::log2(least)))
                                      : std::pow(10, std::floor(std::log10(least)));
    for (const double factor : {2.0, 2.5, 2.0})
        if (unit != Unit::bytes && step < least)
            step *= factor;
    const double first = std::ceil(low / step);
    for (std::size_t i = 0; i <= 2 * most; ++i) {
        const double at = (first + static_cast<double>(i)) * step; // far from 0 maybe the same as before
        if (!(at <= high + 1e-6 * step))
            break;
        if (out.empty() || at > out.back())
            out.push_back(at);
    }
    return out;
}

Svg LineChart::drawing() const {
    constexpr double height = 340;
    double low = 0, high = 1, most = 0;
    bool any = false;
    for (const Series& s : series)
        for (std::size_t i = 0; i < s.points.size(); ++i) {
            const auto [px, py] = s.points[i];
            low = any ? std::min(low, px) : px;
            high = any ? std::max(high, px) : px;
            any = true;
            most = std::max(most, py + (s.errors.empty() ? 0 : s.errors[i]));
        }
    most = y.unit == Unit::percent ? std::min(1.0, most * 1.05) : most * 1.05;
    most = most > 0 ? most : 1;
    Svg out(width, height);
    const double y0 = top, y1 = height - bottom;
    const Scale sx(low, high, left, width - right, x.logarithmic), sy(0, most, y1, y0, false);
    for (const double at : ticks(0, most, false, y.unit, 6)) {
        out.line(left, sy(at), width - right, sy(at), grid);
        out.text(left - 6, sy(at) + 4, short_text(at, y.unit), Svg::Anchor::end, 11);
    }
    x_axis(out, x, sx, low, high, y0, y1);
    out.text(14, (y0 + y1) / 2, y.label, Svg::Anchor::middle, 12, -90);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < series.size(); ++i) {
        const Series& s = series[i];
        names.push_back(s.name);
        std::vector<std::pair<double, double>> line, band, back;
        for (std::size_t k = 0; k < s.points.size(); ++k) {
            const auto [px, py] = s.points[k];
            if (steps && k != 0)
                line.emplace_back(sx(px), line.back().second);
            line.emplace_back(sx(px), sy(py));
            if (!s.errors.empty()) {
                band.emplace_back(sx(px), sy(py + s.errors[k]));
                back.emplace_back(sx(px), sy(std::max(0.0, py - s.errors[k])));
            }
        }
        band.insert(band.end(), back.rbegin(), back.rend());
        if (!band.empty())
            out.polygon(band, colour(i), 0.2);
        out.polyline(line, colour(i), s.dashed);
    }
    out.line(left, y1, width - right, y1, ink);
    out.line(left, y0, left, y1, ink);
    legend(out, names, width - right + 14, top);
    return out;
}

std::string BarChart::svg() const {
    constexpr double row = 20, name_width = 150;
    const double rows = std::max<double>(static_cast<double>(bars.size()), static_cast<double>(parts.size()));
    const double y1 = top + row * rows, x0 = left + name_width - 40, x1 = width - right;
    double most = 0;
    for (const Bar& b : bars)
        most = std::max(most, std::accumulate(b.parts.begin(), b.parts.end(), 0.0));
    most = x.unit == Unit::percent ? std::min(1.0, most) : most;
    most = most > 0 ? most : 1;
    Svg out(width, y1 + bottom);
    const Scale sx(0, most, x0, x1, false);
    x_axis(out, x, sx, 0, most, top, y1);
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const double y0 = top + row * static_cast<double>(i);
        out.text(x0 - 6, y0 + 14, cut(bars[i].name, 30), Svg::Anchor::end, 11);
        double sum = 0;
        for (std::size_t p = 0; p < bars[i].parts.size(); ++p) {
            const double from = sx(sum), to = sx(sum += bars[i].parts[p]);
            if (bars[i].parts[p] > 0)
                out.rectangle(from, y0 + 3, to - from, row - 6, colour(p),
                              fmt::format("{}, {}: {}", bars[i].name, p < parts.size() ? parts[p] : "",
                                          short_text(bars[i].parts[p], x.unit)));
        }
    }
    out.line(x0, top, x0, y1, ink);
    if (parts.size() > 1)
        legend(out, parts, x1 + 14, top);
    return out.str();
}

} // namespace analysis
