#include "razor/program/check_command.h"

#include "razor/check/report.h"
#include "razor/check/scene_report.h"
#include "razor/image/output_file.h"
#include "razor/native/targets.h"
#include "razor/program/arguments.h"
#include "razor/program/explain.h"
#include "razor/program/interrupt.h"
#include "razor/program/progress.h"
#include "razor/scene/error.h"
#include "razor/scene/mesh_error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"
#include "razor/surface/topology.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace razor {
namespace {

constexpr Range rays_range{1, 2e9};
constexpr Range per_origin_range{1, 8192};
constexpr Range converge_range{100, 1e6};
constexpr std::array<std::string_view, 5> isa_words{"auto", "plain", "sse4", "avx2", "avx512"};

std::vector<check::MeshReport> examine(const Scene& scene) {
    std::vector<check::MeshReport> reports;
    for (const Mesh& mesh : scene.meshes) {
        validate_mesh(mesh);
        reports.push_back(check::examine(mesh));
        reports.back().name = printable(mesh.name);
    }
    return reports;
}

} // namespace

void CheckCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand("check", "examine a scene file or a model; shoot rays from inside it");
    CLI::App& check = *command_;
    scene_.add_to(check, "scene");
    check
        .add_option("--escape", escape_,
                    "shoot N rays from inside its closed bodies, each origin with a level of detail of its "
                    "own; without --lod, recursive")
        ->type_name("N");
    check.add_option("--compare", compare_, "of these, compare N hits with the surface by its definition")
        ->type_name("N");
    check
        .add_option(
            "--converge", converge_,
            "shoot N rays at its curved surfaces and show how fast hits come nearer to the limit surface "
            "as edges get shorter")
        ->type_name("N");
    check.add_option("--rays-an-origin", per_origin_, "rays of each origin; without it, 1000")
        ->type_name("N");
    check.add_option("--isa", isa_, "instruction set: auto, plain, sse4, avx2 or avx512")->type_name("NAME");
    check.add_option("--json", json_, "write all findings for programs")->type_name("FILE.json");
    check.add_flag("--strict", strict_, "end with 1 where there is any warning");
    check.add_flag("--quiet", quiet_, "show no progress");
    check.footer(
        "Exit code 0: no ray escaped, and no hit differs from the surface by definition by more than "
        "single precision rounds; 1: some did, or with --strict there are warnings; 2: the model cannot be "
        "used.\n\n"
        "Told are, of meshes: open edges, edges of more than two faces, opposite windings, points where fans "
        "touch, "
        "faces without area, slivers, repeated faces, points of more than 64 faces, sharpness between 0 and "
        "10, "
        "points of no face, holes; of the scene: how exactly hits can be told where each mesh lies, levels "
        "of "
        "detail that cannot be given, lights and materials that do nothing or too much, the "
        "features in "
        "use, and the memory a frame takes, estimated from two small pictures.\n\n"
        "The JSON has meshes (each kind of finding with its count and first place), findings (severity: "
        "warning or "
        "note, kind, object, what, means, mend), precision (by mesh, lengths in world units), features (by "
        "name, "
        "whether in use), memory (bytes, and estimated_from), notes (of what was not read).");
}

