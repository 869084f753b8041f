// What `razor study`, `razor-sim study` and `razor-sim sweep` have in common: options, the order of things,
// what is told.
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
    analysis::Views views;            // of studies that ask for none
    std::vector<std::string> remarks; // for the page: what figures mean
    /// As analysis::RunOptions has it, of points and of what they are compared with.
    std::function<std::string(const analysis::Point& point)> changed{};

    /// The vocabulary's figures are these.
    void name_figures() {
        for (const analysis::Figure& figure : figures)
            vocabulary.figures.push_back(figure.name);
    }
};

/// What is to be measured before others, and how: references, which have results as points have.
struct StudyStage {
    std::vector<analysis::Point> points;
    analysis::Measure measure;
    bool shared = false; // by all parts of a study
};

/// What --help says at its end.
inline constexpr const char* study_exit_codes =
    "Exit codes: 0 where anything was measured, even if some points failed (the summary says how many); 1 "
    "where all failed; 2 for a mistake in the command or its files; 130 where it was interrupted.";

/// What the program's figures allow.
enum class StudyKind {
    timed, // times of the host are among them: a point at a time
    sweep  // none depends on the host: several points at a time, and steps by themselves for clusters
};

class StudyOptions {
public:
    /// Adds options to a subcommand; the object must outlive the parsing.
    void add_to(CLI::App& command, StudyKind kind = StudyKind::timed);

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
    int jobs() const;
    bool wants(const char* step) const;
    void add_steps(CLI::App& command);
    void print_plan(const analysis::Study& study, const std::vector<analysis::Point>& points,
                    const analysis::Store& store) const;
    /// Returns the exit code: 1 where points failed and none was measured.
    int collect(const StudyProgram& program, const analysis::Study& study,
                const std::vector<analysis::Point>& points, const analysis::Store& store) const;

    std::string file_, step_, folder_, part_, point_, jobs_;
    bool timed_ = true;
    bool full_ = false, plan_ = false, collect_ = false, again_ = false, quiet_ = false;
};

} // namespace razor
