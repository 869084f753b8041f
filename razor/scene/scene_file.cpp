#include "razor/scene/scene_file.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/animation/read_keys.h"
#include "razor/scene/animation/read_playback.h"
#include "razor/scene/crop.h"
#include "razor/scene/error.h"
#include "razor/scene/framing.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/models/cage_source.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/nearest.h"
#include "razor/scene/ranges.h"
#include "razor/scene/read_film.h"
#include "razor/scene/read_from_model.h"
#include "razor/scene/read_materials.h"
#include "razor/scene/scene_objects.h"
#include "razor/scene/shapes/shapes.h"
#include "razor/scene/text_file.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace razor {
namespace {

void check_names(const std::vector<std::string>& names, std::string_view name, const TomlTable& table) {
    if (std::find(names.begin(), names.end(), name) != names.end()) {
        table.fail("name", fmt::format("the name '{}' is used twice; choose another", printable(name)));
    }
}

Settings read_settings(TomlTable table) {
    Settings settings;
    const auto [width, height] = table.whole_pair("size", {settings.width, settings.height}, size_range);
    settings.width = width;
    settings.height = height;
    if (const auto crop = table.four_whole("crop", crop_range)) {
        settings.crop = {(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]};
        const std::string wrong = mistake_of_crop(settings.crop, settings);
        if (!wrong.empty()) {
            table.fail("crop", wrong);
        }
    }
    settings.samples = table.whole("samples", settings.samples, samples_range);
    settings.noise_threshold =
        table.number("noise_threshold", settings.noise_threshold, noise_threshold_range);
    settings.light_samples = table.whole("light_samples", settings.light_samples, shadow_samples_range);
    settings.light_choices = table.whole("light_choices", settings.light_choices, light_choices_range);
    settings.sky_samples = table.whole("sky_samples", settings.sky_samples, shadow_samples_range);
    settings.bounces = table.whole("bounces", settings.bounces, bounces_range);
    settings.diffuse_bounces = table.whole("diffuse_bounces", settings.diffuse_bounces, bounces_range);
    settings.seed = table.whole("seed", settings.seed, seed_range);
    settings.edge_pixels = table.number("edge_pixels", settings.edge_pixels, edge_pixels_range);
    settings.lod = choose(table, "lod", settings.lod, lod_words);
    settings.shading = choose(table, "shading", settings.shading, shading_words);
    table.finish();
    return settings;
}

void check(const TomlTable& table, const std::optional<Mistake>& mistake) {
    if (mistake) {
        table.fail(mistake->key, mistake->message);
    }
}

void refuse_lens(const TomlTable& table, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys)
        if (table.has(key))
            table.fail(key, fmt::format("{}.{} is of a perspective camera, and this one is orthographic; "
                                        "leave it out",
                                        table.name(), key));
}

/// What the lens adds to a camera that a model brings.
Camera read_lens(TomlTable& table, Camera camera) {
    camera.aperture_radius = table.number("aperture_radius", camera.aperture_radius, aperture_range);
    camera.focus_distance = table.number("focus_distance", camera.focus_distance, focus_range);
    return camera;
}

Camera read_camera(TomlTable& table) {
    Camera camera;
    camera.position = table.vector("position", camera.position, coordinate_range);
    camera.target = table.vector("target", camera.target, coordinate_range);
    camera.up = table.vector("up", camera.up, coordinate_range);
    camera.projection = choose(table, "projection", camera.projection, projection_words);
    if (camera.projection == Projection::orthographic) {
        refuse_lens(table, {"fov", "aperture_radius", "focus_distance"});
        if (!table.has("height"))
            table.fail("height",
                       "an orthographic camera needs a height; write how much of the scene it shows, "
                       "in world units");
        camera.height = table.number("height", camera.height, height_range);
        return camera;
    }
    if (table.has("height"))
        table.fail("height",
                   fmt::format("{}.height is of a camera with projection = \"orthographic\", and this "
                               "one is perspective; leave it out",
                               table.name()));
    camera.fov_degrees = table.number("fov", camera.fov_degrees, fov_range);
    return read_lens(table, camera);
}

