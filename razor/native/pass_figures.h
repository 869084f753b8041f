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
};

/// After a pass, from the thread that asked for the picture: the film of all samples so far.
using Passed = std::function<void(const Film& so_far, const PassFigures& figures)>;

struct PassOptions {
    int samples = 0; // of each pixel in a pass; 0: there are no passes
    /// Passes go on as long as one like the last will end by then, and one is made in any case. 0: until the
    /// settings' samples are taken.
    double seconds = 0;
    Passed passed{};
};

} // namespace razor
