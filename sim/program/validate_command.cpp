#include "sim/program/validate_command.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/image/output_file.h"
#include "razor/kernels/code_size.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/scene/default_scene.h"
#include "razor/scene/scene_file.h"
#include "sim/config/placement.h"
#include "sim/machine/intervals.h"
#include "sim/machine/machine.h"
#include "sim/program/native_run.h"
#include "sim/validation/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

using State = ValidationRow::State;

struct SceneToCheck {
    const char* name;
    razor::Scene scene;
};

/// A picture so small that it is simulated in seconds.
razor::Scene small(razor::SceneDescription d, int side) {
    d.settings.width = d.settings.height = side;
    d.settings.samples = 1;
    d.settings.edge_pixels = 4;
    d.settings.light_samples = d.settings.sky_samples = 1;
    return razor::build_scene(d);
}

std::vector<SceneToCheck> scenes() {
    const auto shape = [](const char* name, const char* scheme) {
        const std::string text = fmt::format("[[mesh]]\nshape = \"{}\"\n{}", name, scheme);
        return small(razor::parse_scene_file(text, name, "."), 16);
    };
    std::vector<SceneToCheck> out;
    out.push_back({"default", small(razor::default_scene(), 24)});
    out.push_back({"urchin", shape("urchin", "")});
    out.push_back({"knot, bilinear", shape("knot", "scheme = \"bilinear\"\n")});
    return out;
}

/// Three tiles that differ in who comes when.
Config three_tiles() {
    Config c;
    c.chip.tiles = 3;
    c.chip.cores = 2;
    c.chip.threads = 2;
    c.sim.quantum = 100;
    c.kdtree.share = "tile";
    return c;
}

struct Simulated {
    Report report;
    razor::Film film;
};

Simulated simulate(const razor::Scene& scene, const Config& config, int host_threads,
                   const RunOptions& options) {
    const Machine machine(config);
    const int workers = machine.threads();
    razor::Frame frame(scene, {.workers = workers,
                               .tree_of_worker = Placement(config.chip).trees(workers, config.kdtree.share),
                               .place_of_worker = Placement(config.chip).places(workers)});
    const Labels labels{{std::begin(razor::phase_names), std::end(razor::phase_names)},
                        {std::begin(razor::kind_names), std::end(razor::kind_names)}};
    Report r = machine.run(
        frame.memory(), workers, labels, [&](int worker) { frame.render(razor::simulated::kernels, worker); },
        host_threads, options);
    return {std::move(r), frame.film()};
}

/// Everything that is simulated here obeys the laws, or the run would have ended with the first one broken.
class FrameChecks {
public:
    void run(std::vector<ValidationRow>& rows) {
        const std::vector<SceneToCheck> all = scenes();
        check_pictures(all, rows);
        check_order(all.front().scene, rows);
        report_noise(all[1].scene, rows);
        rows.push_back({"laws", "conservation laws of every run (machine/laws.cpp)", "exact",
                        fmt::format("{} frames keep all", frames_), State::passed});
    }

private:
    Simulated frame(const razor::Scene& scene, const Config& config, int host_threads,
                    const RunOptions& options = {}) {
        ++frames_;
        return simulate(scene, config, host_threads, options);
    }

    void check_pictures(const std::vector<SceneToCheck>& all, std::vector<ValidationRow>& rows) {
        const std::atomic<bool> cancel{false};
        for (const SceneToCheck& s : all) {
            const NativeRun native = run_native(s.scene, frame(s.scene, three_tiles(), 1).film, cancel);
            ValidationRow row = exact(fmt::format("operations: scene {}", s.name),
                                      fmt::format("the picture rendered natively ({})", native.isa), 1,
                                      native.equal ? 0 : 1, "a pixel");
            row.bar = "bit for bit";
            row.measured = native.equal ? "equal" : "differs";
            if (!native.equal && native.unfused) { // sse4 rounds twice where the simulated one fuses
                row.measured = "differs in last bits, as sse4 does not fuse";
                row.state = State::reported;
            }
            rows.push_back(std::move(row));
        }
    }

    void check_order(const razor::Scene& scene, std::vector<ValidationRow>& rows) {
        const Report serial = frame(scene, three_tiles(), 1, {.interval = 5000}).report;
        const auto compare = [&](const char* what, const std::vector<RunOptions>& runs,
                                 const std::vector<int>& host_threads) {
            std::size_t wrong = 0;
            std::string first;
            for (std::size_t i = 0; i < runs.size(); ++i) {
                const Report r = frame(scene, three_tiles(), host_threads[i], runs[i]).report;
                if (print_json(r, false) != print_json(serial, false) ||
                    print_intervals(r) != print_intervals(serial))
                    first = wrong++ == 0 ? fmt::format("run {}", i + 1) : first;
            }
            ValidationRow row =
                exact(what, "one host thread, in order: report and time series", runs.size(), wrong, first);
            row.bar = "bit-equal";
            rows.push_back(std::move(row));
        };
        const RunOptions plain{.interval = 5000};
        compare("order: 2 and 3 host threads", {plain, plain}, {2, 3});
        const auto order = [](std::uint32_t seed) {
            return RunOptions{.interval = 5000, .host_order = seed};
        };
        compare("order: tiles and requests of equal times as the host comes to them", {order(1), order(2)},
                {1, 1});
    }