Light read_light(TomlTable& table) {
    Light light;
    light.kind = choose(table, "kind", light.kind, light_words);
    const auto read = [&](std::string_view name, Range range, bool or_number, auto& value) {
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, double>) {
            value = table.number(name, value, range);
        } else {
            const glm::dvec3 preset(value);
            value = Value(or_number ? table.vector_or_number(name, preset, range)
                                    : table.vector(name, preset, range));
        }
    };
    visit_light_fields(light.kind, read, light);
    return light;
}

void read_lights_from(TomlTable& table, SceneDescription& scene, const std::filesystem::path& folder) {
    LightsFromModel run{read_from_model(table, folder, false), scene.lights.size(), 0};
    table.finish();
    try {
        const std::vector<Light> lights = lights_of(run.from, 0);
        run.count = lights.size();
        scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
    } catch (const UserError& error) {
        table.fail("from", error.what());
    }
    scene.light_keys.resize(scene.lights.size());
    scene.lights_from.push_back(std::move(run));
}

/// [camera], which is stated.
void read_camera(TomlTable& table, SceneDescription& scene, const std::filesystem::path& folder) {
    if (!table.has("from")) {
        table.may_have("from");
        scene.camera = read_camera(table);
        scene.camera_keys = read_camera_keys(table, scene.camera.projection);
        table.finish();
        check(table, mistake_of(scene.camera, table.name()));
        return;
    }
    scene.camera_from = read_from_model(table, folder, true);
    try {
        scene.camera = camera_of(*scene.camera_from, scene.settings, 0);
    } catch (const UserError& error) {
        table.fail("from", error.what());
    }
    if (scene.camera.projection == Projection::orthographic)
        refuse_lens(table, {"aperture_radius", "focus_distance"});
    else
        scene.camera = read_lens(table, scene.camera);
    table.finish();
}

void read_sky(TomlTable& table, std::span<const std::string> textures, SceneDescription& scene) {
    table.may_have("map");
    if (table.has("map")) {
        scene.sky_map.texture = read_texture_name(table, "map", textures);
        if (scene.textures[static_cast<std::size_t>(scene.sky_map.texture)].pattern) {
            table.fail("map", "a pattern cannot be the sky's map; give a texture with a file");
        }
        scene.sky_map.rotation = table.number("rotation", scene.sky_map.rotation, angle_range);
        scene.sky = glm::vec3(1);
    }
    scene.sky = glm::vec3(table.vector_or_number("radiance", glm::dvec3(scene.sky), radiance_range));
    table.finish();
}

void read_shape(TomlTable& table, MeshDescription& mesh) {
    std::vector<std::string_view> names;
    for (const ShapeKind& kind : shape_kinds()) {
        names.push_back(kind.name);
    }
    const ShapeKind& kind = shape_kinds()[table.choice("shape", 0, names)];
    mesh.shape = std::string(kind.name);
    TomlTable parameters = table.table("parameters");
    for (const ShapeParameter& parameter : kind.parameters) {
        const Range range{parameter.least, parameter.most};
        mesh.parameters.emplace_back(
            parameter.name, parameter.whole
                                ? parameters.whole(parameter.name, static_cast<int>(parameter.preset), range)
                                : parameters.number(parameter.name, parameter.preset, range));
    }
    parameters.finish();
}

/// `materials = { "of the file" = "of the scene" }`, the scene's being called `names`.
TomlTable read_materials(TomlTable& table, std::span<const std::string_view> names, MeshDescription& mesh) {
    if (table.has("material")) {
        table.fail("materials", "material replaces all of a file's, materials some; leave one out");
    }
    TomlTable pairs = table.table("materials");
    for (const std::string& name : pairs.keys()) {
        mesh.materials.emplace_back(name, names[pairs.choice(name, 0, names)]);
    }
    return pairs;
}

