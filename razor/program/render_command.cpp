#include "razor/program/render_command.h"

#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/native/render.h"
#include "razor/program/arguments.h"
#include "razor/program/interrupt.h"
#include "razor/program/progress.h"
#include "razor/scene/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

namespace razor {
namespace {

constexpr Range threads_range{1, 1024};
constexpr Range frames_range{1, 1000000};
constexpr std::array<std::string_view, 5> isa_words{"auto", "plain", "sse4", "avx2", "avx512"};

} // namespace

void RenderCommand::add_to(CLI::App& app) {
    CLI::App& render = *app.add_subcommand("render", "render a scene file, a model, or the built-in scene");
    scene_.add_to(render, "scene");
    render
        .add_option("-o,--output", outputs_,
                    "the picture: .exr (all layers) or .png; may be given more than once")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    render.add_option("--threads", threads_, "workers; without it, one a processor")->type_name("N");
    render.add_option("--isa", isa_, "instruction set: auto, plain, sse4, avx2 or avx512")->type_name("NAME");
    render
        .add_option("--share", share_,
                    "who shares a kd-tree: chip (all, the default), worker (nobody), or N workers a tree")
        ->type_name("WHO");
    render.add_flag("--eager", eager_,
                    "build all that rays could ask for, but normals, before the first one; to compare with");
    render
        .add_option("--frames", frames_,
                    "render the frame N times and tell the time of each; all but the first find the topology "
                    "analysed, as in an animation")
        ->type_name("N");
    render.add_option("--stats", statistics_, "write statistics and the resolved configuration")
        ->type_name("FILE.json");
    render.add_flag("--print-config", print_config_, "print the complete scene file and render nothing");
    render.add_flag("--quiet", quiet_, "show no progress");
}

int RenderCommand::run() const {
    RenderOptions options;
    options.threads = threads_.empty() ? std::max(1, static_cast<int>(std::thread::hardware_concurrency()))
                                       : parse_whole("--threads", threads_, threads_range);
    options.isa = isa_words[parse_choice("--isa", isa_, isa_words)];
    options.share = parse_share(share_);
    options.eager = eager_;
    options.frames = parse_whole("--frames", frames_, frames_range);
    if (!print_config_ && outputs_.empty() && statistics_.empty()) {
        throw UserError("no output; add -o FILE.exr or -o FILE.png");
    }
    options.cancel = &watch_interrupts();
    const SceneDescription description = scene_.describe();
    const std::string config = to_toml(description);
    if (print_config_) {
        fmt::print("{}", config);
        return 0;
    }
    for (const std::string& output : outputs_) {
        check_output(output);
    }
    if (!statistics_.empty()) {
        check_writable(statistics_);
    }

    Progress progress(!quiet_);
    options.progress = [&](double fraction) { progress.show(fraction); };
    const auto start = std::chrono::steady_clock::now();
    RenderResult result;
    try {
        result = render_native(build_scene(description), options);
    } catch (const Cancelled&) {
        fmt::print(stderr, "{}razor: interrupted; nothing written\n", progress.shown() ? "\r\x1b[K" : "");
        return interrupted_exit;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const OutputGuard guard;
    const ImageAttributes attributes{{"razor.version", std::string(version())},
                                     {"razor.scene", config},
                                     {"razor.isa", result.statistics.isa}};
    for (const std::string& output : outputs_) {
        write_image(output, result.film, attributes);
    }
    if (!statistics_.empty()) {
        const nlohmann::ordered_json report{{"program", "razor"},
                                            {"version", version()},
                                            {"options",
                                             {{"threads", result.statistics.threads},
                                              {"isa", result.statistics.isa},
                                              {"workers_a_tree", options.share},
                                              {"eager", options.eager},
                                              {"frames", options.frames}}},
                                            {"scene", config},
                                            {"seconds", seconds},
                                            {"statistics", nlohmann::ordered_json(result.statistics)}};
        write_text_file(statistics_, report.dump(2) + "\n");
    }
    if (progress.shown()) {
        const FrameStatistics& frame = result.statistics.frame;
        fmt::print(
            stderr, "\r\x1b[K{} x {} pixels in {:.2f} s; first packet after {:.4f} s (refit {:.4f} s)\n",
            result.film.width, result.film.height, seconds, frame.first_packet_seconds, frame.refit_seconds);
    }
    return 0;
}

} // namespace razor
