// Materials of OBJ models: what libraries say, per-face materials, and where they are in the scene.
#include "razor/scene/models/mtl_reader.h"

#include "razor/scene/animation/cage_frames.h"
#include "razor/scene/error.h"
#include "razor/scene/models/obj_materials.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor {
namespace {

const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class Mtl : public testing::Test {
protected:
    Mtl() {
        folder_.file("a b.png", png_of(1, 1, {}, {255, 128, 0}));
        folder_.file("n.png", png_of(1, 1, {}, {128, 128, 255}));
    }
    /// All that a library has, as materials of the names in order.
    ModelMaterials read(const std::string& library, const std::vector<std::string>& names = {"m"}) {
        MtlReader reader(names, cache_);
        reader.read(folder_.file("l.mtl", library));
        return reader.finish();
    }
    Material material(const std::string& fields) { return read("newmtl m\n" + fields).materials.at(0); }
    std::string message(const std::string& fields) {
        try {
            material(fields);
        } catch (const UserError& error) {
            return error.what();
        }
        return {};
    }

    TemporaryFolder folder_;
    TextureCache cache_;
};

TEST_F(Mtl, MattePhongGlassMirror) {
    Material want{.name = "m", .albedo = {0.5F, 0.25F, 0.125F}};
    EXPECT_EQ(material("Kd 0.5 0.25 0.125"), want);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKa 1 1 1\nTf 1 1 1\nsharpness 60\nmap_Ks x.png\n"), want);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKs 0 0 0\nNi 1.0\nd 1.0\nillum 2"), want);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKs 1 1 1\nillum 2"), want) << "no exponent";
    want.specular = 1;
    want.roughness = std::sqrt(std::sqrt(2 / 98.0F));
    EXPECT_FLOAT_EQ(material("Ns 96").roughness, want.roughness);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKs 1 1 1\nNs 96\nillum 2"), want);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKs 1 1 1\nNs 96\nillum 1").specular, 0);
    EXPECT_EQ(material("Ks 1 1 1\nNs 96\nNi 1.75").ior, 1.75F);
    EXPECT_EQ(material("Kd 0.5 0.25 0.125\nKs 1 1 1\nNs 96"), want) << "no illum";
    const Material glass = material("Kd 1 1 1\nd 0.25\nNi 1.25\nillum 7");
    EXPECT_EQ(glass.transmission, 0.75F);
    EXPECT_EQ(glass.ior, 1.25F);
    EXPECT_EQ(glass.specular, 1);
    EXPECT_EQ(glass.roughness, 0);
    EXPECT_EQ(material("Tr 0.75\nNi 1.25\nillum 7\nKd 1 1 1"), glass);
    EXPECT_EQ(material("d -halo 0.5").transmission, 0.5F);
    const Material mirror = material("Kd 0 0 0\nKs 1 0.5 0.25\nNs 10\nillum 3");
    EXPECT_EQ(mirror.metallic, 1);
    EXPECT_EQ(mirror.roughness, 0);
    EXPECT_EQ(mirror.albedo, glm::vec3(1, 0.5F, 0.25F));
    EXPECT_EQ(material("Kd 1\nPr 0.5\nPs 0.75").sheen, glm::vec3(0.75F));
    EXPECT_EQ(material("Ke 1 20 3\nKd 7").emission, glm::vec3(1, 20, 3));
    EXPECT_EQ(material("Kd 7").albedo, glm::vec3(1)) << "one number stands for all; at most 1";
}

TEST_F(Mtl, PhysicalFieldsHaveTheLastWord) {
    const Material m = material("Kd 1 1 1\nKs 1 1 1\nNs 10\nillum 3\nPr 0.25\nPm 0.75\nPc 0.5\nPcr 0.125\n");
    EXPECT_EQ(m.roughness, 0.25F);
    EXPECT_EQ(m.metallic, 0.75F);
    EXPECT_EQ(m.coat, 0.5F);
    EXPECT_EQ(m.coat_roughness, 0.125F);
    EXPECT_EQ(material("Pr 0.25").specular, 1);
    EXPECT_EQ(material("Pr 0.25\nKs 0 0 0").specular, 0);
}

