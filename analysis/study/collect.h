// What the results of a study say together: a table, the Pareto front of each plot, plots, a page.
#pragma once

#include "analysis/plots/scatter_chart.h"
#include "analysis/study/pareto.h"
#include "analysis/study/point.h"
#include "analysis/study/store.h"
#include "analysis/traces/table.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace analysis {

/// Of a figure that results hold, for people.
struct Figure {
    std::string name, label; // "seconds", "time of a frame, s"
};

struct CollectedPoint {
    Point point;
    std::optional<Result> result; // nothing: not measured yet

    /// Values of the figure, of all runs; empty where it has none.
    std::vector<double> samples(const std::string& figure) const;
    bool measured() const { return result && result->failed.empty(); }
};

/// A plot and what it says of each point.
struct CollectedPlot {
    PlotRequest request;
    ScatterChart chart;
    std::vector<Standing> standing; // of each point
};

struct Collection {
    std::string title;
    std::vector<std::string> knobs;
    std::vector<Figure> figures; // those that some result has
    std::vector<CollectedPoint> points;
    std::vector<CollectedPlot> plots;
    std::size_t missing = 0, failed = 0;

    /// A row a point: knobs, then of each figure the median, the least and the greatest, then its standing in
    /// each plot; or why it failed.
    Table table() const;
    std::string json() const;
    /// A page of HTML that stands alone. `remarks`: paragraphs for above the plots.
    std::string html(const std::vector<std::string>& remarks) const;
};

/// Reads what is done. `figures`: all that the program knows, in its order. `plots`: where the study names
/// none. Throws StudyError.
Collection collect(const Study& study, const std::vector<Point>& points, const Store& store,
                   const std::vector<Figure>& figures, const std::vector<PlotRequest>& plots);

/// Into the store's folder: study.csv, study.json, study.html, and for each plot NAME.svg and NAME.png.
/// Returns what was written. Throws StudyError.
std::vector<std::string> write_collection(const Collection& collection, const Store& store,
                                          const std::vector<std::string>& remarks);

} // namespace analysis
