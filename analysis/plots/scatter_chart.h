// Points of two figures with their spreads, both axes logarithmic: what is gained for what is paid.
#pragma once

#include "analysis/plots/chart.h"

#include <string>
#include <vector>

namespace analysis {

struct ScatterChart {
    struct Mark {
        double x = 0, y = 0;                                 // above 0, else the mark is left out
        double x_low = 0, x_high = 0, y_low = 0, y_high = 0; // of the runs
        bool filled = true;                                  // else a ring
        std::string name;                                    // shown where a pointer rests
    };
    struct Series {
        std::string name;
        std::vector<Mark> marks; // joined by a line in this order
        bool dashed = false;
    };
    std::string x_label, y_label;
    std::vector<Series> series; // in the order of colours
    /// A grey line below the marks, steps from one to the next, x rising: the best that is had for so much.
    std::vector<std::pair<double, double>> front;

    /// Whether there is anything to show.
    bool empty() const;
    /// 860 pixels wide, 480 high.
    Svg drawing() const;
};

} // namespace analysis
