// Single materials of models replaced by the scene's.
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

namespace razor {
namespace {

class ReplacedMaterials : public ::testing::Test {
protected:
    ReplacedMaterials() {
        folder_.file("m.obj",
                     "mtllib l.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nusemtl skin\nf 1 2 3\n"
                     "usemtl a b\nf 2 3 4\nusemtl skin\nf 1 3 4\n");
        folder_.file("l.mtl", "newmtl skin\nKd 1 0 0\nnewmtl a b\nKd 0 1 0\n");
        folder_.file("one.obj", "mtllib l.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl skin\nf 1 2 3\n");
        folder_.file("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
        folder_.file("t.instances", "m.obj 1 2 3\n");
    }
    SceneDescription scene(const std::string& rest) const {
        return parse_scene_file(
            "name = \"s\"\n[[material]]\nname = \"first\"\n[[material]]\nname = \"gold\"\n" + rest, "s.toml",
            folder_.path());
    }
    std::string message(const std::string& rest) const {
        try {
            scene(rest);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return {};
    }
    /// Of each face of a mesh.
    static std::vector<std::string> names(const Scene& s, std::size_t mesh) {
        const Mesh& m = s.meshes[mesh];
        std::vector<std::string> result;
        for (std::size_t f = 0; f < m.face_sizes.size(); ++f)
            result.push_back(s.materials[static_cast<std::size_t>(
                                             m.face_materials.empty() ? m.material : m.face_materials[f])]
                                 .name);
        return result;
    }
    using Names = std::vector<std::string>;
    TemporaryFolder folder_;
};

TEST_F(ReplacedMaterials, FacesOfThatNameAloneChange) {
    const SceneDescription d =
        scene("[[mesh]]\nfile = \"m.obj\"\nmaterials = { skin = \"gold\" }\n"
              "[[mesh]]\nfile = \"m.obj\"\nmaterials = { \"a b\" = \"gold\" }\n"
              "[[mesh]]\nfile = \"m.obj\"\n"
              "[[mesh]]\nfile = \"one.obj\"\n[mesh.materials]\nskin = \"gold\"\n"
              "[[mesh]]\nfile = \"m.obj\"\nmaterials = { skin = \"gold\", \"a b\" = \"gold\" }\n");
    const Scene s = build_scene(d);
    EXPECT_EQ(names(s, 0), (Names{"first", "gold", "a b", "gold"}));
    EXPECT_EQ(names(s, 1), (Names{"first", "skin", "gold", "skin"}));
    EXPECT_EQ(names(s, 2), (Names{"first", "skin", "a b", "skin"}));
    EXPECT_EQ(names(s, 3), Names{"gold"});
    EXPECT_EQ(names(s, 4), (Names{"first", "gold", "gold", "gold"}));
    const SceneDescription again = parse_scene_file(to_toml(d), "t", {});
    EXPECT_EQ(to_toml(again), to_toml(d));
    expect_same(build_scene(again), s);
}

TEST_F(ReplacedMaterials, TablesPlaceTheMeshSo) {
    const Scene s = build_scene(scene("[[mesh]]\nfile = \"m.obj\"\nmaterials = { skin = \"gold\" }\n"
                                      "[[object]]\ninstances = \"t.instances\"\n"));
    ASSERT_EQ(s.meshes.size(), 1U);
    EXPECT_EQ(names(s, 0), (Names{"first", "gold", "a b", "gold"}));
}

TEST_F(ReplacedMaterials, ThoseOfGltfFilesWhileTheyMove) {
    GltfWriter w = triangle();
    w.json["meshes"][0]["primitives"][0]["material"] = 0;
    w.json["materials"] = {{{"name", "skin"}}};
    w.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, 3);
    folder_.file("m.glb", w.glb());
    const SceneDescription d = scene("[[mesh]]\nfile = \"m.glb\"\nmaterials = { skin = \"gold\" }\n");
    EXPECT_EQ(names(build_scene(pose_at(d, 0.5)), 0), Names{"gold"});
}

TEST_F(ReplacedMaterials, MistakesAreNamed) {
    const std::string mesh = "[[mesh]]\nfile = \"m.obj\"\n";
    EXPECT_NE(
        message(mesh + "materials = { skim = \"gold\" }\n")
            .find("s.toml:8:22: the model has no material 'skim'; did you mean 'skin'? It has: skin, a b"),
        std::string::npos)
        << message(mesh + "materials = { skim = \"gold\" }\n");
    EXPECT_NE(message(mesh + "materials = { skin = \"silver\" }\n").find("'silver' is unknown; known: "),
              std::string::npos);
    EXPECT_NE(message(mesh + "material = \"gold\"\nmaterials = { skin = \"gold\" }\n").find("leave one out"),
              std::string::npos);
    EXPECT_NE(message(mesh + "materials = \"gold\"\n").find("materials"), std::string::npos);
    EXPECT_NE(message("[[mesh]]\nfile = \"bare.obj\"\nmaterials = { skin = \"gold\" }\n")
                  .find("brings no materials"),
              std::string::npos);
    EXPECT_NE(
        message("[[mesh]]\nshape = \"box\"\nmaterials = { skin = \"gold\" }\n").find("brings no materials"),
        std::string::npos);
}

} // namespace
} // namespace razor