TEST_F(Mtl, MapsWithOptionsAndBlanksInNames) {
    const ModelMaterials own =
        read("newmtl m\r\nKd 0 0 0\r\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on -blendu off a b.png\r\n"
             "map_Ke \tsub\\dir\\a b.png  \r\nnorm n.png\r\nmap_Pr n.png\r\nmap_Pm -imfchan r n.png\r\n"
             "map_d -s 2 3 1 a b.png\r\nmap_Ks none.png\r\nmap_Ns none.png\r\n");
    ASSERT_EQ(own.textures.size(), 3U);
    EXPECT_EQ(own.textures[0].name, "a b");
    EXPECT_EQ(own.textures[0].file, (folder_ / "a b.png").string());
    EXPECT_EQ(own.textures[0].wrap_u, Wrap::clamp);
    EXPECT_EQ(own.textures[1].wrap_u, Wrap::repeat);
    EXPECT_EQ(own.textures[0].pyramid, own.textures[1].pyramid) << "read once";
    EXPECT_FALSE(own.textures[0].linear);
    EXPECT_TRUE(own.textures[2].linear);
    const Material& m = own.materials[0];
    EXPECT_EQ(m.albedo_map, (TextureMap{.texture = 0, .scale = {2, 3}, .offset = {0.5F, 0.25F}}));
    EXPECT_EQ(m.albedo, glm::vec3(1)) << "black with a map is an exporter's fault";
    EXPECT_EQ(m.emission_map.texture, 1);
    EXPECT_EQ(m.emission, glm::vec3(1));
    EXPECT_EQ(m.roughness_map.texture, 2);
    EXPECT_EQ(m.metallic_map.texture, 2);
    EXPECT_EQ(m.normal_map.texture, 2);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.alpha_cutoff, 0.5F);
}

TEST_F(Mtl, MapsOfSheenMultiplyIt) {
    for (const char* const amount : {"", "Ps 0\n", "Ps 0.5\n"}) {
        const ModelMaterials own =
            read(std::string("newmtl m\n") + amount + "map_Ps -s 2 3 -clamp on n.png\n");
        const Material& m = own.materials[0];
        EXPECT_EQ(m.sheen_map, (TextureMap{.texture = 0, .scale = {2, 3}}));
        EXPECT_EQ(m.sheen, glm::vec3(std::string(amount) == "Ps 0.5\n" ? 0.5F : 1)) << amount;
        EXPECT_EQ(m.sheen_roughness_map.texture, -1);
        EXPECT_EQ(m.specular, 0);
        EXPECT_TRUE(own.textures[0].linear);
        EXPECT_EQ(own.textures[0].wrap_u, Wrap::clamp);
        EXPECT_TRUE(own.notes.empty());
    }
}

/// "bump" multiplies heights by -bm, -mm replaces v by base + gain v ("MTL material format").
TEST_F(Mtl, BumpsAndDisplacementAreHeights) {
    folder_.file("h.png", png_of(2, 1, {.colour = PNG_COLOR_TYPE_GRAY}, {51, 204}));
    for (const char* const keyword : {"bump", "map_bump", "map_Bump"}) {
        const ModelMaterials own = read(std::string("newmtl m\n") + keyword + " -s 2 3 -bm -0.25 h.png\n");
        const Material& m = own.materials[0];
        EXPECT_EQ(m.bump_map, (TextureMap{.texture = 0, .scale = {2, 3}})) << keyword;
        EXPECT_EQ(m.bump, -0.25F);
        EXPECT_EQ(m.normal_map.texture, -1);
        EXPECT_TRUE(own.textures[0].linear);
        EXPECT_EQ(own.textures[0].heights, nullptr) << "nothing is displaced";
        EXPECT_TRUE(own.notes.empty());
    }
    EXPECT_EQ(material("bump h.png").bump, 1);
    EXPECT_EQ(material("bump -bm 0.5 -mm 3 0.25 h.png").bump, 0.125F) << "slopes do not know a base";
    EXPECT_EQ(material("bump -bm 0 h.png").bump_map.texture, -1);

    const ModelMaterials own = read("newmtl m\ndisp -mm -0.25 0.5 -clamp on -o 0.5 0 h.png\nmap_Kd h.png\n");
    const Material& m = own.materials[0];
    ASSERT_TRUE(is_displaced(m));
    EXPECT_EQ(m.displacement_map.offset, glm::vec2(0.5F, 0));
    const Texture& heights = own.textures[static_cast<std::size_t>(m.displacement_map.texture)];
    EXPECT_EQ(heights.wrap_u, Wrap::clamp);
    ASSERT_NE(heights.heights, nullptr);
    const auto height = [&](double v) {
        return m.displacement_scale * (v - double{m.displacement_midlevel});
    };
    EXPECT_NEAR(height(heights.heights->least), -0.25 + 0.5 * 0.2, 1e-6);
    EXPECT_NEAR(height(heights.heights->most), -0.25 + 0.5 * 0.8, 1e-6);
    EXPECT_EQ(material("disp h.png").displacement_scale, 1);
    EXPECT_EQ(material("disp h.png").displacement_midlevel, 0);
    EXPECT_FALSE(is_displaced(material("disp -mm 1 0 h.png")));
}

