// razor-sim run --fidelity auto: the ways to simulate a frame, tried from cheap to dear
// (sim/estimate/fidelity.h).
#pragma once

#include "razor/scene/description.h"
#include "sim/config/machine_file.h"
#include "sim/estimate/fidelity.h"
#include "sim/program/closed_form_run.h"
#include "sim/program/frame_run.h"

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sim {

struct Fidelity {
    double wanted = 0;
    std::vector<Rung> rungs;
    std::vector<double> seconds;        // of the host's processor, by rung, pilots included
    std::vector<std::string> settings;  // of the machine, by rung, as of -g; none for a closed form
    double reference_pilot_seconds = 0; // for the parts in the reference mode, which all pilots share
    std::size_t chosen = 0;
    MachineDescription machine; // as the chosen one was simulated
    // What the chosen one found, one of these:
    std::optional<FrameRun> frame;
    std::optional<ClosedForm> closed_form;
    Sampling sampling; // of the frame

    const Rung& way() const { return rungs[chosen]; }
    /// Of the host's processor, for all that was tried.
    double all_seconds() const;
};

/// `describe` gives the machine with these settings on top. `seed_file`: of a closed form, if there is one.
/// Throws razor::UserError, ConfigError, Stopped, razor::Cancelled.
Fidelity run_at_fidelity(double wanted, int workers, const razor::SceneDescription& scene,
                         const std::function<MachineDescription(const std::vector<std::string>&)>& describe,
                         const std::string& seed_file, const std::atomic<bool>& interrupted);

std::string fidelity_text(const Fidelity& fidelity);
nlohmann::ordered_json fidelity_json(const Fidelity& fidelity);

} // namespace sim
