#include "analysis/plots/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace analysis {
namespace {

constexpr double stroke_width = 1.6;

/// The shortest text of a number of hundredths.
std::string number(double x) {
    std::string out = fmt::format("{:.2f}", std::isfinite(x) ? x : 0);
    out.erase(out.find_last_not_of('0') + 1);
    if (out.ends_with('.'))
        out.pop_back();
    return out == "-0" ? "0" : out;
}

std::string list(const std::vector<std::pair<double, double>>& points) {
    std::string out;
    for (const auto& [x, y] : points) {
        if (!out.empty())
            out += ' ';
        out += number(x);
        out += ',';
        out += number(y);
    }
    return out;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text)
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
        }
    return out;
}

std::string cut(std::string_view text, std::size_t most) {
    if (text.size() <= most)
        return std::string(text);
    std::size_t end = most - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) // goes on with a character
        --end;
    return std::string(text.substr(0, end)) + "...";
}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view colour, double width) {
    shapes_.push_back({Shape::line, {{x1, y1}, {x2, y2}}, std::string(colour), width});
    body_ +=
        fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
                    number(x1), number(y1), number(x2), number(y2), colour, number(width));
}

void Svg::rectangle(double x, double y, double width, double height, std::string_view colour,
                    std::string_view title) {
    shapes_.push_back({Shape::area,
                       {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}},
                       std::string(colour)});
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"", number(x),
                         number(y), number(width), number(height), colour);
    body_ += title.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", escaped(title));
}

void Svg::circle(double x, double y, double radius, std::string_view fill, std::string_view edge,
                 std::string_view title) {
    shapes_.push_back({Shape::disk, {{x, y}}, std::string(edge), radius + stroke_width / 2});
    shapes_.push_back({Shape::disk, {{x, y}}, std::string(fill), std::max(0.0, radius - stroke_width / 2)});
    body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"",
                         number(x), number(y), number(radius), fill, edge, stroke_width);
    body_ += title.empty() ? "/>\n" : fmt::format("><title>{}</title></circle>\n", escaped(title));
}

void Svg::polyline(const std::vector<std::pair<double, double>>& points, std::string_view colour,
                   bool dashed) {
    shapes_.push_back({Shape::line, points, std::string(colour), stroke_width, dashed});
    body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n",
                         list(points), colour, stroke_width, dashed ? " stroke-dasharray=\"5 3\"" : "");
}

void Svg::path(const std::vector<std::pair<double, double>>& points, std::string_view colour, double width,
               std::string_view title) {
    shapes_.push_back({Shape::line, points, std::string(colour), width});
    body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
                         list(points), colour, number(width));
    body_ += title.empty() ? "/>\n" : fmt::format("><title>{}</title></polyline>\n", escaped(title));
}

void Svg::polygon(const std::vector<std::pair<double, double>>& points, std::string_view colour,
                  double opacity) {
    shapes_.push_back({Shape::area, points, std::string(colour), opacity});
    body_ += fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{}\"/>\n", list(points), colour,
                         number(opacity));
}

void Svg::text(double x, double y, std::string_view text, Anchor anchor, double size, double degrees) {
    shapes_.push_back({Shape::text_line, {{x, y}}, {}, size, false, std::string(text), anchor, degrees});
    const char* where = anchor == Anchor::start    ? ""
                        : anchor == Anchor::middle ? " text-anchor=\"middle\""
                                                   : " text-anchor=\"end\"";
    const std::string turned =
        degrees == 0 ? ""
                     : fmt::format(" transform=\"rotate({} {} {})\"", number(degrees), number(x), number(y));
    body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"{}{}>{}</text>\n", number(x), number(y),
                         number(size), where, turned, escaped(text));
}

void Svg::image(double x, double y, double width, double height, std::string_view uri) {
    shapes_.push_back({Shape::picture});
    body_ += fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
                         "style=\"image-rendering:pixelated\" xlink:href=\"{}\"/>\n",
                         number(x), number(y), number(width), number(height), uri);
}

std::string Svg::str() const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
        "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n{2}</svg>\n",
        number(width_), number(height_), body_);
}

std::string svg_file(const std::string& element) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + element;
}

std::string Svg::file() const {
    return svg_file(str());
}

std::string_view colour(std::size_t number) {
    constexpr std::array<std::string_view, 14> all = {"#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7",
                                                      "#56b4e9", "#8c6d00", "#5b3a99", "#7f7f7f", "#003f5c",
                                                      "#a05195", "#2f4b7c", "#665191", "#b22222"};
    return all[number % all.size()];
}

} // namespace analysis
