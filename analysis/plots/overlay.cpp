#include "analysis/plots/overlay.h"

#include "analysis/plots/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace analysis {
namespace {

using Rgb = std::array<double, 3>;

/// In [0, 1], from cold to hot: hues of about the same strength, so that the grey below stays seen.
Rgb heat(double part) {
    constexpr std::array<Rgb, 5> stops = {
        {{0.10, 0.20, 0.85}, {0.00, 0.65, 0.80}, {0.10, 0.75, 0.20}, {0.95, 0.80, 0.10}, {0.90, 0.10, 0.05}}};
    const double at = std::clamp(part, 0.0, 1.0) * (stops.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    Rgb out{};
    for (std::size_t c = 0; c < 3; ++c)
        out[c] =
            stops[below][c] + (stops[below + 1][c] - stops[below][c]) * (at - static_cast<double>(below));
    return out;
}

/// IEC 61966-2-1.
double srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

bool shown(double value, bool logarithmic) {
    return std::isfinite(value) && (!logarithmic || value > 0);
}

double part_of(double value, const OverlayScale& scale) {
    const auto along = [&](double v) { return scale.logarithmic ? std::log(v) : v; };
    const double span = along(scale.high) - along(scale.low);
    return span > 0 ? std::clamp((along(value) - along(scale.low)) / span, 0.0, 1.0) : 1;
}

} // namespace

OverlayScale scale_of(const std::vector<double>& values, bool logarithmic) {
    OverlayScale out{0, 1, logarithmic};
    bool any = false;
    for (const double v : values)
        if (shown(v, logarithmic)) {
            out.low = any ? std::min(out.low, v) : v;
            out.high = any ? std::max(out.high, v) : v;
            any = true;
        }
    if (!any && logarithmic)
        out.low = 1;
    return out;
}

Pixels overlaid(const LinearImage& picture, const std::vector<double>& values, const OverlayScale& scale) {
    Pixels out{static_cast<std::size_t>(picture.width), static_cast<std::size_t>(picture.height), {}};
    out.rgb.reserve(3 * picture.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        // Luminance by Rec. 709; NaN is black.
        const double light =
            0.2126 * picture.planes[0][i] + 0.7152 * picture.planes[1][i] + 0.0722 * picture.planes[2][i];
        const double grey = std::isnan(light) ? 0 : srgb(light);
        Rgb rgb = {grey, grey, grey};
        if (shown(values[i], scale.logarithmic)) {
            const Rgb tint = heat(part_of(values[i], scale));
            for (std::size_t c = 0; c < 3; ++c)
                rgb[c] = 0.65 * tint[c] * (0.35 + 0.65 * grey) + 0.35 * grey;
        }
        for (const double c : rgb)
            out.rgb.push_back(static_cast<std::uint8_t>(std::lround(255 * c)));
    }
    return out;
}

std::string overlay_svg(const Pixels& pixels, const OverlayScale& scale, const std::string& name) {
    const double times =
        std::max(1.0, std::floor(640 / static_cast<double>(std::max<std::size_t>(1, pixels.width))));
    const double width = times * static_cast<double>(pixels.width),
                 height = times * static_cast<double>(pixels.height);
    Svg svg(std::max(width, 420.0) + 20, height + 76);
    svg.image(10, 10, width, height, data_uri(png_bytes(pixels)));
    constexpr std::size_t steps = 64;
    for (std::size_t i = 0; i < steps; ++i) {
        const Rgb rgb = heat(static_cast<double>(i) / (steps - 1));
        svg.rectangle(10 + static_cast<double>(i) * 4, height + 22, 4.2, 14,
                      fmt::format("#{:02x}{:02x}{:02x}", std::lround(255 * rgb[0]), std::lround(255 * rgb[1]),
                                  std::lround(255 * rgb[2])));
    }
    svg.text(10, height + 54, short_text(scale.low, Unit::plain), Svg::Anchor::start, 11);
    svg.text(10 + 4 * steps, height + 54, short_text(scale.high, Unit::plain), Svg::Anchor::end, 11);
    svg.text(20 + 4 * steps, height + 33, name + (scale.logarithmic ? ", logarithmic" : ""),
             Svg::Anchor::start, 12);
    return svg.str();
}

} // namespace analysis
