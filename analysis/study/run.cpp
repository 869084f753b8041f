#include "analysis/study/run.h"

#include "analysis/study/error.h"
#include "analysis/study/isolated.h"

#include <fmt/format.h>

namespace analysis {
namespace {

constexpr int stopped_code = 130, unwritten_code = 3;

/// In the point's own process.
int measure_and_write(const Point& point, const Store& store, const Measure& measure,
                      std::string_view program) {
    Result result;
    try {
        result = measure(point);
    } catch (const Stopped&) {
        return stopped_code;
    } catch (const std::bad_alloc&) {
        result = {};
        result.failed = "out of memory";
    } catch (const std::exception& error) {
        result = {};
        result.failed = error.what();
    }
    try {
        store.write_result(point, result, program);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return unwritten_code;
    }
    return 0;
}

Result failure(std::string why) {
    Result result;
    result.failed = std::move(why);
    return result;
}

} // namespace

RunSummary run_points(const std::vector<Point>& points, const Store& store, const Measure& measure,
                      const RunOptions& options) {
    static const std::atomic<bool> never{false};
    const std::atomic<bool>& stop = options.stop == nullptr ? never : *options.stop;
    RunSummary out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& point = points[i];
        if (i % static_cast<std::size_t>(options.parts) + 1 != static_cast<std::size_t>(options.part))
            continue;
        if (store.is_done(point)) {
            const bool again = options.again_failed && !store.read_result(point)->failed.empty();
            if (!again) {
                ++out.kept;
                continue;
            }
        }
        if (stop.load()) {
            out.stopped = true;
            break;
        }
        if (options.progress)
            options.progress(i, points.size(), point);
        store.write_point(point);
        if (!point.impossible.empty()) {
            store.write_result(point, failure(point.impossible), options.program);
        } else {
            const Ended ended =
                run_isolated([&] { return measure_and_write(point, store, measure, options.program); }, stop);
            // Whoever was told to end has no result, however it ended.
            if (stop.load() && (ended.code != 0 || !ended.signal.empty())) {
                out.stopped = true;
                break;
            }
            if (!ended.signal.empty())
                store.write_result(point, failure(fmt::format("ended by a signal: {}", ended.signal)),
                                   options.program);
            else if (ended.code != 0)
                throw StudyError(
                    fmt::format("the result of {} cannot be written; check the disk", point.name));
        }
        ++out.measured;
        if (!store.read_result(point)->failed.empty())
            ++out.failed;
    }
    return out;
}

} // namespace analysis
