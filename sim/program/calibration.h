// How far a machine's counts are from those of a real build of the kernels: what
// analysis/calibration/calibrate.py wrote for the machine's `calibration`, for the reports.
#pragma once

#include "sim/config/machine_file.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace sim {

/// Simulated over counted.
struct CountRatio {
    double ratio = 0;
    bool within = false; // its bar
    bool fitted = false; // false: valgrind does not count it as the processor does
};
struct KernelCalibration {
    std::string kernel; // a phase of the frame
    double share = 0;   // of all instructions of the real build
    CountRatio instructions, references;
};
struct Calibration {
    std::string file;                 // as the machine file names it, its folders resolved
    std::string target, frame, build; // whose counts, of what, compiled by whom
    std::string differs; // the first setting that the machine has otherwise; empty: it is this machine's
    std::vector<KernelCalibration> kernels;
};

/// What the machine's file names, or nothing. Throws ConfigError where it is not there or not of that form.
std::optional<Calibration> read_calibration(const MachineDescription& machine);

/// A line, and a row for each kernel where the calibration is this machine's.
std::string calibration_text(const Calibration& calibration);
nlohmann::ordered_json calibration_json(const Calibration& calibration);

} // namespace sim
