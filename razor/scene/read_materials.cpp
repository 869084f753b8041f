#include "razor/scene/read_materials.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"
#include "razor/scene/toml_words.h"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

namespace razor {
namespace {

glm::vec2 to_vec2(const std::pair<double, double>& p) {
    return {static_cast<float>(p.first), static_cast<float>(p.second)};
}

TextureMap read_map(TomlTable& table, std::string_view key, std::span<const std::string> textures) {
    TextureMap map;
    if (!table.is_table(key)) {
        map.texture = read_texture_name(table, key, textures);
        return map;
    }
    TomlTable parts = table.table(key);
    if (!parts.has("texture")) {
        parts.fail("", fmt::format("{} names no texture; write texture = \"...\"", parts.name()));
    }
    map.texture = read_texture_name(parts, "texture", textures);
    map.scale = to_vec2(parts.pair("scale", {1, 1}, texcoord_range));
    map.offset = to_vec2(parts.pair("offset", {0, 0}, texcoord_range));
    map.rotation = static_cast<float>(glm::radians(parts.number("rotation", 0, angle_range)));
    parts.finish();
    return map;
}

Pattern read_pattern(TomlTable& table) {
    Pattern p;
    p.kind = choose(table, "pattern", p.kind, pattern_words);
    const auto usual = [](PatternKind kind) {
        return kind == PatternKind::bricks ? 0.05F : kind == PatternKind::marble ? 2.0F : 0.2F;
    };
    p.amount = usual(p.kind);
    p.space = choose(table, "space", p.space, pattern_space_words);
    p.size = table.number("size", p.size, pattern_size_range);
    const auto colour = [&](std::string_view key, glm::vec3& c) {
        c = glm::vec3(table.vector_or_number(key, glm::dvec3(c), unit_range));
    };
    colour("low", p.low);
    colour("high", p.high);
    p.octaves = table.whole("octaves", p.octaves, octaves_range);
    p.gain = static_cast<float>(table.number("gain", double{p.gain}, gain_range));
    p.amount = static_cast<float>(table.number("amount", double{p.amount}, amount_range));
    return p;
}

} // namespace

int read_texture_name(TomlTable& table, std::string_view key, std::span<const std::string> textures) {
    if (textures.empty()) {
        table.fail(key, fmt::format("there is no texture '{}'; write a [[texture]] of that name",
                                    printable(table.text(key, ""))));
    }
    const std::vector<std::string_view> words(textures.begin(), textures.end());
    return static_cast<int>(table.choice(key, 0, words));
}

Texture read_texture(TomlTable& table, const std::filesystem::path& folder, TextureCache& cache) {
    Texture texture;
    texture.name = table.text("name", "");
    if (table.has("pattern")) {
        texture.pattern = read_pattern(table);
        table.may_have("file");
        if (table.has("file")) {
            table.fail("file", "a texture is a pattern or a file's picture; leave one out");
        }
        table.finish();
        if (texture.name.empty()) {
            table.fail("name", "a texture without a name; write name = \"...\"");
        }
        return texture;
    }
    table.may_have("pattern");
    const std::string file = table.text("file", "");
    texture.linear = choose(table, "color_space", false, color_space_words);
    const Wrap both = choose(table, "wrap", Wrap::repeat, wrap_words);
    texture.wrap_u = choose(table, "wrap_u", both, wrap_words);
    texture.wrap_v = choose(table, "wrap_v", both, wrap_words);
    table.finish();
    if (texture.name.empty()) {
        table.fail("name", "a texture without a name; write name = \"...\"");
    }
    try {
        if (file.empty()) {
            throw UserError("a texture without a file; write file = \"picture.png\"");
        }
        texture.file = std::filesystem::absolute(folder / file).lexically_normal().string();
        texture.pyramid = cache.read(texture.file, texture.linear);
    } catch (const UserError& error) {
        table.fail("file", error.what());
    }
    return texture;
}

void read_heights(const TomlTable& table, const Material& material, std::span<Texture> textures,
                  TextureCache& cache) {
    if (material.displacement_map.texture < 0) {
        return;
    }
    Texture& texture = textures[static_cast<std::size_t>(material.displacement_map.texture)];
    if (texture.pattern) {
        if (texture.pattern->space == PatternSpace::object)
            table.fail("displacement_map",
                       fmt::format("texture '{}' is a pattern of points, which displacement "
                                   "would move; give it space = \"texture\"",
                                   texture.name));
        return;
    }
    try {
        texture.heights = cache.read(texture.file, true, Texels::heights);
    } catch (const UserError& error) {
        table.fail("displacement_map", error.what());
    }
}

Material read_material(TomlTable& table, std::span<const std::string> textures) {
    const std::string name = table.text("name", "");
    Material material = preset_material(choose(table, "kind", MaterialKind::matte, material_words));
    material.name = name;
    visit_material_maps(
        [&](std::string_view key, TextureMap& map) {
            table.may_have(key);
            if (table.has(key)) {
                map = read_map(table, key, textures);
            }
        },
        material);
    if (material.albedo_map.texture >= 0) {
        material.albedo = glm::vec3(1);
    }
    if (material.metallic_map.texture >= 0) {
        material.metallic = 1;
    }
    if (material.roughness_map.texture >= 0) {
        material.roughness = 1;
    }
    if (material.emission_map.texture >= 0) {
        material.emission = glm::vec3(1);
    }
    if (material.sheen_map.texture >= 0) {
        material.sheen = glm::vec3(1);
    }
    if (material.sheen_roughness_map.texture >= 0) {
        material.sheen_roughness = 1;
    }
    visit_material_fields(
        [&](std::string_view key, Range range, auto& value) {
            if constexpr (std::is_same_v<std::remove_reference_t<decltype(value)>, float>) {
                value = static_cast<float>(table.number(key, double{value}, range));
            } else {
                value = glm::vec3(table.vector_or_number(key, glm::dvec3(value), range));
            }
        },
        material);
    if (material.bump_map.texture >= 0 && !table.has("bump")) {
        table.fail("bump_map", "a bump map without a height; write bump = 0.05, in units of the object");
    }
    material.light = table.flag("light", material.light);
    material.two_sided = table.flag("two_sided", material.two_sided);
    table.finish();
    if (material.name.empty()) {
        table.fail("name", "a material without a name; write name = \"...\"");
    }
    return material;
}

} // namespace razor
