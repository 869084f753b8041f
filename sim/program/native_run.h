// The same frame on the host: what the simulation is slower than, and what its picture must equal.
#pragma once

#include "razor/image/image.h"
#include "razor/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <string>

namespace sim {

struct NativeRun {
    std::string isa;
    double seconds = 0;   // refit, builds and rays, on one thread
    bool equal = false;   // the pictures, bit for bit
    bool unfused = false; // this target rounds where the simulated one fuses: last bits may differ
    double slowdown(double simulated_seconds) const { return seconds > 0 ? simulated_seconds / seconds : 0; }
};

/// Renders the scene's first `tiles` screen tiles (0: all), along the curve or row by row, on one thread with
/// the best native target, and compares them. Throws razor::Cancelled.
NativeRun run_native(const razor::Scene& scene, const razor::Film& simulated, const std::atomic<bool>& cancel,
                     int tiles = 0, bool in_rows = false);
/// A line of the report.
std::string native_text(const NativeRun& native, double simulated_seconds);
nlohmann::ordered_json native_json(const NativeRun& native, double simulated_seconds);

} // namespace sim
