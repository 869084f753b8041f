#include "sim/program/seed_file.h"

#include "razor/frame/phases.h"
#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/scene/error.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

/// No run counts more; below it sums and products of such numbers are finite.
constexpr double most = 1e18;

bool counted(double number) {
    return number >= 0 && number <= most;
}

/// By name, the first number that no run could have found; empty where there is none.
std::string impossible_number(const json& seed) {
    for (const auto& [name, value] : seed.items()) {
        if (value.is_number() && !counted(value.get<double>()))
            return name;
        if (value.is_array())
            for (const json& phase : value)
                if (const std::string own = impossible_number(phase); !own.empty())
                    return own;
    }
    return "";
}

json json_of_needs(const std::vector<ScreenNeed>& needs) {
    json out = {{"nodes", json::array()}, {"surfaces", json::array()}};
    for (const ScreenNeed& n : needs) {
        out["nodes"].push_back(n.nodes);
        out["surfaces"].push_back(n.surfaces);
    }
    return out;
}

/// Throws json::exception.
std::vector<ScreenNeed> needs_of_json(const json& from) {
    std::vector<ScreenNeed> out;
    const auto nodes = from.at("nodes").get<std::vector<double>>();
    for (std::size_t t = 0; t < nodes.size(); ++t)
        out.push_back({nodes[t], from.at("surfaces").at(t).get<double>()});
    return out;
}

bool counted(const ScreenNeed& n) {
    return counted(n.nodes) && counted(n.surfaces);
}

} // namespace

void write_seed(const std::string& file, const KeptSeed& seed) {
    const json out = {{"program", "razor-sim"},
                      {"version", razor::version()},
                      {"kind", "seed of closed forms"},
                      {"machine", print_machine(seed.machine)},
                      {"scene", seed.scene},
                      {"drivers", seed.drivers},
                      {"needs", json_of_needs(seed.needs)},
                      {"seed", json_of_seed(seed.seed)},
                      {"host", {{"processor_seconds", seed.processor_seconds}}}};
    razor::write_json_file(file, out);
}

KeptSeed read_seed(const std::string& option, const std::string& file) {
    std::ifstream in(file);
    if (!in)
        throw razor::UserError(
            fmt::format("{}: cannot read {}; give a seed, or a name for a new one", option, file));
    try {
        const json from = json::parse(in);
        KeptSeed out;
        if (from.at("kind") != "seed of closed forms")
            throw razor::UserError(
                fmt::format("{}: {} is no seed; leave it out, or name a new file", option, file));
        out.machine = parse_machine(from.at("machine").get<std::string>(), file);
        out.scene = from.at("scene").get<std::string>();
        out.drivers = from.at("drivers").get<std::vector<double>>();
        out.needs = needs_of_json(from.at("needs"));
        out.seed = seed_of_json(from.at("seed"));
        out.processor_seconds = from.at("host").at("processor_seconds").get<double>();
        std::string wrong = impossible_number(from.at("seed"));
        if (!std::all_of(out.drivers.begin(), out.drivers.end(), [](double d) { return counted(d); }))
            wrong = "drivers";
        if (!std::all_of(out.needs.begin(), out.needs.end(), [](const ScreenNeed& n) { return counted(n); }))
            wrong = "needs";
        if (!counted(out.processor_seconds))
            wrong = "processor_seconds";
        if (!wrong.empty())
            throw razor::UserError(fmt::format(
                "{}: {}: {} is below 0, or more than any run counts; make it anew", option, file, wrong));
        if (out.drivers.size() != razor::phase_count || out.seed.phases.size() < out.drivers.size())
            throw razor::UserError(
                fmt::format("{}: {} is of another version's phases; make it anew", option, file));
        if (std::all_of(out.seed.phases.begin(), out.seed.phases.end(),
                        [](const SeedPhase& p) { return p.instructions == 0; }))
            throw razor::UserError(fmt::format("{}: {} counts no instructions; make it anew", option, file));
        return out;
    } catch (const nlohmann::json::exception&) {
        throw razor::UserError(
            fmt::format("{}: {} is no seed; leave it out, or name a new file", option, file));
    } catch (const ConfigError& error) {
        throw razor::UserError(fmt::format("{}: {}; make the seed anew", option, error.what()));
    }
}

void check_seed(const std::string& option, const std::string& file, const KeptSeed& seed,
                const Config& machine, const std::string& scene_text) {
    if (const std::string key = unknown_to_seed(seed.machine, machine); !key.empty())
        throw razor::UserError(
            fmt::format("{}: {} is another in {}'s machine, and a seed cannot know what that "
                        "does to misses and instructions; make a seed of this machine",
                        option, key, file));
    if (seed.scene != scene_text)
        throw razor::UserError(
            fmt::format("{}: {} is of another scene, or of other settings of it; make a seed "
                        "of this one",
                        option, file));
}

} // namespace sim
