#include "razor/native/render.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/adaptive_sampling.h"
#include "razor/native/targets.h"
#include "razor/scene/error.h"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace razor {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

} // namespace

void run_workers(Frame& frame, const KernelTable& kernels, const std::function<void(double)>& progress,
                 const std::atomic<bool>* cancel) {
    run_workers(
        frame, [&](int worker) { frame.render(kernels, worker); }, progress, cancel);
}

void run_workers(Frame& frame, const std::function<void(int worker)>& work,
                 const std::function<void(double)>& progress, const std::atomic<bool>* cancel) {
    int workers = frame.workers();
    std::mutex mutex;
    std::condition_variable changed;
    int running = workers;
    std::exception_ptr failure;
    std::vector<std::jthread> threads;
    for (int w = 0; w < workers; ++w)
        threads.emplace_back([&, w] {
            std::exception_ptr mine;
            try {
                work(w);
            } catch (...) {
                mine = std::current_exception();
                frame.stop();
            }
            std::lock_guard guard(mutex);
            if (mine && !failure)
                failure = mine;
            --running;
            changed.notify_one();
        });
    bool cancelled = false;
    {
        std::unique_lock lock(mutex);
        while (running > 0) {
            changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return running == 0; });
            if (cancel != nullptr && cancel->load() && !cancelled) {
                cancelled = true;
                frame.stop();
            }
            if (progress)
                progress(frame.progress());
        }
    }
    threads.clear();
    if (cancelled)
        throw Cancelled{};
    if (failure)
        std::rethrow_exception(failure);
}

namespace {

FrameTime render_frame(Frame& frame, const KernelTable& kernels, const RenderOptions& options,
                       const Settings& settings, const std::function<void(double)>& progress) {
    FrameTime time;
    const double pages_before = frame.statistics().page_seconds;
    const auto begin = Clock::now();
    const std::clock_t processor_begin = std::clock();
    if (options.eager) {
        frame.build_all(kernels);
        time.eager_seconds = seconds_since(begin);
    }
    const auto run = [&](const std::function<void(double)>& shown) {
        if (options.run)
            options.run(frame, shown);
        else
            run_workers(frame, kernels, shown, options.cancel);
    };
    if (settings.noise_threshold > 0)
        time.passes = take_adaptive_passes(frame, kernels, settings, options.passes, run, progress);
    else if (options.passes.target_error > 0)
        time.passes = take_passes_to_error(frame, kernels, settings, options.passes, run, progress);
    else if (options.passes.samples > 0)
        time.passes = take_passes(frame, options.passes, settings.samples, run, progress);
    else
        run(progress);
    time.render_seconds = seconds_since(begin);
    time.render_processor_seconds = static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC;
    time.topology_page_seconds = frame.statistics().page_seconds - pages_before;
    return time;
}

} // namespace

NativeRenderer::NativeRenderer(const Scene& scene, const RenderOptions& options, bool moves)
    : options_(options), moves_(moves),
      kernels_(options.kernels != nullptr ? *options.kernels : native_target(options.isa)) {
    if (options_.threads <= 0)
        options_.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    if (options_.eager && options_.memory_bytes != 0)
        throw UserError(
            "--eager builds everything at once, which no memory budget bounds; leave --memory out");
    load(scene, nullptr);
    if (options_.eager && frame_->statistics().trees > 1)
        throw UserError("--eager builds one kd-tree; leave --share out");
}

void NativeRenderer::pose(const Scene& scene, const SceneChanges* changes) {
    load(scene, changes);
}

