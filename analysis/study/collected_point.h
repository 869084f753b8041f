// A point with its result, as tables and drawings are made of it.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/store.h"

#include <optional>
#include <string>
#include <vector>

namespace analysis {

/// Of a figure that results hold, for people.
struct Figure {
    std::string name, label;     // "seconds", "time of a frame, s"
    bool more_is_better = false; // else less is
};

struct CollectedPoint {
    Point point;
    std::optional<Result> result; // nothing: not measured yet

    /// Values of the figure, of all runs; empty where it has none.
    std::vector<double> samples(const std::string& figure) const;
    /// What the program says in words; a dash where it says nothing.
    std::string word(const std::string& name) const;
    bool measured() const { return result && result->failed.empty(); }
};

/// "lod recursive, samples 4": of those of the knobs that are chosen; of a rival first its name.
std::string settings_text(const Point& point, const std::vector<std::string>& knobs,
                          const std::vector<std::string>& chosen);
/// Of all knobs.
std::string settings_text(const Point& point, const std::vector<std::string>& knobs);

} // namespace analysis
