// Materials of MD3 models: which picture each surface has, by its shader or a skin, and where it is looked
// for.
#include "razor/scene/models/md3_materials.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/models/game_files.h"
#include "razor/scene/models/md3_skin.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/textures/shared_exponent.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/picture_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"
#include "tests/scene/tga_writer.h"

#include <gtest/gtest.h>

namespace razor {
namespace {

const std::string red = tga_of(1, 1, {}, {{255, 0, 0, 0}}), blue = png_of(1, 1, {}, {0, 0, 255});

/// A game's root folder with a model in models/players/imp.
class Md3Materials : public testing::Test {
protected:
    Md3Materials() { std::filesystem::create_directories(folder_ / "models/players/imp"); }

    std::filesystem::path imp(const std::string& name) const {
        return folder_ / ("models/players/imp/" + name);
    }
    void put_imp(const std::string& name, const std::string& bytes) const {
        folder_.file("models/players/imp/" + name, bytes);
    }
    /// Of two surfaces, `left` and `right`.
    void put_model(const std::vector<std::string>& left, const std::vector<std::string>& right,
                   const std::string& name = "head.md3") const {
        std::vector<Md3SurfaceData> surfaces = two_surfaces();
        surfaces[0].shaders = left;
        surfaces[1].shaders = right;
        put_imp(name, write_md3(surfaces, 2));
    }
    std::shared_ptr<const Mesh> read(const std::string& name = "head.md3") {
        Md3Model model = read_md3(imp(name));
        paint(model, imp(name), cache_);
        return std::make_shared<const Mesh>(std::move(model.cage));
    }
    std::string message(const std::string& name = "head.md3") {
        try {
            read(name);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return {};
    }
    /// The picture of the first surface, below the root folder; empty: none.
    std::string picture(const std::string& name = "head.md3") {
        const ModelMaterials own = *read(name)->own_materials;
        const int texture = own.materials.at(0).albedo_map.texture;
        if (texture < 0)
            return {};
        return std::filesystem::path(own.textures.at(static_cast<std::size_t>(texture)).file)
            .lexically_relative(folder_.path())
            .string();
    }
    std::vector<std::string> notes(const std::string& name = "head.md3") {
        return read(name)->own_materials->notes;
    }

    TemporaryFolder folder_;
    TextureCache cache_;
};

TEST_F(Md3Materials, EachSurfaceHasItsPicture) {
    put_imp("skin.tga", red);
    put_imp("eyes.png", blue);
    put_model({"models/players/imp/skin.tga", "other"}, {"models/players/imp/eyes.tga"});
    const auto cage = read();
    const ModelMaterials& own = *cage->own_materials;
    ASSERT_EQ(own.materials.size(), 2U);
    EXPECT_EQ(own.materials[0], (Material{.name = "models/players/imp/skin.tga",
                                          .albedo = glm::vec3(1),
                                          .albedo_map = {.texture = 0}}));
    EXPECT_EQ(own.materials[1].name, "models/players/imp/eyes.tga");
    EXPECT_EQ(own.materials[1].albedo_map.texture, 1);
    EXPECT_EQ(own.parts, (std::vector<std::string>{"left", "right"}));
    ASSERT_EQ(own.textures.size(), 2U);
    EXPECT_EQ(own.textures[0].file, imp("skin.tga").string());
    EXPECT_EQ(own.textures[0].name, "skin");
    EXPECT_EQ(own.textures[0].wrap_u, Wrap::repeat);
    EXPECT_FALSE(own.textures[0].linear);
    EXPECT_EQ(unpack_shared_exponent(own.textures[0].pyramid->levels[0].texels[0]), glm::vec3(1, 0, 0));
    EXPECT_EQ(own.textures[1].file, imp("eyes.png").string());
    EXPECT_EQ(cage->face_materials, (std::vector<int>{0, 0, 1, 1})) << "the triangle without area is gone";
    EXPECT_TRUE(own.notes.empty());
}

TEST_F(Md3Materials, OnePictureIsOneTexture) {
    put_imp("skin.tga", red);
    put_model({"models/players/imp/skin"}, {"skin.tga"});
    const ModelMaterials own = *read()->own_materials;
    EXPECT_EQ(own.textures.size(), 1U);
    EXPECT_EQ(own.materials.size(), 2U);
}

/// One place and name after the other, the last ones first, so that each found is before all that were there.
TEST_F(Md3Materials, PicturesAreLookedForInOrder) {
    for (const char* const folder : {"models/players/imp/models/players/imp", "models/models/players/imp"})
        std::filesystem::create_directories(folder_ / folder);
    put_model({"models\\players/imp/Skin.bmp"}, {});
    EXPECT_EQ(picture(), "");
    for (const std::string at :
         {"models/players/imp/", "models/models/players/imp/", "models/players/imp/models/players/imp/"})
        for (const std::string name :
             {"Skin.bmp.png", "Skin.bmp.tga", "Skin.png", "sKIN.Jpeg", "Skin.jpeg", "Skin.JPG", "Skin.jpg",
              "skin.TGA", "Skin.tga", "SKIN.BMP", "Skin.bmp"}) {
            folder_.file(at + name, red); // by its bytes
            EXPECT_EQ(picture(), at + name);
        }
    put_model({"/far/away/hat.tga"}, {}, "hat.md3");
    put_imp("hat.png", blue);
    EXPECT_EQ(picture("hat.md3"), "models/players/imp/hat.png") << "by its last part";
    put_model({"Models/PLAYERS/imp/hat"}, {}, "cap.md3");
    std::filesystem::create_directory(folder_ / "models/players/imp/cap.tga");
    EXPECT_EQ(picture("cap.md3"), "models/players/imp/hat.png");
    put_model({"cap.tga"}, {}, "cap.md3");
    EXPECT_EQ(picture("cap.md3"), "") << "a folder";
    for (const char* const none : {"", "/", "..", "models/", "a/"})
        EXPECT_EQ(find_game_picture(imp(""), none), std::filesystem::path()) << none;
}

TEST_F(Md3Materials, WhatIsMissingIsNotedAndMatte) {
    put_model({"models/none.tga"}, {"models/none.tga"});
    const auto cage = read();
    EXPECT_EQ(cage->own_materials->materials.at(0), Material{.name = "models/none.tga"});
    EXPECT_EQ(notes(),
              std::vector{imp("head.md3").string() +
                          ": no picture 'models/none.tga'; put it beside the model, or where its path leads "
                          "from there or from a folder above"});
    put_model({"no_one_has_a"}, {"no_one_has_b"}); // not in the folders above either
    EXPECT_NE(notes().at(0).find("no picture 'no_one_has_a', 'no_one_has_b'; put"), std::string::npos)
        << notes().at(0);
}

TEST_F(Md3Materials, SurfacesWithoutShadersAreCalledAsTheyAre) {
    put_model({}, {""});
    const ModelMaterials own = *read()->own_materials;
    EXPECT_EQ(own.materials.at(0).name, "left");
    EXPECT_EQ(own.materials.at(1).name, "right");
    EXPECT_TRUE(own.notes.empty());
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    surfaces[0].triangles.clear(); // nothing of it is seen
    surfaces[0].shaders = {"missing"};
    surfaces[1].name.clear();
    surfaces[1].shaders.clear();
    put_imp("head.md3", write_md3(surfaces, 2));
    const auto cage = read();
    ASSERT_EQ(cage->own_materials->materials.size(), 1U);
    EXPECT_EQ(cage->own_materials->materials[0].name, "surface 2");
    EXPECT_TRUE(cage->own_materials->notes.empty());
    EXPECT_TRUE(cage->face_materials.empty()) << "one is everybody's";
    EXPECT_EQ(cage->material, 0);
}

TEST_F(Md3Materials, SkinsReplaceShaders) {
    put_imp("skin.tga", red);
    put_imp("gold.png", blue);
    put_model({"models/players/imp/skin.tga"}, {"models/players/imp/skin.tga"});
    put_model({"models/players/imp/skin.tga"}, {}, "head_1.md3");
    EXPECT_EQ(picture(), "models/players/imp/skin.tga");
    put_imp("head.skin", "left,models/players/imp/gold.tga\n");
    EXPECT_EQ(picture(), "models/players/imp/gold.png");
    put_imp("head_default.skin", "// a comment\r\n\r\ntag_head,\r\nright, models/players/imp/gold.tga \r\n");
    const ModelMaterials own = *read()->own_materials;
    EXPECT_EQ(own.materials.at(0).name, "models/players/imp/skin.tga") << "of the default one first";
    EXPECT_EQ(own.materials.at(1).name, "models/players/imp/gold.tga");
    EXPECT_EQ(own.textures.at(1).file, imp("gold.png").string());
    EXPECT_TRUE(own.notes.empty());
    put_imp("head_default.skin", "LEFT,gold\nnobody,x.tga");
    EXPECT_EQ(picture(), "models/players/imp/gold.png") << "in any case";
    EXPECT_EQ(notes(), std::vector{imp("head_default.skin").string() +
                                   ": the model has no surface 'nobody'; mend the name"});
    EXPECT_EQ(picture("head_1.md3"), "models/players/imp/gold.png") << "a coarser level";
}

TEST_F(Md3Materials, MistakesNameTheirPlace) {
    put_imp("skin.tga", red.substr(0, 20));
    put_model({"skin.tga"}, {});
    EXPECT_EQ(message(), imp("head.md3").string() + ": surface 'left': " + imp("skin.tga").string() +
                             ": not a readable TGA picture (it is cut short); give another");
    put_imp("head_default.skin", "\nleft,skin\n");
    EXPECT_EQ(message(), imp("head_default.skin").string() + ":2: " + imp("skin.tga").string() +
                             ": not a readable TGA picture (it is cut short); give another");
    put_imp("head_default.skin", "left,x\nright x\n");
    EXPECT_EQ(message(), imp("head_default.skin").string() +
                             ":2: 'right x' is not of the form surface,picture; mend it");
    put_imp("head_default.skin", " ,x\n");
    EXPECT_EQ(message(),
              imp("head_default.skin").string() + ":1: ',x' is not of the form surface,picture; mend it");
}

TEST(Md3Skin, Lines) {
    const std::vector<Md3SkinLine> lines =
        parse_md3_skin("a,b\n \n c d , e,f\t\n//x\ntag_x,\r\nlast,one", "s");
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[1].surface, "c d");
    EXPECT_EQ(lines[1].picture, "e,f");
    EXPECT_EQ(lines[1].line, 3);
    EXPECT_EQ(lines[2].picture, "one");
    EXPECT_EQ(lines[2].line, 6);
    EXPECT_TRUE(parse_md3_skin("", "s").empty());
}

TEST_F(Md3Materials, ScenesReplaceThemByShaderOrSurface) {
    put_model({"models/skin.tga"}, {"models/skin.tga"});
    const auto scene = [&](const std::string& materials) {
        return parse_scene_file(
            "[[material]]\nname = \"first\"\n[[material]]\nname = \"gold\"\n[[mesh]]\nfile = "
            "\"models/players/imp/head.md3\"\n" +
                materials,
            "s.toml", folder_.path());
    };
    using Names = std::vector<std::string>;
    const auto names = [](const Scene& s) {
        Names result;
        for (std::size_t f = 0; f < 4; ++f) {
            const Mesh& m = s.meshes[0];
            const int material = m.face_materials.empty() ? m.material : m.face_materials[f];
            result.push_back(s.materials[static_cast<std::size_t>(material)].name);
        }
        return result;
    };
    const std::string shader = "models/skin.tga", gold = "gold", first = "first";
    EXPECT_EQ(names(build_scene(scene(""))), (Names{shader, shader, shader, shader}));
    EXPECT_EQ(names(build_scene(scene("material = \"gold\"\n"))), (Names{gold, gold, gold, gold}));
    EXPECT_TRUE(notes_of(scene("material = \"gold\"\n")).empty());
    EXPECT_EQ(notes_of(scene("")).size(), 1U);
    EXPECT_EQ(names(build_scene(scene("materials = { \"models/skin.tga\" = \"gold\" }\n"))),
              (Names{gold, gold, gold, gold}));
    const SceneDescription one = scene("materials = { right = \"gold\" }\n");
    EXPECT_EQ(names(build_scene(one)), (Names{shader, shader, gold, gold}));
    EXPECT_EQ(names(build_scene(pose_at(one, 0.02))), (Names{shader, shader, gold, gold}))
        << "between frames";
    EXPECT_EQ(
        names(build_scene(scene("materials = { right = \"first\", \"models/skin.tga\" = \"gold\" }\n"))),
        (Names{gold, gold, first, first}))
        << "a surface is more than a shader";
    const SceneDescription again = parse_scene_file(to_toml(one), "t", {});
    EXPECT_EQ(to_toml(again), to_toml(one));
    expect_same(build_scene(again), build_scene(one));
    try {
        scene("materials = { rigth = \"gold\" }\n");
        ADD_FAILURE();
    } catch (const UserError& error) {
        EXPECT_NE(
            std::string(error.what())
                .find("no material 'rigth'; did you mean 'right'? It has: models/skin.tga, left, right"),
            std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace razor
