// What is asked of rendering in passes, and told of it.
#pragma once

#include "razor/image/image.h"

#include <functional>

namespace razor {

struct PassFigures {
    int passes = 0;
    int samples = 0;             // of each pixel, in all; of adaptive sampling the most
    double mean_samples = 0;     // over the pixels
    double seconds = 0;          // of rendering, what is done after each pass included
    double error = 0;            // of luminance, root mean square over the pixels; after one pass: unknown, 0
    double relative_error = 0;   // the same over the mean luminance
    double threshold = 0;        // of adaptive sampling (Settings::noise_threshold); else 0
    double within_threshold = 0; // the part of the pixels whose noise was found to be no more
    double target = 0;           // PassOptions::target_error; else 0, as are:
    double target_error = 0;     // what was reached of it, estimated
    double target_error_uncertainty = 0; // one standard error of that
};

/// After a pass, from the thread that asked for the picture: the film of all samples so far.
using Passed = std::function<void(const Film& so_far, const PassFigures& figures)>;

inline constexpr int most_target_samples = 65536;

struct PassOptions {
    int samples = 0; // of each pixel in a pass; 0: there are no passes
    /// Passes go on as long as one like the last will end by then, and one is made in any case. 0: until the
    /// settings' samples are taken.
    double seconds = 0;
    /// Not 0: samples are taken where they lower the picture's relative error most until it is estimated to
    /// be no more (razor/native/target_sampling.h), of each pixel from pilot_samples to most_target_samples.
    double target_error = 0;
    Passed passed{};
};

} // namespace razor
