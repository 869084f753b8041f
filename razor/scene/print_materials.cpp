#include "razor/scene/print_materials.h"

#include "razor/scene/toml_text.h"
#include "razor/scene/words.h"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <iterator>

namespace razor {
namespace {

std::string toml_pair(const glm::vec2& v) {
    return fmt::format("[{}, {}]", toml_number(v.x), toml_number(v.y));
}

/// The fewest digits of degrees that are read as just these radians.
std::string toml_degrees(float radians) {
    const double degrees = glm::degrees(double{radians});
    for (int digits = 6; digits < 17; ++digits) {
        const double rounded = std::stod(fmt::format("{:.{}g}", degrees, digits));
        if (static_cast<float>(glm::radians(rounded)) == radians) {
            return toml_number(rounded);
        }
    }
    return toml_number(degrees);
}

std::string to_toml(const TextureMap& map, const std::string& texture) {
    if (map == TextureMap{.texture = map.texture}) {
        return toml_text(texture);
    }
    return fmt::format("{{ texture = {}, scale = {}, offset = {}, rotation = {} }}", toml_text(texture),
                       toml_pair(map.scale), toml_pair(map.offset), toml_degrees(map.rotation));
}

} // namespace

std::string to_toml(const Texture& texture) {
    if (texture.pattern) {
        const Pattern& p = *texture.pattern;
        return fmt::format(
            "\n[[texture]]\nname = {}\npattern = {}\nspace = {}\nsize = {}\nlow = {}\nhigh = {}\n"
            "octaves = {}\ngain = {}\namount = {}\n",
            toml_text(texture.name), toml_text(word_of(pattern_words, p.kind)),
            toml_text(word_of(pattern_space_words, p.space)), toml_number(p.size), toml_value(p.low),
            toml_value(p.high), p.octaves, toml_value(p.gain), toml_value(p.amount));
    }
    const std::string wrap_u = toml_text(word_of(wrap_words, texture.wrap_u));
    const std::string wrap_v = toml_text(word_of(wrap_words, texture.wrap_v));
    return fmt::format("\n[[texture]]\nname = {}\nfile = {}\ncolor_space = {}\n{}", toml_text(texture.name),
                       toml_text(texture.file), toml_text(word_of(color_space_words, texture.linear)),
                       wrap_u == wrap_v ? fmt::format("wrap = {}\n", wrap_u)
                                        : fmt::format("wrap_u = {}\nwrap_v = {}\n", wrap_u, wrap_v));
}

std::string to_toml(const Material& material, const std::vector<Texture>& textures) {
    std::string text = fmt::format("\n[[material]]\nname = {}\n", toml_text(material.name));
    if (material == Material{.name = material.name, .albedo = material.albedo}) {
        return text + fmt::format("albedo = {}\n", toml_value(material.albedo));
    }
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "kind = \"principled\"\n"); // whatever it was read as: all is stated
    visit_material_fields(
        [&](std::string_view name, Range, const auto& value) {
            fmt::format_to(out, "{} = {}\n", name, toml_value(value));
        },
        material);
    fmt::format_to(out, "light = {}\ntwo_sided = {}\n", material.light, material.two_sided);
    visit_material_maps(
        [&](std::string_view name, const TextureMap& map) {
            if (map.texture >= 0) {
                fmt::format_to(out, "{} = {}\n", name,
                               to_toml(map, textures[static_cast<std::size_t>(map.texture)].name));
            }
        },
        material);
    return text;
}

} // namespace razor
