// The PLY reader beside the OBJ reader: the same meshes in all encodings, types and orders; what is joined,
// and every kind of mistake.
#include "razor/scene/models/ply_reader.h"

#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/models/obj_reader.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/ply_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <cmath>
#include <limits>

namespace razor {
namespace {

constexpr PlyEncoding encodings[] = {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian};

/// A house front with a roof, a window twice as far: quads, a triangle, a pentagon, one point unused.
const std::string front = "v 0 0 0.1\nv 2 0 -1e-3\nv 2.5 1 1e300\nv 0 1 4.9e-324\nv 1 2 0\nv 9 9 9\nv 3 3 3\n"
                          "f 1 2 3 4\nf 4 3 5\nf 7 5 4 1 2\n";
/// Four faces about a point, with a seam of texture along one edge.
const std::string seam =
    "v -1 -1 0\nv 0 -1 0\nv 0 0 0\nv -1 0 0\nv 1 -1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nvt 0.75 0.25\nvt 1 0\nvt 1 0.5\nvt 0.75 0.5\n"
    "vt 1 1\nvt 0.75 1\n"
    "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\nf 3/8 6/7 7/9 8/10\n";

/// With the first `from`, which must be there, replaced.
std::string with(const std::string& text, std::string_view from, std::string_view to) {
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.substr(0, place) + std::string(to) + text.substr(place + from.size());
}

std::string message_of(std::string_view bytes) {
    try {
        parse_ply(bytes, "m.ply");
    } catch (const UserError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with("m.ply:")) << message;
        EXPECT_NE(message.find(';'), std::string::npos) << message;
        return message;
    }
    return {};
}

TEST(PlyReader, ReadsWhatTheObjReaderDoesInAllEncodings) {
    for (const std::string& obj : {front, seam}) {
        const Mesh expected = parse_obj(obj, "d/m.obj");
        for (const PlyEncoding encoding : encodings) {
            for (const char* const line_end : {"\n", "\r\n", "\r"}) {
                expect_same(parse_ply(write_ply(expected, encoding, line_end), "d/m.ply"), expected);
            }
        }
    }
}

TEST(PlyReader, ReadsSharedModelsAsTheObjReaderDoes) {
    const std::string folder = std::string(RAZOR_SHARED_SCENES);
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "no shared scenes in " << folder;
    }
    for (const char* const name :
         {"/osd/catmark_torus.obj", "/osd/catmark_nonquads.obj", "/osd/catmark_pole64.obj"}) {
        Mesh expected = read_obj(folder + name);
        expected.texcoords.clear();
        expected.face_texcoords.clear();
        expected.boundary = BoundaryInterpolation::edge_only; // PLY has no tags
        expected.creases.clear();
        expected.corners.clear();
        for (const PlyEncoding encoding : encodings) {
            expect_same(parse_ply(write_ply(expected, encoding), expected.name + ".ply"), expected);
        }
    }
}

/// A triangle (1 2 3) (4 5 6) (7 8 9), with all else that a file may have round about it.
std::string odd_triangle(PlyEncoding encoding, PlyType coordinate, PlyType count, PlyType index) {
    constexpr const char* old_names[] = {"char", "uchar", "short", "ushort",
                                         "int",  "uint",  "float", "double"};
    constexpr const char* new_names[] = {"int8",  "uint8",  "int16",   "uint16",
                                         "int32", "uint32", "float32", "float64"};
    const auto name = [&](PlyType type) {
        return (encoding == PlyEncoding::ascii ? old_names : new_names)[static_cast<std::size_t>(type)];
    };
    PlyWriter w(encoding);
    w.line("comment TextureFile none.png");
    w.line("element material 2");
    w.line("property double shine");
    w.line("property list short double parts");
    w.line("obj_info made by hand");
    w.line("element face 1");
    w.line("property uchar flags");
    w.line(fmt::format("property list {} {} vertex_index", name(count), name(index)));
    w.line("property list uchar float texcoord");
    w.line("element nothing 99999999999");
    w.line("element vertex 3");
    for (const char* const other : {"red", "z", "weights", "y", "quality", "x"}) {
        const std::string type = other == std::string("weights") ? "list uint char"
                                 : std::string_view("xyz").find(other) != std::string_view::npos
                                     ? name(coordinate)
                                     : "ushort";
        w.line(fmt::format("property {} {}", type, other));
    }
    w.line("element edge 1");
    w.line("property int vertex1");
    for (int n = 0; n < 2; ++n) {
        w.put(PlyType::float64, -1.5);
        w.put(PlyType::int16, 3 * n);
        for (int i = 0; i < 3 * n; ++i) {
            w.put(PlyType::float64, 0.25);
        }
        w.end();
    }
    w.put(PlyType::uint8, 255);
    w.put(count, 3);
    for (const int i : {2, 0, 1}) {
        w.put(index, i);
    }
    w.put(PlyType::uint8, 1);
    w.put(PlyType::float32, 0.5);
    w.end();
    for (int n = 0; n < 3; ++n) {
        w.put(PlyType::uint16, 65535);
        w.put(coordinate, 3 * n + 3);
        w.put(PlyType::uint32, n);
        for (int i = 0; i < n; ++i) {
            w.put(PlyType::int8, -128);
        }
        w.put(coordinate, 3 * n + 2);
        w.put(PlyType::uint16, 1);
        w.put(coordinate, 3 * n + 1);
        w.end();
    }
    w.put(PlyType::int32, -7);
    w.end();
    return w.bytes();
}

