// What `razor study` and `razor-sim study` have in common: options, the order of things, what is told.
#pragma once

#include "analysis/study/collect.h"
#include "analysis/study/run.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace razor {

/// A program that measures.
struct StudyProgram {
    std::string name; // and version, for results: "razor 0.1.0"
    analysis::Vocabulary vocabulary;
    std::vector<analysis::Figure> figures;
    std::vector<analysis::PlotRequest> plots; // of studies that name none
    std::vector<std::string> remarks;         // for the page: what figures mean
};

/// What is to be measured before others, and how: references, which have results as points have.
struct StudyStage {
    std::vector<analysis::Point> points;
    analysis::Measure measure;
    bool shared = false; // by all parts of a study
};

class StudyOptions {
public:
    /// Adds options to a subcommand; the object must outlive the parsing.
    void add_to(CLI::App& command);

    /// The folder of the study's file, from which files are named.
    std::filesystem::path base() const;

    /// The study. Throws UserError.
    analysis::Study read(const StudyProgram& program) const;
    /// Measures what is missing, stage after stage, and collects the last one's points. `stages(missing)`
    /// makes them of the points that are to be measured now. Returns the exit code. Throws UserError.
    int run(const StudyProgram& program, const analysis::Study& study,
            const std::vector<analysis::Point>& points, const analysis::Store& store,
            const std::function<std::vector<StudyStage>(const std::vector<analysis::Point>& missing)>& stages)
        const;
    /// Where results go.
    std::filesystem::path folder() const;

private:
    /// N and M of --part N/M.
    std::pair<int, int> part() const;
    void collect(const StudyProgram& program, const analysis::Study& study,
                 const std::vector<analysis::Point>& points, const analysis::Store& store) const;

    std::string file_, folder_, part_;
    bool full_ = false, plan_ = false, collect_ = false, again_ = false, quiet_ = false;
};

} // namespace razor
