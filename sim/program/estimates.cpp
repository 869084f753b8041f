#include "sim/program/estimates.h"

#include "razor/frame/phases.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

Estimated counted(double value, double confidence_factor) {
    const double error = value * confidence_factor;
    return {value, value - error, value + error};
}

json of_figures(const std::vector<EstimatedFigure>& figures) {
    json out = json::object();
    for (const EstimatedFigure& f : figures)
        out[f.name] = {{"value", f.value.value}, {"low", f.value.low}, {"high", f.value.high}};
    return out;
}

} // namespace

std::vector<bool> building_phases() {
    std::vector<bool> builds(razor::phase_count);
    for (int phase : {razor::phase_animate, razor::phase_build, razor::phase_tessellate})
        builds[static_cast<std::size_t>(phase)] = true;
    return builds;
}

Sampling parse_sampling(std::string_view option, std::string_view text) {
    constexpr std::string_view how = "sample:";
    if (!text.starts_with(how))
        throw razor::UserError(fmt::format(
            "{}: \"{}\" is no way to estimate; give sample:FRACTION, such as sample:0.1, or closed-form",
            option, text));
    Sampling s;
    s.fraction = razor::parse_number(option, text.substr(how.size()), {0.001, 1});
    s.builds = building_phases();
    return s;
}

std::vector<EstimatedFigure> sampled_figures(const Report& r, const Estimate& e) {
    const bool sampled = e.detailed < static_cast<double>(r.cycles);
    const auto of = [&](std::uint64_t count, double unseen = Estimate::unseen) {
        return counted(static_cast<double>(count), sampled ? e.count_error(unseen) : 0);
    };
    const std::uint64_t line = static_cast<std::uint64_t>(r.config.last_cache().line_bytes);
    std::vector<EstimatedFigure> out{
        {"cycles", "cycles", e.cycles},
        {"dram_bytes", "bytes from and to DRAM", of(line * (r.memory.reads + r.memory.writes))},
        {"dram_reads", "lines read from DRAM", of(r.memory.reads)},
        {"dram_writes", "lines written to DRAM", of(r.memory.writes)}};
    constexpr std::array<std::array<const char*, 2>, most_levels> misses = {{{"l1_misses", "misses of L1s"},
                                                                             {"l2_misses", "misses of L2s"},
                                                                             {"l3_misses", "misses of L3s"},
                                                                             {"l4_misses", "misses of L4s"},
                                                                             {"l5_misses", "misses of L5s"}}};
    const double unseen_of_l1 = Estimate::unseen_of_l1(static_cast<std::uint64_t>(r.config.chip.threads),
                                                       static_cast<std::uint64_t>(r.config.core.window));
    for (unsigned level = 0; level < r.config.cache_levels(); ++level)
        out.push_back({misses[level][0], misses[level][1],
                       of(r.cache_total(level).misses, level == 0 ? unseen_of_l1 : Estimate::unseen)});
    return out;
}

std::string sampled_text(const Report& r, const Estimate& e, const Sampling& s) {
    std::string out = fmt::format(
        "estimate               sampled: {} units of {} cycles, {:.1f} % of the time in detail, seed {}\n",
        e.units, s.unit, 100 * e.detailed / e.cycles.value, s.seed);
    out += fmt::format("\n{:<24} {:>15} {:>9}   {:.0f} % confidence\n", "", "estimate", "error",
                       100 * e.confidence);
    for (const EstimatedFigure& f : sampled_figures(r, e))
        out += fmt::format("{:<24} {:>15.0f} {:>7.2f} %   {:.0f} to {:.0f}\n", f.label, f.value.value,
                           100 * f.value.error(), f.value.low, f.value.high);
    out += fmt::format(
        "\nunits differ by {:.1f} % from what their work says; an instruction takes a thread {:.2f} "
        "cycles in builds, {:.2f} elsewhere, a miss of an L1 {:.1f}, a line from below {:.1f} more\n",
        100 * e.spread, e.costs[SampledWork::builds], e.costs[SampledWork::others],
        e.costs[SampledWork::misses], e.costs[SampledWork::lines]);
    out += fmt::format("host: {:.3f} s, {:.3f} s of processor time\n", r.host_seconds, r.processor_seconds);
    return out;
}

json sampled_json(const Report& r, const Estimate& e, const Sampling& s) {
    json all = json::parse(print_json(r)), out;
    for (const char* key : {"machine", "mode", "workers", "cycles", "seconds", "core",
                            "instructions_by_class", "phases", "l1", "l2", "l3", "l4", "l5", "tlb"})
        if (all.contains(key))
            out[key] = all[key];
    out["memory"] = {{"reads", r.memory.reads}, {"writes", r.memory.writes}};
    out["estimate"] = {{"how", "sampled"},
                       {"fraction", s.fraction},
                       {"seed", s.seed},
                       {"units", e.units},
                       {"unit_cycles", s.unit},
                       {"detailed_cycles", e.detailed},
                       {"confidence", e.confidence},
                       {"spread", e.spread},
                       {"figures", of_figures(sampled_figures(r, e))}};
    out["host"] = all["host"];
    return out;
}

} // namespace sim
