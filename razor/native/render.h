// Rendering a scene on the host: one thread a worker runs the kernels of the chosen target.
#pragma once

#include "razor/frame/frame.h"
#include "razor/image/image.h"
#include "razor/native/passes.h"
#include "razor/native/render_calls.h"
#include "razor/native/visible.h"
#include "razor/scene/scene.h"
#include "razor/survey/survey.h"

#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace razor {

struct RenderOptions {
    int threads = 0;          // 0: one a core
    std::string isa = "auto"; // plain, sse4, avx2, avx512 or auto: the best this processor has
    int share = 0;            // workers that share one kd-tree; 0: all
    /// To compare with: one thread splits the whole kd-tree, down to the finest blocks that any ray could ask
    /// for, before the first ray. Shading normals stay lazy. There must be one tree.
    bool eager = false;
    /// The frame is rendered so many times, everything built anew each time but topology pages: what a later
    /// frame of an animation costs. The film and all figures but the times are those of the last.
    int frames = 1;
    /// What a frame may build at a time: FrameOptions::memory_bytes. 0: no bound.
    std::uint64_t memory_bytes = 0;
    int tiles = 0;              // screen tiles rendered, along the curve; pixels of others stay 0. 0: all
    bool tiles_in_rows = false; // their order
    PassOptions passes{};       // in which camera samples are taken
    LayerSet layers{};          // added to the film, once the frame is rendered
    TouchMeter touched{};       // for some of them
    /// Instead of those of `isa`; and what runs all workers of a frame with them, instead of run_workers().
    const KernelTable* kernels = nullptr;
    std::function<void(Frame& frame, const std::function<void(double)>& progress)> run{};
    /// Called now and then with the fraction of tiles begun, from the calling thread.
    std::function<void(double fraction)> progress{};
    /// Set to true from anywhere to stop early; render_native then throws Cancelled.
    const std::atomic<bool>* cancel = nullptr;
};

/// Host time of one frame.
struct FrameTime {
    double render_seconds = 0;           // refit, builds and rays
    double render_processor_seconds = 0; // the same: processor time of all threads
    double eager_seconds = 0;            // of that: what was built before the first ray
    double topology_page_seconds = 0;    // of that: topology pages made, which later frames find
    PassFigures passes{};                // where there were any
};

struct RenderStatistics {
    FrameStatistics frame;   // the last one
    Duplicates duplicates;   // in it
    BudgetStatistics budget; // likewise
    std::string isa;
    int width_lanes = 0, threads = 0;
    double load_seconds = 0; // topology and frame memory
    std::vector<FrameTime> times;
    VisibleSurface visible;
    double survey_seconds = 0; // host time that layers took, beside the frame's
};

/// Counters by name; those of a kind of ray under its name.
void to_json(nlohmann::ordered_json& json, const Counters& counters);
void to_json(nlohmann::ordered_json& json, const CountersByKind& counters);
/// Of a memory budget.
void to_json(nlohmann::ordered_json& json, const BudgetStatistics& statistics);
/// Every figure by name: counters, what was built, what laziness left unbuilt, host seconds apart.
void to_json(nlohmann::ordered_json& json, const RenderStatistics& statistics);

struct RenderResult {
    Film film;
    RenderStatistics statistics;
};

/// Renders a scene, and if it `moves` the same scene in other poses, whose topology is analysed once.
class NativeRenderer {
public:
    /// Throws UserError for scenes and options that cannot be rendered.
    NativeRenderer(const Scene& scene, const RenderOptions& options, bool moves);
    /// The same scene in another pose; a scene with other meshes or instances is analysed anew. Throws
    /// UserError for scenes that cannot be rendered. `changes`: what of it is other than when this was last
    /// called, or the constructor (see Frame::pose()); null: anything.
    void pose(const Scene& scene, const SceneChanges* changes = nullptr);
    /// options.frames times. `calls` take the place of the options' own, each that is given.
    RenderResult render(const RenderCalls& calls = {});
    /// Of the kernels: "avx2".
    std::string isa() const { return kernels_.name; }

private:
    void load(const Scene& scene, const SceneChanges* changes);

    RenderOptions options_;
    bool moves_;
    const KernelTable& kernels_;
    Camera camera_;
    Settings settings_;
    std::unique_ptr<Frame> frame_;
    bool fresh_ = true; // nothing has been rendered since
    double load_seconds_ = 0;
};

RenderResult render_native(const Scene& scene, const RenderOptions& options);

/// Runs all workers of a frame to the end, each on a thread of its own; throws what the first failing worker
/// threw, and Cancelled.
void run_workers(Frame& frame, const std::function<void(int worker)>& work,
                 const std::function<void(double)>& progress = {}, const std::atomic<bool>* cancel = nullptr);
/// ... with these kernels.
void run_workers(Frame& frame, const KernelTable& kernels, const std::function<void(double)>& progress = {},
                 const std::atomic<bool>* cancel = nullptr);

} // namespace razor
