// Lines over an axis, and stacked bars: what traces' figures look like, as SVG.
#pragma once

#include "analysis/plots/svg.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace analysis {

/// Numbers at an axis in the field's short forms: "32 KiB", "4 M".
enum class Unit { plain, bytes, percent };
std::string short_text(double value, Unit unit);
/// Values at which an axis from `low` to `high` is marked: multiples of 1, 2 or 5 times a power of ten (of
/// bytes, of two), or, if it is logarithmic, powers of ten, or of two where these are few; at most about
/// `most`.
std::vector<double> ticks(double low, double high, bool logarithmic, Unit unit, std::size_t most);

struct Axis {
    std::string label;
    Unit unit = Unit::plain;
    bool logarithmic = false; // all values are above 0
};

struct LineChart {
    struct Series {
        std::string name;
        std::vector<std::pair<double, double>> points; // ascending x
        std::vector<double> errors;                    // of y, or empty
        bool dashed = false;
    };
    Axis x, y;                  // y from 0
    std::vector<Series> series; // in the order of colours
    bool steps = false;         // a point holds until the next one's x
    /// 860 pixels wide, 340 high.
    Svg drawing() const;
    std::string svg() const { return drawing().str(); }
};

struct BarChart {
    struct Bar {
        std::string name;
        std::vector<double> parts; // as `parts` of the chart, at least 0
    };
    Axis x; // linear, from 0
    std::vector<std::string> parts;
    std::vector<Bar> bars; // from the top
    /// 860 pixels wide, as high as it has bars.
    std::string svg() const;
};

} // namespace analysis
