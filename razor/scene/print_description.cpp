#include "razor/scene/animation/pose.h"
#include "razor/scene/animation/read_keys.h"
#include "razor/scene/animation/read_playback.h"
#include "razor/scene/description.h"
#include "razor/scene/light_fields.h"
#include "razor/scene/print_materials.h"
#include "razor/scene/read_film.h"
#include "razor/scene/read_from_model.h"
#include "razor/scene/shapes/shapes.h"
#include "razor/scene/toml_text.h"
#include "razor/scene/words.h"

#include <fmt/format.h>

#include <iterator>

namespace razor {
namespace {

bool is_whole(std::string_view shape, std::string_view parameter) {
    for (const ShapeParameter& known : find_shape_kind(shape)->parameters) {
        if (known.name == parameter) {
            return known.whole;
        }
    }
    return false;
}

void print_camera(std::string& text, const Camera& camera, const FromModel& from) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "\n[camera]\n{}", to_toml(from, true));
    if (camera.projection == Projection::perspective)
        fmt::format_to(out, "aperture_radius = {}\nfocus_distance = {}\n",
                       toml_number(camera.aperture_radius), toml_number(camera.focus_distance));
}

void print_camera(std::string& text, const Camera& camera, const CameraKeys& keys, std::string_view header) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "\n[{}]\nposition = {}\ntarget = {}\nup = {}\nprojection = {}\n", header,
                   toml_value(camera.position), toml_value(camera.target), toml_value(camera.up),
                   toml_text(word_of(projection_words, camera.projection)));
    if (camera.projection == Projection::orthographic) {
        fmt::format_to(out, "height = {}\n", toml_number(camera.height));
    } else {
        const double focus =
            keys.any() ? camera.focus_distance : focus_distance(camera); // follows the target
        fmt::format_to(out, "fov = {}\naperture_radius = {}\nfocus_distance = {}\n",
                       toml_number(camera.fov_degrees), toml_number(camera.aperture_radius),
                       toml_number(focus));
    }
    text += to_toml(keys, header);
}

void print_object(std::string& text, const ObjectDescription& object, std::string_view header) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "\n[[{}]]\nname = {}\n", header, toml_text(object.name));
    if (!object.instances.empty()) {
        fmt::format_to(out, "instances = {}\n", toml_text(object.instances));
    } else if (!object.group.empty()) {
        fmt::format_to(out, "group = {}\n", toml_text(object.group));
    } else {
        fmt::format_to(out, "mesh = {}\n", toml_text(object.mesh));
    }
    if (object.attachment) {
        const Attachment& on = *object.attachment;
        fmt::format_to(out, "attach = {}\n{} = {}\n", toml_text(on.object), on.node.empty() ? "tag" : "node",
                       toml_text(on.node.empty() ? on.tag : on.node));
    }
    if (!object.material.empty()) {
        fmt::format_to(out, "material = {}\n", toml_text(object.material));
    }
    const Transform& t = object.transform;
    if (t.matrix) {
        const auto row = [&](int i) {
            const glm::dmat3& m = t.matrix->linear;
            return fmt::format("[{}, {}, {}, {}]", toml_number(m[0][i]), toml_number(m[1][i]),
                               toml_number(m[2][i]), toml_number(t.matrix->translation[i]));
        };
        fmt::format_to(out, "matrix = [{}, {}, {}]\n", row(0), row(1), row(2));
    } else {
        fmt::format_to(out, "scale = {}\nrotate = {}\ntranslate = {}\n", toml_value(t.scale),
                       toml_value(t.rotate), toml_value(t.translate));
    }
    fmt::format_to(out, "array = [{}, {}, {}]\nspacing = {}\nlevel_offset = {}\nrate = {}\n", object.copies.x,
                   object.copies.y, object.copies.z, toml_value(object.spacing), object.level_offset,
                   toml_number(object.rate));
    text += to_toml(object.keys, header);
}

} // namespace

