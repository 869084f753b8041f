#include "razor/program/render_command.h"

#include "analysis/images/image_file.h"
#include "razor/image/output.h"
#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/program/explain.h"
#include "razor/program/frame_trace.h"
#include "razor/program/interrupt.h"
#include "razor/program/passes_report.h"
#include "razor/program/sequence.h"
#include "razor/scene/error.h"
#include "razor/scene/numbered_name.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

namespace razor {
namespace {

double made_megabytes(const RenderStatistics& s) {
    const FrameStatistics& f = s.frame;
    const BudgetStatistics& b = s.budget;
    return 1e-6 * static_cast<double>(b.budget_bytes != 0
                                          ? b.made_grid_bytes + b.made_node_bytes + b.made_list_bytes
                                          : f.grid_bytes + f.node_bytes + f.list_bytes);
}

/// ", ..." of a memory budget; else nothing.
std::string memory_text(const BudgetStatistics& s) {
    if (s.budget_bytes == 0)
        return "";
    const auto percent = [](std::int64_t part, std::int64_t whole) {
        return 100 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(whole, 1));
    };
    return fmt::format(", at most {:.1f} MB at a time: {:.1f} % of blocks and {:.1f} % of nodes made again",
                       static_cast<double>(s.peak_bytes) / 1e6, percent(s.regenerated_blocks, s.made_blocks),
                       percent(s.regenerated_nodes, s.made_nodes));
}

constexpr Range threads_range{1, 1024};
constexpr Range repeat_range{1, 1000000};
constexpr std::array<std::string_view, 5> isa_words{"auto", "plain", "sse4", "avx2", "avx512"};

/// A file's name may be any bytes, a scene file's text not. Throws UserError.
void check_readable(const std::string& scene) {
    std::istringstream lines(scene);
    for (std::string line; std::getline(lines, line);) {
        try {
            static_cast<void>(nlohmann::json(line).dump());
        } catch (const nlohmann::json::type_error&) {
            throw UserError(
                fmt::format("{}: is not in UTF-8, as scene files are; rename the file or the thing",
                            printable(line, 1000)));
        }
    }
}

bool is_file(const std::string& name) {
    std::error_code error;
    return std::filesystem::is_regular_file(name, error);
}

/// Whether it can be read to its end, and has this size: not what another program or a crash left.
bool is_whole_picture(const std::string& name, int width, int height) {
    if (!is_file(name))
        return false;
    try {
        const analysis::ImageFile picture = analysis::read_image(name);
        return picture.width == width && picture.height == height;
    } catch (const analysis::ImageError&) {
        return false;
    }
}

bool is_whole_json(const std::string& name) {
    std::ifstream file(name, std::ios::binary);
    return is_file(name) && nlohmann::json::accept(file);
}

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
    render
        .add_option(
            "--memory", memory_,
            "what grids, kd nodes and item lists may take in all, such as 256MiB; what was used longest "
            "ago is dropped and made again; without it, no bound")
        ->type_name("SIZE");
    render.add_flag("--eager", eager_,
                    "build all that rays could ask for, but normals, before the first one; to compare with");
    render
        .add_option("--frames", frames_,
                    "render a sequence: these frames of what moves, each to its own files, whose names have "
                    "%d or %04d where the number comes; with a line of figures for each")
        ->type_name("FIRST:LAST");
    render.add_flag("--resume", resume_,
                    "of --frames, leave out those whose files are there, whole and of the size asked for");
    render
        .add_option("--repeat", repeat_,
                    "render the frame N times and tell the time of each; all but the first find the topology "
                    "analysed, as in an animation")
        ->type_name("N");
    render.add_flag("--progressive", progressive_,
                    "take samples in passes, and write the pictures after each: there are whole ones at any "
                    "moment");
    render
        .add_option(
            "--time", time_,
            "take samples in passes as long as another ends by then, such as 10s, and tell how many "
            "that were and how far the picture may be off; levels of detail are those of --spp samples")
        ->type_name("TIME");
    render
        .add_option(
            "--target-error", target_error_,
            "take samples, where they help most, until the picture's noise is estimated to be no more than "
            "E: the "
            "root mean square over pixels and channels of (v - r) / (r + 0.01), the root of what compare "
            "calls relative MSE, such as 0.05; from 16 to 65536 samples a pixel, or as --time ends; without "
            "--edge-pixels, also choose these so that levels of detail differ less than that from ones half "
            "as "
            "long; light that --bounces and --diffuse-bounces leave out is no part of it; levels are those "
            "of "
            "--spp samples")
        ->type_name("E");
    render.add_option("--exposure", exposure_, "of PNG files, in stops; without it, 0")->type_name("X");
    render
        .add_option("--tone", tone_,
                    "how PNG files show light: srgb (as it is, cut off at 1; the default), aces (as film "
                    "does) or agx (likewise, bright colours fading to white)")
        ->type_name("NAME");
    layers_.add_to(render);
    render.add_option("--stats", statistics_, "write statistics and the resolved configuration")
        ->type_name("FILE.json");
    render
        .add_option("--trace", trace_,
                    "record what the frame loads and stores, for razor-trace: of the simulated kernels, with "
                    "no machine")
        ->type_name("FILE.rzt");
    render.add_flag("--print-config", print_config_, "print the complete scene file and render nothing");
    render.add_flag("--explain", explain_,
                    "tell what the frame needed, what was left out, and what was never built");
    render.add_flag("--quiet", quiet_, "show no progress");
}

