// Runs of the machine at the points of a study, beside runs of its reference.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/run.h"
#include "razor/program/study/study_options.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sim {

/// Settings, figures and plots that `razor-sim study` knows.
razor::StudyProgram machine_study_program();
/// ... `razor-sim sweep`.
razor::StudyProgram sweep_program();
/// Settings besides those of scenes and of the machine's file.
const std::vector<std::string_view>& run_keys();

class MachineStudy {
public:
    /// `folder`: where files are named from. `program`: this one's file, which is run for each point.
    MachineStudy(const analysis::Study& study, std::filesystem::path folder, std::string program,
                 const std::atomic<bool>& stop);

    /// A point's body, with the whole machine and scene. Throws std::exception where they do not fit.
    std::string body(const analysis::Point& point) const;
    /// What these points are compared with, each once; none where the study names no reference.
    std::vector<analysis::Point> references(const std::vector<analysis::Point>& points) const;
    /// Figures of one point's runs, of all its seeds. Throws razor::UserError, analysis::Stopped.
    analysis::Result measure_reference(const analysis::Point& reference) const;
    /// ... beside its reference's, which has been measured.
    analysis::Result measure(const analysis::Point& point, const analysis::Store& store) const;

private:
    /// What is known of a scene of these settings.
    struct Described {
        std::string digest;
        analysis::Settings settings; // all of them
    };
    const Described& described(const analysis::Settings& settings) const;
    /// `razor-sim run` of these settings. With seeds, of that one.
    std::vector<std::string> command(const analysis::Settings& settings, int seed,
                                     const std::string& json) const;
    void run(const std::vector<std::string>& words, const std::filesystem::path& log) const;
    std::string own_body(const analysis::Settings& settings, int seeds) const;
    analysis::Point reference_of(const analysis::Point& point) const;
    analysis::Result run_all(const analysis::Settings& settings, int seeds) const;

    const analysis::Study& study_;
    std::filesystem::path folder_;
    std::string program_;
    const std::atomic<bool>& stop_;
    mutable std::map<std::string, Described> described_; // by the settings' text: scenes take long to read
};

} // namespace sim
