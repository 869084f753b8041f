// Camera samples taken in passes: a picture that is there early and gets better, for a number of samples or
// for a time, and how far it may be off.
#pragma once

#include "razor/frame/frame.h"
#include "razor/native/pass_figures.h"

#include <functional>
#include <vector>

namespace razor {

/// How far pictures are off, from how far their passes differ: the variance of the mean of batches (weighted
/// by their samples) of each pixel's luminance. Passes share a sequence that fills what earlier ones left
/// open, so that the mean is nearer than if they were independent, as is assumed: the estimate is high
/// rather than low. What all passes miss alike it cannot tell.
class ErrorEstimate {
public:
    /// The film of `samples` a pixel, more than the last time. What is no finite number is left out.
    void add(const Film& so_far, int samples);
    /// Of the luminance, root mean square over pixels; 0 before the second pass.
    double error() const;
    double relative_error() const;

private:
    std::vector<double> mean_, squares_; // of each pixel; sum of samples times batch mean squared
    int samples_ = 0, passes_ = 0;
};

/// Makes all workers do their share of the tiles dealt, and throws what they throw; given whom to tell the
/// fraction that is done.
using RunWorkers = std::function<void(const std::function<void(double)>& progress)>;

/// The frame's settings say how many `samples` there are.
PassFigures take_passes(Frame& frame, const PassOptions& options, int samples, const RunWorkers& run,
                        const std::function<void(double)>& progress);

/// Passes by noise (razor/native/adaptive_sampling.h): as many samples as each tile needs for the settings'
/// noise_threshold, at most the settings' samples. With options.seconds also no more than there is time for.
/// `kernels` are those that `run` runs.
PassFigures take_adaptive_passes(Frame& frame, const KernelTable& kernels, const Settings& settings,
                                 const PassOptions& options, const RunWorkers& run,
                                 const std::function<void(double)>& progress);

/// Passes by error (razor/native/target_sampling.h): as many samples as options.target_error needs, and with
/// options.seconds no more than there is time for. Levels of detail are those of the settings' samples.
PassFigures take_passes_to_error(Frame& frame, const KernelTable& kernels, const Settings& settings,
                                 const PassOptions& options, const RunWorkers& run,
                                 const std::function<void(double)>& progress);

} // namespace razor
