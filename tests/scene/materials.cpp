// Materials and textures of scene files, and the printed scene that has them again.
#include "razor/scene/error.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/print_materials.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace razor {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
const std::string box = "[[mesh]]\nshape = \"box\"\n";

SceneDescription parsed(const std::string& text, const std::filesystem::path& folder = {}) {
    return parse_scene_file(text, "s.toml", folder);
}

Material material(const std::string& fields) {
    return parsed("[[material]]\nname = \"m\"\n" + fields + "\n" + box).materials.at(0);
}

std::string message_of(const std::string& text, const std::filesystem::path& folder = {}) {
    try {
        parsed(text, folder);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

void add_pictures(const TemporaryFolder& folder) {
    folder.file("a.png", png_of(2, 2, {}, std::vector<std::uint8_t>(12, 128)));
    folder.file("b.jpg", jpeg_of(8, 8, 1, std::vector<std::uint8_t>(64, 128)));
}

constexpr std::string_view textures = "[[texture]]\nname = \"bricks\"\nfile = \"a.png\"\n"
                                      "[[texture]]\nname = \"rough\"\nfile = \"b.jpg\"\n"
                                      "color_space = \"linear\"\nwrap = \"mirror\"\n";

/// Each direction has what it states, else what both do; and keeps it when the scene is printed.
TEST(Materials, TexturesWrapEachWayByItself) {
    const TemporaryFolder folder;
    add_pictures(folder);
    for (const auto& [stated, u, v] : std::vector<std::tuple<std::string, Wrap, Wrap>>{
             {"wrap_u = \"clamp\"", Wrap::clamp, Wrap::repeat},
             {"wrap_v = \"mirror\"", Wrap::repeat, Wrap::mirror},
             {"wrap = \"mirror\"\nwrap_u = \"clamp\"", Wrap::clamp, Wrap::mirror},
             {"wrap_u = \"mirror\"\nwrap_v = \"clamp\"", Wrap::mirror, Wrap::clamp}}) {
        const std::string text = "[[texture]]\nname = \"t\"\nfile = \"a.png\"\n" + stated +
                                 "\n[[material]]\nname = \"m\"\nalbedo_map = \"t\"\n" + box;
        const SceneDescription read = parsed(text, folder.path());
        const SceneDescription again = parsed(to_toml(read), folder.path());
        for (const SceneDescription* scene : {&read, &again}) {
            ASSERT_EQ(scene->textures.size(), 1U) << stated;
            EXPECT_EQ(scene->textures[0].wrap_u, u) << stated;
            EXPECT_EQ(scene->textures[0].wrap_v, v) << stated;
        }
    }
}

TEST(Materials, KindsAreWhatElseIsNotStated) {
    const Material plain{.name = "m"};
    EXPECT_EQ(material(""), plain);
    EXPECT_EQ(material("kind = \"matte\""), plain);
    EXPECT_TRUE(is_matte(material("albedo = 0.25")));
    Material want = plain;
    want.specular = 1;
    EXPECT_EQ(material("kind = \"principled\""), want);
    want = plain;
    want.albedo = glm::vec3(1);
    want.metallic = 1;
    want.roughness = 0;
    EXPECT_EQ(material("kind = \"mirror\""), want);
    want = plain;
    want.albedo = glm::vec3(1);
    want.specular = want.transmission = 1;
    want.roughness = 0;
    EXPECT_EQ(material("kind = \"glass\""), want);
    want.ior = 1.25F;
    want.albedo = {0.5F, 0.25F, 1};
    EXPECT_EQ(material("ior = 1.25\nkind = \"glass\"\nalbedo = [0.5, 0.25, 1]"), want);
}

TEST(Materials, EveryFieldIsRead) {
    const Material m = material(R"(albedo = [0.1, 0.2, 0.3]
        metallic = 0.125
        roughness = 0.25
        specular = 0.375
        ior = 2.5
        transmission = 0.625
        coat = 0.75
        coat_roughness = 0.875
        sheen = [0.1, 0.2, 0.3]
        sheen_roughness = 0.625
        emission = 3
        normal_scale = -0.5
        displacement_scale = -2
        displacement_midlevel = 0.25
        alpha_cutoff = 0.0625
        light = true
        two_sided = false)");
    EXPECT_EQ(m.albedo, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(m.metallic, 0.125F);
    EXPECT_EQ(m.roughness, 0.25F);
    EXPECT_EQ(m.specular, 0.375F);
    EXPECT_EQ(m.ior, 2.5F);
    EXPECT_EQ(m.transmission, 0.625F);
    EXPECT_EQ(m.coat, 0.75F);
    EXPECT_EQ(m.coat_roughness, 0.875F);
    EXPECT_EQ(m.sheen, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(m.sheen_roughness, 0.625F);
    EXPECT_EQ(m.emission, glm::vec3(3));
    EXPECT_EQ(m.normal_scale, -0.5F);
    EXPECT_EQ(m.displacement_scale, -2);
    EXPECT_EQ(m.displacement_midlevel, 0.25F);
    EXPECT_EQ(m.alpha_cutoff, 0.0625F);
    EXPECT_TRUE(m.light);
    EXPECT_FALSE(m.two_sided);
}

TEST(Materials, MapsNameTextures) {
    const TemporaryFolder folder;
    add_pictures(folder);
    const std::string text = std::string(textures) + R"([[material]]
        name = "wall"
        albedo_map = "bricks"
        roughness_map = { texture = "rough", scale = [2, -3], offset = [0.5, 1], rotation = 90 }
        metallic_map = "rough"
        emission_map = "bricks"
        sheen_map = "bricks"
        sheen_roughness_map = { texture = "rough", scale = [3, 1] }
        normal_map = { texture = "rough" }
        emission = [0, 2, 0]
        )" + box;
    const Scene scene = build_scene(parsed(text, folder.path()));
    ASSERT_EQ(scene.textures.size(), 2U);
    EXPECT_EQ(scene.textures[0].name, "bricks");
    EXPECT_EQ(scene.textures[0].file, (folder / "a.png").string());
    EXPECT_FALSE(scene.textures[0].linear);
    EXPECT_EQ(scene.textures[0].wrap_v, Wrap::repeat);
    EXPECT_TRUE(scene.textures[1].linear);
    EXPECT_EQ(scene.textures[1].wrap_u, Wrap::mirror);
    EXPECT_EQ(scene.textures[1].wrap_v, Wrap::mirror);
    ASSERT_NE(scene.textures[1].pyramid, nullptr);
    EXPECT_EQ(scene.textures[1].pyramid->levels.size(), 4U);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.albedo_map, (TextureMap{.texture = 0}));
    EXPECT_EQ(m.roughness_map.texture, 1);
    EXPECT_EQ(m.roughness_map.scale, glm::vec2(2, -3));
    EXPECT_EQ(m.roughness_map.offset, glm::vec2(0.5F, 1));
    EXPECT_FLOAT_EQ(m.roughness_map.rotation, pi / 2);
    EXPECT_EQ(m.sheen_map, (TextureMap{.texture = 0}));
    EXPECT_EQ(m.sheen_roughness_map, (TextureMap{.texture = 1, .scale = {3, 1}}));
    EXPECT_EQ(m.normal_map, (TextureMap{.texture = 1}));
    // What a map multiplies is 1 unless stated.
    EXPECT_EQ(m.albedo, glm::vec3(1));
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.sheen, glm::vec3(1));
    EXPECT_EQ(m.sheen_roughness, 1);
    EXPECT_EQ(m.emission, glm::vec3(0, 2, 0));
}

TEST(Materials, DisplacementReadsHeights) {
    const TemporaryFolder folder;
    add_pictures(folder);
    const Scene scene = build_scene(
        parsed(std::string(textures) + "[[material]]\nname = \"m\"\ndisplacement_map = \"bricks\"\n" + box,
               folder.path()));
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.displacement_map, TextureMap{.texture = 0});
    EXPECT_EQ(m.displacement_scale, 1);
    EXPECT_EQ(m.displacement_midlevel, 0.5F);
    EXPECT_TRUE(is_displaced(m));
    ASSERT_NE(scene.textures[0].heights, nullptr);
    EXPECT_EQ(scene.textures[0].heights->most, 128.0F / 255) << "as it is in the file, though that is sRGB";
    EXPECT_EQ(scene.textures[1].heights, nullptr) << "nobody's";
}

