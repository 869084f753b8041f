#include "sim/program/calibration.h"

#include "sim/config/error.h"
#include "sim/config/parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace sim {
namespace {

using json = nlohmann::ordered_json;

[[noreturn]] void fail(const std::string& file, const std::string& what) {
    throw ConfigError(
        fmt::format("{}: {}; make it anew with analysis/calibration/calibrate.py -o", file, what));
}

CountRatio read_ratio(const json& row) {
    CountRatio out{row.at("ratio").get<double>(), row.at("within").get<bool>(), row.at("fitted").get<bool>()};
    if (!(out.ratio > 0) || !std::isfinite(out.ratio))
        throw std::domain_error("a ratio is not above zero");
    return out;
}

/// The first setting that the machine has otherwise, in words.
std::string difference(const json& settings, const Config& config) {
    for (const auto& [key, value] : settings.items()) {
        const Parameter* p = find_parameter(key);
        if (p == nullptr)
            throw std::domain_error(fmt::format("there is no setting {}", key));
        const std::string ours = print_value(*p, config);
        if (json::parse(ours) != value)
            return fmt::format("{} is {}, not {}", key, ours, value.dump());
    }
    return "";
}

std::string percent(const CountRatio& r) {
    return fmt::format("{:+.0f} %{}", 100 * (r.ratio - 1), !r.fitted ? "*" : r.within ? " " : "!");
}

json ratio_json(const CountRatio& r) {
    return {{"ratio", r.ratio}, {"within", r.within}, {"fitted", r.fitted}};
}

} // namespace

std::optional<Calibration> read_calibration(const MachineDescription& machine) {
    if (machine.calibration.empty())
        return std::nullopt;
    Calibration out;
    out.file = std::filesystem::path(machine.calibration).lexically_normal().string();
    std::ifstream in(out.file);
    if (!in || std::filesystem::is_directory(out.file))
        fail(out.file, fmt::format("the calibration of {} cannot be read", machine.name));
    try {
        const json all = json::parse(in);
        out.target = all.at("target").get<std::string>();
        out.frame = all.at("frame").get<std::string>();
        out.build = all.at("build").get<std::string>();
        out.differs = difference(all.at("settings"), machine.config);
        for (const json& row : all.at("kernels"))
            out.kernels.push_back({row.at("kernel").get<std::string>(), row.at("share").get<double>(),
                                   read_ratio(row.at("instructions")), read_ratio(row.at("references"))});
        if (out.kernels.empty())
            throw std::domain_error("there are no kernels");
    } catch (const json::exception& e) {
        // Behind "[json.exception.name.number] "; a message of the parser may have several lines.
        const std::string_view what = e.what();
        const std::string_view message = what.substr(what.find("] ") + 2);
        fail(out.file, fmt::format("is no calibration: {}", message.substr(0, message.find('\n'))));
    } catch (const std::domain_error& e) {
        fail(out.file, fmt::format("is no calibration: {}", e.what()));
    }
    return out;
}

std::string calibration_text(const Calibration& c) {
    if (!c.differs.empty())
        return fmt::format("calibration            none: {} where {} was made\n", c.differs, c.file);
    std::string out =
        fmt::format("calibration            counts beside those of the kernels' {} build, of the frame "
                    "{} ({})\n  {:<14} {:>8} {:>14} {:>12}\n",
                    c.target, c.frame, c.file, "kernel", "of all", "instructions", "references");
    bool missed = false, unfitted = false;
    for (const KernelCalibration& k : c.kernels) {
        const std::string row = fmt::format("  {:<14} {:>6.1f} % {:>14} {:>12}", k.kernel, 100 * k.share,
                                            percent(k.instructions), percent(k.references));
        out += row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
        for (const CountRatio& r : {k.instructions, k.references}) {
            missed |= r.fitted && !r.within;
            unfitted |= !r.fitted;
        }
    }
    if (missed)
        out += "  !: farther off than 20 % (instructions), 25 % (references)\n";
    if (unfitted)
        out += "  *: valgrind counts some instructions' references several times\n";
    return out;
}

json calibration_json(const Calibration& c) {
    json out{{"file", c.file},
             {"target", c.target},
             {"frame", c.frame},
             {"build", c.build},
             {"differs", c.differs}};
    for (const KernelCalibration& k : c.kernels)
        out["kernels"].push_back({{"kernel", k.kernel},
                                  {"share", k.share},
                                  {"instructions", ratio_json(k.instructions)},
                                  {"references", ratio_json(k.references)}});
    return out;
}

} // namespace sim