TEST(PlyReader, TakesAnyTypesAndOrdersAndPassesOverTheRest) {
    for (const PlyEncoding encoding : encodings) {
        for (int type = 0; type < 8; ++type) {
            const auto coordinate = static_cast<PlyType>(type), whole = static_cast<PlyType>(type % 6);
            const Mesh mesh = parse_ply(
                odd_triangle(encoding, coordinate, whole, static_cast<PlyType>((type + 2) % 6)), "m");
            EXPECT_EQ(mesh.points, (std::vector<glm::dvec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})) << type;
            EXPECT_EQ(mesh.face_vertices, (std::vector<int>{2, 0, 1}));
            EXPECT_EQ(mesh.face_sizes, std::vector<int>{3});
            EXPECT_TRUE(mesh.face_texcoords.empty());
        }
    }
}

TEST(PlyReader, NumbersAreOfTheirTypesInText) {
    const auto text = [](const char* type, const char* x) {
        return fmt::format(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty {} x\nproperty int y\nproperty "
            "short z\nelement face 1\nproperty list int int vertex_indices\nend_header\n{} -3 2\n+1 4 5\n6 7 "
            "8\n3\n0 1\n2",
            type, x);
    };
    EXPECT_EQ(parse_ply(text("float", "0.1"), "m").points[0], glm::dvec3(double{0.1F}, -3, 2));
    EXPECT_EQ(parse_ply(text("double", "0.1"), "m").points[0].x, 0.1);
    EXPECT_EQ(parse_ply(text("double", "1e-400"), "m").points[0].x, 0);
    EXPECT_NE(message_of(text("float", "1e39")).find("m.ply:10: 1e39 is beyond single precision"),
              std::string::npos);
    for (const char* const x : {"nan", "inf", "-inf", "1e999"}) {
        EXPECT_NE(message_of(text("double", x)).find("m.ply:10: x is no finite number; mend it"),
                  std::string::npos)
            << x;
    }
    for (const char* const x : {"one", "1.5.2", "0x10", "--1"}) {
        EXPECT_NE(message_of(text("double", x)).find("is not a number"), std::string::npos) << x;
    }
    EXPECT_NE(message_of(text("int", "1.5")).find("'1.5' is not a whole number"), std::string::npos);
    for (const PlyEncoding encoding : {PlyEncoding::little_endian, PlyEncoding::big_endian}) {
        Mesh mesh = parse_obj(front, "m.obj");
        mesh.points[1].y = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(message_of(write_ply(mesh, encoding)), "m.ply: vertex 1: y is no finite number; mend it");
    }
}

/// As the writer's vertices are: a square of two triangles, apart along the diagonal.
std::string apart(std::string_view properties, std::string_view rest_of_second) {
    return fmt::format(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
        "float z\n{}element face 2\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n-0 0 0 {}\n1 1 0 {}\n0 1 0 0 1\n3 0 1 2\n3 3 4 5\n",
        properties, rest_of_second, rest_of_second == "0 0" ? "1 1" : "0.5 0.5");
}

