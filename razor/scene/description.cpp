#include "razor/scene/description.h"

#include "razor/scene/obj_reader.h"
#include "razor/scene/shapes/shapes.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace razor {
namespace {

/// Cosine and sine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> cos_sin_degrees(double angle) {
    const double turn = std::remainder(angle, 360.0);
    if (std::fmod(turn, 90.0) == 0) {
        constexpr int cosines[] = {1, 0, -1, 0};
        const int quarter = (static_cast<int>(turn / 90.0) + 4) % 4;
        return {cosines[quarter], cosines[(quarter + 3) % 4]};
    }
    const double radians = turn * (std::numbers::pi / 180.0);
    return {std::cos(radians), std::sin(radians)};
}

glm::dvec3 rotated(glm::dvec3 p, int axis, double degrees) {
    const auto [c, s] = cos_sin_degrees(degrees);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double pu = p[u];
    const double pv = p[v];
    p[u] = c * pu - s * pv;
    p[v] = s * pu + c * pv;
    return p;
}

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

/// TOML wants a point or an exponent in a real number; the shortest digits that read back as the same value.
template <typename Real> std::string number(Real value) {
    std::string text = fmt::format("{}", value + Real{0}); // + 0: no negative zero
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

template <typename Vector> std::string vector3(const Vector& v) {
    return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
}

bool is_whole(std::string_view shape, std::string_view parameter) {
    for (const ShapeParameter& known : find_shape_kind(shape)->parameters) {
        if (known.name == parameter) {
            return known.whole;
        }
    }
    return false;
}

} // namespace

void load_cage(MeshDescription& mesh) {
    if (mesh.file.empty()) {
        mesh.cage = std::make_shared<const Mesh>(make_shape(mesh.shape, mesh.parameters));
    } else {
        mesh.cage = std::make_shared<const Mesh>(read_obj(mesh.file));
    }
}

std::vector<glm::dvec3> placed_points(const MeshDescription& mesh) {
    std::vector<glm::dvec3> points;
    points.reserve(mesh.cage->points.size());
    for (const glm::dvec3& point : mesh.cage->points) {
        glm::dvec3 p = mesh.scale * point;
        for (int axis = 0; axis < 3; ++axis) {
            if (mesh.rotate[axis] != 0) {
                p = rotated(p, axis, mesh.rotate[axis]);
            }
        }
        points.push_back(mesh.translate + p);
    }
    return points;
}

Scene build_scene(const SceneDescription& description) {
    Scene scene;
    scene.name = description.name;
    scene.settings = description.settings;
    scene.camera = description.camera;
    scene.sky = description.sky;
    scene.lights = description.lights;
    scene.materials = description.materials;
    for (const MeshDescription& source : description.meshes) {
        Mesh mesh = *source.cage;
        mesh.name = source.name;
        mesh.scheme = source.scheme;
        mesh.edge_length = source.edge_length;
        mesh.points = placed_points(source);
        const auto material = std::find_if(scene.materials.begin(), scene.materials.end(),
                                           [&](const Material& m) { return m.name == source.material; });
        mesh.material = static_cast<int>(std::distance(scene.materials.begin(), material));
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

std::string to_toml(const SceneDescription& description) {
    std::string text;
    const auto out = std::back_inserter(text);
    const Settings& settings = description.settings;
    fmt::format_to(
        out, "name = {}\n\n[settings]\nsize = [{}, {}]\nsamples = {}\nlight_samples = {}\nsky_samples = {}\n",
        toml_text(description.name), settings.width, settings.height, settings.samples,
        settings.light_samples, settings.sky_samples);
    fmt::format_to(out, "edge_pixels = {}\n", number(settings.edge_pixels));
    const Camera& camera = description.camera;
    fmt::format_to(out, "\n[camera]\nposition = {}\ntarget = {}\nup = {}\nfov = {}\n",
                   vector3(camera.position), vector3(camera.target), vector3(camera.up),
                   number(camera.fov_degrees));
    fmt::format_to(out, "\n[sky]\nradiance = {}\n", vector3(description.sky));
    for (const RectangleLight& light : description.lights) {
        fmt::format_to(out, "\n[[light]]\ncorner = {}\nedge_u = {}\nedge_v = {}\nradiance = {}\n",
                       vector3(light.corner), vector3(light.edge_u), vector3(light.edge_v),
                       vector3(light.radiance));
    }
    for (const Material& material : description.materials) {
        fmt::format_to(out, "\n[[material]]\nname = {}\nalbedo = {}\n", toml_text(material.name),
                       vector3(material.albedo));
    }
    for (const MeshDescription& mesh : description.meshes) {
        fmt::format_to(out, "\n[[mesh]]\nname = {}\n", toml_text(mesh.name));
        if (mesh.file.empty()) {
            fmt::format_to(out, "shape = {}\n", toml_text(mesh.shape));
        } else {
            fmt::format_to(out, "file = {}\n", toml_text(mesh.file));
        }
        fmt::format_to(out, "scheme = {}\nmaterial = {}\n", toml_text(word_of(scheme_words, mesh.scheme)),
                       toml_text(mesh.material));
        fmt::format_to(out, "scale = {}\nrotate = {}\ntranslate = {}\nedge_length = {}\n",
                       vector3(mesh.scale), vector3(mesh.rotate), vector3(mesh.translate),
                       number(mesh.edge_length));
        if (!mesh.parameters.empty()) {
            text += "[mesh.parameters]\n";
            for (const auto& [name, value] : mesh.parameters) {
                fmt::format_to(out, "{} = {}\n", name,
                               is_whole(mesh.shape, name) ? fmt::format("{:.0f}", value) : number(value));
            }
        }
    }
    return text;
}

} // namespace razor
