#include "sim/estimate/screen_schedule.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace sim {
namespace {

struct Taken {
    int tile = -1; // none
    bool foreign = false;
};

/// What is left of the workers' stretches.
class Screen {
public:
    Screen(int tiles, const std::vector<ScreenWorker>& workers) : workers_(workers) {
        const auto first = stretches(tiles, static_cast<int>(workers.size()));
        for (std::size_t w = 0; w < workers.size(); ++w)
            left_.push_back({first[w], first[w + 1]});
    }

    bool has_own(std::size_t place) const { return left_[place].begin < left_[place].end; }
    /// The worker's next tile.
    Taken take(std::size_t place) {
        Stretch& own = left_[place];
        if (own.begin < own.end)
            return {own.begin++, false};
        const std::size_t span = std::bit_ceil(left_.size());
        for (const bool others : {false, true})
            for (std::size_t apart = 1; apart < span; ++apart) {
                const std::size_t victim = place ^ apart;
                if (victim >= left_.size() || left_[victim].begin == left_[victim].end ||
                    (workers_[victim].tree != workers_[place].tree) != others)
                    continue;
                Stretch& theirs = left_[victim];
                const int kept = theirs.begin + (theirs.end - theirs.begin) / 2;
                own = {kept + 1, theirs.end};
                theirs.end = kept;
                return {kept, others};
            }
        return {};
    }

private:
    struct Stretch {
        int begin = 0, end = 0;
    };
    const std::vector<ScreenWorker>& workers_;
    std::vector<Stretch> left_;
};

/// The workers at one moment.
class Crew {
public:
    Crew(const std::vector<double>& work, const std::vector<ScreenWorker>& workers, ScreenSchedule& out)
        : work_(work), workers_(workers), out_(out), screen_(static_cast<int>(work.size()), workers),
          running_(workers.size()) {
        out_.finish.assign(workers.size(), 0);
        // All begin at once: nobody takes what its owner is about to.
        for (const bool own : {true, false})
            for (std::size_t w = 0; w < workers.size(); ++w)
                if (screen_.has_own(w) == own && !running_[w].begun) {
                    running_[w].begun = true;
                    go_on(w);
                    running_[w].wait = workers[w].delay;
                }
    }

    void count(std::vector<int>& at_work) const {
        std::fill(at_work.begin(), at_work.end(), 0);
        for (std::size_t w = 0; w < running_.size(); ++w)
            if (!running_[w].done && running_[w].wait <= 0)
                ++at_work[core(w)];
    }
    /// Until the first of them has something else to do; infinity: all are done.
    double next(const std::vector<double>& pace) const {
        double step = std::numeric_limits<double>::infinity();
        for (std::size_t w = 0; w < running_.size(); ++w)
            if (const Running& r = running_[w]; !r.done)
                step = std::min(step, r.wait > 0 ? r.wait : r.left / pace[core(w)]);
        return step;
    }
    void advance(double step, const std::vector<double>& pace) {
        out_.cycles += step;
        // Those that end together end in one step, whatever rounding leaves of them.
        const double rest = 1e-9 * (1 + out_.cycles);
        for (std::size_t w = 0; w < running_.size(); ++w) {
            Running& r = running_[w];
            if (r.done)
                continue;
            if (r.wait > 0) {
                out_.waiting += step;
                r.wait = r.wait - step > rest ? r.wait - step : 0;
                continue;
            }
            out_.busy += step;
            r.left -= step * pace[core(w)];
            if (r.left <= rest * pace[core(w)])
                go_on(w);
        }
    }

private:
    struct Running {
        double wait = 0, left = 0;
        bool begun = false, done = false;
    };
    std::size_t core(std::size_t w) const { return static_cast<std::size_t>(workers_[w].core); }
    void go_on(std::size_t w) {
        const Taken next = screen_.take(w);
        running_[w].done = next.tile < 0;
        if (running_[w].done)
            out_.finish[w] = out_.cycles;
        else
            running_[w].left = work_[static_cast<std::size_t>(next.tile)];
        out_.stolen_from_others += next.foreign ? 1 : 0;
    }

    const std::vector<double>& work_;
    const std::vector<ScreenWorker>& workers_;
    ScreenSchedule& out_;
    Screen screen_;
    std::vector<Running> running_;
};

} // namespace

std::vector<int> stretches(int tiles, int workers) {
    std::vector<int> out;
    for (int w = 0; w <= workers; ++w)
        out.push_back(static_cast<int>(std::int64_t{tiles} * w / workers));
    return out;
}

ScreenSchedule schedule_screen(const std::vector<double>& work, const std::vector<ScreenWorker>& workers,
                               int cores, const Paces& paces) {
    ScreenSchedule out;
    Crew crew(work, workers, out);
    std::vector<int> at_work(static_cast<std::size_t>(cores));
    for (;;) {
        crew.count(at_work);
        const std::vector<double>& pace = paces(at_work);
        const double step = crew.next(pace);
        if (!(step < std::numeric_limits<double>::infinity()))
            return out;
        crew.advance(step, pace);
    }
}

} // namespace sim
