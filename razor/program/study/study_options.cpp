#include "razor/program/study/study_options.h"

#include "analysis/study/error.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

#include <cstdio>
#include <tuple>
#include <unistd.h>

namespace razor {
namespace {

/// A line on a terminal that says which point is measured.
class Line {
public:
    explicit Line(bool wanted) : shown_(wanted && ::isatty(STDERR_FILENO) == 1) {}
    ~Line() { clear(); }
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;

    void show(std::size_t done, std::size_t of, const std::string& what) {
        if (!shown_)
            return;
        fmt::print(stderr, "\r\x1b[K{} of {}: {}", done + 1, of, what.substr(0, 90));
        std::fflush(stderr);
    }
    void clear() const {
        if (shown_) {
            fmt::print(stderr, "\r\x1b[K");
            std::fflush(stderr);
        }
    }

private:
    bool shown_;
};

std::string described(const analysis::Point& point, const std::vector<std::string>& knobs) {
    std::string out = point.rival;
    for (const std::string& key : knobs)
        if (const auto found = point.settings.find(key); found != point.settings.end())
            out += fmt::format("{}{} {}", out.empty() ? "" : ", ", key, analysis::plain_text(found->second));
    return out;
}

} // namespace

void StudyOptions::add_to(CLI::App& command) {
    command.add_option("study", file_, "the study, such as configs/studies/showcase-levels.toml")
        ->type_name("STUDY.toml")
        ->required();
    command
        .add_option(
            "-o,--output", folder_,
            "where points, results, tables and plots go; what is there already is not measured again; "
            "without it, out/ and the study's name")
        ->type_name("FOLDER");
    command.add_flag("--full", full_, "the study's full size, [full] in its file");
    command.add_flag("--plan", plan_, "say which points there are, and measure nothing");
    command.add_flag("--collect", collect_, "of what is measured already, make tables and plots anew");
    command
        .add_option("--part", part_,
                    "measure only every M-th point, beginning with the N-th: for several machines with one "
                    "folder")
        ->type_name("N/M");
    command.add_flag("--again", again_, "measure points anew that failed");
    command.add_flag("--quiet", quiet_, "show no progress");
}

std::filesystem::path StudyOptions::base() const {
    return std::filesystem::path(file_).parent_path();
}

std::filesystem::path StudyOptions::folder() const {
    return folder_.empty() ? std::filesystem::path("out") / std::filesystem::path(file_).stem()
                           : std::filesystem::path(folder_);
}

std::pair<int, int> StudyOptions::part() const {
    return part_.empty() ? std::pair{1, 1} : parse_span("--part", part_, {1, 100000}, "/");
}

analysis::Study StudyOptions::read(const StudyProgram& program) const {
    part(); // a wrong one is found before any file is read
    try {
        return analysis::read_study(file_, program.vocabulary, full_);
    } catch (const analysis::StudyError& error) {
        throw UserError(error.what());
    }
}

int StudyOptions::run(
    const StudyProgram& program, const analysis::Study& study, const std::vector<analysis::Point>& points,
    const analysis::Store& store,
    const std::function<std::vector<StudyStage>(const std::vector<analysis::Point>& missing)>& stages) const {
    if (plan_) {
        for (const analysis::Point& point : points) {
            store.write_point(point);
            fmt::print("{} {}{}\n", point.name, described(point, study.knobs),
                       point.impossible.empty() ? store.is_done(point) ? " (done)" : ""
                                                : ": impossible: " + point.impossible);
        }
        return 0;
    }
    analysis::RunSummary all;
    if (!collect_) {
        analysis::RunOptions options;
        options.program = program.name;
        options.stop = &watch_interrupts();
        options.again_failed = again_;
        const auto [part, parts] = this->part();
        std::vector<analysis::Point> missing;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool mine = i % static_cast<std::size_t>(parts) + 1 == static_cast<std::size_t>(part);
            const bool again =
                again_ && store.is_done(points[i]) && !store.read_result(points[i])->failed.empty();
            if (mine && points[i].impossible.empty() && (again || !store.is_done(points[i])))
                missing.push_back(points[i]);
        }
        Line line(!quiet_);
        options.progress = [&](std::size_t done, std::size_t of, const analysis::Point& next) {
            line.show(done, of, described(next, study.knobs));
        };
        for (const StudyStage& stage : stages(missing)) {
            std::tie(options.part, options.parts) = stage.shared ? std::pair{1, 1} : std::pair{part, parts};
            all = run_points(stage.points, store, stage.measure, options);
            if (all.stopped)
                break;
        }
    }
    if (all.stopped) {
        fmt::print(stderr, "{}: interrupted; what was measured is in {}: the same command goes on\n",
                   program.name.substr(0, program.name.find(' ')), store.folder().string());
        return interrupted_exit;
    }
    collect(program, study, points, store);
    return 0;
}

void StudyOptions::collect(const StudyProgram& program, const analysis::Study& study,
                           const std::vector<analysis::Point>& points, const analysis::Store& store) const {
    const OutputGuard guard;
    const analysis::Collection all = analysis::collect(study, points, store, program.figures, program.plots);
    const std::vector<std::string> written = analysis::write_collection(all, store, program.remarks);
    if (quiet_)
        return;
    fmt::print("{} points: {} measured, {} failed, {} missing\n", points.size(),
               points.size() - all.failed - all.missing, all.failed, all.missing);
    for (const analysis::CollectedPlot& plot : all.plots) {
        fmt::print("\n{} over {}: the Pareto front\n", plot.request.y, plot.request.x);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (plot.standing[i] != analysis::Standing::front && plot.standing[i] != analysis::Standing::tied)
                continue;
            const auto x = analysis::spread_of(all.points[i].samples(plot.request.x));
            const auto y = analysis::spread_of(all.points[i].samples(plot.request.y));
            fmt::print("  {:10.4g} [{:.4g} .. {:.4g}]  {:10.4g} [{:.4g} .. {:.4g}]  {}{}\n", x.median,
                       x.least, x.most, y.median, y.least, y.most, described(points[i], all.knobs),
                       plot.standing[i] == analysis::Standing::tied ? " (tied)" : "");
        }
    }
    for (const analysis::CollectedPoint& point : all.points)
        if (point.result && !point.measured())
            fmt::print("failed: {}: {}\n", described(point.point, all.knobs), point.result->failed);
    fmt::print("\n{}\n", fmt::join(written, "\n"));
}

} // namespace razor
