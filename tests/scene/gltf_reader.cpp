// Shapes of glTF files: joined points, seams, stored types, and what is refused.
#include "razor/scene/models/gltf_reader.h"
#include "razor/scene/error.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace razor {
namespace {

Mesh read(const GltfWriter& writer) {
    const TemporaryFolder folder;
    return *read_gltf(folder.file("m.gltf", writer.text()), "", 0).cage;
}
std::string message_of(const std::string& bytes, const char* name = "m.gltf") {
    const TemporaryFolder folder;
    try {
        read_gltf(folder.file(name, bytes), "", 0);
    } catch (const UserError& error) {
        const std::string message = error.what(), prefix = (folder / name).string() + ":";
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_NE(message.find(';'), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with(prefix)) << message;
        return message.substr(std::min(prefix.size(), message.size()));
    }
    return {};
}

using Points = std::vector<glm::dvec3>;
const Points triangle_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(GltfReader, ReadsTheSameFromTextBinaryAndBesideIt) {
    const TemporaryFolder folder;
    const GltfWriter w = triangle();
    folder.file("a b.bin", w.bytes);
    for (const auto& file : {folder.file("a.gltf", w.text()), folder.file("a.glb", w.glb()),
                             folder.file("c.gltf", w.text_with_buffer_file("a%20b.bin"))}) {
        const GltfModel model = read_gltf(file, "", 0);
        EXPECT_EQ(model.cage->name, file.stem().string());
        EXPECT_EQ(model.cage->points, triangle_points);
        EXPECT_EQ(model.cage->face_sizes, std::vector<int>{3});
        EXPECT_EQ(model.cage->face_vertices, (std::vector<int>{0, 1, 2}));
        EXPECT_TRUE(model.cage->texcoords.empty());
        EXPECT_TRUE(model.cage->face_texcoords.empty());
        EXPECT_FALSE(model.motion);
    }
}

/// By one to four bytes, in a file of its own or in the text; but not shorter.
TEST(GltfReader, BuffersMayBeLongerThanTheyState) {
    const TemporaryFolder folder;
    const GltfWriter w = triangle();
    for (const std::size_t more : {1U, 2U, 3U, 4U}) {
        folder.file("long.bin", w.bytes + std::string(more, 'x'));
        GltfWriter longer = w;
        longer.bytes += std::string(more, 'x');
        GltfWriter::Json text = GltfWriter::Json::parse(longer.text());
        text["buffers"][0]["byteLength"] = w.bytes.size();
        for (const auto& file :
             {folder.file("a.gltf", w.text_with_buffer_file("long.bin")), folder.file("b.gltf", text.dump())})
            EXPECT_EQ(read_gltf(file, "", 0).cage->points, triangle_points) << file << ' ' << more;
    }
    folder.file("short.bin", w.bytes.substr(1));
    EXPECT_THROW(read_gltf(folder.file("c.gltf", w.text_with_buffer_file("short.bin")), "", 0), UserError);
}

// Two triangles of a square that a seam keeps apart along the diagonal at one end, normals at the other.
TEST(GltfReader, SeamsAreJoinedAndStaySeamsOfTexture) {
    GltfWriter w;
    const int points = w.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, -0.0F}, 3);
    const int uv = w.floats({0, 0, 1, 0, 1, 1, 0.5F, 0.25F, 1, 1, 0, 1}, 2);
    w.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", points}, {"TEXCOORD_0", uv}}}}}}});
    w.add("nodes", {{"mesh", 0}});
    const Mesh mesh = read(w);
    EXPECT_EQ(mesh.points, (Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.texcoords, (std::vector<glm::vec2>{{0, 1}, {1, 1}, {1, 0}, {0.5, 0.75}, {0, 0}}));
    EXPECT_EQ(mesh.face_texcoords, (std::vector<int>{0, 1, 2, 3, 2, 4}));
}

TEST(GltfReader, PrimitivesShareTheirPoints) {
    GltfWriter w = triangle();
    const int other = w.floats({5, 5, 5, 1, 0, 0, 0, 0, 0, 0, 0, 1}, 3);
    const int indices = w.accessor<std::uint32_t>({1, 2, 3, 2, 2, 3, 3, 1, 3}, 1); // two without area
    const int uv = w.floats({0, 0, 0, 0, 0, 0, 1, 0}, 2);
    w.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", other}, {"TEXCOORD_0", uv}}}, {"indices", indices}});
    const Mesh mesh = read(w);
    EXPECT_EQ(mesh.points, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})) << "(5, 5, 5) has no use";
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2, 1, 0, 3}));
    ASSERT_EQ(mesh.face_texcoords.size(), 6U);
    for (const std::size_t corner : {0U, 1U, 2U})
        EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(mesh.face_texcoords[corner])], glm::vec2(0, 0));
    EXPECT_EQ(mesh.texcoords[static_cast<std::size_t>(mesh.face_texcoords[5])], glm::vec2(1, 1));
}