TEST_F(Mtl, NormalMapsThatAreCalledBumpsAreThat) {
    folder_.file("m.png", png_of(2, 1, {}, {128, 128, 255, 140, 110, 240}));
    const Material m = material("map_Bump -bm 0.5 m.png");
    EXPECT_EQ(m.bump_map.texture, -1);
    EXPECT_EQ(m.normal_map.texture, 0);
    EXPECT_EQ(m.normal_scale, 0.5F);
    EXPECT_EQ(material("bump a b.png").normal_map.texture, -1) << "orange";
}

TEST_F(Mtl, OptionsThatArePassedOverAreNoted) {
    folder_.file("h.png", png_of(1, 1, {}, {51, 51, 51}));
    const auto notes = [&](const std::string& fields) { return read("newmtl m\n" + fields).notes; };
    EXPECT_TRUE(notes("map_Kd -blendu off -blendv on -boost 2 -cc on -texres 64 -t 0 0 0 -mm 0 1 h.png\n"
                      "bump -imfchan l h.png\ndisp -imfchan r h.png\nmap_d -imfchan m h.png\n")
                    .empty());
    EXPECT_EQ(
        notes("map_Kd -t 0.5 0.5 -mm 0 2 h.png\nbump -imfchan r -fancy 7 h.png\ndisp -bm 2 h.png\n"),
        (std::vector<std::string>{
            (folder_ / "l.mtl").string() +
            ": options of maps that are passed over: -t (line 2), -mm (line 2), -imfchan (line 3), -fancy "
            "(line 3) and 1 more"}));
    EXPECT_TRUE(read("newmtl other\nmap_Kd -fancy 7 h.png\nnewmtl m\n").notes.empty()) << "not used";
    EXPECT_EQ(material("bump -imfchan r -fancy 7 h.png").bump_map.texture, 0);
    folder_.file("l.mtl", "newmtl m\nmap_Kd -fancy 7 h.png\n");
    folder_.file("o.obj", points + "mtllib l.mtl\nusemtl m\nf 1 2 3\n");
    const auto of = [&](const std::string& mesh) {
        return notes_of(parse_scene_file("[[material]]\nname = \"x\"\n" + mesh, "s.toml", folder_.path()));
    };
    EXPECT_EQ(of("[[mesh]]\nfile = \"o.obj\"\n[[mesh]]\nfile = \"o.obj\"\nname = \"b\"\n").size(), 1U);
    EXPECT_TRUE(of("[[mesh]]\nfile = \"o.obj\"\nmaterial = \"x\"\n").empty());
}

TEST_F(Mtl, MistakesNameTheLine) {
    folder_.file("h.png", png_of(1, 1, {}, {51, 51, 51}));
    EXPECT_NE(message("bump -bm x h.png").find("l.mtl:2: -bm is 'x', not a number; mend it"),
              std::string::npos);
    EXPECT_NE(message("Kd 1\ndisp -mm 0 h.png").find("l.mtl:3: -mm is 'h.png', not a number; mend it"),
              std::string::npos);
    EXPECT_NE(message("disp none.png").find("l.mtl:2: the texture 'none.png' is not there"),
              std::string::npos);

    EXPECT_NE(message("Kd 1 x 1").find("l.mtl:2: Kd is 'x', not a number; mend it"), std::string::npos);
    EXPECT_NE(message("Ns").find("l.mtl:2: Ns is missing"), std::string::npos);
    EXPECT_NE(message("Kd 1 1 1\nmap_Kd none.png")
                  .find("l.mtl:3: the texture 'none.png' is not there; put it beside the library"),
              std::string::npos);
    std::filesystem::create_directory(folder_ / "pictures");
    EXPECT_NE(
        message("map_Kd pictures").find("l.mtl:2: the texture 'pictures' is a directory; name a picture"),
        std::string::npos);
    folder_.file("x.tga", "nothing");
    EXPECT_NE(message("map_Kd x.tga").find("l.mtl:2: "), std::string::npos);
    EXPECT_NE(message("map_Kd x.tga").find("x.tga: not a readable TGA picture"), std::string::npos);
}

