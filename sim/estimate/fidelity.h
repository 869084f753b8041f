// Which way to simulate a run: the first, from cheap to dear, whose error is within what is asked for. What
// decides is the error that each way tells of itself: errors of a validation (closed form), the interval of a
// sample, a pilot of parts of the frame beside the same parts in the reference mode (fast mode); the
// reference mode is what errors are beside.
//
// Samples: the smallest is run first. Its interval says how wide those of larger ones will be (what the draw
// leaves open goes with one over the root of the fraction), and those of which that is too much are passed
// over. As that falls with the fraction, whoever disappoints from there on is followed by the next dearer
// one: so a smaller error never ends with a cheaper way, as it has tried no rung that a larger one would not
// have.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sim {

enum class Way { closed_form, sampled, fast, reference };

/// Half a 95 % interval, relative; no number where it is not known.
struct RelativeError {
    double cycles = 0, dram_bytes = 0;
    double worst() const { return cycles > dram_bytes ? cycles : dram_bytes; } // of what is known
};

/// Of one way, what it says of itself.
struct OwnError {
    RelativeError error;
    double drawn = 0; // of a sample's cycles: what the draw of its units leaves open, relative
};

struct Rung {
    enum class State {
        not_needed,  // a cheaper one was within the error
        impossible,  // this run is not simulated so
        passed_over, // what was predicted is too much
        too_wide,    // it was run, and what it says of itself is too much
        chosen
    };
    Way way = Way::reference;
    std::string name{};       // for reports
    double fraction = 0;      // of a sample: of the time, in detail
    std::string impossible{}; // why; empty: it is not
    /// What error is expected before it is run, where that is known: given, or found on the way.
    std::optional<RelativeError> predicted{};
    std::string source{};                 // ... from what
    std::optional<RelativeError> error{}; // what it said of itself, where it was run
    State state = State::not_needed;
};
const char* name_of(Rung::State state);

/// How ways are tried; whatever they throw goes on.
struct Trials {
    std::function<OwnError(std::size_t rung)> run;
    /// Of a rung of the fast mode: its error by parts of the frame.
    std::function<RelativeError(std::size_t rung)> pilot;
};

/// `rungs`, from cheap to dear, are told what became of them; the last is the reference mode. `wanted`: the
/// largest error of cycles and of bytes from and to DRAM; 0 is the reference mode without further ado.
/// Returns the number of the one chosen.
std::size_t choose_fidelity(double wanted, std::vector<Rung>& rungs, const Trials& trials);

/// Half a 95 % interval of a mean of differences, and that mean's distance from 0: what a pilot says of a
/// whole run. With fewer than two: infinite.
double pilot_error(const std::vector<double>& differences);

} // namespace sim