RenderOptions RenderCommand::options() const {
    RenderOptions options;
    options.threads = threads_.empty() ? std::max(1, static_cast<int>(std::thread::hardware_concurrency()))
                                       : parse_whole("--threads", threads_, threads_range);
    options.isa = isa_words[parse_choice("--isa", isa_, isa_words)];
    options.share = parse_share(share_);
    options.eager = eager_;
    options.memory_bytes = memory_.empty() ? 0 : parse_bytes("--memory", memory_);
    options.frames = parse_whole("--repeat", repeat_, repeat_range);
    const bool sequence = !frames_.empty();
    if (sequence && scene_.frame_given()) {
        throw UserError("--frame and --frames together; give one of them");
    }
    if (resume_ && !sequence) {
        throw UserError("--resume without --frames; leave it out");
    }
    if (sequence) {
        parse_frames(frames_);
    } else {
        scene_.frame();
    }
    if (!print_config_ && outputs_.empty() && statistics_.empty() && trace_.empty() && !explain_) {
        throw UserError("no output; add -o FILE.exr or -o FILE.png");
    }
    if (!trace_.empty() && (sequence || options.frames > 1 || eager_ || options.isa != "auto")) {
        throw UserError("--trace is of one frame, rendered once, by kernels of its own; leave out --frames, "
                        "--repeat, --eager and --isa");
    }
    if (layers_.given() && !trace_.empty()) {
        throw UserError(
            "--trace is of kernels that keep no time of tiles; leave out --layers and --false-colour");
    }
    if (layers_.shows() && (!exposure_.empty() || tone_ != "srgb")) {
        throw UserError("--false-colour shows no light; leave out --exposure and --tone");
    }
    layers_.ask(options, outputs_);
    tone(); // a wrong one is found before any file is read
    if ((!exposure_.empty() || tone_ != "srgb") && std::none_of(outputs_.begin(), outputs_.end(), is_png)) {
        throw UserError("--exposure and --tone are of PNG files; name one by -o, or leave them out");
    }
    options.passes = passes();
    if (options.passes.samples > 0 && (options.frames > 1 || !trace_.empty())) {
        throw UserError(
            "--progressive, --time and --target-error take passes of one frame, rendered once; leave out "
            "--repeat and --trace");
    }
    if (progressive_ && (sequence || outputs_.empty())) {
        throw UserError(
            "--progressive writes one frame's pictures again and again; give -o FILE, and leave out "
            "--frames");
    }
    if (options.passes.samples > 0 && !options.layers.empty()) {
        throw UserError("layers are of whole frames; leave out --progressive, --time and --target-error, or "
                        "--layers and --false-colour");
    }
    return options;
}

