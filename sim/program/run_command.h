// razor-sim run: a frame on a machine, to a picture and reports.
#pragma once

#include "razor/program/scene_options.h"
#include "sim/config/machine_file.h"
#include "sim/machine/machine.h"
#include "sim/program/pixel_costs.h"
#include "sim/program/sharing_report.h"
#include "sim/program/trace_options.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sim {

/// A machine none of whose files may be written over from now on. Throws ConfigError.
MachineDescription noted_machine(const std::string& file, const std::vector<std::string>& settings);

/// The options that choose a machine.
class MachineOptions {
public:
    void add_to(CLI::App& app);
    std::string file;
    std::vector<std::string> settings;
};

class RunCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);
    /// Returns the exit code. Throws razor::UserError and ConfigError.
    int run() const;

private:
    std::optional<Sampling> sampling(const Machine& machine) const;
    bool in_closed_form() const;
    void check_closed_form(const Config& config) const;
    int run_closed_form(const MachineDescription& machine, int workers,
                        const razor::SceneDescription& scene) const;
    void add_fidelity_to(CLI::App& run);
    /// Checks --fidelity and --error, and that nothing else contradicts them.
    double wanted_error() const;
    int run_fidelity(double wanted, const std::vector<std::string>& settings, int workers,
                     const razor::SceneDescription& scene) const;
    /// To the file of --report, or to standard output.
    void give(const std::string& report) const;

    MachineOptions machine_;
    razor::SceneOptions scene_;
    std::string estimate_, seed_, seed_report_, fidelity_, error_;
    TraceOptions trace_;
    PixelCostOptions costs_;
    SharingOptions sharing_;
    std::vector<std::string> outputs_;
    std::string json_, report_, workers_, share_, host_threads_, jitter_, interval_, intervals_, frames_,
        tiles_, memory_;
    bool tiles_in_rows_ = false;
    bool quiet_ = false, no_native_ = false, no_calibration_ = false;
};

} // namespace sim