TEST(GltfReader, StripsAndFansKeepTheirWinding) {
    for (const int mode : {4, 5, 6}) {
        GltfWriter w;
        const int points = w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 3);
        w.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", points}}}, {"mode", mode}}}}});
        w.add("nodes", {{"mesh", 0}});
        if (mode == 4)
            w.json["meshes"][0]["primitives"][0]["indices"] = w.accessor<std::uint8_t>({2, 1, 3}, 1);
        const Mesh mesh = read(w);
        std::vector<int> named; // points in the file's order
        for (const int v : mesh.face_vertices)
            named.push_back(static_cast<int>(mesh.points[static_cast<std::size_t>(v)].x +
                                             2 * mesh.points[static_cast<std::size_t>(v)].y));
        EXPECT_EQ(named, mode == 4   ? (std::vector<int>{2, 1, 3})
                         : mode == 5 ? (std::vector<int>{0, 1, 2, 1, 3, 2})
                                     : (std::vector<int>{1, 2, 0, 2, 3, 0}));
    }
}

TEST(GltfReader, MirroredNodesAreTurned) {
    GltfWriter w = triangle();
    w.json["nodes"][0] = {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1}}};
    w.add("nodes", {{"mesh", 0}, {"scale", {1, 2, 1}}});
    w.json["scenes"][0]["nodes"] = {0, 1};
    const Mesh mesh = read(w);
    EXPECT_EQ(mesh.points, (Points{{3, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 2, 0}}));
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 2, 1, 3, 4, 5}));
    w.json["scenes"][0]["nodes"] = {1};
    EXPECT_EQ(read(w).points.size(), 3U) << "only what the scene names";
    w.json.erase("scenes");
    w.json.erase("scene");
    EXPECT_EQ(read(w).points.size(), 6U);
}

TEST(GltfReader, StoredTypesStridesAndSparseParts) {
    GltfWriter w = triangle();
    auto& position = w.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    position = w.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 0, -32768, 0}, 3, true);
    EXPECT_EQ(read(w).points, (Points{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
    position = w.accessor<std::uint8_t>({0, 0, 0, 255, 0, 0, 0, 51, 0}, 3, true);
    EXPECT_EQ(read(w).points, (Points{{0, 0, 0}, {1, 0, 0}, {0, 0.2, 0}}));
    position = w.accessor<std::int8_t>({0, 0, 0, 127, 0, 0, 0, -7, 0}, 3);
    EXPECT_EQ(read(w).points, (Points{{0, 0, 0}, {127, 0, 0}, {0, -7, 0}}));
    const int view = w.view<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}, 16);
    position = w.add(
        "accessors",
        {{"bufferView", view}, {"byteOffset", 4}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    EXPECT_EQ(read(w).points, triangle_points);
    w.json["accessors"].back()["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", w.view<std::uint16_t>({2})}, {"componentType", 5123}}},
        {"values", {{"bufferView", w.view<float>({7, 8, 9})}}}};
    EXPECT_EQ(read(w).points, (Points{{0, 0, 0}, {1, 0, 0}, {7, 8, 9}}));
    // Of zeros that are stored nowhere.
    GltfWriter::Json& accessor = w.json["accessors"].back();
    accessor.erase("bufferView");
    accessor.erase("byteOffset");
    accessor["sparse"]["count"] = 2;
    accessor["sparse"]["indices"]["bufferView"] = w.view<std::uint16_t>({1, 2});
    accessor["sparse"]["values"]["bufferView"] = w.view<float>({1, 0, 0, 7, 8, 9});
    EXPECT_EQ(read(w).points, (Points{{0, 0, 0}, {1, 0, 0}, {7, 8, 9}}));
    accessor["count"] = 100000000; // more than anybody means
    EXPECT_THROW(read(w), UserError);
}

TEST(GltfReader, ImagesAndMaterialsDoNotMatter) {
    GltfWriter w = triangle();
    w.json["images"] = {
        {{"uri", "data:image/odd;base64,!!"}}, {{"uri", "missing.png"}}, GltfWriter::Json::object()};
    w.json["materials"] = "none";
    w.json["extensionsUsed"] = {"VENDOR_thing"};
    w.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_mesh_quantization"};
    w.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "?"}}}}}}};
    w.json["extras"] = {1, {2, {3}}};
    EXPECT_EQ(read(w).points, triangle_points);
}

