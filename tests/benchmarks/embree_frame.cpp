// A frame as `razor render SCENE --frame N` makes it, by Embree, from pose to picture; with --razor in turn
// with Razor itself.
//   embree_frame configs/scenes/courtyard.toml --frame 40 --threads 2 --repeat 5 --razor --json times.json
// Both find topology analysed: what a first frame takes beside is told apart. embree_frames.py chooses the
// level.
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/program/scene_options.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "tests/benchmarks/embree/renderer.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <ctime>
#include <numeric>
#include <optional>

namespace {

using namespace razor;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct Stopwatch {
    Clock::time_point begin = Clock::now();
    std::clock_t processor_begin = std::clock();

    double seconds() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
    double processor_seconds() const {
        return static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC;
    }
};

struct Command {
    SceneOptions scene;
    std::string threads = "2", isa = "auto", quality = "medium", levels = "instance", finer = "0",
                flatten = "0", repeat = "1", most_triangles = "100000000", output, razor_output, json;
    bool razor = false;

    void add_to(CLI::App& app) {
        scene.add_to(app, "scene");
        app.add_option("--threads", threads, "of all steps")->type_name("N");
        app.add_option("--isa", isa, "of tessellation and shading: auto, plain, sse4, avx2 or avx512")
            ->type_name("NAME");
        app.add_option("--quality", quality, "of Embree's BVHs: low (Morton codes), medium or high")
            ->type_name("NAME");
        app.add_option(
               "--levels", levels,
               "how finely Embree's meshes are cut: instance (each its own level, by edges at its nearest "
               "point), mesh (one level a mesh, that of its nearest instance), deviation (each instance by "
               "how far from the surface it is then) or uniform (every patch 2^K x 2^K quads)")
            ->type_name("NAME");
        app.add_option("--finer", finer, "all so many levels finer; negative: coarser")->type_name("K");
        app.add_option("--flatten", flatten,
                       "meshes whose instances have at most so many triangles together are drawn without "
                       "Embree's instances")
            ->type_name("N");
        app.add_option("--most-triangles", most_triangles, "refuse to tessellate into more")->type_name("N");
        app.add_option("--repeat", repeat, "measure N frames, after one that makes what later ones find")
            ->type_name("N");
        app.add_flag("--razor", razor, "measure Razor's frame in turn, at its own levels of detail");
        app.add_option("-o,--output", output, "Embree's picture, .exr or .png")->type_name("FILE");
        app.add_option("--razor-output", razor_output, "Razor's picture")->type_name("FILE");
        app.add_option("--json", json, "all figures")->type_name("FILE.json");
    }

    baseline::Options options() const {
        constexpr std::array<std::string_view, 3> qualities{"low", "medium", "high"};
        baseline::Options o;
        o.threads = parse_whole("--threads", threads, {1, 1024});
        o.isa = isa;
        o.quality = static_cast<baseline::Quality>(parse_choice("--quality", quality, qualities));
        constexpr std::array<std::string_view, 4> rules{"instance", "mesh", "deviation", "uniform"};
        o.levels = static_cast<baseline::Levels>(parse_choice("--levels", levels, rules));
        o.finer = parse_whole("--finer", finer, {-20, 20});
        o.flatten = parse_whole("--flatten", flatten, {0, 1000000000});
        o.most_triangles = parse_whole("--most-triangles", most_triangles, {1, 1000000000});
        return o;
    }
};

Json figures(const baseline::Report& r, double pose, double processor) {
    const baseline::Seconds& s = r.seconds;
    return {{"seconds", pose + s.all()}, {"processor_seconds", processor},
            {"pose", pose + s.place},    {"tessellate", s.tessellate},
            {"build", s.build},          {"trace", s.trace},
            {"topology", s.topology}};
}

Json what_was_made(const baseline::Report& r) {
    return {{"triangles", r.triangles},
            {"instanced_triangles", r.instanced_triangles},
            {"pieces", r.pieces},
            {"grid_meshes", r.grid_meshes},
            {"bvh_bytes", r.bvh_bytes},
            {"vertex_bytes", r.vertex_bytes},
            {"topology_bytes", r.topology_bytes},
            {"rays", {{"camera", r.rays.camera}, {"light", r.rays.light}, {"sky", r.rays.sky}}}};
}

/// Razor's side.
class Ours {
public:
    explicit Ours(const Command& c) {
        options_.threads = parse_whole("--threads", c.threads, {1, 1024});
        options_.isa = c.isa;
    }

