#include "razor/program/study/study_options.h"

#include "analysis/study/error.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <thread>
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

constexpr const char* again_hint = " (--again measures what failed anew)";

/// Of a plot that shows no point.
std::string why_empty(const analysis::Collection& all, const analysis::PlotRequest& plot) {
    for (const std::string& figure : {plot.y, plot.x})
        if (std::all_of(all.points.begin(), all.points.end(),
                        [&](const analysis::CollectedPoint& point) { return point.samples(figure).empty(); }))
            return "no point has " + figure;
    return "no point has both above zero";
}

/// Why the first point that failed did.
std::string first_failure(const std::vector<analysis::Point>& points, const analysis::Store& store) {
    for (const analysis::Point& point : points)
        if (point.impossible.empty() && store.is_done(point))
            if (const std::string why = store.read_result(point)->failed; !why.empty())
                return printable(why, 500);
    return "";
}

} // namespace

void StudyOptions::add_to(CLI::App& command, StudyKind kind) {
    command.add_option("study", file_, "the study, such as those of configs/studies")
        ->type_name("STUDY.toml")
        ->required();
    timed_ = kind == StudyKind::timed;
    if (!timed_)
        add_steps(command);
    command
        .add_option(
            "-o,--output", folder_,
            "where points, results, tables and plots go; what is there already is not measured again; "
            "without it, out/ and the study's name")
        ->type_name("FOLDER");
    command.add_flag("--full", full_, "the study's full size, [full] in its file");
    if (timed_) {
        command.add_flag("--plan", plan_, "say which points there are, and measure nothing");
        command.add_flag("--collect", collect_, "of what is measured already, make tables and plots anew");
    }
    command
        .add_option("--part", part_,
                    "measure only every M-th point, beginning with the N-th: for several machines with one "
                    "folder")
        ->type_name("N/M");
    command.add_flag("--again", again_, "measure points anew that failed");
    command.add_flag("--quiet", quiet_, "show no progress and no summary, but what failed");
}

void StudyOptions::add_steps(CLI::App& command) {
    command
        .add_option("step", step_,
                    "one step alone: plan writes points/NAME.toml for each point and lists them, run "
                    "measures them, collect makes tables and plots; without it, all three")
        ->type_name("plan|run|collect");
    command.add_option("--point", point_, "run this point alone, by the name that plan tells")
        ->type_name("NAME");
    command.add_option("--jobs", jobs_, "points measured at a time; without it, one a processor")
        ->type_name("N");
}

bool StudyOptions::wants(const char* step) const {
    return step_.empty() || step_ == step;
}

int StudyOptions::jobs() const {
    return jobs_.empty() ? static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))
                         : parse_whole("--jobs", jobs_, {1, 4096});
}

std::filesystem::path StudyOptions::base() const {
    return std::filesystem::path(file_).parent_path();
}

std::filesystem::path StudyOptions::folder() const {
    return folder_.empty() ? std::filesystem::path("out") / std::filesystem::path(file_).stem()
                           : std::filesystem::path(folder_);
}

std::pair<int, int> StudyOptions::part() const {
    if (part_.empty())
        return {1, 1};
    const std::size_t slash = part_.find('/');
    const std::string number = part_.substr(0, slash),
                      of = slash == std::string::npos ? "" : part_.substr(slash + 1);
    const auto whole = [](const std::string& text) {
        return !text.empty() && text.size() < 7 && text.find_first_not_of("0123456789") == std::string::npos;
    };
    if (!whole(number) || !whole(of) || std::stoi(number) < 1 || std::stoi(number) > std::stoi(of))
        throw UserError(
            fmt::format("--part '{}': give N/M, the N-th of M parts, as 1/4 to 4/4", printable(part_)));
    return {std::stoi(number), std::stoi(of)};
}