TEST_F(Mtl, OnlyWhatIsUsedIsRead) {
    const ModelMaterials own =
        read("Kd 9\nnewmtl a\nKd 0.25\nnewmtl unused\nmap_Kd none.png\nnewmtl a b \nKd 0.5\nnewmtl a\nKd 1\n",
             {"a b", "a", "missing"});
    ASSERT_EQ(own.materials.size(), 2U);
    EXPECT_EQ(own.materials[0].name, "a");
    EXPECT_EQ(own.materials[0].albedo, glm::vec3(0.25F)) << "the first of two";
    EXPECT_EQ(own.materials[1].name, "a b");
}

TEST_F(Mtl, FacesHaveTheirMaterials) {
    folder_.file("l.mtl", "newmtl red one\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    const auto obj = [&](const std::string& text) {
        return read_obj(folder_.file("o.obj", points + text), cache_);
    };
    const Mesh mesh =
        obj("mtllib l.mtl\nf 1 2 3\nusemtl blue\r\nf 1 2 3\nusemtl red one \nf 1 3 4\nf 2 3 4\nusemtl other\n"
            "f 1 2 4\nusemtl blue # again\nf 1 2 3\n");
    ASSERT_NE(mesh.own_materials, nullptr);
    ASSERT_EQ(mesh.own_materials->materials.size(), 2U);
    EXPECT_EQ(mesh.own_materials->materials[0].name, "red one");
    EXPECT_EQ(mesh.face_materials, (std::vector<int>{-1, 1, 0, 0, -1, 1}));
    const Mesh one = obj("mtllib other.mtl l.mtl\nusemtl blue\nf 1 2 3\nf 1 2 4\n");
    EXPECT_TRUE(one.face_materials.empty());
    EXPECT_EQ(one.own_materials->materials.at(static_cast<std::size_t>(one.material)).name, "blue");
    for (const char* const text : {"mtllib none.mtl\nusemtl blue\nf 1 2 3\n", "mtllib l.mtl\nf 1 2 3\n",
                                   "usemtl blue\nf 1 2 3\n", "mtllib l.mtl\nusemtl x\nf 1 2 3\n"}) {
        const Mesh none = obj(text);
        const bool noted = none.own_materials != nullptr; // for its notes alone
        EXPECT_TRUE(!noted || (none.own_materials->materials.empty() && !none.own_materials->notes.empty()))
            << text;
        EXPECT_TRUE(none.face_materials.empty()) << text;
        EXPECT_EQ(none.material, noted ? -1 : 0) << text;
    }
}

TEST_F(Mtl, OwnMaterialsComeBehindTheScenes) {
    folder_.file("l.mtl", "newmtl red\nKd 1 0 0\nmap_Kd a b.png\nnewmtl blue\nKd 0 0 1\nnorm n.png\n");
    folder_.file("o.obj", points + "mtllib l.mtl\nf 1 2 4\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n");
    folder_.file("p.obj", points + "mtllib l.mtl\nusemtl blue\nf 1 3 4\n");
    const SceneDescription description = parse_scene_file(R"(
        [[texture]]
        name = "t"
        file = "n.png"
        [[material]]
        name = "green"
        albedo_map = "t"
        [[material]]
        name = "red"
        [[mesh]]
        name = "own"
        file = "o.obj"
        [[mesh]]
        name = "stated"
        file = "o.obj"
        material = "red"
        [[mesh]]
        name = "again"
        file = "o.obj"
        [[mesh]]
        name = "other"
        file = "p.obj"
        [[mesh]]
        shape = "box")",
                                                          "s.toml", folder_.path());
    const Scene scene = build_scene(description);
    ASSERT_EQ(scene.materials.size(), 5U) << "two of the scene, two of o.obj once, one of p.obj";
    ASSERT_EQ(scene.textures.size(), 4U);
    EXPECT_EQ(scene.meshes[0].face_materials, (std::vector<int>{0, 2, 3}));
    EXPECT_EQ(scene.meshes[1].material, 1);
    EXPECT_TRUE(scene.meshes[1].face_materials.empty());
    EXPECT_EQ(scene.meshes[2].face_materials, scene.meshes[0].face_materials);
    EXPECT_EQ(scene.meshes[3].material, 4);
    EXPECT_TRUE(scene.meshes[3].face_materials.empty());
    EXPECT_EQ(scene.meshes[4].material, 0);
    EXPECT_EQ(scene.materials[2].albedo_map.texture, 1);
    EXPECT_EQ(scene.materials[3].normal_map.texture, 2);
    EXPECT_EQ(scene.materials[4].normal_map.texture, 3);
    EXPECT_EQ(scene.textures[3].pyramid, scene.textures[2].pyramid);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        EXPECT_EQ(scene.meshes[m].own_materials, nullptr);
        expect_same(build_mesh(description, m), scene.meshes[m]);
    }
    const std::string printed = to_toml(description);
    EXPECT_EQ(printed.find("material = \"green\"\nscale"), printed.rfind("material = \"green\"\nscale"))
        << "of the box alone";
    const SceneDescription again = parse_scene_file(printed, "s.toml", "/nowhere");
    expect_same(build_scene(again), scene);
    EXPECT_EQ(to_toml(again), printed);
}

