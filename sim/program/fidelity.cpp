#include "sim/program/fidelity.h"

#include "razor/native/render.h"
#include "sim/machine/machine.h"
#include "sim/program/estimates.h"

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>
#include <numeric>

namespace sim {
namespace {

constexpr double fractions[] = {0.03, 0.06, 0.12, 0.25};
/// Parts of the frame that pilots of the fast mode render, beside the same in the reference mode.
constexpr int pilot_parts = 4;

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A way to simulate the machine, as settings of it.
struct Mode {
    std::vector<std::string> settings;
    MachineDescription machine;
};

double dram_bytes(const Report& r) {
    return static_cast<double>(r.config.last_cache().line_bytes) *
           static_cast<double>(r.memory.reads + r.memory.writes);
}

/// Half the interval that the draw of units alone would give cycles, relative.
double drawn(const Estimate& e) {
    const double units = static_cast<double>(std::max<std::size_t>(e.units, 2));
    const boost::math::students_t t(units - 1);
    return (1 - e.detailed / e.cycles.value) * boost::math::quantile(t, 0.5 + e.confidence / 2) * e.spread /
           std::sqrt(units);
}

class Attempts {
public:
    Attempts(Fidelity& out, int workers, const razor::SceneDescription& scene, const std::string& seed_file,
             const std::atomic<bool>& interrupted)
        : out_(out), workers_(workers), description_(scene), scene_(razor::build_scene(scene)),
          tiles_(razor::screen_tiles(scene.settings)), seed_file_(seed_file), interrupted_(interrupted) {}

    void add(Rung rung, Mode mode) {
        out_.rungs.push_back(std::move(rung));
        out_.settings.push_back(fmt::format("{}", fmt::join(mode.settings, " ")));
        out_.seconds.push_back(0);
        modes_.push_back(std::move(mode));
    }
    /// Screen tiles of a pilot's part; 0: the picture is too small for pilots.
    int part_tiles() const {
        const int part = std::max(workers_, tiles_ / 32);
        return pilot_parts * part <= tiles_ / 4 ? part : 0;
    }

    const MachineDescription& machine_of(std::size_t i) const { return modes_[i].machine; }

    OwnError run(std::size_t i) {
        const Rung& rung = out_.rungs[i];
        const Config& config = modes_[i].machine.config;
        const double began = processor_seconds();
        OwnError own;
        out_.frame.reset();
        if (rung.way == Way::closed_form) {
            out_.closed_form.emplace(
                compute_closed_form(config, workers_, description_, seed_file_, true, interrupted_));
            own.error = *rung.predicted;
        } else {
            Sampling sampling;
            sampling.fraction = rung.fraction;
            sampling.builds = building_phases();
            const bool sampled = rung.way == Way::sampled;
            out_.frame.emplace(
                run_frame(config, scene_, workers_, 0, tiles_, interrupted_, sampled ? &sampling : nullptr));
            out_.sampling = sampling;
            const Estimate& e = out_.frame->estimate;
            if (rung.way == Way::fast)
                own.error = *rung.predicted;
            else if (sampled && e.detailed < e.cycles.value)
                own = {{e.cycles.error(), e.count_error()}, drawn(e)};
        }
        out_.seconds[i] += processor_seconds() - began;
        return own;
    }

    RelativeError pilot(std::size_t i) {
        if (references_.empty()) {
            const double began = processor_seconds();
            references_ = render_parts(modes_.back().machine.config);
            out_.reference_pilot_seconds = processor_seconds() - began;
        }
        const double began = processor_seconds();
        const std::vector<Found> found = render_parts(modes_[i].machine.config);
        out_.seconds[i] += processor_seconds() - began;
        std::vector<double> cycles, bytes;
        for (std::size_t part = 0; part < found.size(); ++part) {
            cycles.push_back(found[part].cycles / references_[part].cycles - 1);
            bytes.push_back(references_[part].bytes > 0 ? found[part].bytes / references_[part].bytes - 1
                                                        : 0);
        }
        out_.rungs[i].source = fmt::format("pilot: {} parts of {} screen tiles beside the reference mode",
                                           pilot_parts, part_tiles());
        return {pilot_error(cycles), pilot_error(bytes)};
    }

private:
    struct Found {
        double cycles, bytes;
    };
    /// In the middles of equal stretches of the curve along which tiles are taken.
    std::vector<Found> render_parts(const Config& config) const {
        std::vector<Found> out;
        const int tiles = part_tiles();
        for (int part = 0; part < pilot_parts; ++part) {
            const int first = (2 * part + 1) * tiles_ / (2 * pilot_parts) - tiles / 2;
            const Report r = run_frame(config, scene_, workers_, first, first + tiles, interrupted_).report;
            out.push_back({static_cast<double>(r.cycles), dram_bytes(r)});
        }
        return out;
    }