    void report_noise(const razor::Scene& scene, std::vector<ValidationRow>& rows) {
        std::vector<double> cycles;
        for (int seed = 1; seed <= 10; ++seed) {
            Config c = three_tiles();
            c.sim.jitter = seed;
            cycles.push_back(static_cast<double>(frame(scene, c, 1).report.cycles));
        }
        const auto [least, most] = std::minmax_element(cycles.begin(), cycles.end());
        rows.push_back({"noise: cycles, seeds 1 to 10", "each other (sim.jitter)", "reported",
                        fmt::format("{:.0f} to {:.0f}: {:.2f} %", *least, *most, 100 * (*most / *least - 1)),
                        State::reported});
    }

    int frames_ = 0;
};

/// Rows of the table that this program does not run, and why.
std::vector<ValidationRow> elsewhere() {
    return {
        {"instruction and reference counts", "sse4 and avx2 builds under cachegrind, by kernel", "20 %, 25 %",
         "analysis/calibration; reports of xeon-x5355-2s and zen4-2c-avx2 show what remains", State::tests},
        {"caches", "an independent simple model, on the same traces", "exact",
         "test_sim, CacheOracle: integers equal", State::tests},
        {"TLB", "an independent simple model, on the same traces", "exact",
         "test_sim, TlbOracle: integers equal", State::tests},
        {"DRAM: curves beside DRAMsim3 and Ramulator", "those two, where they agree", "10 %",
         "by hand, in sim/README.md", State::tests},
        {"DRAM: distances of commands", "the data sheet's, pairwise, of random traffic", "exact",
         "test_sim, DramRules", State::tests},
        {"core: threads, registers, store buffer, pairing", "closed forms", "exact cycles",
         "test_sim, Core, Stores, Pairing", State::tests},
        {"coherence of plain data: who has which line", "an independent table of states, random accesses",
         "exact", "test_sim, Coherence: integers equal", State::tests},
        {"coherence of shared words", "hand-derived cycles", "2 %", "test_sim, Sharing and Tiles",
         State::tests},
        {"network: what tiles and memory do over it", "laws, hand-derived cycles, other host threads",
         "exact", "test_sim, Network", State::tests},
        {"order: the other compiler", "the same run", "bit-equal", "this program is one compiler's",
         State::tests},
        {"assumptions: halved and doubled", "the study's conclusion", "reported",
         "by hand, analysis/sweep/assumptions.py", State::tests},
        {"the whole: frames of 26 points, simulated", "the same frames rendered by a host", "reported",
         "analysis/whole/whole.py; a table in sim/README.md", State::tests},
        {"the whole: instructions, lanes, windows", "what was published of Razor on a Xeon and Niagara",
         "reported", "analysis/whole/characterise.py; a table in sim/README.md", State::tests},
    };
}

nlohmann::ordered_json to_json(const ValidationRow& r) {
    return {{"what", r.what},
            {"against", r.against},
            {"bar", r.bar},
            {"measured", r.measured},
            {"result", name_of(r.state)}};
}

void print_rows(const std::vector<ValidationRow>& rows) {
    for (const ValidationRow& r : rows)
        fmt::print("{:<10} {:<52} {:<14} {}\n{:<10}   against {}\n", name_of(r.state), r.what, r.bar,
                   r.measured, "", r.against);
}

} // namespace

void ValidateCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "validate", "compare the machine with what it must equal: native pictures, closed forms, "
                    "itself on other host threads; exit code 1 if a bar is missed");
    command_->add_option("--json", json_, "write the table for programs")->type_name("FILE.json");
}

int ValidateCommand::run() const {
    if (!json_.empty())
        razor::check_writable(json_);
    std::vector<ValidationRow> rows;
    const auto add = [&rows](const std::vector<ValidationRow>& more) {
        print_rows(more);
        rows.insert(rows.end(), more.begin(), more.end());
    };
    fmt::print("{:<10} {:<52} {:<14} {}\n", "result", "what", "bar", "measured");
    add(check_core());
    add(check_reference());
    add(check_tlb());
    add(check_network());
    add(check_coherence());
    add(check_dram());
    std::vector<ValidationRow> frames;
    FrameChecks().run(frames);
    add(frames);
    add(elsewhere());
    const auto count = [&rows](State s) {
        return std::count_if(rows.begin(), rows.end(), [s](const ValidationRow& r) { return r.state == s; });
    };
    fmt::print("\n{} rows passed, {} missed, {} reported; {} by tests alone, {} not built\n",
               count(State::passed), count(State::missed), count(State::reported), count(State::tests),
               count(State::unbuilt));
    if (!json_.empty()) {
        nlohmann::ordered_json out{{"program", "razor-sim validate"}, {"version", razor::version()}};
        for (const ValidationRow& r : rows)
            out["rows"].push_back(to_json(r));
        out["missed"] = count(State::missed);
        razor::write_json_file(json_, out);
    }
    return exit_code(rows);
}

} // namespace sim
