#include "razor/program/info_models.h"

#include "razor/scene/models/model_file.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace razor {
namespace {

template <class List, class Show> std::string line_of(std::string_view title, const List& list, Show show) {
    std::string text;
    for (const auto& entry : list)
        text +=
            fmt::format("{}{} ({})", text.empty() ? "" : ", ", printable(entry.called(), 100), show(entry));
    return text.empty() ? "" : fmt::format("    {}: {}\n", title, text);
}

/// The names of joints, or of other nodes, each once: as many as a line should have.
std::string names_of(std::string_view title, const std::vector<NamedNode>& nodes, bool joints) {
    constexpr std::size_t most_bytes = 1000;
    std::vector<std::pair<std::string_view, int>> names; // and how many nodes are called so
    std::map<std::string_view, std::size_t> known;
    for (const NamedNode& node : nodes) {
        if (node.joint != joints)
            continue;
        const auto [at, is_new] = known.try_emplace(node.name, names.size());
        if (is_new)
            names.emplace_back(node.name, 0);
        ++names[at->second].second;
    }
    std::string text;
    std::size_t listed = 0;
    for (; listed < names.size() && text.size() < most_bytes; ++listed) {
        const auto& [name, times] = names[listed];
        text += fmt::format("{}{}", text.empty() ? "" : ", ", printable(name, 100));
        if (times > 1)
            text += fmt::format(" ({} of this name)", times);
    }
    if (listed < names.size())
        text += fmt::format(", and {} more", names.size() - listed);
    return text.empty() ? "" : fmt::format("    {}: {}\n", title, text);
}

std::string shown(const CarriedCamera& camera) {
    std::string text = camera.perspective ? fmt::format("{:g} degrees", camera.fov_degrees)
                                          : fmt::format("orthographic, height {:g}", camera.height);
    if (camera.aspect_ratio > 0)
        text += fmt::format(", {:g} times as wide as high", camera.aspect_ratio);
    return text;
}

} // namespace

std::vector<GltfContents> contents_of(const SceneDescription& description) {
    std::vector<std::string> files;
    const auto add = [&](const std::string& file) {
        if (model_file(file) == ModelFile::gltf && std::find(files.begin(), files.end(), file) == files.end())
            files.push_back(file);
    };
    for (const MeshDescription& mesh : description.meshes) {
        add(mesh.file);
        add(mesh.playback.clip_file);
    }
    if (description.camera_from)
        add(description.camera_from->file);
    for (const LightsFromModel& lights : description.lights_from)
        add(lights.from.file);
    std::vector<GltfContents> result;
    result.reserve(files.size());
    for (const std::string& file : files)
        result.push_back(read_gltf_contents(file));
    return result;
}

std::string text_of(const std::vector<GltfContents>& files) {
    std::string text;
    if (!files.empty())
        text = fmt::format("glTF files: {}\n", files.size());
    for (const GltfContents& file : files) {
        text += fmt::format("  {}\n", printable(file.file, 1000));
        text += line_of("cameras", file.cameras, shown);
        text += line_of("lights", file.lights,
                        [](const CarriedLight& light) { return word_of(light_words, light.light.kind); });
        text += line_of("animations", file.clips,
                        [](const ClipLength& clip) { return fmt::format("{:g} s", clip.seconds); });
        text += names_of("joints", file.nodes, true);
        text += names_of("nodes", file.nodes, false);
    }
    return text;
}

