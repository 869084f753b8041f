// What a study's points say beside each other: who is best by a figure, what each setting does to it, and how
// it runs along one.
#pragma once

#include "analysis/plots/chart.h"
#include "analysis/plots/ratio_chart.h"
#include "analysis/study/collected_point.h"
#include "analysis/study/ranking.h"
#include "analysis/study/sensitivity.h"

#include <string>
#include <vector>

namespace analysis {

/// The figure's runs of each point; for ranking by what is better the more, negated.
std::vector<Spread> spreads_of(const std::vector<CollectedPoint>& points, const Figure& figure);

struct Ranking {
    Figure figure;
    std::vector<Place> places;       // of each point
    std::vector<std::size_t> order;  // points with a place, the best median first
    std::vector<Sensitivity> ratios; // of each knob

    RatioChart chart() const;
    /// In a sentence or two: who is best, as far as that is known.
    std::string verdict(const std::vector<CollectedPoint>& points,
                        const std::vector<std::string>& knobs) const;
};
Ranking ranking_of(const std::vector<CollectedPoint>& points, const std::vector<std::string>& knobs,
                   const Figure& figure);
/// "2", or "2-5"; a dash for none.
std::string place_text(const Place& place);

struct Curve {
    CurveRequest request;
    LineChart chart; // with the range of the runs; without series where nothing was measured
};
Curve curve_of(const std::vector<CollectedPoint>& points, const std::vector<std::string>& knobs,
               const CurveRequest& request, const std::string& label);
/// Knobs that have at least three values, all of them numbers: those worth a curve.
std::vector<std::string> curve_knobs(const std::vector<CollectedPoint>& points,
                                     const std::vector<std::string>& knobs);

} // namespace analysis