std::string toml_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            result += fmt::format("\\u{:04x}", byte);
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string to_toml(const SceneDescription& description) {
    std::string text;
    const auto out = std::back_inserter(text);
    const Settings& settings = description.settings;
    fmt::format_to(out,
                   "name = {}\n\n[settings]\nsize = [{}, {}]\nsamples = {}\nnoise_threshold = "
                   "{}\nlight_samples = {}\nlight_choices = {}\nsky_samples "
                   "= {}\nbounces = {}\ndiffuse_bounces = {}\nseed = {}\n",
                   toml_text(description.name), settings.width, settings.height, settings.samples,
                   toml_number(settings.noise_threshold), settings.light_samples, settings.light_choices,
                   settings.sky_samples, settings.bounces, settings.diffuse_bounces, settings.seed);
    if (const Crop& crop = settings.crop; crop != Crop{}) {
        fmt::format_to(out, "crop = [{}, {}, {}, {}]\n", crop.x, crop.y, crop.width, crop.height);
    }
    fmt::format_to(out, "edge_pixels = {}\nlod = {}\nshading = {}\n", toml_number(settings.edge_pixels),
                   toml_text(word_of(lod_words, settings.lod)),
                   toml_text(word_of(shading_words, settings.shading)));
    text += to_toml(settings.filter);
    if (description.camera_from) {
        print_camera(text, description.camera, *description.camera_from);
    } else {
        print_camera(text, description.camera, description.camera_keys, "camera");
    }
    if (description.dicing_camera) {
        print_camera(text, *description.dicing_camera, {}, "dicing_camera");
    }
    fmt::format_to(out, "\n[sky]\nradiance = {}\n", toml_value(description.sky));
    if (const SkyMap& map = description.sky_map; map.texture >= 0) {
        fmt::format_to(out, "map = {}\nrotation = {}\n",
                       toml_text(description.textures[static_cast<std::size_t>(map.texture)].name),
                       toml_number(map.rotation));
    }
    if (is_animated(description)) {
        fmt::format_to(out, "\n[animation]\nrate = {}\n", toml_number(description.frame_rate));
    }
    auto run = description.lights_from.begin();
    for (std::size_t l = 0; l < description.lights.size(); ++l) {
        if (run != description.lights_from.end() && run->first == l) {
            fmt::format_to(out, "\n[[light]]\n{}", to_toml(run->from, false));
            l += run->count - 1;
            ++run;
            continue;
        }
        const Light& light = description.lights[l];
        fmt::format_to(out, "\n[[light]]\nkind = {}\n", toml_text(word_of(light_words, light.kind)));
        visit_light_fields(
            light.kind,
            [&](std::string_view name, Range, bool, const auto& value) {
                fmt::format_to(out, "{} = {}\n", name, toml_value(value));
            },
            light);
        if (l < description.light_keys.size()) {
            text += to_toml(description.light_keys[l], "light");
        }
    }
    for (const Texture& texture : description.textures) {
        text += to_toml(texture);
    }
    for (const Material& material : description.materials) {
        text += to_toml(material, description.textures);
    }
    for (const MeshDescription& mesh : description.meshes) {
        fmt::format_to(out, "\n[[mesh]]\nname = {}\n", toml_text(mesh.name));
        if (mesh.file.empty()) {
            fmt::format_to(out, "shape = {}\n", toml_text(mesh.shape));
        } else {
            fmt::format_to(out, "file = {}\n", toml_text(mesh.file));
        }
        fmt::format_to(out, "scheme = {}\n", toml_text(word_of(scheme_words, mesh.scheme)));
        if (!mesh.material.empty()) {
            fmt::format_to(out, "material = {}\n", toml_text(mesh.material));
        }
        if (!mesh.materials.empty()) {
            std::vector<std::string> pairs;
            for (const auto& [name, replacement] : mesh.materials) {
                pairs.push_back(fmt::format("{} = {}", toml_text(name), toml_text(replacement)));
            }
            fmt::format_to(out, "materials = {{ {} }}\n", fmt::join(pairs, ", "));
        }
        fmt::format_to(out, "scale = {}\nrotate = {}\ntranslate = {}\nedge_length = {}\n",
                       toml_value(mesh.scale), toml_value(mesh.rotate), toml_value(mesh.translate),
                       toml_number(mesh.edge_length));
        if (mesh.crease_angle < no_crease_angle) {
            fmt::format_to(out, "crease_angle = {}\n", toml_number(mesh.crease_angle));
        }
        text += playback_to_toml(mesh);
        if (!mesh.parameters.empty()) {
            text += "[mesh.parameters]\n";
            for (const auto& [name, value] : mesh.parameters) {
                fmt::format_to(out, "{} = {}\n", name,
                               is_whole(mesh.shape, name) ? fmt::format("{:.0f}", value)
                                                          : toml_number(value));
            }
        }
        text += deformers_to_toml(mesh);
    }
    for (const GroupDescription& group : description.groups) {
        fmt::format_to(out, "\n[[group]]\nname = {}\n", toml_text(group.name));
        for (const ObjectDescription& object : group.objects) {
            print_object(text, object, "group.object");
        }
    }
    for (const ObjectDescription& object : description.objects) {
        print_object(text, object, "object");
    }
    return text;
}

} // namespace razor
