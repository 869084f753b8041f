// razor info: what it lists of a scene, for people and for programs.
#include "tests/program/run.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/picture_writer.h"

#include <nlohmann/json.hpp>

namespace razor {
namespace {

class Info : public ::testing::Test {
protected:
    Info() {
        folder_.file("a.png", png_of(6, 3, {}, std::vector<std::uint8_t>(54, 128)));
        folder_.file("o.obj",
                     "mtllib l.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl shown\n"
                     "f 1 3 4\nf 1 2 4\n");
        folder_.file("l.mtl", "newmtl red\nKd 1 0 0\nnewmtl shown\nKs 1 1 1\nNs 9\nmap_Kd a.png\n");
        folder_.file("s.toml",
                     "name = \"both\"\n[[texture]]\nname = \"t\"\nfile = \"a.png\"\nwrap = \"clamp\"\n"
                     "color_space = \"linear\"\n[[material]]\nname = \"grey\"\nroughness_map = \"t\"\n"
                     "[[material]]\nname = \"glass\"\nkind = \"glass\"\n"
                     "[[material]]\nname = \"felt\"\nsheen_map = \"t\"\nsheen_roughness_map = \"t\"\n"
                     "[[mesh]]\nname = \"quad\"\nfile = \"o.obj\"\nscheme = \"bilinear\"\n"
                     "[[object]]\nmesh = \"quad\"\narray = [3, 1, 1]\nspacing = [2, 0, 0]\n"
                     "[[object]]\nmesh = \"quad\"\nmaterial = \"glass\"\ntranslate = [0, 4, 0]\n");
    }
    Outcome info(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_PROGRAM) + " info " + arguments, folder_.path());
    }
    TemporaryFolder folder_;
};

TEST_F(Info, ListsWhatASceneConsistsOf) {
    const Outcome result = info("s.toml --json i.json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const std::string& line :
         {std::string("  quad: 3 faces, 4 points, bilinear, 4 instances\n"), std::string("instances: 4\n"),
          std::string("  grey: matte, albedo 0.7, roughness 1, roughness_map t, not used\n"),
          std::string("  glass: glossy, albedo 1, roughness 0, specular 1, transmission 1, 3 faces\n"),
          std::string("  felt: glossy, albedo 0.7, sheen 1, sheen_roughness 1, sheen_map t, "
                      "sheen_roughness_map t, not used\n"),
          std::string("  red: matte, albedo 1 0 0, 3 faces\n"),
          std::string("  shown: glossy, albedo 1, roughness 0.652994, specular 1, albedo_map a, 6 faces\n"),
          "  t: 6 x 3, 4 levels, 320 B, clamp, linear, " + (folder_ / "a.png").string() + ", not used\n",
          "  a: 6 x 3, 4 levels, 320 B, repeat, srgb, " + (folder_ / "a.png").string() + "\n"})
        EXPECT_NE(result.out.find(line), std::string::npos) << line << result.out;
    std::ifstream file(folder_ / "i.json");
    const auto json = nlohmann::json::parse(file);
    EXPECT_EQ(json["scene"], "both");
    EXPECT_EQ(json["meshes"][0]["instances"], 4);
    EXPECT_EQ(json["materials"][1]["transmission"], 1.0);
    EXPECT_EQ(json["materials"][2]["sheen_map"]["texture"], "t");
    EXPECT_EQ(json["materials"][4]["albedo_map"]["number"], 1);
    EXPECT_EQ(json["materials"][4]["faces"], 6);
    EXPECT_EQ(json["textures"][0]["color_space"], "linear");
    EXPECT_EQ(json["textures"][0]["used"], false);
    EXPECT_EQ(json["textures"][1]["bytes"], 320);
    EXPECT_EQ(json["lights"].size(), 1U);
    EXPECT_EQ(json["camera"]["target"].size(), 3U);
}

