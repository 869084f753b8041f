// Does what a ray hits move continuously as its footprint grows?
#pragma once

#include "tests/reference/experiment.h"

namespace razor::reference {

struct Jumps {
    long steps = 0; // of a ray's footprint
    long pops = 0;  // jumps with as many crossings before as after
    long folds = 0; // jumps where the number of crossings changes: a part of the surface comes or goes
};

/// Fixed rays from inside and as many from outside, w0 from half a target edge of level 0 through `octaves`
/// octaves. A jump is a change of the nearest distance by more than a thousandth of e0 that is still there
/// when the step has been halved down to 1e-9 of an octave.
Jumps jumps(const Setting& setting, const std::string& scheme, double octaves, int steps_an_octave);

} // namespace razor::reference