    Fidelity& out_;
    int workers_;
    const razor::SceneDescription& description_;
    razor::Scene scene_;
    int tiles_;
    const std::string& seed_file_;
    const std::atomic<bool>& interrupted_;
    std::vector<Mode> modes_;
    std::vector<Found> references_;
};

/// Why the frame is not computed in closed form.
std::string not_computed(const Config& machine, const std::string& seed_file) {
    if (const std::string why = not_in_closed_form(machine); !why.empty())
        return why;
    if (seed_file.empty() || !std::filesystem::exists(seed_file))
        return "no seed is kept (--seed-report); to make one takes as long as a run in the fast mode";
    return "";
}

} // namespace

double Fidelity::all_seconds() const {
    return std::accumulate(seconds.begin(), seconds.end(), reference_pilot_seconds);
}

Fidelity run_at_fidelity(double wanted, int workers, const razor::SceneDescription& scene,
                         const std::function<MachineDescription(const std::vector<std::string>&)>& describe,
                         const std::string& seed_file, const std::atomic<bool>& interrupted) {
    const auto mode = [&](std::vector<std::string> settings) {
        Mode out{std::move(settings), {}};
        out.machine = describe(out.settings);
        return out;
    };
    const Mode own = mode({});
    const std::string quantum = own.machine.config.sim.mode == "fast"
                                    ? fmt::format("sim.quantum={}", own.machine.config.sim.quantum)
                                    : "sim.quantum=100";
    const Mode reference =
        mode({"sim.mode=reference", "memory.controller=queued", "sim.quantum=0", "sim.window=0"});
    const Mode at_once = mode({"sim.mode=fast", "memory.controller=immediate", quantum});
    const Mode queued = mode({"sim.mode=fast", "memory.controller=queued", quantum});

    Fidelity out;
    out.wanted = wanted;
    Attempts attempts(out, workers, scene, seed_file, interrupted);
    Rung computed{Way::closed_form, "closed form"};
    computed.impossible = not_computed(reference.machine.config, seed_file);
    computed.predicted = RelativeError{closed_form_error, closed_form_error};
    computed.source = "validation: all of 63 runs were closer";
    attempts.add(std::move(computed), mode({}));
    Estimate counts;
    counts.confidence = Sampling().confidence;
    const std::string unsampled = Machine(reference.machine.config).not_sampled();
    for (const double fraction : fractions) {
        Rung sample{Way::sampled, fmt::format("sample:{} of the reference mode", fraction), fraction};
        sample.impossible = unsampled;
        // Counts come no closer, whatever the fraction.
        sample.predicted = RelativeError{std::numeric_limits<double>::quiet_NaN(), counts.count_error()};
        sample.source = "order in which caches are warmed";
        attempts.add(std::move(sample), reference);
    }
    for (const bool queues : {false, true}) {
        Rung fast{Way::fast, queues ? "fast mode, DRAM with queues" : "fast mode, DRAM answering at once"};
        if (unsampled.empty())
            fast.impossible = "pilots of it say less than samples, and cost as much";
        else if (attempts.part_tiles() == 0)
            fast.impossible = fmt::format(
                "no pilot: {} parts of a screen tile a worker are more than a quarter of the picture",
                pilot_parts);
        attempts.add(std::move(fast), queues ? queued : at_once);
    }
    Rung whole{Way::reference, "reference mode"};
    whole.predicted = RelativeError{};
    whole.source = "errors are beside it";
    attempts.add(std::move(whole), reference);

    out.chosen = choose_fidelity(
        wanted, out.rungs,
        {[&](std::size_t i) { return attempts.run(i); }, [&](std::size_t i) { return attempts.pilot(i); }});
    out.machine = attempts.machine_of(out.chosen);
    return out;
}

} // namespace sim