int RenderCommand::run() const {
    RenderOptions options = this->options();
    const bool sequence = !frames_.empty();
    const FrameRange frames = sequence ? parse_frames(frames_) : FrameRange{scene_.frame(), scene_.frame()};
    options.cancel = &watch_interrupts();
    if (print_config_) {
        const std::string text = to_toml(scene_.frame_given() ? scene_.describe() : scene_.describe_moving());
        check_readable(text);
        fmt::print("{}", text);
        return 0;
    }
    SceneDescription description = sequence ? scene_.describe_moving() : scene_.describe();
    for (const std::string& note : notes_of(description)) {
        if (!quiet_) {
            fmt::print(stderr, "razor: {}\n", note);
        }
    }
    if (layers_.shows_samples() && description.settings.noise_threshold <= 0 &&
        options.passes.target_error <= 0) {
        throw UserError("--false-colour samples is of samples taken by noise; add --noise-threshold X or "
                        "--target-error E");
    }
    if (options.passes.target_error > 0 && description.settings.noise_threshold > 0) {
        throw UserError("a noise threshold and --target-error both say how many samples there are; leave out "
                        "one (--noise-threshold 0)");
    }
    std::vector<std::filesystem::path> files(outputs_.begin(), outputs_.end());
    files.insert(files.end(), {statistics_, trace_});
    check_apart(files);
    for (const std::string& output : outputs_) {
        check_numbered("-o", output, frames);
        check_output(numbered(output, frames.first));
    }
    if (!statistics_.empty()) {
        check_numbered("--stats", statistics_, frames);
        check_writable(numbered(statistics_, frames.first));
    }
    std::optional<EdgeChoice> levels;
    if (options.passes.target_error > 0) {
        levels = choose_edges(description, frames.first, options, scene_.edge_pixels_given());
        if (levels && !quiet_) {
            fmt::print("{}\n", text_of(*levels));
            std::fflush(stdout);
        }
        if (!levels) {
            fmt::print(stderr, "razor: interrupted; nothing written\n");
            return interrupted_exit;
        }
    }
    api::Scene scene(std::move(description));
    std::optional<FrameTrace> trace;
    if (!trace_.empty()) {
        check_writable(trace_);
        trace.emplace(trace_, scene.toml());
        trace->record_by(options);
    }

    Progress progress(!quiet_);
    const Crop part = shown_part(scene.description().settings);
    const auto is_there = [this, part](int frame) {
        return std::all_of(outputs_.begin(), outputs_.end(),
                           [&](const std::string& name) {
                               return is_whole_picture(numbered(name, frame), part.width, part.height);
                           }) &&
               (statistics_.empty() || is_whole_json(numbered(statistics_, frame)));
    };
    api::Renderer renderer(std::move(scene), options, sequence);
    double written = 0;
    for (int frame = frames.first; frame <= frames.last; ++frame) {
        if (resume_ && is_there(frame)) {
            continue;
        }
        if (sequence) {
            renderer.go_to_frame(frame);
        }
        RenderCalls calls;
        calls.progress = [&](double fraction) {
            progress.show((frame - frames.first + fraction) / frames.count());
        };
        if (progressive_) {
            calls.passed = write_passes(renderer, frame, written);
        }
        if (!render(renderer, frame, calls, progress, levels)) {
            fmt::print(stderr, "{}razor: interrupted; {}\n", progress.shown() ? "\r\x1b[K" : "",
                       sequence ? fmt::format(
                                      "frame {} and what follows are not written; go on with --resume", frame)
                       : written > 0 ? fmt::format("the pictures are of {:.6g} samples a pixel", written)
                                     : "nothing written");
            return interrupted_exit;
        }
    }
    if (trace) {
        const OutputGuard guard;
        const std::string told = trace->finish();
        if (!quiet_) {
            fmt::print("{}\n", told);
        }
    }
    return 0;
}

Tone RenderCommand::tone() const {
    constexpr std::array<std::string_view, 3> names{"srgb", "aces", "agx"};
    constexpr std::array<ToneCurve, 3> curves{ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx};
    Tone tone;
    tone.curve = curves[parse_choice("--tone", tone_, names)];
    if (!exposure_.empty())
        tone.exposure = static_cast<float>(parse_number("--exposure", exposure_, stops_range));
    return tone;
}

PassOptions RenderCommand::passes() const {
    constexpr int samples_a_pass = 4; // as in a packet of 32 lanes that sees eight pixels
    PassOptions passes;
    passes.target_error =
        target_error_.empty() ? 0 : parse_number("--target-error", target_error_, target_error_range);
    passes.samples = progressive_ || !time_.empty() || passes.target_error > 0 ? samples_a_pass : 0;
    passes.seconds = time_.empty() ? 0 : parse_seconds("--time", time_);
    return passes;
}