TEST(Materials, PrintedSceneIsTheSame) {
    const TemporaryFolder folder;
    add_pictures(folder);
    std::string text = "[settings]\nbounces = 9\ndiffuse_bounces = 3\n" + std::string(textures);
    for (const char* const kind : {"matte", "principled", "mirror", "glass"})
        text += std::string("[[material]]\nname = \"") + kind + "\"\nkind = \"" + kind + "\"\n";
    text += "[[material]]\nname = \"all \\\"x\\\"\"\nalbedo = [0.1, 0.2, 0.3]\nmetallic = 0.1\nroughness = "
            "0.7\nspecular = 0.3\nior = 1.33\ncoat = 0.9\ncoat_roughness = 0.123\nsheen = [0, 0.1, "
            "1]\nsheen_roughness = 0.7\nemission = [1e9, 0, 1]\n"
            "normal_scale = 0.77\ndisplacement_map = \"bricks\"\ndisplacement_scale = 0.3\nalpha_cutoff = "
            "0.5\nlight = true\ntwo_sided = false\nalbedo_map = \"rough\"\nsheen_map = \"rough\"\n"
            "sheen_roughness_map = { texture = \"bricks\", offset = [0.5, 0] }\n";
    for (int i = 0; i < 40; ++i)
        text += "[[material]]\nname = \"m" + std::to_string(i) +
                "\"\nnormal_map = { texture = \"bricks\", scale = [0.1, 1], offset = [-0.3, 7], rotation = " +
                std::to_string(i * 37.712345 - 500) + " }\n";
    for (const char* const kind : {"checker", "bricks", "noise", "turbulence", "marble", "wood"})
        text +=
            std::string("[[texture]]\nname = \"of ") + kind + "\"\npattern = \"" + kind +
            "\"\nspace = \"texture\"\nsize = 0.3\nlow = [0.1, 0, 1]\nhigh = 0.25\noctaves = 9\ngain = 0.7\n";
    text +=
        "[[material]]\nname = \"bumpy\"\nbump_map = \"of wood\"\nbump = -0.07\nalbedo_map = \"of marble\"\n";
    text += box + "material = \"glass\"\n";
    const SceneDescription description = parsed(text, folder.path());
    const std::string printed = to_toml(description);
    const SceneDescription again = parsed(printed, "/nowhere");
    expect_same(build_scene(description), build_scene(again));
    EXPECT_EQ(to_toml(again), printed);
    EXPECT_EQ(again.settings.bounces, 9);
    EXPECT_EQ(again.settings.diffuse_bounces, 3);
}