/// Whether what is to be replaced is there.
void check_materials(const TomlTable& pairs, const MeshDescription& mesh) {
    std::vector<std::string_view> known;
    if (mesh.source->own_materials) {
        const auto add = [&](std::string_view name) {
            if (std::find(known.begin(), known.end(), name) == known.end()) {
                known.push_back(name);
            }
        };
        for (const Material& material : mesh.source->own_materials->materials) {
            add(material.name);
        }
        for (const std::string& part : mesh.source->own_materials->parts) {
            add(part);
        }
    }
    for (const auto& [name, replacement] : mesh.materials) {
        if (known.empty()) {
            pairs.fail(name, "the model brings no materials that could be replaced; write material instead");
        }
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            pairs.fail(name, fmt::format("the model has no material '{}'; {}", printable(name),
                                         or_known(name, known, "It has")));
        }
    }
}

MeshDescription read_mesh(TomlTable table, std::span<const Material> materials,
                          const std::filesystem::path& folder, double frame_rate, CageCache& cages) {
    MeshDescription mesh;
    mesh.name = table.text("name", "");
    const std::string file = table.text("file", "");
    if (table.has("file") == table.has("shape")) {
        table.fail("shape", "a mesh needs either file = \"model.obj\" or shape = \"...\"; write one of them");
    }
    if (table.has("shape")) {
        read_shape(table, mesh);
    } else {
        table.may_have("shape");
        if (!file.empty()) // of which there is no absolute path; refused below
            mesh.file = std::filesystem::absolute(folder / file).lexically_normal().string();
    }
    mesh.scheme = choose(table, "scheme", mesh.scheme, scheme_words);
    mesh.scale = table.vector_or_number("scale", mesh.scale, scale_range);
    mesh.rotate = table.vector("rotate", mesh.rotate, angle_range);
    mesh.translate = table.vector("translate", mesh.translate, coordinate_range);
    mesh.edge_length = table.number("edge_length", mesh.edge_length, {0, 1e30});
    mesh.crease_angle = table.number("crease_angle", mesh.crease_angle, {0, no_crease_angle});
    if (table.has("crease_angle") && !has_split_points(mesh.file)) {
        table.fail("crease_angle", "only MD3 and glTF models have normals instead of creases; leave it out");
    }

    std::vector<std::string_view> names;
    for (const Material& material : materials) {
        names.push_back(material.name);
    }
    if (table.has("material")) {
        mesh.material = std::string(names[table.choice("material", 0, names)]);
    }
    table.may_have("material");
    std::optional<TomlTable> replaced;
    if (table.has("materials")) {
        replaced = read_materials(table, names, mesh);
    }
    table.may_have("materials");
    read_playback(table, mesh, folder, frame_rate);
    table.finish();
    try {
        if (table.has("file") && file.empty()) {
            throw UserError("the file name is empty; give a model");
        }
        load_cage(mesh, cages);
    } catch (const UserError& error) {
        table.fail(table.key_in(error.what(), {"clip", "clip_file"}, table.has("file") ? "file" : "shape"),
                   error.what());
    }
    check_cycle(table, mesh.playback);
    if (replaced) {
        check_materials(*replaced, mesh);
    }
    if (mesh.material.empty() && !mesh.source->own_materials) {
        mesh.material = materials.front().name;
    }
    if (mesh.name.empty()) {
        mesh.name = mesh.file.empty() ? mesh.shape : cage_name(mesh.file);
    }
    return mesh;
}

