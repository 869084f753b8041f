// A run that is not simulated but computed: razor-sim run --estimate closed-form.
#pragma once

#include "razor/scene/description.h"
#include "sim/config/machine_file.h"
#include "sim/estimate/closed_form.h"
#include "sim/program/screen_work.h"
#include "sim/program/seed_run.h"

#include <atomic>
#include <optional>
#include <string>

namespace sim {

/// Relative error of cycles, and of bytes from and to DRAM, that all of 63 computed runs stayed below beside
/// simulated ones (README.md, Measured).
inline constexpr double closed_form_error = 0.2;

struct ClosedForm {
    KeptSeed seed;
    bool made = false; // in this run
    Prediction prediction;
    CountedScreen counted;
    double model_seconds = 0; // of the host, for the model alone
    double processor_seconds = 0, seconds = 0;
};

/// Why this machine is not computed, in a few words; empty if it is.
std::string not_in_closed_form(const Config& machine);

/// The seed comes from the file if there is one, and goes there if there is a name alone. Throws
/// razor::UserError, ConfigError, Stopped, razor::Cancelled.
ClosedForm compute_closed_form(const Config& machine, int workers, const razor::SceneDescription& scene,
                               const std::string& seed_file, bool quiet,
                               const std::atomic<bool>& interrupted);

std::string closed_form_text(const ClosedForm& result, const Config& machine, int workers);
/// As of a run, but for what is not known, with the object "estimate".
nlohmann::ordered_json closed_form_json(const ClosedForm& result, const Config& machine, int workers);

} // namespace sim