void RenderCommand::write_pictures(const api::Renderer& renderer, int frame, const Film& film,
                                   const PassFigures& passes) const {
    const ImageAttributes attributes = renderer.attributes(passes);
    const Film colours = layers_.shows() ? layers_.shown(film) : Film();
    for (const std::string& output : outputs_) {
        write_image(numbered(output, frame), layers_.shows() && is_png(output) ? colours : film, attributes,
                    tone());
    }
}

Passed RenderCommand::write_passes(const api::Renderer& renderer, int frame, double& written) const {
    using Clock = std::chrono::steady_clock;
    // Writing takes no more than about a tenth of the time.
    return [this, &renderer, frame, &written,
            next = Clock::time_point{}](const Film& film, const PassFigures& figures) mutable {
        const auto begin = Clock::now();
        if (begin < next) {
            return;
        }
        const OutputGuard guard;
        write_pictures(renderer, frame, film, figures);
        written = figures.mean_samples;
        const auto end = Clock::now();
        next = end + 10 * (end - begin);
    };
}

bool RenderCommand::render(api::Renderer& renderer, int frame, const RenderCalls& calls,
                           const Progress& progress, const std::optional<EdgeChoice>& levels) const {
    const auto start = std::chrono::steady_clock::now();
    const Film* film = nullptr;
    try {
        film = &renderer.render(calls);
    } catch (const Cancelled&) {
        return false;
    } catch (const UserError& error) {
        if (frames_.empty()) {
            throw;
        }
        throw UserError(fmt::format("frame {}: {}", frame, error.what()));
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const OutputGuard guard;
    write_pictures(renderer, frame, *film, renderer.statistics().passes);
    if (!statistics_.empty()) {
        write_statistics(renderer, frame, seconds, levels);
    }
    tell(renderer, frame, seconds, *film, progress);
    return true;
}

void RenderCommand::write_statistics(const api::Renderer& renderer, int frame, double seconds,
                                     const std::optional<EdgeChoice>& levels) const {
    const RenderStatistics& figures = renderer.figures();
    const RenderOptions& asked = renderer.options();
    nlohmann::ordered_json report{{"program", "razor"},
                                  {"version", version()},
                                  {"options",
                                   {{"threads", figures.threads},
                                    {"isa", figures.isa},
                                    {"workers_a_tree", asked.share},
                                    {"eager", asked.eager},
                                    {"memory_bytes", asked.memory_bytes},
                                    {"repeat", asked.frames},
                                    {"frame", frame}}},
                                  {"scene", renderer.scene_text()},
                                  {"seconds", seconds},
                                  {"statistics", nlohmann::ordered_json(figures)}};
    if (levels) {
        report["levels"] = json_of(*levels);
    }
    write_json_file(numbered(statistics_, frame), report);
}

void RenderCommand::tell(const api::Renderer& renderer, int frame, double seconds, const Film& film,
                         const Progress& progress) const {
    const RenderStatistics& figures = renderer.figures();
    const FrameStatistics& built = figures.frame;
    if (!frames_.empty() && !quiet_) {
        fmt::print(stderr, "{}", progress.shown() ? "\r\x1b[K" : "");
        fmt::print("frame {}: {:.3f} s, of which {:.3f} s to load; {} instances and {} clusters touched, "
                   "{:.2f} million rays, {:.1f} MB built, slowest tile {:.1f} ms{}\n",
                   frame, seconds, figures.load_seconds, built.touched.instances, built.touched.clusters,
                   static_cast<double>(built.counters.rays) / 1e6, made_megabytes(figures),
                   1e3 * built.slowest_tile_seconds, memory_text(figures.budget));
        std::fflush(stdout);
    } else if (progress.shown()) {
        fmt::print(stderr,
                   "\r\x1b[K{} x {} pixels in {:.2f} s; first packet after {:.4f} s (refit {:.4f} s)\n",
                   film.width, film.height, seconds, built.first_packet_seconds, built.refit_seconds);
    }
    if (const PassFigures& passes = figures.times.back().passes; passes.passes > 0 && !quiet_) {
        fmt::print("{}\n", passes_text(passes));
        std::fflush(stdout);
    }
    if (!quiet_) {
        fmt::print("{}", layers_.legend(film));
    }
    if (explain_) {
        fmt::print("{}", explain(renderer.posed(), figures));
    }
}

} // namespace razor