TEST_F(Info, TellsWhatGltfFilesHold) {
    GltfWriter w = triangle();
    w.json["nodes"][0]["name"] = "Body";
    w.json["nodes"][0]["camera"] = 0;
    w.json["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    w.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.5707963267948966}, {"aspectRatio", 2}}}},
        {{"type", "orthographic"}, {"name", "plan"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}}}}};
    w.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
    w.add("nodes", {{"camera", 1}});
    for (const char* const name : {"Hand", "Lamp", "Hand", "Foot"})
        w.add("nodes", {{"name", name}});
    w.add("skins", {{"joints", {2, 4, 5}}});
    w.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5};
    w.channel(0, "translation", {0, 1.25}, {0, 0, 0, 1, 0, 0}, 3);
    w.json["animations"][0]["name"] = "Run";
    folder_.file("m.glb", w.glb());
    folder_.file("g.toml",
                 "[camera]\nfrom = \"m.glb\"\n[[light]]\nfrom = \"m.glb\"\n[[mesh]]\nfile = \"o.obj\"\n");
    for (const std::string scene : {"m.glb", "g.toml"}) {
        const Outcome result = info(scene + " --json i.json");
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(
            result.out.find("glTF files: 1\n  " + (folder_ / "m.glb").string() +
                            "\n    cameras: Body (90 degrees, 2 times as wide as high), plan (orthographic, "
                            "height 4, 1.5 times as wide as high)\n    lights: Body (spot)\n    animations: "
                            "Run (1.25 s)\n    joints: Hand (2 of this name), Foot\n    nodes: Body, Lamp\n"),
            std::string::npos)
            << result.out;
        std::ifstream file(folder_ / "i.json");
        const auto json = nlohmann::json::parse(file)["gltf_files"];
        ASSERT_EQ(json.size(), 1U);
        EXPECT_EQ(json[0]["cameras"][0]["aspect_ratio"], 2.0);
        EXPECT_EQ(json[0]["cameras"][1]["projection"], "orthographic");
        EXPECT_EQ(json[0]["cameras"][1]["height"], 4.0);
        EXPECT_EQ(json[0]["lights"][0]["kind"], "spot");
        EXPECT_EQ(json[0]["animations"][0]["seconds"], 1.25);
        ASSERT_EQ(json[0]["nodes"].size(), 5U);
        EXPECT_EQ(json[0]["nodes"][2]["name"], "Lamp");
        EXPECT_EQ(json[0]["nodes"][2]["joint"], false);
        EXPECT_EQ(json[0]["nodes"][4]["joint"], true);
    }
    EXPECT_EQ(info("o.obj").out.find("glTF"), std::string::npos);
}

TEST_F(Info, ListsTags) {
    folder_.file("m.md3", write_md3(two_surfaces(), 2, {{"tag_head", {{}, {}}}, {"tag_weapon", {{}, {}}}}));
    const Outcome result = info("m.md3 --json i.json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("\ntags of m: tag_head, tag_weapon\n"), std::string::npos) << result.out;
    std::ifstream file(folder_ / "i.json");
    const auto json = nlohmann::json::parse(file)["tags"];
    ASSERT_EQ(json.size(), 1U);
    EXPECT_EQ(json[0]["mesh"], "m");
    EXPECT_EQ(json[0]["file"], (folder_ / "m.md3").string());
    EXPECT_EQ(json[0]["tags"], nlohmann::json::array({"tag_head", "tag_weapon"}));
    EXPECT_EQ(info("o.obj").out.find("tags of"), std::string::npos);
}

TEST_F(Info, ListsFramesAndSurfacesOfMd3Files) {
    const auto surfaces = two_surfaces();
    folder_.file("m.md3", write_md3(surfaces, 2));
    const Outcome result = info("m.md3 --json i.json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find((folder_ / "m.md3").string() + ": 2 frames, 0 to 1; surfaces: " +
                              surfaces[0].name + ", " + surfaces[1].name + "\n"),
              std::string::npos)
        << result.out;
    std::ifstream file(folder_ / "i.json");
    const auto json = nlohmann::json::parse(file)["md3_files"];
    ASSERT_EQ(json.size(), 1U);
    EXPECT_EQ(json[0]["frames"], 2);
    EXPECT_EQ(json[0]["surfaces"], nlohmann::json::array({surfaces[0].name, surfaces[1].name}));
    EXPECT_EQ(info("o.obj").out.find("frames"), std::string::npos);
}

TEST_F(Info, ListsEveryShippedScene) {
    int patterns = 0, heights = 0;
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/scenes")) {
        if (entry.path().extension() != ".toml")
            continue;
        const Outcome result = info(quoted_argument(entry.path().string()) + " --json i.json");
        ASSERT_EQ(result.code, 0) << entry.path() << result.err;
        std::ifstream file(folder_ / "i.json");
        const auto json = nlohmann::json::parse(file);
        for (const nlohmann::json& texture : json.at("textures")) {
            patterns += texture.contains("pattern") ? 1 : 0;
            // What displacement reads it reads beside what colours do: more than a word a texel.
            if (!texture.contains("pattern") && texture.at("used") == true)
                heights +=
                    texture.at("bytes") > 6 * texture.at("width").get<int>() * texture.at("height").get<int>()
                        ? 1
                        : 0;
        }
    }
    EXPECT_GT(patterns, 20);
    EXPECT_EQ(heights, 5); // of showcase-displaced
}

TEST_F(Info, TakesModelsAndNamesMistakes) {
    EXPECT_NE(info("o.obj").out.find("materials: 4\n"), std::string::npos);
    EXPECT_NE(info("").out.find("scene default"), std::string::npos);
    folder_.file("l.mtl", "newmtl red\nmap_Kd none.png\n");
    const Outcome result = info("s.toml");
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error_lines(), 1);
    EXPECT_NE(result.err.find("l.mtl:2: the texture 'none.png' is not there"), std::string::npos);
}

} // namespace
} // namespace razor
