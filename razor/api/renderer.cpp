#include "razor/api/renderer.h"

#include "razor/api/mesh_file.h"
#include "razor/api/scene_state.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/native/targets.h"
#include "razor/scene/animation/moving_scene.h"
#include "razor/scene/mesh_error.h"
#include "razor/scene/ranges.h"
#include "razor/scene/text_file.h"
#include "razor/survey/layers.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <utility>

namespace razor::api {

std::string_view version() {
    return RAZOR_VERSION;
}

namespace {

RenderOptions native_options(const Options& options) {
    const auto check = [](std::string_view name, double value, double most) {
        if (!(value >= 0 && value <= most))
            throw UserError(
                fmt::format("Options::{} is {:g}; it must lie between 0 and {:g}", name, value, most));
    };
    check("threads", options.threads, 1024);
    check("share", options.share, 1024);
    check("pass_samples", options.pass_samples, 65536);
    check("pass_seconds", options.pass_seconds, 1e9);
    RenderOptions all;
    all.threads = options.threads;
    all.isa = options.isa;
    all.share = options.share;
    all.memory_bytes = options.memory_bytes;
    all.passes.samples = options.pass_samples;
    all.passes.seconds = options.pass_seconds;
    if (options.target_error != 0 && !(options.target_error >= target_error_range.least &&
                                       options.target_error <= target_error_range.most))
        throw UserError(
            fmt::format("Options::target_error is {:g}; it must be 0, or lie between {:g} and {:g}",
                        options.target_error, target_error_range.least, target_error_range.most));
    all.passes.target_error = options.target_error;
    native_target(all.isa);
    if (!options.layers.empty())
        all.layers = parse_layers("Options::layers", options.layers, false);
    if (!all.layers.empty() && (all.passes.samples > 0 || all.passes.target_error > 0))
        throw UserError("Options::layers are of whole frames; leave out pass_samples and target_error");
    return all;
}

} // namespace

struct Renderer::State {
    Scene scene;
    RenderOptions options;
    bool again;
    double seconds = 0, shown = 0; // of the next picture; of what is posed
    std::unique_ptr<MovingScene> moving{};
    std::unique_ptr<NativeRenderer> native{};
    std::optional<RenderResult> result{};
    std::optional<PassFigures> told{}; // of the pass that is told of just now

