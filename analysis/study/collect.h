// What the results of a study say together: a table, the Pareto front of each plot, plots, a page.
#pragma once

#include "analysis/plots/scatter_chart.h"
#include "analysis/study/collected_point.h"
#include "analysis/study/comparison.h"
#include "analysis/study/pareto.h"
#include "analysis/study/store.h"
#include "analysis/traces/table.h"

#include <string>
#include <vector>

namespace analysis {

/// What a program shows of its studies, where these do not ask for more.
struct Views {
    std::vector<PlotRequest> plots;
    std::vector<std::string> rank{};  // figures
    bool curves = false;              // the first of these over each knob of at least three numbers
    std::vector<std::string> words{}; // that results hold among their details, such as what limits a run
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
    std::vector<std::string> words; // likewise
    std::vector<CollectedPlot> plots;
    std::vector<Ranking> rankings;
    std::vector<Curve> curves;
    std::size_t missing = 0, failed = 0;

    /// A row a point: knobs, then of each figure the median, the least and the greatest, words, then its
    /// standing in each plot and its place in each ranking; or why it failed.
    Table table() const;
    std::string json() const;
    /// A page of HTML that stands alone. `remarks`: paragraphs for above the plots.
    std::string html(const std::vector<std::string>& remarks) const;
};

/// Reads what is done. `figures`: all that the program knows, in its order. Throws StudyError.
Collection collect(const Study& study, const std::vector<Point>& points, const Store& store,
                   const std::vector<Figure>& figures, const Views& views);

/// Into the store's folder: study.csv, study.json, study.html, and each drawing as NAME.svg and NAME.png.
/// Returns what was written. Throws StudyError.
std::vector<std::string> write_collection(const Collection& collection, const Store& store,
                                          const std::vector<std::string>& remarks);

} // namespace analysis