SceneDescription read_scene(TomlTable root, std::string_view file_name, const std::filesystem::path& folder) {
    SceneDescription scene;
    scene.name = root.text("name", std::filesystem::path(file_name).stem().string());
    scene.settings = read_settings(root.table("settings"));
    scene.settings.filter = read_filter(root.table("film"));
    TomlTable camera = root.table("camera");
    TomlTable dicing_camera = root.table("dicing_camera");
    TomlTable sky = root.table("sky");
    TomlTable animation = root.table("animation");
    scene.frame_rate = animation.number("rate", scene.frame_rate, frame_rate_range);
    animation.finish();
    for (TomlTable& light : root.tables("light")) {
        if (light.has("from")) {
            read_lights_from(light, scene, folder);
            continue;
        }
        light.may_have("from");
        scene.lights.push_back(read_light(light));
        scene.light_keys.push_back(read_light_keys(light, scene.lights.back().kind));
        light.finish();
        check(light, mistake_of(scene.lights.back()));
    }
    CageCache cages;
    std::vector<std::string> texture_names, names;
    for (TomlTable& table : root.tables("texture")) {
        scene.textures.push_back(read_texture(table, folder, cages.textures));
        check_names(texture_names, scene.textures.back().name, table);
        texture_names.push_back(scene.textures.back().name);
    }
    read_sky(sky, texture_names, scene);
    for (TomlTable& table : root.tables("material")) {
        scene.materials.push_back(read_material(table, texture_names));
        read_heights(table, scene.materials.back(), scene.textures, cages.textures);
        check_names(names, scene.materials.back().name, table);
        names.push_back(scene.materials.back().name);
    }
    if (scene.materials.empty()) {
        scene.materials.push_back(Material{.name = "default"});
    }
    for (TomlTable& mesh : root.tables("mesh")) {
        scene.meshes.push_back(read_mesh(std::move(mesh), scene.materials, folder, scene.frame_rate, cages));
    }
    read_objects(root, scene, folder, cages);
    root.finish();
    if (scene.meshes.empty()) {
        root.fail("mesh", "no meshes; write at least one [[mesh]]");
    }
    if (camera.stated()) {
        read_camera(camera, scene, folder);
    } else {
        place_camera(scene);
    }
    if (dicing_camera.stated()) {
        scene.dicing_camera = read_camera(dicing_camera);
        dicing_camera.finish();
        check(dicing_camera, mistake_of(*scene.dicing_camera, dicing_camera.name()));
    }
    if (scene.lights.empty() && !sky.stated()) {
        place_light_and_sky(scene);
    }
    return scene;
}

} // namespace

SceneDescription read_scene_file(const std::filesystem::path& path) {
    return parse_scene_file(read_text_file(path, "a scene file"), path.string(), path.parent_path());
}

SceneDescription parse_scene_file(std::string_view text, std::string_view file_name,
                                  const std::filesystem::path& folder) {
    try {
        const toml::table table = toml::parse(text, std::string_view(file_name));
        return read_scene(TomlTable(&table, "", file_name), file_name, folder);
    } catch (const toml::parse_error& error) {
        fail_at(file_name, error.source(),
                fmt::format("not valid TOML: {}", printable(error.description(), 300)));
    }
}

bool is_model_file(const std::filesystem::path& path) {
    return model_file(path) != ModelFile::none || lower_extension(path) == ".instances";
}

SceneDescription describe(const std::filesystem::path& path, const FramingOptions& framing) {
    if (lower_extension(path) == ".toml") {
        return read_scene_file(path);
    }
    if (is_model_file(path)) {
        return model_file(path) != ModelFile::none ? frame_model(path, framing)
                                                   : frame_instances(path, framing);
    }
    if (std::filesystem::is_directory(path)) {
        throw UserError(fmt::format("{}: is a directory; give a file ending in {}",
                                    printable(path.string(), 1000), scene_extensions));
    }
    throw UserError(fmt::format("{}: neither a scene file nor a model; give a file ending in {}",
                                printable(path.string(), 1000), scene_extensions));
}

Scene load_scene(const std::filesystem::path& path) {
    return build_scene(pose_at(describe(path, {}), 0));
}

} // namespace razor