analysis::Study StudyOptions::read(const StudyProgram& program) const {
    // Wrong ones are found before any file is read.
    part();
    jobs();
    if (!step_.empty() && step_ != "plan" && step_ != "run" && step_ != "collect")
        throw UserError(
            fmt::format("{} is no step of a sweep; write plan, run, collect, or none for all three",
                        printable(step_, 100)));
    if (!point_.empty() && step_ != "run")
        throw UserError("--point says which point the step run takes; write run behind the study");
    if (!point_.empty() && !part_.empty())
        throw UserError("--point and --part both say which points run; give one of them");
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
    if (!points.empty() && std::none_of(points.begin(), points.end(), [](const analysis::Point& point) {
            return point.impossible.empty();
        }))
        throw UserError(fmt::format("{}: none of its points can be measured; the first: {}", study.file,
                                    printable(points.front().impossible, 500)));
    if (plan_ || step_ == "plan") {
        print_plan(study, points, store);
        return 0;
    }
    if (!point_.empty() && std::none_of(points.begin(), points.end(),
                                        [&](const analysis::Point& point) { return point.name == point_; }))
        throw UserError(fmt::format("{}: there is no point {}; the step plan lists them", study.file,
                                    printable(point_, 100)));
    const bool collects_alone = collect_ || step_ == "collect";
    if (collects_alone && std::none_of(points.begin(), points.end(),
                                       [&](const analysis::Point& point) { return store.is_done(point); }))
        throw UserError(fmt::format("{}: nothing measured there; {}, or mend -o",
                                    printable(store.folder().string(), 300),
                                    timed_ ? "measure first, without --collect" : "run the step run first"));
    analysis::RunSummary all;
    if (!collect_ && wants("run")) {
        analysis::RunOptions options;
        options.program = program.name;
        options.stop = &watch_interrupts();
        options.again_failed = again_;
        options.jobs = timed_ ? 1 : jobs();
        options.changed = program.changed;
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
            line.show(done, of, analysis::settings_text(next, study.knobs));
        };
        for (StudyStage stage : stages(missing)) {
            if (!point_.empty())
                std::erase_if(stage.points, [&](const analysis::Point& point) {
                    return !stage.shared && point.name != point_;
                });
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
    if (wants("collect"))
        return collect(program, study, points, store);
    std::size_t failed_before = 0;
    const auto [mine, parts] = part();
    for (std::size_t i = 0; i < points.size(); ++i)
        if (i % static_cast<std::size_t>(parts) + 1 == static_cast<std::size_t>(mine) &&
            (point_.empty() || points[i].name == point_) && store.is_done(points[i]) &&
            !store.read_result(points[i])->failed.empty())
            ++failed_before;
    failed_before -= std::min(failed_before, all.failed);
    if (!quiet_)
        fmt::print("{} measured, {} of them failed; {} were there{}{}\n", all.measured, all.failed, all.kept,
                   failed_before == 0 ? "" : fmt::format(", {} of them failed", failed_before),
                   all.failed + failed_before == 0 ? "" : again_hint);
    return 0;
}

void StudyOptions::print_plan(const analysis::Study& study, const std::vector<analysis::Point>& points,
                              const analysis::Store& store) const {
    for (const analysis::Point& point : points) {
        if (!plan_)
            store.write_point(point);
        if (!quiet_)
            fmt::print("{} {}{}\n", point.name, analysis::settings_text(point, study.knobs),
                       point.impossible.empty() ? store.is_done(point) ? " (done)" : ""
                                                : ": impossible: " + point.impossible);
    }
}

int StudyOptions::collect(const StudyProgram& program, const analysis::Study& study,
                          const std::vector<analysis::Point>& points, const analysis::Store& store) const {
    const OutputGuard guard;
    const analysis::Collection all = analysis::collect(study, points, store, program.figures, program.views);
    const std::vector<std::string> written = analysis::write_collection(all, store, program.remarks);
    const int code = all.failed > 0 && all.failed + all.missing == points.size() ? 1 : 0;
    if (code != 0)
        fmt::print(stderr, "{}: all that was measured of {} failed; {}\n",
                   program.name.substr(0, program.name.find(' ')), study.file, first_failure(points, store));
    if (quiet_) {
        if (all.failed > 0 && code == 0)
            fmt::print(stderr, "{}: {} of {} points failed; {}\n",
                       program.name.substr(0, program.name.find(' ')), all.failed, points.size(),
                       first_failure(points, store));
        return code;
    }
    fmt::print("{} points: {} measured, {} failed, {} missing{}\n", points.size(),
               points.size() - all.failed - all.missing, all.failed, all.missing,
               all.failed == 0 ? "" : again_hint);
    for (const analysis::CollectedPlot& plot : all.plots) {
        fmt::print("\n{} over {}: the Pareto front\n", plot.request.y, plot.request.x);
        if (plot.chart.empty())
            fmt::print("  ({})\n", why_empty(all, plot.request));
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (plot.standing[i] != analysis::Standing::front && plot.standing[i] != analysis::Standing::tied)
                continue;
            const auto x = analysis::spread_of(all.points[i].samples(plot.request.x));
            const auto y = analysis::spread_of(all.points[i].samples(plot.request.y));
            fmt::print("  {:10.4g} [{:.4g} .. {:.4g}]  {:10.4g} [{:.4g} .. {:.4g}]  {}{}\n", x.median,
                       x.least, x.most, y.median, y.least, y.most,
                       analysis::settings_text(points[i], all.knobs),
                       plot.standing[i] == analysis::Standing::tied ? " (tied)" : "");
        }
    }
    for (const analysis::Ranking& ranking : all.rankings) {
        fmt::print("\n{}\n", ranking.verdict(all.points, all.knobs));
        for (const analysis::Sensitivity& s : ranking.ratios)
            fmt::print("  {:<28} {} to {}: {:.4g} [{:.4g} .. {:.4g}] of {} pairs, {} beyond noise\n", s.knob,
                       analysis::plain_text(s.from), analysis::plain_text(s.to), s.ratio.median,
                       s.ratio.least, s.ratio.most, s.ratio.count, s.sure);
    }
    for (const analysis::CollectedPoint& point : all.points)
        if (point.result && !point.measured())
            fmt::print("failed: {}: {}\n", analysis::settings_text(point.point, all.knobs),
                       point.result->failed);
    fmt::print("\n{}\n", fmt::join(written, "\n"));
    return code;
}

} // namespace razor
