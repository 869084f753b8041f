// Measures the points of a study that are not done.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/store.h"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace analysis {

/// One point, measured. Throws Stopped where it was stopped; any other std::exception is why it fails.
using Measure = std::function<Result(const Point& point)>;

/// The measuring was stopped: the point has no result.
struct Stopped {};

struct RunOptions {
    std::string program;                     // and its version, for results
    const std::atomic<bool>* stop = nullptr; // set to true from anywhere, a signal handler too, to stop
    bool again_failed = false;               // measure points anew that failed
    int part = 1, parts = 1;                 // of all points, only each parts-th, the part-th first
    /// Before each point that is measured: how many are begun or done of how many, and the point.
    std::function<void(std::size_t done, std::size_t of, const Point& next)> progress{};
    int jobs = 1; // points measured at a time, each in a process
    /// Which of the files that a point is measured from is no more what it was when the point was named, or
    /// nothing: asked of each that is measured, in its process, before its result is written. May throw
    /// Stopped.
    std::function<std::string(const Point& point)> changed{};
};

struct RunSummary {
    std::size_t measured = 0, failed = 0, kept = 0; // now; of them failed; done before, or by others
    bool stopped = false;
};

/// In a process for each point, so that one that crashes, or takes all memory, is a result that says so.
/// Where others measure points of the same folder at the same time (Claims), waits for these. Throws
/// StudyError where a result cannot be written, or is of files that changed: it is not written then.
RunSummary run_points(const std::vector<Point>& points, const Store& store, const Measure& measure,
                      const RunOptions& options);

} // namespace analysis