nlohmann::ordered_json json_of(const std::vector<GltfContents>& files) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const GltfContents& file : files) {
        Json json{{"file", file.file}};
        for (const char* const part : {"cameras", "lights", "animations", "nodes"})
            json[part] = Json::array();
        for (const CarriedCamera& camera : file.cameras) {
            Json entry{{"name", camera.called()},
                       {"projection", camera.perspective ? "perspective" : "orthographic"}};
            if (camera.perspective)
                entry["fov"] = camera.fov_degrees;
            else
                entry["height"] = camera.height;
            if (camera.aspect_ratio > 0)
                entry["aspect_ratio"] = camera.aspect_ratio;
            json["cameras"].push_back(std::move(entry));
        }
        for (const CarriedLight& light : file.lights)
            json["lights"].push_back(
                {{"name", light.called()}, {"kind", word_of(light_words, light.light.kind)}});
        for (const ClipLength& clip : file.clips)
            json["animations"].push_back({{"name", clip.name}, {"seconds", clip.seconds}});
        for (const NamedNode& node : file.nodes)
            json["nodes"].push_back({{"name", node.name}, {"joint", node.joint}});
        list.push_back(std::move(json));
    }
    return list;
}

std::vector<Md3Contents> md3_contents_of(const SceneDescription& description) {
    std::vector<Md3Contents> files;
    for (const MeshDescription& mesh : description.meshes) {
        const bool known = std::any_of(files.begin(), files.end(),
                                       [&](const Md3Contents& there) { return there.file == mesh.file; });
        if (known || model_file(mesh.file) != ModelFile::md3)
            continue;
        Md3Model model = read_md3(mesh.file);
        std::vector<std::string> notes; // told of the scene
        std::vector<Md3Paint> paints = find_md3_paints(mesh.file, model, notes);
        files.push_back({mesh.file, model.frames.size(), std::move(model.surfaces), std::move(paints)});
    }
    return files;
}

std::string text_of(const std::vector<Md3Contents>& files) {
    std::string text;
    for (const Md3Contents& file : files) {
        std::string surfaces;
        for (const Md3Surface& surface : file.surfaces)
            surfaces += fmt::format("{}{}", surfaces.empty() ? "" : ", ", printable(surface.name, 100));
        text += fmt::format("{}: {} frame{}; surfaces: {}\n", printable(file.file, 1000), file.frames,
                            file.frames == 1 ? "" : fmt::format("s, 0 to {}", file.frames - 1), surfaces);
        for (std::size_t s = 0; s < file.surfaces.size(); ++s) {
            const Md3Paint& paint = file.paints[s];
            text +=
                fmt::format("  {}: {}, {}\n", printable(file.surfaces[s].name, 100),
                            paint.shader.empty() ? "no shader" : printable(paint.shader, 100),
                            paint.picture.empty() ? "no picture" : printable(paint.picture.string(), 1000));
        }
    }
    return text;
}

nlohmann::ordered_json json_of(const std::vector<Md3Contents>& files) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Md3Contents& file : files) {
        Json names = Json::array(), shaders = Json::array(), pictures = Json::array();
        const auto stated = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
        for (const Md3Surface& surface : file.surfaces)
            names.push_back(surface.name);
        for (const Md3Paint& paint : file.paints) {
            shaders.push_back(stated(paint.shader));
            pictures.push_back(stated(paint.picture.string()));
        }
        list.push_back({{"file", file.file},
                        {"frames", file.frames},
                        {"surfaces", std::move(names)},
                        {"shaders", std::move(shaders)},
                        {"pictures", std::move(pictures)}});
    }
    return list;
}

std::string text_of_tags(const SceneDescription& description) {
    std::string text;
    for (const MeshDescription& mesh : description.meshes) {
        if (!mesh.tags)
            continue;
        text += fmt::format("tags of {}:", printable(mesh.name, 100));
        for (std::size_t t = 0; t < mesh.tags->count(); ++t)
            text += fmt::format("{} {}", t == 0 ? "" : ",", printable(mesh.tags->name(t), 100));
        text += '\n';
    }
    return text;
}

nlohmann::ordered_json json_of_tags(const SceneDescription& description) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MeshDescription& mesh : description.meshes) {
        if (!mesh.tags)
            continue;
        nlohmann::ordered_json names = nlohmann::ordered_json::array();
        for (std::size_t t = 0; t < mesh.tags->count(); ++t)
            names.push_back(mesh.tags->name(t));
        list.push_back({{"mesh", mesh.name}, {"file", mesh.file}, {"tags", std::move(names)}});
    }
    return list;
}

} // namespace razor
