// Materials of glTF files: every member and extension, maps and their transforms, images wherever they are.
#include "razor/scene/error.h"
#include "razor/scene/models/gltf/uri.h"
#include "razor/scene/models/gltf_reader.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/textures/shared_exponent.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace razor {
namespace {

using Json = GltfWriter::Json;

/// The triangle, of material 0.
GltfWriter of(const Json& material) {
    GltfWriter w = triangle();
    w.json["meshes"][0]["primitives"][0]["material"] = 0;
    w.json["materials"] = Json::array({material});
    return w;
}

/// Images 0 to 2: in a buffer, in a data URI, beside the file; texture n shows image n.
GltfWriter with_images(const Json& material, const TemporaryFolder& folder) {
    GltfWriter w = of(material);
    const std::string red = png_of(1, 1, {}, {255, 0, 0});
    const int view = w.view(std::vector<std::uint8_t>(red.begin(), red.end()));
    folder.file("a b.png", png_of(1, 1, {}, {0, 0, 255}));
    w.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}},
                        {{"uri", "data:image/png;base64,iVBORw0KGgo="}},
                        {{"uri", "a%20b.png"}, {"name", "beside"}}};
    w.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}, {{"wrapS", 10497}}};
    w.json["textures"] = {
        {{"source", 0}, {"sampler", 0}}, {{"source", 1}}, {{"source", 2}, {"sampler", 1}, {"name", "t"}}};
    return w;
}

Mesh read(const GltfWriter& w, const TemporaryFolder& folder) {
    TextureCache cache;
    return *read_gltf(folder.file("m.glb", w.glb()), "", 0, &cache).cage;
}
Material material(const Json& fields) {
    const TemporaryFolder folder;
    return read(of(fields), folder).own_materials->materials.at(0);
}
std::string message_of(const GltfWriter& w, const TemporaryFolder& folder) {
    try {
        read(w, folder);
    } catch (const UserError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with((folder / "m.glb").string() + ": ")) << message;
        return message;
    }
    return {};
}

TEST(GltfMaterials, PresetsAreTheStandards) {
    const Material m = material(Json::object());
    const Material want{.name = "material 0",
                        .albedo = glm::vec3(1),
                        .metallic = 1,
                        .roughness = 1,
                        .specular = 1,
                        .two_sided = false};
    EXPECT_EQ(m, want);
}

TEST(GltfMaterials, EveryFieldIsRead) {
    const Material m = material(
        {{"name", "paint"},
         {"doubleSided", true},
         {"emissiveFactor", {0.5, 0.25, 1}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.125, 0.25, 0.5, 0.5}},
           {"metallicFactor", 0.75},
           {"roughnessFactor", 0.25}}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 1.25}}},
           {"KHR_materials_specular", {{"specularFactor", 0.375}}},
           {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.0625}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.625}}},
           {"KHR_materials_sheen",
            {{"sheenColorFactor", {0.25, 0.5, 0.75}}, {"sheenRoughnessFactor", 0.375}}},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
           {"VENDOR_x", 3}}}});
    const Material want{.name = "paint",
                        .albedo = {0.125F, 0.25F, 0.5F},
                        .metallic = 0.75F,
                        .roughness = 0.25F,
                        .specular = 0.375F,
                        .ior = 1.25F,
                        .transmission = 0.625F,
                        .coat = 0.5F,
                        .coat_roughness = 0.0625F,
                        .sheen = {0.25F, 0.5F, 0.75F},
                        .sheen_roughness = 0.375F,
                        .emission = {4, 2, 8}};
    EXPECT_EQ(m, want);
    EXPECT_TRUE(
        material({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}).two_sided)
        << "what is gone through is left through its other side";
    EXPECT_EQ(material({{"extensions", {{"KHR_materials_ior", {{"ior", 9}}}}}}).ior, 3);
    EXPECT_EQ(material({{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}}).ior, 1);
    // 0 is a boundless one, of which specularColorFactor says what is reflected: 0.04 are those of 1.5.
    EXPECT_EQ(material({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).ior, 3);
    EXPECT_NEAR(material({{"extensions",
                           {{"KHR_materials_ior", {{"ior", 0}}},
                            {"KHR_materials_specular", {{"specularColorFactor", {0.02, 0.04, 0.01}}}}}}})
                    .ior,
                1.5, 1e-6);
    EXPECT_EQ(material({{"extensions",
                         {{"KHR_materials_ior", {{"ior", 0}}},
                          {"KHR_materials_specular", {{"specularColorFactor", {0, 0, 0}}}}}}})
                  .ior,
              1);
    EXPECT_EQ(
        material({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}})
            .transmission,
        0.75F);
}