    Json frame(const SceneDescription& moving, int number, Film& film) {
        const Stopwatch all;
        const Scene scene = build_scene(pose_of_frame(moving, number));
        if (renderer_)
            renderer_->pose(scene);
        else
            renderer_.emplace(scene, options_, true);
        const double pose = all.seconds();
        RenderResult result = renderer_->render();
        const double seconds = all.seconds(), processor = all.processor_seconds();
        film = std::move(result.film);
        const FrameStatistics& f = result.statistics.frame;
        made = {{"triangles", f.counters.triangles_made},
                {"bytes", f.grid_bytes + f.node_bytes + f.list_bytes + f.patch_table_bytes},
                {"page_bytes", f.page_bytes},
                {"rays", f.counters.rays}};
        return {{"seconds", seconds},
                {"processor_seconds", processor},
                {"pose", pose},
                {"render", result.statistics.times.back().render_seconds},
                {"topology", result.statistics.times.back().topology_page_seconds}};
    }
    Json made;

private:
    RenderOptions options_;
    std::optional<NativeRenderer> renderer_;
};

int run(const Command& c) {
    const baseline::Options options = c.options();
    const int repeat = parse_whole("--repeat", c.repeat, {0, 1000000});
    for (const std::string& name : {c.output, c.razor_output})
        if (!name.empty())
            check_output(name);
    const int number = c.scene.frame();
    const SceneDescription moving = c.scene.describe_moving();
    baseline::Renderer renderer(options);
    std::optional<Ours> ours;
    if (c.razor || !c.razor_output.empty())
        ours.emplace(c);
    Json embree_runs = Json::array(), razor_runs = Json::array();
    baseline::Report report;
    for (int n = 0; n <= repeat; ++n) {
        Film film;
        const Stopwatch all;
        const Scene scene = build_scene(pose_of_frame(moving, number));
        const double pose = all.seconds(), processor = all.processor_seconds();
        film = renderer.render(scene, report);
        Json run = figures(report, pose, processor + report.seconds.processor);
        fmt::print("{}Embree {:.3f} s: pose {:.3f}, tessellate {:.3f}, build {:.3f}, trace {:.3f}; processor "
                   "{:.3f}; "
                   "topology beside that {:.3f}\n",
                   n == 0 ? "first: " : "", run["seconds"].get<double>(), run["pose"].get<double>(),
                   report.seconds.tessellate, report.seconds.build, report.seconds.trace,
                   run["processor_seconds"].get<double>(), report.seconds.topology);
        if (n == repeat && !c.output.empty())
            write_image(c.output, film, {});
        if (n > 0)
            embree_runs.push_back(std::move(run));
        if (!ours)
            continue;
        run = ours->frame(moving, number, film);
        fmt::print(
            "{}Razor  {:.3f} s: pose {:.3f}, render {:.3f}; processor {:.3f}; topology in that {:.3f}\n",
            n == 0 ? "first: " : "", run["seconds"].get<double>(), run["pose"].get<double>(),
            run["render"].get<double>(), run["processor_seconds"].get<double>(),
            run["topology"].get<double>());
        if (n == repeat && !c.razor_output.empty())
            write_image(c.razor_output, film, {});
        if (n > 0)
            razor_runs.push_back(std::move(run));
    }
    fmt::print(
        "{} triangles, {} with instances; {} pieces of {} meshes and levels; {:.1f} MB of BVHs, {:.1f} MB of "
        "vertices; {} rays\n",
        report.triangles, report.instanced_triangles, report.pieces, report.grid_meshes,
        static_cast<double>(report.bvh_bytes) / 1e6, static_cast<double>(report.vertex_bytes) / 1e6,
        report.rays.camera + report.rays.light + report.rays.sky);
    if (!c.json.empty()) {
        Json all{{"frame", number}, {"embree", {{"made", what_was_made(report)}, {"runs", embree_runs}}}};
        if (ours)
            all["razor"] = {{"made", ours->made}, {"runs", razor_runs}};
        write_text_file(c.json, all.dump(2) + "\n");
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("A frame by Embree, tessellated at fixed levels, and by Razor", "embree_frame");
    Command command;
    command.add_to(app);
    return run_program(app, argc, argv, [&] { return run(command); });
}
