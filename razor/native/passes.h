// Camera samples taken in passes: a picture that is there early and gets better, for a number of samples or
// for a time, and how far it may be off.
#pragma once

#include "razor/frame/frame.h"

#include <functional>
#include <vector>

namespace razor {

struct PassFigures {
    int passes = 0;
    int samples = 0;           // of each pixel, in all
    double seconds = 0;        // of rendering, what is done after each pass included
    double error = 0;          // of luminance, root mean square over the pixels; after one pass: unknown, 0
    double relative_error = 0; // the same over the mean luminance
};

struct PassOptions {
    int samples = 0; // of each pixel in a pass; 0: there are no passes
    /// Passes go on as long as one like the last will end by then, and one is made in any case. 0: until the
    /// settings' samples are taken.
    double seconds = 0;
    /// After each pass, from the calling thread: the film of all samples so far.
    std::function<void(const Film&, const PassFigures&)> passed;
};

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

/// `run` makes all workers do their share of the tiles dealt, and throws what they throw; it is given whom to
/// tell the fraction that is done. The frame's settings say how many `samples` there are.
PassFigures take_passes(Frame& frame, const PassOptions& options, int samples,
                        const std::function<void(const std::function<void(double)>&)>& run,
                        const std::function<void(double)>& progress);

} // namespace razor
