// A ray's footprint along its way, and the weights of levels that follow from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace razor::reference {

/// Width of a ray at a distance from its origin, world units: w0 + min(growth, cap) * distance, never below
/// `least` > 0. A growth below 0 is a ray that narrows.
struct Footprint {
    double w0 = 0.1;
    double growth = 0;
    double least = 1e-6;
    double cap = std::numeric_limits<double>::infinity(); // gradation cap

    double at(double distance) const { return std::max(w0 + std::min(growth, cap) * distance, least); }
};

/// Level k is whole up to the footprint s_k, gone from s'_k = 2 e_k / q on; between them it morphs. The morph
/// fills the last part of the octave e_k ... 2 e_k of q times the footprint.
struct Transition {
    double e0 = 0.1;    // target edge of level 0
    double q = 1;       // target edge in footprints
    double part = 0.25; // of the octave that morphs, (0, 1]

    double end(int k) const { return std::ldexp(e0, k + 1); }
    double begin(int k) const { return end(k) - part * std::ldexp(e0, k); }
    /// Whether level k is gone: w_k = 0. Tests must use this, which is monotone in the footprint to the last
    /// bit, and not weight() == 0, which rounding makes true a little before.
    bool gone(int k, double footprint) const { return q * footprint >= end(k); }
    double weight(int k, double footprint) const {
        if (gone(k, footprint))
            return 0;
        double x = (q * footprint - begin(k)) / (end(k) - begin(k));
        x = std::clamp(x, 0.0, 1.0);
        return 1 - x * x * (3 - 2 * x);
    }
};

} // namespace razor::reference