TEST(GltfMaterials, MapsAndImagesWhereverTheyAre) {
    const TemporaryFolder folder;
    const GltfWriter w = with_images({{"alphaMode", "MASK"},
                                      {"alphaCutoff", 0.25},
                                      {"emissiveTexture", {{"index", 2}}},
                                      {"emissiveFactor", {1, 1, 1}},
                                      {"normalTexture", {{"index", 0}, {"scale", -2}}},
                                      {"occlusionTexture", {{"index", 1}}},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorTexture", {{"index", 0}}},
                                        {"baseColorFactor", {1, 1, 1, 0.5}},
                                        {"metallicRoughnessTexture", {{"index", 2}, {"texCoord", 0}}}}}},
                                     folder);
    const Mesh mesh = read(w, folder);
    const Material& m = mesh.own_materials->materials.at(0);
    const std::vector<Texture>& textures = mesh.own_materials->textures;
    const auto shows = [&](const TextureMap& map) -> const Texture& {
        return textures.at(static_cast<std::size_t>(map.texture));
    };
    const auto colour = [](const Texture& t) {
        return unpack_shared_exponent(t.pyramid->levels.at(0).texels.at(0));
    };
    ASSERT_EQ(textures.size(), 4U);
    EXPECT_EQ(colour(shows(m.albedo_map)), glm::vec3(1, 0, 0));
    EXPECT_FALSE(shows(m.albedo_map).linear);
    EXPECT_EQ(shows(m.albedo_map).wrap_u, Wrap::clamp);
    EXPECT_EQ(shows(m.albedo_map).wrap_v, Wrap::mirror);
    EXPECT_EQ(shows(m.albedo_map).file, "");
    EXPECT_TRUE(shows(m.normal_map).linear);
    EXPECT_EQ(m.normal_scale, -2);
    EXPECT_EQ(m.metallic_map, m.roughness_map);
    EXPECT_TRUE(shows(m.metallic_map).linear);
    EXPECT_EQ(colour(shows(m.metallic_map)), glm::vec3(0, 0, 1));
    EXPECT_EQ(shows(m.emission_map).file, (folder / "a b.png").string());
    EXPECT_EQ(shows(m.emission_map).name, "t");
    EXPECT_EQ(shows(m.emission_map).wrap_v, Wrap::repeat);
    EXPECT_EQ(m.alpha_cutoff, 0.5F) << "of the map's opacity, which the factor halves";
    GltfWriter other = w;
    other.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["texCoord"] = 1;
    EXPECT_EQ(read(other, folder).own_materials->materials[0].metallic_map.texture, -1);
}