TEST(GltfReader, RefusesClearly) {
    using Change = void (*)(GltfWriter&);
    using Json = GltfWriter::Json;
    const auto primitive = [](GltfWriter& w) -> Json& { return w.json["meshes"][0]["primitives"][0]; };
    static const auto of = primitive;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    static const std::vector<float> not_finite{0, 0, 0, 1, 0, 0, 0, nan, 0};
    const std::pair<Change, const char*> cases[] = {
        {[](GltfWriter& w) { w.json["asset"]["version"] = "1.0"; }, "glTF version 1.0"},
        {[](GltfWriter& w) { w.json.erase("asset"); }, "states no glTF version"},
        {[](GltfWriter& w) { w.json["asset"]["minVersion"] = "2.1"; }, "needs a reader of glTF 2.1"},
        {[](GltfWriter& w) { w.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
         "needs the extension KHR_draco_mesh_compression, which is not read; export it without compression"},
        {[](GltfWriter& w) { w.json["extensionsRequired"] = {"EXT_meshopt_compression"}; }, "without compr"},
        {[](GltfWriter& w) { w.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"}; }, "not read"},
        {[](GltfWriter& w) { of(w)["mode"] = 7; }, "mode 7"},
        {[](GltfWriter& w) { of(w)["mode"] = 1; }, "draws no triangles"},
        {[](GltfWriter& w) { of(w)["attributes"]["POSITION"] = 9; }, "accessor 9, but the file has 1"},
        {[](GltfWriter& w) { of(w)["attributes"]["POSITION"] = "x"; },
         "1 of 1 mesh primitives make no sense"},
        {[](GltfWriter& w) { of(w)["attributes"]["POSITION"] = w.floats(not_finite, 3); }, "finite"},
        {[](GltfWriter& w) {
             of(w)["indices"] = w.accessor<std::uint16_t>({0, 1, 3}, 1);
         },
         "point 3"},
        {[](GltfWriter& w) {
             of(w)["indices"] = w.accessor<std::uint16_t>({0, 1}, 1);
         },
         "whole triangles"},
        {[](GltfWriter& w) {
             of(w)["indices"] = w.floats({0, 1, 2}, 1);
         },
         "no unsigned integers"},
        {[](GltfWriter& w) { w.json["accessors"][0]["count"] = 4; }, "beyond the end of their buffer"},
        {[](GltfWriter& w) { w.json["accessors"][0]["count"] = 0x7FFFFFFF; }, "beyond the end"},
        {[](GltfWriter& w) { w.json["accessors"][0]["count"] = std::uint64_t{1} << 62; }, "in number"},
        {[](GltfWriter& w) { w.json["accessors"][0]["byteOffset"] = ~std::uint64_t{15}; }, "beyond the end"},
        {[](GltfWriter& w) { w.json["accessors"][0]["type"] = "VEC4"; }, "4 components, not 3"},
        {[](GltfWriter& w) { w.json["accessors"][0]["componentType"] = 5130; }, "stored as type 5130"},
        {[](GltfWriter& w) { w.json["accessors"][0].erase("bufferView"); }, "have no data"},
        {[](GltfWriter& w) { w.json["bufferViews"][0]["byteOffset"] = ~std::uint64_t{3}; }, "beyond the end"},
        {[](GltfWriter& w) { w.json["bufferViews"][0]["byteLength"] = ~std::uint64_t{0}; }, "beyond the end"},
        {[](GltfWriter& w) { w.json["bufferViews"][0]["buffer"] = 1; }, "buffer 1, but the file has 1"},
        {[](GltfWriter& w) { w.json["nodes"][0]["mesh"] = 3; }, "mesh 3, but the file has 1"},
        {[](GltfWriter& w) { w.json["nodes"][0]["children"] = {0}; }, "its own ancestor"},
        {[](GltfWriter& w) { w.json["nodes"][0]["children"] = {5}; }, "node 0 names node 5"},
        {[](GltfWriter& w) {
             w.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
         },
         "node 1 is a child of nodes 0 and 2"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["matrix"] = {1, 2, 3};
         },
         "3 numbers, not 16"},
        {[](GltfWriter& w) { w.json["nodes"][0]["weights"] = {1}; }, "1 numbers, not 0"},
        {[](GltfWriter& w) { w.json["scene"] = 4; }, "scene 4"},
        {[](GltfWriter& w) { w.json["scenes"][0]["nodes"] = {7}; }, "node 7"},
        {[](GltfWriter& w) { w.json["nodes"][0]["skin"] = 0; }, "node 0 names skin 0, but the file has 0"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["skin"] = w.add("skins", {{"joints", GltfWriter::Json::array()}});
         },
         "skin 0 has no joints"},
        {[](GltfWriter& w) {
             w.json["skins"] = {{{"name", "s"}}};
         },
         "skin 0 has no joints"},
        {[](GltfWriter& w) { w.json["nodes"][0]["translation"] = "x"; },
         "node 0 has translation \"x\", which is no list of numbers"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["rotation"] = {{"x", 1}};
         },
         "node 0 has rotation {"},
        {[](GltfWriter& w) { w.json["nodes"][0]["scale"] = true; }, "node 0 has scale true"},
        {[](GltfWriter& w) { w.json["nodes"][0]["matrix"] = nullptr; }, "node 0 has matrix null"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["scale"] = {1, 1, GltfWriter::Json::array({1})};
         },
         "node 0 has scale [1,1,[1]]"},
        {[](GltfWriter& w) { w.json["bufferViews"][0]["byteOffset"] = -4; },
         "buffer view 0 has byteOffset -4, which is no number of bytes"},
        {[](GltfWriter& w) { w.json["bufferViews"][0]["byteStride"] = 12.5; }, "has byteStride 12.5"},
        {[](GltfWriter& w) { w.json["accessors"][0]["byteOffset"] = "0"; },
         "accessor 0 has byteOffset \"0\""},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["skin"] = w.add("skins", {{"joints", {9}}});
         },
         "skin 0 names node 9"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["skin"] = w.add("skins", {{"joints", {0}}});
         },
         "no joints and weights"},
        {[](GltfWriter& w) {
             w.json["nodes"][0]["skin"] = w.add("skins", {{"joints", {0}}});
             of(w)["attributes"]["JOINTS_0"] = w.accessor(std::vector<std::uint8_t>(12, 1), 4);
             of(w)["attributes"]["WEIGHTS_0"] = w.floats(std::vector<float>(12, 1), 4);
         },
         "joint 1, but the skin has 1"},
        {[](GltfWriter& w) {
             w.channel(0, "translation", {1, 0}, {0, 0, 0, 0, 0, 0}, 3);
         },
         "not in order"},
        {[](GltfWriter& w) {
             w.channel(0, "translation", {0, 1}, {0, 0, 0}, 3);
         },
         "values are 1, not 2"},
        {[](GltfWriter& w) {
             w.channel(0, "scale", {0}, {0, 0, 0}, 3, "BEZIER");
         },
         "by BEZIER"},
        {[](GltfWriter& w) {
             w.channel(6, "scale", {0}, {0, 0, 0}, 3);
         },
         "channel 0 names node 6"},
    };
    for (const auto& [change, cause] : cases) {
        GltfWriter w = triangle();
        change(w);
        EXPECT_NE(message_of(w.text()).find(cause), std::string::npos) << cause << "\n"
                                                                       << message_of(w.text());
    }
    const GltfWriter w = triangle();
    EXPECT_NE(message_of(w.text_with_buffer_file("none.bin")).find("File not found : none.bin); put"),
              std::string::npos);
    EXPECT_NE(message_of(std::string(100000, '[')).find("brackets"), std::string::npos);
    EXPECT_NE(message_of("v 0 0 0\n").find("is no glTF file"), std::string::npos);
    EXPECT_TRUE(message_of("{\n  \"asset\": ,\n}\n").starts_with("2:12: is no glTF file, or broken;"));
}

