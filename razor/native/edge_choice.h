// How far a picture is off by its levels of detail, and which target edge length keeps that within an error.
//
// Two frames of the same samples, one with all target edges halved, differ by what the coarser levels get
// wrong, but for what halving leaves, and by noise where paths part. The mean product of two such
// differences, of samples that have nothing in common, has no noise in its expectation: it is the mean square
// of the levels' difference (razor/native/target_sampling.h has the relative error). Only some tiles are
// rendered, evenly along the screen's curve, with as many samples as are needed to tell whether the
// difference matters.
//
// Hits converge as the square of the edge, silhouettes and shadows' edges at least as its first power: a
// difference d to half the edge means an error between 4/3 d and 2 d.
#pragma once

#include "razor/native/render.h"

#include <string>

namespace razor {

struct LevelDifference {
    double edge_pixels = 0;
    double error = 0; // relative, root mean square, of a picture of half the edges; 0 where noise hides it
    double square = 0, square_uncertainty = 0; // its square as found, and one standard error of that
    int samples = 0;                           // of each pixel that it was found from
    std::size_t pixels = 0;
};

/// Between levels of the scene as it is and with all target edges halved, found well enough to tell
/// whether it is above `target`. Throws UserError and Cancelled.
LevelDifference level_difference(const Scene& scene, const RenderOptions& options, double target);

struct EdgeChoice {
    LevelDifference chosen;
    bool given = false;   // Settings::edge_pixels stays; why: `reason`
    std::string reason{}; // why it is this one
    int frames = 0;       // rendered in part
    double seconds = 0;
};

/// The coarsest edge_pixels, from an eighth of the settings' to four times as many in powers of two, whose
/// difference to half of it is not found to be above half the target: with noise of the target's size it adds
/// an eighth to the whole error, where edges are not blurred by noise more. It is coarser than the settings'
/// only where the difference is surely below a quarter. `given`: it is the settings'; as where a mesh states
/// its own edge length. Where options.passes.seconds bound the time, no level is tried once a quarter of it
/// is over. Throws UserError and Cancelled.
EdgeChoice choose_edge(const Scene& scene, const RenderOptions& options, double target, bool given);

} // namespace razor