TEST_F(Mtl, WhatNoLibraryHasIsNoted) {
    folder_.file("l.mtl", "newmtl red\nKd 1 0 0\n");
    const auto notes = [&](const std::string& lines) {
        folder_.file("o.obj", points + lines + "f 1 2 3\n");
        return notes_of(parse_scene_file("[[mesh]]\nfile = \"o.obj\"\n", "s.toml", folder_.path()));
    };
    const std::string file = (folder_ / "o.obj").string();
    EXPECT_EQ(notes("mtllib l.mtl\nusemtl red\n"), std::vector<std::string>{});
    EXPECT_EQ(notes("usemtl red\n"), std::vector<std::string>{}) << "it names none";
    EXPECT_EQ(
        notes("mtllib none.mtl\nusemtl red\n"),
        std::vector{file + ": goes on without its material library 'none.mtl'; put it beside the model"});
    EXPECT_EQ(
        notes("mtllib l.mtl none.mtl\nusemtl red\n"),
        std::vector{file + ": goes on without its material library 'none.mtl'; put it beside the model"});
    EXPECT_EQ(notes("mtllib l.mtl\nusemtl red\nf 1 2 3\nusemtl blue\n"),
              std::vector{file + ": its libraries have no material 'blue'; add it to one"});
    EXPECT_EQ(notes("mtllib l.mtl\nusemtl blue\n"),
              std::vector{file + ": its libraries have no material 'blue'; add it to one"});
}

TEST_F(Mtl, FramesOfASequenceHaveTheFirstOnesMaterials) {
    folder_.file("l.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    folder_.file("w1.obj", points + "mtllib l.mtl\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n");
    folder_.file("w2.obj", "v 0 0 9\n" + points + "usemtl blue\nf 1 2 3\nf 1 3 4\nusemtl red\nf 2 3 4\n");
    const CageSequence sequence((folder_ / "w%d.obj").string(), 1, 2, 1, {Interpolation::step, 0}, &cache_);
    const auto first = sequence.at(0), second = sequence.at(1);
    EXPECT_EQ(first->face_materials, (std::vector<int>{0, 1}));
    EXPECT_EQ(second->face_materials, (std::vector<int>{1, 1, 0}));
    EXPECT_EQ(second->own_materials, first->own_materials);
}

TEST_F(Mtl, SharedModelsLoadWithTheirMaterials) {
    const std::filesystem::path scenes = RAZOR_SHARED_SCENES;
    const std::filesystem::path map = scenes / "oa_map/oacmpdm1.obj";
    if (!std::filesystem::exists(map))
        GTEST_SKIP();
    const Scene scene = load_scene(map);
    EXPECT_EQ(scene.materials.size(), 2U + 29) << "model, floor and its own";
    EXPECT_EQ(scene.textures.size(), 27U);
    EXPECT_EQ(scene.meshes[0].face_materials.size(), scene.meshes[0].face_sizes.size());
    const Scene gargoyle = load_scene(scenes / "oa_gargoyle/frame_%03d.obj");
    EXPECT_EQ(gargoyle.textures.size(), 1U);
    EXPECT_EQ(load_scene(scenes / "kenney_city/building-garage.obj").materials.size(), 2U);
}

} // namespace
} // namespace razor