TEST(GltfMaterials, TexturesOfSheenAreRead) {
    const TemporaryFolder folder;
    folder.file("cloth.png", png_of(1, 2, {.colour = PNG_COLOR_TYPE_RGBA}, {255, 0, 0, 51, 0, 0, 255, 255}));
    const Json turned{{"index", 3},
                      {"texCoord", 1},
                      {"extensions", {{"KHR_texture_transform", {{"texCoord", 0}, {"scale", {2, 3}}}}}}};
    Json sheen{{"sheenColorFactor", {1, 0.5, 0.25}}, {"sheenRoughnessFactor", 0.5}};
    const auto read_with = [&](const Json& colour, const Json& roughness) {
        sheen["sheenColorTexture"] = colour;
        sheen["sheenRoughnessTexture"] = roughness;
        GltfWriter w =
            with_images({{"name", "cloth"}, {"extensions", {{"KHR_materials_sheen", sheen}}}}, folder);
        w.add("images", {{"uri", "cloth.png"}});
        w.add("textures", {{"source", 3}});
        return read(w, folder);
    };
    const Mesh mesh = read_with({{"index", 3}}, turned);
    const Material& m = mesh.own_materials->materials.at(0);
    EXPECT_TRUE(mesh.own_materials->notes.empty());
    ASSERT_EQ(mesh.own_materials->textures.size(), 1U) << "of both";
    const Texture& texture = mesh.own_materials->textures[0];
    EXPECT_FALSE(texture.linear);
    EXPECT_FALSE(texture.pyramid->levels[0].opacity.empty());
    EXPECT_EQ(m.sheen, glm::vec3(1, 0.5F, 0.25F));
    EXPECT_EQ(m.sheen_roughness, 0.5F);
    EXPECT_EQ(m.sheen_map, TextureMap{.texture = 0});
    EXPECT_EQ(m.sheen_roughness_map.texture, 0);
    EXPECT_EQ(m.sheen_roughness_map.scale, glm::vec2(2, 3));
    const Mesh opaque = read_with({{"index", 3}, {"texCoord", 1}}, {{"index", 0}});
    EXPECT_EQ(opaque.own_materials->materials[0].sheen_map.texture, -1) << "of other coordinates";
    EXPECT_EQ(opaque.own_materials->materials[0].sheen_roughness_map.texture, -1) << "1 everywhere";
}

TEST(GltfMaterials, TexturesThatArePassedOverAreTold) {
    const TemporaryFolder folder;
    const Json texture{{"index", 0}};
    const Mesh mesh = read(with_images({{"name", "cloth"},
                                        {"extensions",
                                         {{"KHR_materials_sheen",
                                           {{"sheenColorFactor", {1, 1, 1}}, {"sheenColorTexture", texture}}},
                                          {"KHR_materials_transmission", {{"transmissionTexture", texture}}},
                                          {"KHR_materials_clearcoat", {{"clearcoatTexture", texture}}}}}},
                                       folder),
                           folder);
    ASSERT_EQ(mesh.own_materials->notes.size(), 1U);
    EXPECT_NE(mesh.own_materials->notes[0].find(
                  "material 'cloth': textures that are passed over: transmissionTexture, clearcoatTexture"),
              std::string::npos)
        << mesh.own_materials->notes[0];
    EXPECT_TRUE(read(with_images({{"name", "plain"}}, folder), folder).own_materials->notes.empty());
}

TEST(GltfMaterials, WhatIsTakenOtherwiseIsTold) {
    const TemporaryFolder folder;
    const Mesh mesh = read(
        with_images({{"name", "odd"}, {"pbrMetallicRoughness", {{"roughnessFactor", -3}}}}, folder), folder);
    EXPECT_EQ(mesh.own_materials->materials[0].roughness, 0.0F);
    ASSERT_EQ(mesh.own_materials->notes.size(), 1U);
    EXPECT_NE(mesh.own_materials->notes[0].find("roughnessFactor of -3 is taken as 0"), std::string::npos)
        << mesh.own_materials->notes[0];
    GltfWriter points = with_images({{"name", "plain"}}, folder);
    Json more = points.json["meshes"][0]["primitives"][0];
    more["mode"] = 0;
    points.json["meshes"][0]["primitives"].push_back(more);
    const Mesh drawn = read(points, folder);
    ASSERT_EQ(drawn.own_materials->notes.size(), 1U);
    EXPECT_NE(drawn.own_materials->notes[0].find("mesh 0 primitive 1 is of points, which are passed over"),
              std::string::npos)
        << drawn.own_materials->notes[0];
}

