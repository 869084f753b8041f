// What razor-sim run --fidelity auto says of its choice.
#include "sim/program/fidelity.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

json error_json(const std::optional<RelativeError>& e) {
    // What is not known is no number, and null there.
    return e ? json{{"cycles", e->cycles}, {"dram_bytes", e->dram_bytes}} : json(nullptr);
}

std::string percents(const std::optional<RelativeError>& e) {
    const auto percent = [](double x) { return std::isfinite(x) ? fmt::format("{:.1f} %", 100 * x) : "?"; };
    return e ? fmt::format("{}, {}", percent(e->cycles), percent(e->dram_bytes)) : "";
}

std::string why(const Rung& r) {
    return r.state == Rung::State::impossible   ? r.impossible
           : r.state == Rung::State::not_needed ? ""
                                                : r.source;
}

} // namespace

std::string fidelity_text(const Fidelity& f) {
    const Rung& chosen = f.way();
    std::string out = fmt::format(
        "fidelity               {}: error {:.2f} % of cycles, {:.2f} % of bytes from and to DRAM, of {:.2f} "
        "% asked for; "
        "{:.3f} s of processor time in all\n\n{:<36} {:<12} {:>14} {:>14} {:>9}   predicted from\n",
        chosen.name, 100 * chosen.error->cycles, 100 * chosen.error->dram_bytes, 100 * f.wanted,
        f.all_seconds(), "way", "", "predicted", "own error", "host, s");
    for (std::size_t i = 0; i < f.rungs.size(); ++i) {
        const Rung& r = f.rungs[i];
        const bool tells = r.state != Rung::State::impossible && r.state != Rung::State::not_needed;
        std::string row = fmt::format("{:<36} {:<12} {:>14} {:>14} {:>9}   {}", r.name, name_of(r.state),
                                      tells ? percents(r.predicted) : "", percents(r.error),
                                      f.seconds[i] > 0 ? fmt::format("{:.3f}", f.seconds[i]) : "", why(r));
        out += row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
    }
    if (f.reference_pilot_seconds > 0)
        out += fmt::format("pilots' parts in the reference mode took {:.3f} s more\n",
                           f.reference_pilot_seconds);
    return out + '\n';
}

json fidelity_json(const Fidelity& f) {
    json rungs = json::array(), seconds = json::array();
    for (const Rung& r : f.rungs)
        rungs.push_back({{"way", r.name},
                         {"state", name_of(r.state)},
                         {"predicted_error", error_json(r.predicted)},
                         {"source", why(r)},
                         {"own_error", error_json(r.error)}});
    for (std::size_t i = 0; i < f.rungs.size(); ++i)
        rungs[i]["settings"] = f.settings[i];
    return {{"how", "auto"},          {"wanted_error", f.wanted},
            {"chosen", f.way().name}, {"error", error_json(f.way().error)},
            {"confidence", 0.95},     {"ways", rungs}};
}

} // namespace sim
