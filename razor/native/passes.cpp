#include "razor/native/passes.h"

#include "razor/native/adaptive_sampling.h"
#include "razor/native/target_sampling.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace razor {

void ErrorEstimate::add(const Film& so_far, int samples) {
    const auto plane = [&](const char* name) { return so_far.find(name)->values.data(); };
    const float *red = plane("R"), *green = plane("G"), *blue = plane("B");
    mean_.resize(so_far.pixel_count());
    squares_.resize(so_far.pixel_count());
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        const double mean = luminance(double{red[i]}, double{green[i]}, double{blue[i]});
        const double batch = (mean * samples - mean_[i] * samples_) / (samples - samples_);
        squares_[i] += batch * batch * (samples - samples_);
        mean_[i] = mean;
    }
    samples_ = samples;
    ++passes_;
}

double ErrorEstimate::error() const {
    if (passes_ < 2)
        return 0;
    double sum = 0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        const double apart = squares_[i] - samples_ * mean_[i] * mean_[i];
        if (!std::isfinite(apart))
            continue;
        sum += std::max(apart, 0.0) / samples_ / (passes_ - 1);
        ++pixels;
    }
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(pixels, 1)));
}

double ErrorEstimate::relative_error() const {
    double sum = 0;
    std::size_t pixels = 0;
    for (const double mean : mean_)
        if (std::isfinite(mean)) {
            sum += mean;
            ++pixels;
        }
    return sum > 0 ? error() * static_cast<double>(pixels) / sum : 0;
}

PassFigures take_passes(Frame& frame, const PassOptions& options, int samples, const RunWorkers& run,
                        const std::function<void(double)>& progress) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto now = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    const bool timed = options.seconds > 0;
    const int most =
        timed ? std::numeric_limits<int>::max() / 4096 : samples; // shadow samples are numbered too
    PassFigures figures;
    ErrorEstimate estimate;
    double last = 0;
    while (figures.samples < most && (figures.passes == 0 || !timed || now() + last <= options.seconds)) {
        const double before = now();
        const int count = std::min(options.samples, most - figures.samples);
        frame.take_samples(figures.samples, count);
        run([&](double fraction) {
            if (progress)
                progress(timed ? now() / options.seconds
                               : (figures.samples + fraction * count) / static_cast<double>(samples));
        });
        figures.samples += count;
        figures.mean_samples = figures.samples;
        ++figures.passes;
        const Film film = frame.film();
        estimate.add(film, figures.samples);
        figures.error = estimate.error();
        figures.relative_error = estimate.relative_error();
        figures.seconds = now();
        if (options.passed)
            options.passed(film, figures);
        figures.seconds = now();
        last = figures.seconds - before;
    }
    return figures;
}

namespace {

PassFigures take_planned_passes(Frame& frame, const KernelTable& kernels, SamplePlan& sampling,
                                const PassOptions& options, const RunWorkers& run,
                                const std::function<void(double)>& progress) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto now = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    PassFigures figures;
    double seconds_a_sample = 0;
    while (sampling.next()) {
        const double before = now();
        const auto added = static_cast<double>(sampling.added());
        if (options.seconds > 0 && figures.passes > 0 && before + seconds_a_sample * added > options.seconds)
            break;
        frame.take_samples(kernels, sampling.samples());
        const auto [from, to] = sampling.progress();
        run([&, from = from, to = to](double fraction) {
            if (progress)
                progress(std::max(from + fraction * (to - from),
                                  options.seconds > 0 ? std::min(now() / options.seconds, 1.0) : 0.0));
        });
        const Film film = frame.film();
        sampling.add(film);
        const int passes = figures.passes + 1;
        figures = sampling.figures();
        figures.passes = passes;
        figures.seconds = now();
        if (options.passed)
            options.passed(film, figures);
        figures.seconds = now();
        seconds_a_sample = (figures.seconds - before) / added;
    }
    return figures;
}

} // namespace

PassFigures take_adaptive_passes(Frame& frame, const KernelTable& kernels, const Settings& settings,
                                 const PassOptions& options, const RunWorkers& run,
                                 const std::function<void(double)>& progress) {
    AdaptiveSampling sampling(frame.tile_places(kernels), shown_part(settings), settings.noise_threshold,
                              settings.samples);
    return take_planned_passes(frame, kernels, sampling, options, run, progress);
}

PassFigures take_passes_to_error(Frame& frame, const KernelTable& kernels, const Settings& settings,
                                 const PassOptions& options, const RunWorkers& run,
                                 const std::function<void(double)>& progress) {
    TargetSampling sampling(frame.tile_places(kernels), shown_part(settings), settings.filter,
                            options.target_error, most_target_samples);
    return take_planned_passes(frame, kernels, sampling, options, run, progress);
}

} // namespace razor
