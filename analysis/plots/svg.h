// A drawing as SVG 1.1 text: shapes with numbers rounded to hundredths, texts escaped. Equal drawings are
// equal bytes, and stand in a page as they are or in a file alone.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace analysis {

/// `& < > "` as entities; bytes that are no text (control characters) as question marks.
std::string escaped(std::string_view text);
/// A text of at most so many bytes: longer ones end in three dots, behind a whole character of UTF-8.
std::string cut(std::string_view text, std::size_t most);
/// A file of an SVG element.
std::string svg_file(const std::string& element);

/// x to the right, y down, in pixels.
class Svg {
public:
    Svg(double width, double height) : width_(width), height_(height) {}

    enum class Anchor { start, middle, end };
    void line(double x1, double y1, double x2, double y2, std::string_view colour, double width = 1);
    /// With what is shown where a pointer rests.
    void rectangle(double x, double y, double width, double height, std::string_view colour,
                   std::string_view title = {});
    /// Likewise with a title.
    void circle(double x, double y, double radius, std::string_view fill, std::string_view edge,
                std::string_view title = {});
    void polyline(const std::vector<std::pair<double, double>>& points, std::string_view colour,
                  bool dashed = false);
    /// Lines of a width of their own, likewise with a title.
    void path(const std::vector<std::pair<double, double>>& points, std::string_view colour, double width,
              std::string_view title = {});
    void polygon(const std::vector<std::pair<double, double>>& points, std::string_view colour,
                 double opacity);
    void text(double x, double y, std::string_view text, Anchor anchor = Anchor::start, double size = 12,
              double degrees = 0);
    /// A picture as a data URI, its pixels as they are.
    void image(double x, double y, double width, double height, std::string_view uri);

    /// What was drawn, in order, for other forms than text.
    struct Shape {
        enum Kind { area, line, disk, text_line, picture } kind = area;
        std::vector<std::pair<double, double>> points{}; // corners; a disk's middle; where a text stands
        std::string colour{};
        double size = 1; // an area's opacity, a line's width, a disk's radius, a text's size
        bool dashed = false;
        std::string text{};
        Anchor anchor = Anchor::start;
        double degrees = 0;
    };
    const std::vector<Shape>& shapes() const { return shapes_; }
    double width() const { return width_; }
    double height() const { return height_; }

    /// The element.
    std::string str() const;
    /// With what a file begins with.
    std::string file() const;

private:
    double width_, height_;
    std::string body_;
    std::vector<Shape> shapes_;
};

/// Colours that stay apart for most who see few (Okabe and Ito 2008, and darker ones behind them), in turn.
std::string_view colour(std::size_t number);

} // namespace analysis