namespace {

/// Throws UserError where samples cannot be taken by noise.
void check_noise_threshold(const Scene& scene, const RenderOptions& options) {
    if (scene.settings.noise_threshold <= 0)
        return;
    if (scene.settings.samples <= pilot_samples)
        throw UserError(fmt::format("{}: with a noise threshold samples are the most that a pixel may have, "
                                    "and {} leave no choice: each has {} to begin with; give more (--spp)",
                                    scene.name, scene.settings.samples, pilot_samples));
    if (!options.layers.empty())
        throw UserError("layers are of whole frames; leave them out, or the noise threshold");
    if (options.frames > 1 || options.tiles > 0 || options.run)
        throw UserError("a noise threshold is of one frame, all of it, rendered once; set it to 0");
}

/// Throws UserError where samples cannot be taken by error.
void check_target_error(const Scene& scene, const RenderOptions& options) {
    if (options.passes.target_error <= 0)
        return;
    if (scene.settings.noise_threshold > 0)
        throw UserError(
            fmt::format("{}: a noise threshold and a target error both say how many samples there "
                        "are; leave out one",
                        scene.name));
    if (!options.layers.empty())
        throw UserError("layers are of whole frames; leave them out, or the target error");
    if (options.frames > 1 || options.tiles > 0 || options.run)
        throw UserError("a target error is of one frame, all of it, rendered once; set it to 0");
}

} // namespace

void NativeRenderer::load(const Scene& scene, const SceneChanges* changes) {
    check_noise_threshold(scene, options_);
    check_target_error(scene, options_);
    camera_ = scene.camera;
    settings_ = scene.settings;
    const auto begin = Clock::now();
    const auto pose = [&] {
        return changes != nullptr ? frame_->pose(scene, *changes) : frame_->pose(scene);
    };
    if (!frame_ || !pose()) {
        frame_.reset(); // its memory goes before the next one's comes
        const bool by_tiles = settings_.noise_threshold > 0 || options_.passes.target_error > 0;
        frame_ = std::make_unique<Frame>(
            scene, FrameOptions{.workers = options_.threads,
                                .tree_of_worker = tree_groups(options_.threads, options_.share),
                                .tiles_in_rows = options_.tiles_in_rows,
                                .memory_bytes = options_.memory_bytes,
                                .apart = options_.layers.has(LayerSource::touch),
                                .moves = moves_,
                                .passes = options_.passes.samples > 0 || by_tiles,
                                .tile_passes = by_tiles,
                                .tile_costs = options_.layers.has(LayerSource::tile)});
    }
    load_seconds_ = seconds_since(begin);
    fresh_ = true;
}

RenderResult NativeRenderer::render(const RenderCalls& calls) {
    RenderOptions options = options_;
    if (calls.progress)
        options.progress = calls.progress;
    if (calls.cancel != nullptr)
        options.cancel = calls.cancel;
    if (calls.passed)
        options.passes.passed = calls.passed;
    RenderResult r;
    r.statistics.isa = kernels_.name;
    r.statistics.width_lanes = kernels_.width;
    r.statistics.threads = options.threads;
    r.statistics.load_seconds = load_seconds_;
    for (int n = 0; n < options.frames; ++n) {
        if (!fresh_)
            frame_->reset();
        fresh_ = false;
        if (options.tiles > 0)
            frame_->take_tiles(0, options.tiles);
        std::function<void(double)> part;
        if (options.progress)
            part = [&](double fraction) { options.progress((n + fraction) / options.frames); };
        r.statistics.times.push_back(render_frame(*frame_, kernels_, options, settings_, part));
    }
    r.statistics.frame = frame_->statistics();
    r.statistics.budget = frame_->budget();
    r.statistics.duplicates = frame_->duplicates();
    r.film = frame_->film();
    r.statistics.visible = visible_surface(r.film, camera_, settings_);
    if (!options.layers.empty()) {
        const auto begin = Clock::now();
        const SurveyOptions asked{options.layers, &kernels_, options.touched, options.cancel};
        if (!survey(*frame_, shown_part(settings_), asked, r.film))
            throw Cancelled{};
        r.statistics.survey_seconds = seconds_since(begin);
    }
    return r;
}

RenderResult render_native(const Scene& scene, const RenderOptions& options) {
    return NativeRenderer(scene, options, false).render();
}

} // namespace razor
