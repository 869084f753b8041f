// Samples of traces at the points of a study, beside the exact curves of the same caches.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/run.h"
#include "razor/program/study/study_options.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace traces {

/// Settings, figures and plots that `razor-trace study` knows.
razor::StudyProgram trace_study_program();
/// What each setting means, a line each.
std::string trace_settings_text();

class TraceStudy {
public:
    /// `folder`: where traces are named from. Reads all traces once. Throws Error where there is none, or one
    /// that cannot be studied; analysis::Stopped.
    TraceStudy(const analysis::Study& study, std::filesystem::path folder, const std::atomic<bool>& stop);

    /// A point's body. Throws std::exception where its settings do not fit each other.
    std::string body(const analysis::Point& point) const;
    /// The exact curves that these points are compared with, each once.
    std::vector<analysis::Point> references(const std::vector<analysis::Point>& points) const;
    /// Throws Error, analysis::Stopped.
    analysis::Result measure_reference(const analysis::Point& reference) const;
    /// ... beside its reference's, which has been measured.
    analysis::Result measure(const analysis::Point& point, const analysis::Store& store) const;
    /// The point's trace, where it is no more what it was when the study began; else nothing. Throws
    /// analysis::Stopped.
    std::string changed(const analysis::Point& point) const;

private:
    struct Known {          // of a trace's file
        std::string digest; // of its bytes
        std::string stamp;  // while it is this, nobody has written there: large traces need not be read again
        std::uint64_t line_bytes = 64;
    };
    struct Run {                                                          // of a trace through an estimator
        std::vector<double> ratios;                                       // by size
        double seconds = 0, processor_seconds = 0, estimator_seconds = 0; // the last: without reading
        std::uint64_t touches = 0, looked_at = 0;
    };
    const Known& known(const analysis::Settings& settings) const;
    std::filesystem::path file_of(const analysis::Settings& settings) const;
    /// All that counts of these settings, with defaults.
    analysis::Settings whole(const analysis::Settings& settings) const;
    std::string own_body(const analysis::Settings& whole, int seeds) const;
    analysis::Point reference_of(const analysis::Point& point) const;
    Run run(const analysis::Settings& whole, std::uint64_t seed) const;

    const analysis::Study& study_;
    std::filesystem::path folder_;
    const std::atomic<bool>& stop_;
    std::map<std::string, Known> known_; // by file and format
};

} // namespace traces
