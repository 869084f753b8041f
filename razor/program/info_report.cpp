#include "razor/program/info_report.h"

#include "razor/scene/graph/flatten.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/text_file.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>

namespace razor {
namespace {

using Json = nlohmann::ordered_json;

std::string shown(double value) {
    return fmt::format("{:g}", value);
}
template <class Real, glm::qualifier q> std::string shown(const glm::vec<3, Real, q>& v) {
    const auto w = v + Real{0}; // no negative zero
    return w.x == w.y && w.y == w.z ? fmt::format("{:g}", w.x) : fmt::format("{:g} {:g} {:g}", w.x, w.y, w.z);
}

Json to_json(double value) {
    return value;
}
template <int N, class Real, glm::qualifier q> Json to_json(const glm::vec<N, Real, q>& v) {
    Json list = Json::array();
    for (int i = 0; i < N; ++i)
        list.push_back(v[i]);
    return list;
}

/// Of all levels.
std::size_t bytes_of(const TexturePyramid& pyramid) {
    std::size_t words = 0;
    for (const TextureLevel& level : pyramid.levels)
        words += level.texels.size() + level.opacity.size();
    return words * sizeof(std::uint32_t);
}

/// Of what displacement reads of it as well; of a pattern none.
std::size_t bytes_of(const Texture& texture) {
    std::size_t bytes = 0;
    for (const auto& pyramid : {texture.pyramid, texture.heights})
        bytes += pyramid != nullptr ? bytes_of(*pyramid) : 0;
    return bytes;
}

/// Textures may share them.
std::size_t bytes_of(const std::vector<Texture>& textures) {
    std::set<std::shared_ptr<const TexturePyramid>> pyramids;
    for (const Texture& texture : textures)
        pyramids.insert({texture.pyramid, texture.heights});
    pyramids.erase(nullptr);
    return std::accumulate(pyramids.begin(), pyramids.end(), std::size_t{0},
                           [](std::size_t bytes, const auto& pyramid) { return bytes + bytes_of(*pyramid); });
}

std::string text_of_bytes(std::size_t bytes) {
    constexpr double step = 1024;
    const auto size = static_cast<double>(bytes);
    return size < step          ? fmt::format("{} B", bytes)
           : size < step * step ? fmt::format("{:.1f} KiB", size / step)
                                : fmt::format("{:.1f} MiB", size / (step * step));
}

std::string counted(std::int64_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

const Texture& texture_of(const Scene& scene, const TextureMap& map) {
    return scene.textures[static_cast<std::size_t>(map.texture)];
}

std::string_view wrap_of(Wrap wrap) {
    return word_of(wrap_words, wrap);
}

void print_mesh(std::string& text, const Mesh& mesh, std::int64_t instances) {
    fmt::format_to(
        std::back_inserter(text), "  {}: {}, {}, {}{}, {}\n", printable(mesh.name, 100),
        counted(static_cast<std::int64_t>(mesh.face_sizes.size()), "face"),
        counted(static_cast<std::int64_t>(mesh.points.size()), "point"), word_of(scheme_words, mesh.scheme),
        mesh.face_texcoords.empty() ? "" : ", texture coordinates", counted(instances, "instance"));
}

/// What is not as it is by itself, and albedo.
void print_material(std::string& text, const Scene& scene, const Material& material, std::int64_t faces) {
    const auto out = std::back_inserter(text);
    const Material plain;
    fmt::format_to(out, "  {}: {}", printable(material.name, 100), is_matte(material) ? "matte" : "glossy");
    visit_material_fields(
        [&](std::string_view name, Range, const auto& value, const auto& preset) {
            if (value != preset || name == "albedo")
                fmt::format_to(out, ", {} {}", name, shown(value));
        },
        material, plain);
    visit_material_maps(
        [&](std::string_view name, const TextureMap& map) {
            if (map.texture >= 0)
                fmt::format_to(out, ", {} {}", name, printable(texture_of(scene, map).name, 100));
        },
        material);
    fmt::format_to(out, "{}{}, {}\n", material.light ? ", a light" : "",
                   material.two_sided ? "" : ", one-sided", faces == 0 ? "not used" : counted(faces, "face"));
}

void print_pattern(std::string& text, const Texture& texture, const Pattern& p, bool used) {
    fmt::format_to(std::back_inserter(text), "  {}: {}, by {} coordinates, cells of {}{}\n",
                   printable(texture.name, 100), word_of(pattern_words, p.kind),
                   word_of(pattern_space_words, p.space), p.size, used ? "" : ", not used");
}

void print_texture(std::string& text, const Texture& texture, bool used) {
    if (texture.pattern) {
        print_pattern(text, texture, *texture.pattern, used);
        return;
    }
    const TextureLevel& finest = texture.pyramid->levels.front();
    fmt::format_to(std::back_inserter(text), "  {}: {} x {}, {}, {}{}, {}{}, {}{}{}\n",
                   printable(texture.name, 100), finest.width, finest.height,
                   counted(static_cast<std::int64_t>(texture.pyramid->levels.size()), "level"),
                   text_of_bytes(bytes_of(texture)), finest.opacity.empty() ? "" : " with opacity",
                   wrap_of(texture.wrap_u),
                   texture.wrap_u == texture.wrap_v ? "" : fmt::format(" by {}", wrap_of(texture.wrap_v)),
                   word_of(color_space_words, texture.linear),
                   texture.file.empty() ? "" : ", " + printable(texture.file, 1000),
                   used ? "" : ", not used");
}

Json to_json(const Scene& scene, const Material& material, std::int64_t faces) {
    Json json{{"name", material.name}, {"matte", is_matte(material)}};
    visit_material_fields(
        [&](std::string_view name, Range, const auto& value) { json[std::string(name)] = to_json(value); },
        material);
    json["light"] = material.light;
    json["two_sided"] = material.two_sided;
    visit_material_maps(
        [&](std::string_view name, const TextureMap& map) {
            if (map.texture >= 0)
                json[std::string(name)] = {{"texture", texture_of(scene, map).name},
                                           {"number", map.texture},
                                           {"scale", to_json(map.scale)},
                                           {"offset", to_json(map.offset)},
                                           {"rotation", map.rotation}};
        },
        material);
    json["faces"] = faces;
    return json;
}

Json to_json(const Texture& texture, bool used) {
    if (texture.pattern) {
        const Pattern& p = *texture.pattern;
        return {{"name", texture.name},  {"pattern", word_of(pattern_words, p.kind)},
                {"size", p.size},        {"space", word_of(pattern_space_words, p.space)},
                {"low", to_json(p.low)}, {"high", to_json(p.high)},
                {"octaves", p.octaves},  {"gain", p.gain},
                {"amount", p.amount},    {"used", used}};
    }
    const TextureLevel& finest = texture.pyramid->levels.front();
    return {{"name", texture.name},
            {"file", texture.file},
            {"width", finest.width},
            {"height", finest.height},
            {"levels", texture.pyramid->levels.size()},
            {"bytes", bytes_of(texture)},
            {"opacity", !finest.opacity.empty()},
            {"wrap_u", wrap_of(texture.wrap_u)},
            {"wrap_v", wrap_of(texture.wrap_v)},
            {"color_space", word_of(color_space_words, texture.linear)},
            {"used", used}};
}

Json to_json(const Camera& camera) {
    Json json{{"position", to_json(camera.position)},
              {"target", to_json(camera.target)},
              {"up", to_json(camera.up)},
              {"projection", word_of(projection_words, camera.projection)}};
    if (camera.projection == Projection::orthographic) {
        json["height"] = camera.height;
        return json;
    }
    json["fov"] = camera.fov_degrees;
    json["aperture_radius"] = camera.aperture_radius;
    json["focus_distance"] = focus_distance(camera);
    return json;
}

std::string text_of(const Camera& camera) {
    if (camera.projection == Projection::orthographic)
        return fmt::format("at {}, to {}, orthographic, height {:g}\n", shown(camera.position),
                           shown(camera.target), camera.height);
    return fmt::format("at {}, to {}, {:g} degrees, aperture radius {:g}\n", shown(camera.position),
                       shown(camera.target), camera.fov_degrees, camera.aperture_radius);
}

} // namespace

SceneUse use_of(const Scene& scene, std::span<const Box> bounds) {
    SceneUse use{std::vector<std::int64_t>(scene.meshes.size()),
                 std::vector<std::int64_t>(scene.materials.size()), std::vector<bool>(scene.textures.size())};
    const auto add = [&](int material, std::int64_t faces) {
        if (static_cast<std::size_t>(material) < scene.materials.size())
            use.material_faces[static_cast<std::size_t>(material)] += faces;
    };
    std::vector<std::int64_t> plain(scene.meshes.size()); // instances that have the mesh's own materials
    if (scene.graph.groups.empty()) {
        std::fill(use.instances.begin(), use.instances.end(), 1);
        plain = use.instances;
    } else {
        for (const FlatInstance& instance : flatten(scene.graph, bounds).instances) {
            const auto m = static_cast<std::size_t>(instance.mesh);
            ++use.instances[m];
            if (instance.material < 0)
                ++plain[m];
            else
                add(instance.material, static_cast<std::int64_t>(scene.meshes[m].face_sizes.size()));
        }
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        if (mesh.face_materials.empty())
            add(mesh.material, plain[m] * static_cast<std::int64_t>(mesh.face_sizes.size()));
        for (const int material : mesh.face_materials)
            add(material, plain[m]);
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        visit_material_maps(
            [&](std::string_view, const TextureMap& map) {
                if (map.texture >= 0 && use.material_faces[i] > 0)
                    use.textures[static_cast<std::size_t>(map.texture)] = true;
            },
            scene.materials[i]);
    if (scene.sky_map.texture >= 0)
        use.textures[static_cast<std::size_t>(scene.sky_map.texture)] = true;
    return use;
}

std::string text_of(const Scene& scene, const SceneUse& use) {
    std::string text;
    const auto out = std::back_inserter(text);
    const std::int64_t instances =
        std::accumulate(use.instances.begin(), use.instances.end(), std::int64_t{0});
    const auto head = [&](std::string_view title, std::size_t count) {
        fmt::format_to(out, "{}: {}\n", title, count);
    };
    fmt::format_to(out, "scene {}: {} x {} pixels, {} in a row\n", printable(scene.name, 100),
                   scene.settings.width, scene.settings.height, counted(scene.settings.bounces, "bounce"));
    head("meshes", scene.meshes.size());
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        print_mesh(text, scene.meshes[m], use.instances[m]);
    fmt::format_to(out, "instances: {}\n", instances);
    head("materials", scene.materials.size());
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        print_material(text, scene, scene.materials[m], use.material_faces[m]);
    fmt::format_to(out, "textures: {}, {}\n", scene.textures.size(), text_of_bytes(bytes_of(scene.textures)));
    for (std::size_t t = 0; t < scene.textures.size(); ++t)
        print_texture(text, scene.textures[t], use.textures[t]);
    head("lights", scene.lights.size());
    for (const Light& light : scene.lights) {
        fmt::format_to(out, "  {}", word_of(light_words, light.kind));
        visit_light_fields(
            light.kind,
            [&](std::string_view name, Range, bool, const auto& value) {
                fmt::format_to(out, ", {} {}", name, shown(value));
            },
            light);
        text += '\n';
    }
    fmt::format_to(out, "sky: {}", shown(scene.sky));
    if (const SkyMap& map = scene.sky_map; map.texture >= 0)
        fmt::format_to(out, ", map '{}' turned by {} degrees",
                       printable(scene.textures[static_cast<std::size_t>(map.texture)].name, 100),
                       shown(map.rotation));
    fmt::format_to(out, "\ncamera: {}", text_of(scene.camera));
    if (scene.dicing_camera)
        fmt::format_to(out, "dicing camera: {}", text_of(*scene.dicing_camera));
    return text;
}

Json json_of(const Scene& scene, const SceneUse& use) {
    Json json{{"scene", scene.name},
              {"width", scene.settings.width},
              {"height", scene.settings.height},
              {"bounces", scene.settings.bounces}};
    for (const char* const list : {"meshes", "materials", "textures", "lights"})
        json[list] = Json::array();
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        json["meshes"].push_back({{"name", mesh.name},
                                  {"faces", mesh.face_sizes.size()},
                                  {"points", mesh.points.size()},
                                  {"texcoords", mesh.face_texcoords.empty() ? 0 : mesh.texcoords.size()},
                                  {"scheme", word_of(scheme_words, mesh.scheme)},
                                  {"instances", use.instances[m]}});
    }
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        json["materials"].push_back(to_json(scene, scene.materials[m], use.material_faces[m]));
    for (std::size_t t = 0; t < scene.textures.size(); ++t)
        json["textures"].push_back(to_json(scene.textures[t], use.textures[t]));
    for (const Light& light : scene.lights) {
        Json fields{{"kind", word_of(light_words, light.kind)}};
        visit_light_fields(
            light.kind,
            [&](std::string_view name, Range, bool, const auto& value) {
                fields[std::string(name)] = to_json(value);
            },
            light);
        json["lights"].push_back(std::move(fields));
    }
    json["sky"] = {{"radiance", to_json(scene.sky)}};
    if (const SkyMap& map = scene.sky_map; map.texture >= 0) {
        json["sky"]["map"] = scene.textures[static_cast<std::size_t>(map.texture)].name;
        json["sky"]["rotation"] = map.rotation;
    }
    json["camera"] = to_json(scene.camera);
    if (scene.dicing_camera)
        json["dicing_camera"] = to_json(*scene.dicing_camera);
    return json;
}

} // namespace razor