int CheckCommand::run() const {
    check::EscapeOptions options;
    const bool shoots = !escape_.empty();
    if (shoots) {
        options.rays = parse_whole("--escape", escape_, rays_range);
    } else if (!compare_.empty() || !per_origin_.empty()) {
        throw UserError("--compare and --rays-an-origin are about rays; add --escape N");
    }
    if (!compare_.empty()) {
        options.compared = parse_whole("--compare", compare_, rays_range);
    }
    if (!per_origin_.empty()) {
        options.rays_an_origin = parse_whole("--rays-an-origin", per_origin_, per_origin_range);
    }
    check::ConvergenceOptions convergence_options;
    if (!converge_.empty()) {
        convergence_options.rays = static_cast<int>(parse_whole("--converge", converge_, converge_range));
    }
    const KernelTable& kernels =
        native_target(std::string(isa_words[parse_choice("--isa", isa_, isa_words)]));
    if (!json_.empty()) {
        check_writable(json_);
    }
    options.cancel = convergence_options.cancel = &watch_interrupts();

    SceneDescription description = scene_.describe_alone(); // a floor is no part of a model
    options.seed = convergence_options.seed = static_cast<unsigned>(description.settings.seed);
    if (!scene_.lod_given()) {
        description.settings.lod = Lod::recursive;
    }
    const std::vector<std::string> notes = notes_of(description);
    Scene scene = build_scene(description);
    const std::vector<check::MeshReport> meshes = naming_files(description, [&] { return examine(scene); });
    std::optional<Scene> closed;
    if (shoots) {
        closed = check::closed_part(scene, meshes);
        if (closed->meshes.empty()) {
            throw UserError(
                fmt::format("{}: nothing in it is closed, so no ray can be kept inside: {}; close it, "
                            "or leave out --escape",
                            printable(scene.name), check::why_open(meshes)));
        }
    }
    const std::vector<check::SceneFinding> findings = check::findings_of(scene);
    const std::vector<check::PrecisionBudget> precision = check::precision_of(scene);
    const check::MemoryEstimate memory =
        naming_files(description, [&] { return check::estimate_memory(scene, kernels); });
    std::optional<check::EscapeReport> escapes;
    if (closed) {
        Progress progress(!quiet_, "checking");
        options.progress = [&](double fraction) { progress.show(fraction); };
        Frame frame(*closed, {});
        escapes = check::shoot_from_inside(frame, kernels, closed->settings.lod.lod, options);
        if (escapes->cancelled) {
            fmt::print(stderr, "{}razor: interrupted; nothing written\n", progress.shown() ? "\r\x1b[K" : "");
            return interrupted_exit;
        }
        if (escapes->origins == 0) {
            throw UserError(fmt::format(
                "{}: no point inside was found that {} level of detail has inside; the "
                "bodies are too thin for rays from inside",
                printable(scene.name), check::sees_one_surface(closed->settings.lod.lod) ? "its" : "every"));
        }
    }
    std::optional<check::ConvergenceReport> convergence;
    if (!converge_.empty()) {
        Progress progress(!quiet_, "measuring");
        convergence_options.progress = [&](double fraction) { progress.show(fraction); };
        convergence = check::measure_convergence(scene, kernels, convergence_options);
        if (convergence->cancelled) {
            fmt::print(stderr, "{}razor: interrupted; nothing written\n", progress.shown() ? "\r\x1b[K" : "");
            return interrupted_exit;
        }
    }

    const OutputGuard guard;
    if (!json_.empty()) {
        nlohmann::ordered_json report{{"program", "razor"}, {"version", version()}, {"scene", scene.name}};
        report["meshes"] = nlohmann::ordered_json::array();
        for (const check::MeshReport& m : meshes) {
            report["meshes"].push_back(check::json_of(m));
        }
        report["findings"] = check::json_of(findings);
        report["precision"] = check::json_of(scene, precision);
        for (const auto& [feature, used] : features_in_use(scene, memory.frame)) {
            report["features"][feature] = used;
        }
        report["memory"] = check::json_of(memory);
        report["notes"] = notes;
        if (escapes) {
            report["escape"] = {{"lod", word_of(lod_words, description.settings.lod)},
                                {"isa", kernels.name},
                                {"seed", options.seed}};
            report["escape"].update(check::json_of(*escapes));
        }
        if (convergence) {
            report["convergence"] = check::json_of(*convergence);
        }
        // Names need not be UTF-8.
        write_json_file(json_, report);
    }
    fmt::print("{}{}{}{}{}", check::text_of(meshes), check::text_of(findings),
               check::text_of(scene, precision), features_text(scene, memory.frame), check::text_of(memory));
    for (const std::string& note : notes) {
        fmt::print("not read: {}\n", note);
    }
    if (convergence) {
        fmt::print("{}", check::text_of(*convergence));
    }
    const bool warned = check::warnings_of(meshes) > 0 ||
                        std::any_of(findings.begin(), findings.end(), [](const check::SceneFinding& f) {
                            return f.severity == check::Severity::warning;
                        });
    const int calm = strict_ && warned ? 1 : 0;
    if (!escapes) {
        return calm;
    }
    fmt::print("{} on {}: {}", word_of(lod_words, description.settings.lod), kernels.name,
               check::text_of(*escapes));
    return escapes->escapes + escapes->different > 0 ? 1 : calm;
}

} // namespace razor