TEST(Materials, PatternsAreTextures) {
    const SceneDescription d =
        parsed("[[texture]]\nname = \"a\"\npattern = \"bricks\"\n"
               "[[texture]]\nname = \"b\"\npattern = \"noise\"\nspace = \"texture\"\n"
               "size = 3\nlow = 0.5\nhigh = [1, 0, 0]\noctaves = 2\ngain = 0.25\namount = 7\n"
               "[[material]]\nname = \"m\"\nalbedo_map = \"a\"\nbump_map = \"b\"\nbump = 0.1\n" +
               box);
    Pattern bricks{.kind = PatternKind::bricks};
    bricks.amount = 0.05F;
    EXPECT_EQ(d.textures.at(0).pattern, bricks);
    const Pattern noise{.kind = PatternKind::noise,
                        .space = PatternSpace::texture,
                        .size = 3,
                        .low = glm::vec3(0.5F),
                        .high = {1, 0, 0},
                        .octaves = 2,
                        .gain = 0.25F,
                        .amount = 7};
    EXPECT_EQ(d.textures.at(1).pattern, noise);
    EXPECT_EQ(d.materials.at(0).bump_map, (TextureMap{.texture = 1}));
    EXPECT_EQ(d.materials.at(0).bump, 0.1F);
    EXPECT_EQ(d.materials.at(0).albedo, glm::vec3(1));
}