    /// Brings what is posed to what is asked for. Where this throws, the next call does it all.
    void pose() {
        const SceneEdits edits = std::exchange(scene.state_->edits, {});
        const bool whole = !moving || !native || edits.more;
        if (!whole && !edits.any() && seconds == shown)
            return;
        try {
            if (whole) {
                native.reset(); // its memory goes before the next one's comes
                moving = std::make_unique<MovingScene>(scene.description());
                moving->go_to(seconds);
                native = naming_files(scene.description(), [&] {
                    return std::make_unique<NativeRenderer>(moving->scene(), options, again);
                });
            } else {
                if (edits.any())
                    moving->take_over(scene.description(), edits.objects);
                moving->go_to(seconds);
                naming_files(scene.description(), [&] { native->pose(moving->scene(), moving->changes()); });
            }
        } catch (...) {
            scene.state_->edits.more = true;
            throw;
        }
        shown = seconds;
    }
};

Renderer::Renderer(Scene scene, const Options& options)
    : Renderer(std::move(scene), native_options(options), true) {}
Renderer::Renderer(Scene scene, const RenderOptions& options, bool again)
    : state_(std::make_unique<State>(State{std::move(scene), options, again})) {}
Renderer::Renderer(Renderer&& other) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept = default;
Renderer::~Renderer() = default;

Scene& Renderer::scene() {
    return state_->scene;
}
const Scene& Renderer::scene() const {
    return state_->scene;
}
void Renderer::go_to(double seconds) {
    if (!std::isfinite(seconds))
        throw UserError(fmt::format("go_to: {:g} seconds; give a finite time", seconds));
    state_->seconds = seconds;
}
void Renderer::go_to_frame(int frame) {
    go_to(frame / state_->scene.frame_rate());
}

const Film& Renderer::render(const RenderCalls& calls) {
    State& s = *state_;
    const PassOptions& passes = s.options.passes;
    if (passes.seconds > 0 && passes.samples == 0 && passes.target_error == 0 &&
        s.scene.settings().noise_threshold == 0)
        throw UserError(
            "Options::pass_seconds of a picture without passes; set pass_samples, target_error or "
            "the scene's noise_threshold, or leave it out");
    s.result.reset();
    s.pose();
    RenderCalls all = calls;
    if (const Passed& passed = calls.passed ? calls.passed : passes.passed)
        all.passed = [&](const Film& film, const PassFigures& figures) {
            struct Telling { // ends also where `passed` throws
                std::optional<PassFigures>& told;
                ~Telling() { told.reset(); }
            };
            s.told = figures;
            const Telling telling{s.told};
            passed(film, figures);
        };
    s.result = s.native->render(all);
    return s.result->film;
}

MeshFigures Renderer::write_mesh(const std::filesystem::path& file) const {
    if (file.extension() != ".obj")
        throw UserError(fmt::format("{}: the mesh is written as OBJ only; end the name in .obj",
                                    printable(file.string(), 1000)));
    check_writable(file.string());
    MovingScene moving(state_->scene.description());
    moving.go_to(state_->seconds);
    return naming_files(state_->scene.description(), [&] {
        return write_mesh_file(file, moving.scene(), state_->options.isa, state_->options.cancel);
    });
}

std::string Renderer::scene_text() const {
    return to_toml(state_->moving->description());
}
ImageAttributes Renderer::attributes(const PassFigures& passes) const {
    ImageAttributes attributes{{"razor.version", std::string(version())},
                               {"razor.scene", scene_text()},
                               {"razor.isa", state_->native->isa()}};
    if (passes.passes > 0)
        attributes.emplace_back("razor.samples", fmt::format("{:.6g}", passes.mean_samples));
    return attributes;
}
void Renderer::write(const std::filesystem::path& file, const Film& film, const Tone& tone) const {
    check_output(file);
    write_image(file, film, attributes(state_->told ? *state_->told : statistics().passes), tone);
}

std::vector<std::string> Renderer::instances() const {
    const razor::Scene& scene = posed();
    const SceneGraph graph = drawn_graph(scene.graph, scene.meshes.size());
    const FlatGraph flat = flatten(graph, mesh_bounds(state_->moving->description()));
    std::vector<std::string> names;
    for (const FlatInstance& instance : flat.instances)
        names.push_back(path_of(flat, graph, instance.node));
    return names;
}

Statistics Renderer::statistics() const {
    const RenderStatistics& all = figures();
    const FrameStatistics& f = all.frame;
    Statistics s;
    s.isa = all.isa;
    s.plan = f.plan;
    s.threads = all.threads;
    s.load_seconds = all.load_seconds;
    s.render_seconds = all.times.back().render_seconds;
    s.rays = f.counters.rays;
    s.instances = f.instances;
    s.patches = f.patches;
    s.patches_opened = f.counters.patches_opened - all.budget.regenerated_patches;
    s.blocks = f.counters.blocks_made;
    s.grid_bytes = f.grid_bytes;
    s.node_bytes = f.node_bytes;
    s.list_bytes = f.list_bytes;
    s.passes = all.times.back().passes;
    return s;
}
std::string Renderer::statistics_json() const {
    return nlohmann::ordered_json(figures()).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}
const RenderOptions& Renderer::options() const {
    return state_->options;
}
const RenderStatistics& Renderer::figures() const {
    if (!state_->result)
        throw std::logic_error("no picture was rendered");
    return state_->result->statistics;
}
const razor::Scene& Renderer::posed() const {
    if (!state_->moving)
        throw std::logic_error("no picture was rendered");
    return state_->moving->scene();
}

} // namespace razor::api
