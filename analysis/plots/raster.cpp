#include "analysis/plots/raster.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace analysis {
namespace {

using Point = std::pair<double, double>;
using Points = std::vector<Point>;

constexpr int samples = 4; // a pixel and direction

std::array<double, 3> rgb_of(std::string_view colour) {
    if (colour == "white")
        return {255, 255, 255};
    if (colour.size() != 7 || colour[0] != '#')
        throw std::invalid_argument("a drawing has a colour that is not #rrggbb");
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        unsigned value = 0;
        std::from_chars(colour.data() + 1 + 2 * c, colour.data() + 3 + 2 * c, value, 16);
        out[c] = value;
    }
    return out;
}

class Raster {
public:
    Raster(double width, double height, double scale) : scale_(scale) {
        pixels_.width = static_cast<std::size_t>(std::ceil(width * scale));
        pixels_.height = static_cast<std::size_t>(std::ceil(height * scale));
        pixels_.rgb.assign(3 * pixels_.width * pixels_.height, 255);
        covered_.resize(pixels_.width);
    }

    /// What an odd number of the polygon's edges lie to the left of.
    void fill(const Points& polygon, std::string_view colour, double opacity) {
        const auto rgb = rgb_of(colour);
        double low = 1e300, high = -1e300;
        for (const auto& [x, y] : polygon) {
            low = std::min(low, y * scale_);
            high = std::max(high, y * scale_);
        }
        const auto height = static_cast<double>(pixels_.height);
        const auto first = static_cast<std::size_t>(std::clamp(std::floor(low), 0.0, height));
        const auto last = static_cast<std::size_t>(std::clamp(std::ceil(high), 0.0, height));
        for (std::size_t row = first; row < last; ++row) {
            std::fill(covered_.begin(), covered_.end(), 0.0);
            for (int s = 0; s < samples; ++s)
                cover(polygon, static_cast<double>(row) + (s + 0.5) / samples);
            for (std::size_t x = 0; x < pixels_.width; ++x)
                if (covered_[x] > 0)
                    blend(row * pixels_.width + x, rgb, opacity * covered_[x]);
        }
    }

    Pixels take() { return std::move(pixels_); }

private:
    /// Adds what a line of samples has inside.
    void cover(const Points& polygon, double y) {
        std::vector<double> crossings;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto [ax, ay] = polygon[i];
            const auto [bx, by] = polygon[(i + 1) % polygon.size()];
            const double y0 = ay * scale_, y1 = by * scale_;
            if ((y0 <= y) != (y1 <= y))
                crossings.push_back(scale_ * (ax + (bx - ax) * (y - y0) / (y1 - y0)));
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            const auto sample = [&](double x) {
                return static_cast<long>(std::clamp(std::ceil(x * samples - 0.5), 0.0,
                                                    static_cast<double>(samples * pixels_.width)));
            };
            for (long at = sample(crossings[i]); at < sample(crossings[i + 1]); ++at)
                covered_[static_cast<std::size_t>(at / samples)] += 1.0 / (samples * samples);
        }
    }
    void blend(std::size_t pixel, const std::array<double, 3>& rgb, double part) {
        for (std::size_t c = 0; c < 3; ++c) {
            std::uint8_t& value = pixels_.rgb[3 * pixel + c];
            value = static_cast<std::uint8_t>(std::lround(value + (rgb[c] - value) * std::min(part, 1.0)));
        }
    }

    Pixels pixels_;
    double scale_;
    std::vector<double> covered_; // of a row: the part of each pixel
};

void stroke(Raster& raster, const Point& a, const Point& b, double width, std::string_view colour) {
    const double dx = b.first - a.first, dy = b.second - a.second, length = std::hypot(dx, dy);
    if (length == 0)
        return;
    const double nx = -dy / length * width / 2, ny = dx / length * width / 2;
    raster.fill({{a.first + nx, a.second + ny},
                 {b.first + nx, b.second + ny},
                 {b.first - nx, b.second - ny},
                 {a.first - nx, a.second - ny}},
                colour, 1);
}

/// As of stroke-dasharray "5 3".
void dashes(Raster& raster, const Points& line, double width, std::string_view colour) {
    constexpr double on = 5, off = 3;
    double at = 0; // along the pattern
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const auto [ax, ay] = line[i];
        const auto [bx, by] = line[i + 1];
        const double length = std::hypot(bx - ax, by - ay);
        for (double from = 0; from < length;) {
            const double left = at < on ? on - at : on + off - at;
            const double to = std::min(length, from + left);
            if (at < on)
                stroke(raster, {ax + (bx - ax) * from / length, ay + (by - ay) * from / length},
                       {ax + (bx - ax) * to / length, ay + (by - ay) * to / length}, width, colour);
            at = std::fmod(at + (to - from), on + off);
            if (to - from < 1e-9)
                at = std::fmod(at + 1e-9, on + off);
            from = std::max(to, from + 1e-9);
        }
    }
}

void write(Raster& raster, const Svg::Shape& shape) {
    std::string text = shape.text;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    struct Vertex {
        float x, y, z;
        unsigned char colour[4];
    };
    std::vector<Vertex> vertices(text.size() * 4 * 40 + 4);
    const int quads = stb_easy_font_print(0, 0, text.data(), nullptr, vertices.data(),
                                          static_cast<int>(vertices.size() * sizeof(Vertex)));
    // Its capitals are 7 high above a base line at 7; those of other fonts 0.72 of their size.
    const double scale = 0.72 * shape.size / 7, base = 7;
    const double whole = stb_easy_font_width(text.data());
    const double before = shape.anchor == Svg::Anchor::start    ? 0
                          : shape.anchor == Svg::Anchor::middle ? whole / 2
                                                                : whole;
    const double turn = shape.degrees * std::numbers::pi / 180, c = std::cos(turn), s = std::sin(turn);
    for (int q = 0; q < quads; ++q) {
        Points polygon;
        for (int v = 0; v < 4; ++v) {
            const Vertex& at = vertices[static_cast<std::size_t>(4 * q + v)];
            const double x = (at.x - before) * scale, y = (at.y - base) * scale;
            polygon.emplace_back(shape.points[0].first + c * x - s * y,
                                 shape.points[0].second + s * x + c * y);
        }
        raster.fill(polygon, "#000000", 1);
    }
}

Points ring(const Point& middle, double radius) {
    constexpr int corners = 24;
    Points out;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        out.emplace_back(middle.first + radius * std::cos(angle), middle.second + radius * std::sin(angle));
    }
    return out;
}

} // namespace

Pixels rasterised(const Svg& drawing, double scale) {
    Raster raster(drawing.width(), drawing.height(), scale);
    for (const Svg::Shape& shape : drawing.shapes())
        switch (shape.kind) {
        case Svg::Shape::area:
            raster.fill(shape.points, shape.colour, shape.size);
            break;
        case Svg::Shape::line:
            if (shape.dashed)
                dashes(raster, shape.points, shape.size, shape.colour);
            else
                for (std::size_t i = 0; i + 1 < shape.points.size(); ++i)
                    stroke(raster, shape.points[i], shape.points[i + 1], shape.size, shape.colour);
            break;
        case Svg::Shape::disk:
            raster.fill(ring(shape.points[0], shape.size), shape.colour, 1);
            break;
        case Svg::Shape::text_line:
            write(raster, shape);
            break;
        case Svg::Shape::picture:
            throw std::invalid_argument("a drawing with pictures is not made into pixels");
        }
    return raster.take();
}

} // namespace analysis