TEST(Materials, TheSkyHasAMap) {
    const TemporaryFolder folder;
    add_pictures(folder);
    const std::string known = "[[texture]]\nname = \"other\"\nfile = \"b.jpg\"\n" + std::string(textures);
    const SceneDescription dim =
        parsed("[sky]\nmap = \"rough\"\nrotation = -30\nradiance = [1, 2, 3]\n" + known + box, folder.path());
    EXPECT_EQ(dim.sky_map, (SkyMap{2, -30}));
    EXPECT_EQ(dim.sky, glm::vec3(1, 2, 3));
    EXPECT_EQ(dim.lights.size(), 0U); // none of those of a bare model
    const SceneDescription again = parsed(to_toml(dim), "/nowhere");
    expect_same(build_scene(dim), build_scene(again));
    const SceneDescription whole = parsed("[sky]\nmap = \"bricks\"\n" + known + box, folder.path());
    EXPECT_EQ(whole.sky, glm::vec3(1));
    EXPECT_EQ(parsed("[sky]\nradiance = 2\n" + known + box, folder.path()).sky_map, SkyMap{});
}

TEST(Materials, MattePrintsAsItAlwaysHas) {
    EXPECT_EQ(to_toml(Material{.name = "a", .albedo = {0.5F, 0.1F, 1}}, {}),
              "\n[[material]]\nname = \"a\"\nalbedo = [0.5, 0.1, 1.0]\n");
    Material shining{.name = "a"};
    shining.emission = glm::vec3(0, 0, 1);
    EXPECT_NE(to_toml(shining, {}).find("emission = [0.0, 0.0, 1.0]\n"), std::string::npos);
    Material turned{.name = "a"};
    turned.normal_map = {.texture = 0, .rotation = pi / 2};
    Texture texture;
    texture.name = "t";
    EXPECT_NE(to_toml(turned, {texture}).find("rotation = 90.0 }"), std::string::npos);
}