// No shell expansion, and nothing from the working folder.
TEST(GltfReader, FileNamesAreTakenAsTheyAre) {
    const TemporaryFolder folder;
    const GltfWriter w = triangle();
    folder.file("$HOME.bin", w.bytes);
    EXPECT_EQ(read_gltf(folder.file("a.gltf", w.text_with_buffer_file("$HOME.bin")), "", 0).cage->points,
              triangle_points);
    const std::string command = "$(touch " + (folder / "made").string() + ")";
    EXPECT_THROW(read_gltf(folder.file("b.gltf", w.text_with_buffer_file(command)), "", 0), UserError);
    EXPECT_FALSE(std::filesystem::exists(folder / "made"));
}

TEST(GltfReader, DamagedFilesAreRefusedOrRead) {
    const TemporaryFolder folder;
    GltfWriter w = triangle();
    w.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, 3);
    unsigned state = 1;
    for (const std::string& whole : {w.text(), w.glb()}) {
        for (std::size_t length = 0; length < whole.size(); length += length < 40 ? 1 : 5)
            EXPECT_THROW(read_gltf(folder.file("cut", whole.substr(0, length)), "", 0), UserError) << length;
        for (std::size_t at = 0; at < whole.size(); at += 4) {
            std::string damaged = whole;
            state = state * 1664525 + 1013904223;
            damaged[at] = static_cast<char>(state >> 24);
            try {
                const GltfModel model = read_gltf(folder.file("damaged", damaged), "", 0);
                if (model.motion)
                    model.motion->at(0.5);
            } catch (const UserError&) {
            }
        }
    }
}

} // namespace
} // namespace razor
