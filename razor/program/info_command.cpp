#include "razor/program/info_command.h"

#include "razor/image/output_file.h"
#include "razor/program/arguments.h"
#include "razor/program/info_models.h"
#include "razor/program/info_report.h"
#include "razor/program/interrupt.h"
#include "razor/scene/animation/pose.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace razor {

void InfoCommand::add_to(CLI::App& app) {
    command_ = app.add_subcommand(
        "info", "list a scene's meshes, instances, materials, textures and lights, and what "
                "cameras, lights, animations and nodes glTF files and what frames, "
                "surfaces and tags MD3 files hold");
    scene_.add_to(*command_, "scene");
    command_->add_option("--json", json_, "write it for programs")->type_name("FILE.json");
}

int InfoCommand::run() const {
    if (!json_.empty()) {
        check_writable(json_);
    }
    const int frame = scene_.frame(); // a wrong one is found before any file is read
    const SceneDescription moving = scene_.describe_moving(), description = pose_of_frame(moving, frame);
    const std::vector<GltfContents> files = contents_of(moving);
    const std::vector<Md3Contents> md3_files = md3_contents_of(moving);
    const Scene scene = build_scene(description);
    const std::vector<std::string> notes = notes_of(moving);
    const SceneUse use = use_of(scene, mesh_bounds(description));
    const OutputGuard guard;
    if (!json_.empty()) {
        nlohmann::ordered_json report{{"program", "razor"}, {"version", version()}};
        report.update(json_of(scene, use));
        report["gltf_files"] = json_of(files);
        report["md3_files"] = json_of(md3_files);
        report["tags"] = json_of_tags(moving);
        report["notes"] = notes;
        // Names need not be UTF-8.
        write_json_file(json_, report);
    }
    fmt::print("{}{}{}{}", text_of(scene, use), text_of(files), text_of(md3_files), text_of_tags(moving));
    for (const std::string& note : notes) {
        fmt::print("not read: {}\n", note);
    }
    return 0;
}

} // namespace razor
