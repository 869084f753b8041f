#include "analysis/study/run.h"

#include "analysis/study/claim.h"
#include "analysis/study/error.h"
#include "analysis/study/isolated.h"

#include <fmt/format.h>

#include <deque>
#include <list>

namespace analysis {
namespace {

constexpr int stopped_code = 130, unwritten_code = 3, changed_code = 4;
constexpr int look_ms = 50; // at whether it is to stop, and at what others have done

/// In the point's own process.
int measure_and_write(const Point& point, const Store& store, const Measure& measure,
                      const RunOptions& options) {
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
    try { // what failed may have failed for that
        if (options.changed && !options.changed(point).empty())
            return changed_code;
    } catch (const Stopped&) {
        return stopped_code;
    }
    try {
        store.write_result(point, result, options.program);
    } catch (const std::exception&) {
        return unwritten_code; // whoever waits for this process says so
    }
    return 0;
}

Result failure(std::string why) {
    Result result;
    result.failed = std::move(why);
    return result;
}

/// The points of one call, some of them under way.
class Queue {
public:
    Queue(const std::vector<Point>& points, const Store& store, const Measure& measure,
          const RunOptions& options)
        : points_(points), store_(store), measure_(measure), options_(options), claims_(store) {
        store.make_folders(); // before work is begun for nothing
        for (std::size_t i = 0; i < points.size(); ++i)
            if (i % static_cast<std::size_t>(options.parts) + 1 == static_cast<std::size_t>(options.part))
                waiting_.push_back(i);
    }

    RunSummary run() {
        static const std::atomic<bool> never{false};
        const std::atomic<bool>& stop = options_.stop == nullptr ? never : *options_.stop;
        for (;;) {
            stopping_ = stopping_ || stop.load();
            collect_ended();
            if (!stopping_)
                begin_some(stop);
            if (running_.empty() && (stopping_ || waiting_.empty()))
                break;
            claims_.keep();
            wait_for_one();
        }
        out_.stopped = stopping_ && (cut_off_ || !waiting_.empty());
        return out_;
    }

private:
    struct Running {
        std::size_t point;
        Isolated process;
    };

    void wait_for_one() const {
        std::vector<pid_t> children;
        for (const Running& one : running_)
            children.push_back(one.process.process());
        ChildrenEnd(children).wait(look_ms);
    }

    /// Takes each waiting point once: what is done already falls out, what others have waits on.
    void begin_some(const std::atomic<bool>& stop) {
        for (std::size_t left = waiting_.size(); left > 0; --left) {
            if (running_.size() >= static_cast<std::size_t>(options_.jobs))
                return;
            stopping_ = stopping_ || stop.load();
            if (stopping_)
                return;
            const std::size_t i = waiting_.front();
            waiting_.pop_front();
            if (is_kept(points_[i])) {
                ++out_.kept;
                continue;
            }
            if (!claims_.take(points_[i])) {
                waiting_.push_back(i);
                continue;
            }
            if (is_kept(points_[i])) { // by who had it until now
                claims_.release(points_[i]);
                ++out_.kept;
                continue;
            }
            begin(i);
        }
    }

    bool is_kept(const Point& point) const {
        return store_.is_done(point) &&
               !(options_.again_failed && !store_.read_result(point)->failed.empty());
    }

    void begin(std::size_t i) {
        const Point& point = points_[i];
        if (options_.progress)
            options_.progress(out_.kept + out_.measured + running_.size(), points_.size(), point);
        store_.write_point(point);
        if (!point.impossible.empty()) {
            store_.write_result(point, failure(point.impossible), options_.program);
            finish(i);
            return;
        }
        running_.push_back(
            {i, Isolated([&] { return measure_and_write(point, store_, measure_, options_); })});
    }

    void finish(std::size_t i) {
        claims_.release(points_[i]);
        ++out_.measured;
        if (!store_.read_result(points_[i])->failed.empty())
            ++out_.failed;
    }

    [[noreturn]] void fail_changed(const Point& point) const {
        const std::string file = options_.changed(point);
        throw StudyError(fmt::format("{}: was changed while the study ran, and what was measured of it is "
                                     "not kept; run the same command again",
                                     file.empty() ? "a file of " + point.name : file));
    }

    void collect_ended() {
        for (auto one = running_.begin(); one != running_.end();) {
            if (stopping_)
                one->process.ask_to_end();
            Ended ended;
            if (!one->process.has_ended(ended)) {
                ++one;
                continue;
            }
            const std::size_t i = one->point;
            one = running_.erase(one);
            // Whoever was told to end has no result, however it ended.
            if (stopping_ && (ended.code != 0 || !ended.signal.empty())) {
                cut_off_ = true;
                claims_.release(points_[i]);
                continue;
            }
            if (ended.code == stopped_code) { // told by a terminal that has yet to tell this process
                claims_.release(points_[i]);
                cut_off_ = stopping_ = true;
                continue;
            }
            if (!ended.signal.empty())
                store_.write_result(points_[i], failure(fmt::format("ended by a signal: {}", ended.signal)),
                                    options_.program);
            else if (ended.code == changed_code)
                fail_changed(points_[i]);
            else if (ended.code != 0)
                throw StudyError(fmt::format("{}: cannot be written; check the disk and the folder's rights",
                                             store_.result_file(points_[i]).string()));
            finish(i);
        }
    }

    const std::vector<Point>& points_;
    const Store& store_;
    const Measure& measure_;
    const RunOptions& options_;
    Claims claims_;
    std::deque<std::size_t> waiting_;
    std::list<Running> running_;
    RunSummary out_;
    bool stopping_ = false, cut_off_ = false;
};

} // namespace

RunSummary run_points(const std::vector<Point>& points, const Store& store, const Measure& measure,
                      const RunOptions& options) {
    return Queue(points, store, measure, options).run();
}

} // namespace analysis