TEST(Materials, MistakesNamePlaceCauseAndMend) {
    const TemporaryFolder folder;
    add_pictures(folder);
    folder.file("no.png", "nothing");
    const std::string head = "[[material]]\nname = \"m\"\n", known = std::string(textures);
    const std::pair<std::string, std::string> cases[] = {
        {head + "metallic = 1.5\n" + box,
         "s.toml:3:12: material.metallic = 1.5 is out of range; write a number from 0 to 1"},
        {head + "ior = 0.5\n" + box, "material.ior = 0.5 is out of range; write a number from 1 to 3"},
        {head + "emission = -1\n" + box, "material.emission = -1 is out of range"},
        {head + "kind = \"metal\"\n" + box, "s.toml:3:8: material.kind 'metal' is unknown; known: matte, "
                                            "principled, mirror, glass"},
        {head + "two_sided = 1\n" + box,
         "s.toml:3:13: material.two_sided is a whole number; write true or false"},
        {head + "albedo_mop = \"x\"\n" + box,
         "unknown key 'material.albedo_mop'; did you mean 'albedo_map'?"},
        {head + "albedo_map = \"x\"\n" + box, "s.toml:3:14: there is no texture 'x'; write a [[texture]]"},
        {known + head + "albedo_map = \"brick\"\n" + box,
         "material.albedo_map 'brick' is unknown; did you mean 'bricks'? Known: bricks, rough"},
        {known + head + "albedo_map = 3\n" + box, "material.albedo_map is a whole number; write one of"},
        {known + head + "albedo_map = { scale = [1, 2] }\n" + box,
         "material.albedo_map names no texture; write texture"},
        {known + head + "albedo_map = { texture = \"bricks\", scale = 2 }\n" + box,
         "material.albedo_map.scale is a whole number; write two numbers [a, b]"},
        {known + head + "albedo_map = { texture = \"bricks\", rotate = 2 }\n" + box,
         "unknown key 'material.albedo_map.rotate'; did you mean 'rotation'?"},
        {"[[texture]]\nfile = \"a.png\"\n" + box, "a texture without a name"},
        {"[[texture]]\nname = \"t\"\n" + box, "s.toml:1:1: a texture without a file; write file"},
        {"[[texture]]\nname = \"t\"\nfile = \"c.png\"\n" + box, "c.png: no such file"},
        {"[[texture]]\nname = \"t\"\nfile = \"no.png\"\n" + box, "no.png: is no picture that is read"},
        {"[[texture]]\nname = \"t\"\nfile = \"a.png\"\nwrap = \"tile\"\n" + box,
         "texture.wrap 'tile' is unknown"},
        {"[[texture]]\nname = \"t\"\nfile = \"a.png\"\nwrap_v = \"clam\"\n" + box,
         "texture.wrap_v 'clam' is unknown; did you mean 'clamp'?"},
        {"[[texture]]\nname = \"t\"\nfile = \"a.png\"\ncolour_space = \"linear\"\n" + box,
         "unknown key 'texture.colour_space'; did you mean 'color_space'?"},
        {"[[texture]]\nname = \"t\"\nfile = \"a.png\"\n[[texture]]\nname = \"t\"\nfile = \"a.png\"\n" + box,
         "s.toml:5:8: the name 't' is used twice"},
        {"[sky]\nmap = \"x\"\n" + box, "s.toml:2:7: there is no texture 'x'; write a [[texture]]"},
        {"[sky]\nmap = \"brick\"\n" + known + box, "sky.map 'brick' is unknown; did you mean 'bricks'?"},
        {"[[texture]]\nname = \"t\"\npattern = \"noize\"\n" + box,
         "texture.pattern 'noize' is unknown; did you mean 'noise'?"},
        {"[[texture]]\nname = \"t\"\npattern = \"noise\"\nfile = \"a.png\"\n" + box,
         "a texture is a pattern or a file's picture; leave one out"},
        {"[[texture]]\nname = \"t\"\npattern = \"noise\"\nsize = 0\n" + box,
         "texture.size = 0 is out of range"},
        {"[[texture]]\nname = \"t\"\npattern = \"noise\"\noctaves = 25\n" + box,
         "texture.octaves = 25 is out of range"},
        {known + head + "bump_map = \"bricks\"\n" + box, "a bump map without a height; write bump = 0.05"},
        {"[sky]\nmap = \"t\"\n[[texture]]\nname = \"t\"\npattern = \"noise\"\n" + box,
         "a pattern cannot be the sky's map"},
        {"[settings]\nshading = \"grid\"\n" + box,
         "settings.shading 'grid' is unknown; did you mean 'grids'?"},
        {"[sky]\nradiance = 1\nrotation = 9\n" + box, "unknown key 'sky.rotation'"},
        {"[settings]\nbounces = 65\n" + box,
         "settings.bounces = 65 is out of range; write a number from 0 to 64"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = message_of(text, folder.path());
        EXPECT_NE(message.find(expected), std::string::npos)
            << text << "\n says: '" << message << "'\n not: " << expected;
        EXPECT_TRUE(message.starts_with("s.toml:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

} // namespace
} // namespace razor