TEST(GltfMaterials, DataUrisAreDecoded) {
    const TemporaryFolder folder;
    GltfWriter w = with_images({{"emissiveTexture", {{"index", 1}}}}, folder);
    EXPECT_NE(message_of(w, folder).find("image 1: not a readable PNG picture"), std::string::npos)
        << "but eight bytes of one";
    EXPECT_EQ(gltf::data_of_uri("data:x/y;base64,aGVsbG8="), "hello");
    EXPECT_EQ(gltf::data_of_uri("data:;base64,_-8"), "\xff\xef");
    EXPECT_EQ(gltf::data_of_uri("data:x/y;base64,a?"), std::nullopt);
    EXPECT_EQ(gltf::data_of_uri("data:x/y,abc"), std::nullopt);
    EXPECT_EQ(gltf::data_of_uri("a.png"), std::nullopt);
    EXPECT_EQ(gltf::path_of_uri("a%20b%2Fc%zz%4"), "a b/c%zz%4");
}

/// A point of the surface shows the same place of the picture as with v downwards.
TEST(GltfMaterials, TransformsAreTurnedUpwards) {
    const TemporaryFolder folder;
    for (const double angle : {0.0, 0.3, 1.5707963267948966, -2.0}) {
        const glm::dvec2 offset(0.25, -0.5), scale(2, -0.75);
        const Material m = read(with_images({{"normalTexture",
                                              {{"index", 0},
                                               {"extensions",
                                                {{"KHR_texture_transform",
                                                  {{"offset", {offset.x, offset.y}},
                                                   {"rotation", angle},
                                                   {"scale", {scale.x, scale.y}}}}}}}}},
                                            folder),
                                folder)
                               .own_materials->materials.at(0);
        const TextureMap& map = m.normal_map;
        for (const glm::dvec2 uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.3, 0.9)}) {
            // The extension's example: the lower left quadrant, turned clockwise.
            const double c = std::cos(angle), s = std::sin(angle);
            const glm::dvec2 p = scale * uv;
            const glm::dvec2 down = offset + glm::dvec2(c * p.x + s * p.y, c * p.y - s * p.x);
            const double mc = std::cos(double{map.rotation}), ms = std::sin(double{map.rotation});
            const glm::dvec2 q = glm::dvec2(map.scale) * glm::dvec2(uv.x, 1 - uv.y);
            const glm::dvec2 up =
                glm::dvec2(map.offset) + glm::dvec2(mc * q.x - ms * q.y, ms * q.x + mc * q.y);
            EXPECT_NEAR(up.x, down.x, 1e-6) << angle;
            EXPECT_NEAR(1 - up.y, down.y, 1e-6) << angle;
        }
    }
}

TEST(GltfMaterials, FacesHaveThoseOfTheirPrimitives) {
    const TemporaryFolder folder;
    GltfWriter w = of({{"name", "unused"}});
    w.add("materials", {{"name", "b"}});
    w.add("materials", {{"name", "c"}});
    Json& primitives = w.json["meshes"][0]["primitives"];
    primitives[0]["material"] = 2;
    const int flat = w.accessor<std::uint8_t>({0, 1, 2, 0, 0, 1, 2, 1, 0}, 1); // the second is no triangle
    Json second = primitives[0], third = primitives[0];
    second["material"] = 1;
    second["indices"] = flat;
    third.erase("material");
    primitives.push_back(second);
    primitives.push_back(third);
    const Mesh mesh = read(w, folder);
    EXPECT_EQ(mesh.face_materials, (std::vector<int>{0, 1, 1, -1}));
    ASSERT_EQ(mesh.own_materials->materials.size(), 2U);
    EXPECT_EQ(mesh.own_materials->materials[0].name, "c");
    EXPECT_EQ(mesh.own_materials->materials[1].name, "b");
    const Scene scene = load_scene(folder / "m.glb");
    EXPECT_EQ(scene.materials.size(), 4U);
    EXPECT_EQ(scene.meshes[0].face_materials, (std::vector<int>{2, 3, 3, 0}));
    const Mesh one = read(of(Json::object()), folder);
    EXPECT_EQ(one.material, 0);
    EXPECT_TRUE(one.face_materials.empty());
    const Mesh none = read(triangle(), folder);
    EXPECT_EQ(none.own_materials, nullptr);
}

