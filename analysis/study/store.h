// The folder of a study: points/NAME.toml, a point's body; results/NAME.json, what was measured. Files appear
// whole or not at all, and a point is done when its result is there: a study that was stopped goes on where
// it was, no lock is needed, and two in one folder do no harm but that they may measure a point twice.
#pragma once

#include "analysis/study/point.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace analysis {

/// Measured values by figure, each of every run.
using Samples = std::map<std::string, std::vector<double>>;

struct Result {
    std::string failed;             // why nothing was measured; empty: it was
    Samples values;                 // the same whenever and wherever they are measured
    Samples host;                   // times and whatever else depends on the host
    nlohmann::ordered_json details; // what else the program says of the point, the same everywhere
};

/// A text file, whole or not there. Throws StudyError.
void write_whole(const std::filesystem::path& file, std::string_view text);

class Store {
public:
    /// Makes nothing, so that reading from a folder that is not there leaves none.
    explicit Store(std::filesystem::path folder);

    const std::filesystem::path& folder() const { return folder_; }
    /// Makes the folders. Throws StudyError.
    void make_folders() const;
    bool is_done(const Point& point) const;
    /// Throws StudyError.
    void write_point(const Point& point) const;
    /// `program`: what measured it, and of which version. Throws StudyError.
    void write_result(const Point& point, const Result& result, std::string_view program) const;
    /// Of a point that is done. Throws StudyError where the file is damaged, or is of another point.
    std::optional<Result> read_result(const Point& point) const;
    void forget_result(const Point& point) const;

    std::filesystem::path result_file(const Point& point) const;

private:
    std::filesystem::path folder_;
};

} // namespace analysis