TEST(PlyReader, JoinsWhatIsApartForTextureCoordinatesAndNormalsOnly) {
    for (const auto& [u, v] : {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v"),
                               std::pair("texture_s", "texture_t")}) {
        const std::string properties = fmt::format("property float {}\nproperty float {}\n", u, v);
        const Mesh mesh = parse_ply(apart(properties, "0.25 0.5"), "m");
        EXPECT_EQ(mesh.points, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
        EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
        EXPECT_EQ(mesh.texcoords,
                  (std::vector<glm::vec2>{{0, 0}, {1, 0}, {1, 1}, {0.25, 0.5}, {0.5, 0.5}, {0, 1}}));
        EXPECT_EQ(mesh.face_texcoords, (std::vector<int>{0, 1, 2, 3, 4, 5}));
        const Mesh same = parse_ply(apart(properties, "0 0"), "m");
        EXPECT_EQ(same.face_texcoords, (std::vector<int>{0, 1, 2, 0, 2, 3})) << "no seam where none is";
    }
    const Mesh facets = parse_ply(apart("property float nx\nproperty float ny\n", "0 1"), "m");
    EXPECT_EQ(facets.points.size(), 4U);
    EXPECT_TRUE(facets.face_texcoords.empty());
    const Mesh meant = parse_ply(apart("property float a\nproperty float b\n", "0 1"), "m");
    EXPECT_EQ(meant.points.size(), 6U) << "nothing says why they are apart";
    EXPECT_EQ(meant.face_vertices, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(PlyReader, FacesThatJoiningFoldsLoseCornersOrGo) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty float s\nproperty float t\nelement face ";
    const std::string points =
        "\nproperty list int int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n"
        "1 0 0 9 9\n1 0 0 8 8\n";
    const Mesh mesh = parse_ply(head + "2" + points + "4 0 1 4 2\n3 1 4 5\n", "m");
    EXPECT_EQ(mesh.face_sizes, std::vector<int>{3});
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(mesh.face_texcoords.size(), 3U);
    EXPECT_NE(message_of(head + "1" + points + "3 1 4 5\n").find("no faces that have an area"),
              std::string::npos);
}

TEST(PlyReader, RefusesClearly) {
    const std::string sound = write_ply(parse_obj(front, "m.obj"), PlyEncoding::ascii);
    ASSERT_EQ(message_of(sound), "");
    struct Case {
        const char *from, *to, *message;
    };
    const Case cases[] = {
        {"ply\n", "plx\n", "m.ply:1: begins with 'plx\\x0a', not with a line 'ply'; give a PLY file"},
        {"ply\n", "plyx\n", "m.ply:1: begins with"},
        {"format ascii 1.0\n", "", "m.ply:8: the header ends without a format line"},
        {"ascii 1.0", "ascii 2.0", "m.ply:2: this format is not known"},
        {"ascii", "binary_middle_endian", "m.ply:2: this format is not known"},
        {"element vertex 7", "element vertex -7", "m.ply:3: an element without a name and a number"},
        {"element vertex 7", "element vertex 7x", "m.ply:3: an element without"},
        {"element vertex 7", "element vertex", "m.ply:3: an element without"},
        {"element vertex 7", "element vertex 3000000000", "m.ply:3: more than 2147483647 elements 'vertex'"},
        {"element vertex 7", "element vertex 2000000000", "m.ply:3: element vertex 2000000000 does not fit"},
        {"element vertex 7\n", "", "m.ply:3: a property before any element"},
        {"element face", "element vertex", "m.ply:7: there are two elements 'vertex'"},
        {"element face 3", "element faces 3", "m.ply: has no element 'face'"},
        {"element vertex 7", "element point 7", "m.ply: has no element 'vertex'"},
        {"double y", "double x", "m.ply:5: element vertex has two properties 'x'"},
        {"double y", "double w", "m.ply:3: vertices have no number 'y'"},
        {"double y", "list int double y", "m.ply:3: vertices have no number 'y'"},
        {"double y", "long y", "m.ply:5: 'long' is no type of PLY"},
        {"double y", "double", "m.ply:5: a property is not complete"},
        {"list uchar", "list float", "m.ply:8: 'vertex_indices' counts its list by a float"},
        {"uchar int", "uchar float", "m.ply:7: faces have no list of whole numbers"},
        {"list uchar int", "int", "m.ply:7: faces have no list"},
        {"vertex_indices", "corners", "m.ply:7: faces have no list"},
        {"end_header", "end header", "m.ply:9: 'end' is not a statement of a PLY header"},
        {"end_header\n", "", "is not a statement of a PLY header"},
        {"4 0 1 2 3", "2 0 1", "m.ply:17: face with 2 corners; a face needs 3 or more"},
        {"4 0 1 2 3", "1 0", "m.ply:17: face with 1 corner;"},
        {"4 0 1 2 3", "0", "m.ply:17: face with 0 corners;"},
        {"4 0 1 2 3", "-4 0 1 2 3", "m.ply:17: the list 'vertex_indices' has -4 values"},
        {"4 0 1 2 3", "400 0 1 2 3",
         "m.ply:17: the list 'vertex_indices' has 400 values, more than are left"},
        {"4 0 1 2 3", "4 0 1 2 7",
         "m.ply:17: face names vertex 7, but the file has 7, from 0; mend the index"},
        {"4 0 1 2 3", "4 0 1 2 -1", "m.ply:17: face names vertex -1"},
        {"4 0 1 2 3", "4 0 1 1 3", "m.ply:17: face names vertex 1 twice in a row"},
        {"4 0 1 2 3", "4 0 1 2 0", "m.ply:17: face names vertex 0 twice in a row"},
        {"4 0 1 2 3", "4 0 1 2 x", "m.ply:17: 'x' is not a whole number"},
        {"element face 3", "element face 2", "m.ply:19: the file goes on after its last element"},
        {"element face 3", "element face 4", "m.ply:20: the file ends at face 3 of 4; it is cut off"},
        {"element vertex 7", "element vertex 6", "m.ply:17: face names vertex 3 twice in a row"},
    };
    for (const auto& [from, to, message] : cases) {
        const std::string text = with(sound, from, to);
        EXPECT_NE(message_of(text).find(message), std::string::npos) << message << "\n" << message_of(text);
    }
    EXPECT_NE(
        message_of(sound.substr(0, sound.find("4 0 1"))).find("m.ply:7: element face 3 does not fit into"),
        std::string::npos);
    const std::string no_faces =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty "
        "int z\nelement face 0\nproperty list int int vertex_index\nend_header\n";
    EXPECT_EQ(message_of(no_faces), "m.ply: no faces; a model needs at least one");
}

TEST(PlyReader, BinaryMistakesNameTheElement) {
    Mesh mesh = parse_obj(front, "m.obj");
    for (const PlyEncoding encoding : {PlyEncoding::little_endian, PlyEncoding::big_endian}) {
        const std::string sound = write_ply(mesh, encoding);
        for (std::size_t length = 0; length < sound.size(); ++length) {
            EXPECT_NE(message_of(sound.substr(0, length)), "") << length;
        }
        EXPECT_EQ(message_of(sound + std::string("\n\0", 2)), "");
        EXPECT_NE(
            message_of(sound + "more").find("m.ply: the file goes on after its last element, by 4 bytes"),
            std::string::npos);
        const std::string many = with(sound, "vertex 7", "vertex 2147483647");
        EXPECT_NE(message_of(many).find("m.ply:3: element vertex 2147483647 does not fit"),
                  std::string::npos);
        std::string wrong = sound;
        wrong.back() = wrong[wrong.size() - 4] = 127;
        EXPECT_NE(message_of(wrong).find("m.ply: face 2: face names vertex"), std::string::npos);
    }
}

TEST(PlyReader, DamagedFilesAreRefusedOrSound) {
    unsigned state = 1;
    for (const PlyEncoding encoding : encodings) {
        const std::string whole = write_ply(parse_obj(seam, "m.obj"), encoding);
        for (int round = 0; round < 1500; ++round) {
            std::string damaged = whole;
            for (int n = 0; n < 2; ++n) {
                state = state * 1664525 + 1013904223;
                damaged[state / 256 % damaged.size()] = static_cast<char>(state >> 24);
            }
            try {
                const Mesh mesh = parse_ply(damaged, "m.ply");
                for (const int v : mesh.face_vertices) {
                    ASSERT_LT(static_cast<std::size_t>(v), mesh.points.size());
                }
                for (const int t : mesh.face_texcoords) {
                    ASSERT_LT(static_cast<std::size_t>(t), mesh.texcoords.size());
                }
            } catch (const UserError&) {
            }
        }
    }
}

/// Wherever a scene takes an OBJ file it takes a PLY file.
TEST(PlyReader, ScenesTakeItForObj) {
    const TemporaryFolder folder;
    for (int n = 0; n < 3; ++n) {
        Mesh mesh = parse_obj(front, "m.obj");
        mesh.points[2] = {2.5, 1 + n, 0};
        folder.file(fmt::format("w_{}.PLY", n), write_ply(mesh, PlyEncoding::little_endian));
        const std::string obj = with(with(front, "1e300", "0"), "2.5 1", fmt::format("2.5 {}", 1 + n));
        folder.file(fmt::format("w_{}.obj", n), obj);
    }
    EXPECT_TRUE(is_model_file("a.ply") && is_model_file("w_%d.PLY"));
    for (const std::string& rest : {std::string("[[mesh]]\nfile = \"w_1.X\"\nscheme = \"bilinear\"\n"),
                                    std::string("[[mesh]]\nfile = \"w_%d.X\"\nframe_rate = 1.0\n"),
                                    std::string("[[object]]\ninstances = \"X.instances\"\n")}) {
        std::vector<Scene> scenes;
        for (const std::string extension : {"obj", "PLY"}) {
            const std::string text = "name = \"s\"\n" + with(rest, "X", extension);
            folder.file(extension + ".instances",
                        "w_2." + extension + " 1 2 90\nw_0." + extension + " 1 2 3 4\n");
            const SceneDescription d = parse_scene_file(text, "s.toml", folder.path());
            scenes.push_back(build_scene(pose_at(d, 1.25)));
            expect_same(scenes.back(), build_scene(pose_at(parse_scene_file(to_toml(d), "s", {}), 1.25)));
        }
        expect_same(scenes[0], scenes[1]);
    }
    expect_same(load_scene(folder / "w_2.PLY"), load_scene(folder / "w_2.obj"));
}

} // namespace
} // namespace razor