TEST(GltfMaterials, MistakesAreNamed) {
    const TemporaryFolder folder;
    using Change = std::function<void(GltfWriter&)>;
    const std::pair<Change, const char*> cases[] = {
        {[](GltfWriter& w) { w.json["materials"] = "none"; },
         "a mesh primitive names material 0, but the file has 0; export it anew"},
        {[](GltfWriter& w) { w.json["materials"][0] = 3; }, "material 0 is no object"},
        {[](GltfWriter& w) { w.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = "x"; },
         "material 0 pbrMetallicRoughness has metallicFactor \"x\", which is no number; export it anew"},
        {[](GltfWriter& w) {
             w.json["materials"][0]["emissiveFactor"] = {1, 2};
         },
         "has emissiveFactor [1,2], which is not of 3 numbers"},
        {[](GltfWriter& w) { w.json["materials"][0]["doubleSided"] = 1; }, "neither true nor false"},
        {[](GltfWriter& w) { w.json["materials"][0]["normalTexture"]["index"] = 7; },
         "material 0 normalTexture names texture 7, but the file has 3"},
        {[](GltfWriter& w) { w.json["materials"][0]["normalTexture"]["index"] = -2; }, "which is no index"},
        {[](GltfWriter& w) {
             w.json["materials"][0]["extensions"]["KHR_materials_sheen"]["sheenColorTexture"]["index"] = 8;
         },
         "material 0 extensions KHR_materials_sheen sheenColorTexture names texture 8, but the file has 3"},
        {[](GltfWriter& w) {
             w.json["materials"][0]["extensions"]["KHR_materials_sheen"]["sheenRoughnessTexture"] = 8;
         },
         "material 0 extensions KHR_materials_sheen sheenRoughnessTexture is no object; export it anew"},
        {[](GltfWriter& w) {
             w.json["materials"][0]["extensions"]["KHR_materials_sheen"]["sheenRoughnessTexture"]["index"] =
                 1;
         },
         "image 1: not a readable PNG picture"},
        {[](GltfWriter& w) { w.json["textures"][0].erase("source"); },
         "texture 0 has no image in PNG or JPEG; export it anew"},
        {[](GltfWriter& w) { w.json["textures"][0]["source"] = 9; }, "names image 9, but the file has 3"},
        {[](GltfWriter& w) { w.json["textures"][0]["sampler"] = 9; }, "names sampler 9, but the file has 2"},
        {[](GltfWriter& w) { w.json["images"][0]["uri"] = "none.png"; }, "none.png: no such file"},
        {[](GltfWriter& w) { w.json["images"][0]["uri"] = "data:image/png;base64,??"; }, "not in base64"},
        {[](GltfWriter& w) { w.json["images"][0] = Json::object(); }, "image 0 names buffer view -1"},
        {[](GltfWriter& w) { w.json["images"][0]["bufferView"] = 0; }, "is no picture that is read"},
    };
    for (const auto& [change, expected] : cases) {
        GltfWriter w = with_images({{"normalTexture", {{"index", 0}}}}, folder);
        EXPECT_EQ(message_of(w, folder), "");
        change(w);
        const std::string message = message_of(w, folder);
        EXPECT_NE(message.find(expected), std::string::npos) << message << "\n not: " << expected;
    }
}

} // namespace
} // namespace razor
