// How fast hits come nearer to the limit surface as rays ask for shorter edges.
#pragma once

#include "razor/check/tracer.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

namespace razor::check {

struct ConvergenceOptions {
    int rays = 4096;
    unsigned seed = 1;
    std::function<void(double fraction)> progress;
    const std::atomic<bool>* cancel = nullptr;
};

struct ConvergenceReport {
    struct Step {
        double edge = 0; // length asked for, world units
        double median_error =
            0; // of the distances of hits, world units: silhouettes and folds do not show in it
        std::int64_t hits = 0; // of curved patches, also at the limit
    };
    std::vector<Step> steps; // each with edges half as long as the one before
    /// The power of the edge's length with which the error falls, by least squares over the steps; 0 where
    /// nothing is to be measured: see converges().
    double order = 0;
    bool cancelled = false;

    /// Whether there are curved surfaces, and hits on them that err.
    bool converges() const { return order != 0; }
};

/// Traces random rays at the curved meshes of a scene, whose own edges (the finest, taken for the limit) are
/// made 16 times shorter than it says: at 2^7, 2^6 ... 2^3 of these. A coarse cage has its limits: a patch is
/// not cut into more than 2^13 quads a side, so that edges shorter than that are the limit itself.
ConvergenceReport measure_convergence(Scene scene, const KernelTable& kernels,
                                      const ConvergenceOptions& options);

} // namespace razor::check
