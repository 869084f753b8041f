// The OBJ reader: statements one by one, every kind of mistake, and every shared file against its published
// counts.
#include "razor/scene/models/obj_reader.h"

#include "razor/scene/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

namespace razor {
namespace {

/// The message of the UserError that parsing `text` as "m.obj" throws; empty if it loads.
std::string message_of(std::string_view text) {
    try {
        parse_obj(text, "m.obj");
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string with_square(std::string_view rest) {
    return std::string(square) + std::string(rest);
}

TEST(ObjReader, ReadsPointsAsDoubles) {
    const Mesh mesh =
        parse_obj("v 0.1 +2e3 -3.5 1 0.2 0.3 0.4\nv 16777217 0 0\nv 1e-400 0 4.9e-324\nf 1 2 3", "d/cup.obj");
    EXPECT_EQ(mesh.name, "cup");
    ASSERT_EQ(mesh.points.size(), 3U);
    EXPECT_EQ(mesh.points[0], glm::dvec3(0.1, 2000, -3.5));
    EXPECT_EQ(mesh.points[1].x, 16777217.0);
    EXPECT_EQ(mesh.points[2].x, 0.0);
    EXPECT_EQ(mesh.points[2].z, 4.9e-324);
    EXPECT_EQ(mesh.face_sizes, std::vector<int>{3});
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2}));
    EXPECT_TRUE(mesh.face_texcoords.empty());
}

TEST(ObjReader, ReadsEveryFormOfCorner) {
    const Mesh mesh = parse_obj(with_square("vt 0 0\nvt 1 0\nvt 1 1 9\nvt 0.5\nvn 0 0 1\n"
                                            "f 1/1 2/2 3/3\nf 1/1/1 3/3/1 4/4/1\nf -4/-4/-1 -3/-3 -1/-1/\n"),
                                "m.obj");
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3, 0, 1, 3}));
    EXPECT_EQ(mesh.face_texcoords, (std::vector<int>{0, 1, 2, 0, 2, 3, 0, 1, 3}));
    EXPECT_EQ(mesh.texcoords[3], glm::vec2(0.5F, 0));
    const Mesh careless = parse_obj(with_square("f 1// 2// 3/\nf 1//1 3//2 4//-7\n"), "m.obj");
    EXPECT_EQ(careless.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(careless.face_texcoords.empty());
}

TEST(ObjReader, NegativeIndicesCountFromTheFaceBack) {
    const Mesh mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n", "m.obj");
    EXPECT_EQ(mesh.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
}

TEST(ObjReader, FacesMayComeBeforePoints) {
    EXPECT_EQ(parse_obj("f 1 2 3\nt crease 2/1/0 0 1 2\nv 0 0 0\nv 1 0 0\nv 1 1 0", "m.obj").points.size(),
              3U);
}

TEST(ObjReader, LinesEndInEveryWay) {
    for (const std::string_view end : {"\n", "\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF# top \\\nv 0 0 0\nv 1 0 0 # here\n\n v 1 \\\n 1 0\nv 0 1 0\nf 1 "
                           "2\\\n\t3 \\\n4\nbad";
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) {
            text.replace(at, 1, end);
        }
        EXPECT_EQ(message_of(text),
                  "m.obj:11: 'bad' is not an OBJ statement; remove the line or give an OBJ file");
        text.resize(text.size() - 3);
        EXPECT_EQ(parse_obj(text, "m.obj").face_vertices, (std::vector<int>{0, 1, 2, 3}));
    }
}

TEST(ObjReader, PassesOverGroupsAndMaterials) {
    const Mesh mesh =
        parse_obj(with_square("mtllib a b\\c\ng An f Three\no x\nusemtl m\ns off\nf 1 2 3\no y\n"
                              "vn nonsense\nl 1 2\np 1\ng\nf 1 3 4\n"),
                  "m.obj");
    EXPECT_EQ(mesh.face_sizes, (std::vector<int>{3, 3}));
}

TEST(ObjReader, TextureCoordinatesAreForAllFacesOrNone) {
    const Mesh some = parse_obj(with_square("vt 1 1\nf 1/1 2/1 3/1\nf 1 3 4\n"), "m.obj");
    EXPECT_EQ(some.face_texcoords, (std::vector<int>{0, 0, 0, 1, 1, 1}));
    EXPECT_EQ(some.texcoords.back(), glm::vec2(0));
    const Mesh dangling = parse_obj(with_square("f 1/1 2/2 3/3\n"), "m.obj");
    EXPECT_TRUE(dangling.face_texcoords.empty());
    const Mesh unused = parse_obj(with_square("vt 1 1\nf 1 2 3\n"), "m.obj");
    EXPECT_TRUE(unused.face_texcoords.empty());
}

TEST(ObjReader, ReadsTags) {
    const Mesh mesh = parse_obj(
        with_square("f 1 2 3 4\nt crease 2/1/0 0 1 2.5\nt corner 1/1/0 3 10\nt corner 2/2/0 0 1 3 4\n"
                    "t hole 1/0/0 0\nt interpolateboundary 1/0/0 1 \n"
                    "t facevaryinginterpolateboundary 1/0/0 4\nt creasemethod 0/0/1 chaikin\n"
                    "t smoothtriangles 0/0/1 smooth\n"),
        "m.obj");
    ASSERT_EQ(mesh.creases.size(), 1U);
    EXPECT_EQ(mesh.creases[0].v1, 1);
    EXPECT_EQ(mesh.creases[0].sharpness, 2.5F);
    ASSERT_EQ(mesh.corners.size(), 3U);
    EXPECT_EQ(mesh.corners[0].vertex, 3);
    EXPECT_EQ(mesh.corners[2].sharpness, 4.0F);
    EXPECT_EQ(mesh.holes, std::vector<int>{0});
    EXPECT_EQ(mesh.boundary, BoundaryInterpolation::edge_and_corner);
    EXPECT_EQ(mesh.face_varying, FaceVaryingInterpolation::boundaries);
    EXPECT_EQ(mesh.crease_method, CreaseMethod::chaikin);
    EXPECT_EQ(mesh.triangles, TriangleSubdivision::smooth);
    const auto boundary = [](std::string_view value) {
        return parse_obj(with_square("f 1 2 3\nt interpolateboundary 1/0/0 " + std::string(value)), "m.obj")
            .boundary;
    };
    EXPECT_EQ(boundary("0"), BoundaryInterpolation::none);
    EXPECT_EQ(boundary("2"), BoundaryInterpolation::edge_only);
    EXPECT_EQ(parse_obj(with_square("f 1 2 3"), "m.obj").boundary, BoundaryInterpolation::edge_only);
}

TEST(ObjReader, MistakesNameLineAndCause) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"v 0 0\n", "m.obj:1: z of v is missing"},
        {"v 0 0 x\n", "m.obj:1: z of v is 'x', not a number"},
        {"v 0 0 1,5\n", "not a number"},
        {"v 0 +-1 0\n", "not a number"},
        {"v nan 0 0\n", "m.obj:1: x of v is 'nan', not a finite number"},
        {"v 0 -inf 0\n", "not a finite number"},
        {"v 0 0 1e400\n", "not a finite number"},
        {"v 0 0 0 red\n", "weight or colour of v is 'red'"},
        {"vt 1e300 0\n", "single precision"},
        {with_square("f 1 2\n"), "m.obj:5: face with 2 corners; a face needs 3 or more"},
        {with_square("f\n"), "face with 0 corners"},
        {with_square("f 1 2 0\n"), "index 0; OBJ counts from 1"},
        {with_square("f 1 2 3\nf 1 2 5\n\n"), "m.obj:6: face names point 5, but the file has 4 v lines"},
        {with_square("f 1 2 -5\n"), "m.obj:5: point index -5, but only 4 come before"},
        {with_square("f 1 2 3000000000\n"), "too large"},
        {with_square("f 1 2 99999999999999999999\n"), "out of range"},
        {with_square("f 1 2 2147483647\n"), "face names point 2147483647"},
        {with_square("f 1 2 x\n"), "point is 'x'"},
        {with_square("f 1 2 3/x\n"), "texture coordinate is 'x'"},
        {with_square("f 1 2 3//x\n"), "normal of f is 'x'"},
        {with_square("f 1 2 3/1/1/1\n"), "normal of f is '1/1'"},
        {with_square("f 1 2 3 1\n"), "m.obj:5: face names point 1 twice in a row"},
        {with_square("v 0 0 1\nv 0 0 2\nv 0 0 3\nv 0 0 4\nv 0 0 5\nf 1 2 3 4 5 5 6 7 8 9\n"),
         "names point 5 twice in a row"},
        {with_square("vt 0 0\nf 1/1 2/1 3/2\n"),
         "m.obj:6: face names texture coordinate 2, but the file has 1 vt line;"},
        {with_square("vt 0 0\nf 1/1 2/1 3\n"), "only some corners"},
        {with_square("f 1 2 3\ncurv 0 1 1 2\n"), "free-form"},
        {with_square("f 1 2 3\nfaces\n"), "m.obj:6: 'faces' is not an OBJ statement"},
        {with_square(""), "m.obj: no faces"},
        {"\n", "m.obj: no faces"},
        {with_square("f 1 2 3\nt\n"), "tag without a name"},
        {with_square("f 1 2 3\nt crease 0 1 2\n"), "lacks its counts"},
        {with_square("f 1 2 3\nt crease -2/1/0 0 1 2\n"), "negative count"},
        {with_square("f 1 2 3\nt crease 2/1/0 0 1\n"), "a number of the tag is missing"},
        {with_square("f 1 2 3\nt crease 2/1/0 0 1 2 3\n"), "more values than its counts say"},
        {with_square("f 1 2 3\nt crease 2/1/0 0 0 2\n"), "write t crease 2/1/0 v0 v1 sharpness"},
        {with_square("f 1 2 3\nt crease 2/1/0 0 4 2\n"),
         "m.obj:6: tag names point 4, but they go from 0 to 3"},
        {with_square("f 1 2 3\nt crease 2/1/0 -1 1 2\n"), "-1 is out of range"},
        {with_square("f 1 2 3\nt crease 2/1/0 0 1 -2\n"), "negative"},
        {with_square("f 1 2 3\nt corner 1/1/0 9 2\n"), "tag names point 9"},
        {with_square("f 1 2 3\nt hole 1/0/0 1\n"), "tag names face 1, but they go from 0 to 0"},
        {with_square("f 1 2 3\nt interpolateboundary 1/0/0 3\n"), "0 none, 1 edge and corner, 2 edge only"},
        {with_square("f 1 2 3\nt facevaryinginterpolateboundary 1/0/0 6\n"), "write t facevarying"},
        {with_square("f 1 2 3\nt creasemethod 0/0/1 soft\n"), "normal or chaikin"},
        {with_square("f 1 2 3\nt smoothtriangles 0/0/1 soft\n"), "catmark or smooth"},
        {with_square("f 1 2 3\nt creas 2/1/0 0 1 2\n"),
         "m.obj:6: unknown tag 'creas'; known: crease, corner"},
        {with_square("f 1 2 3\nt hole 999999999999/0/0 1\n"), "a whole number of the tag is missing"},
        {std::string("\x7f"
                     "ELF\0\x1b\xff",
                     7),
         "m.obj:1: '\\x7fELF\\x00\\x1b\\xff' is not an OBJ statement"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string message = message_of(text);
        EXPECT_NE(message.find(expected), std::string::npos)
            << text << "\n says: '" << message << "'\n not: " << expected;
        EXPECT_TRUE(message.starts_with("m.obj:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(ObjReader, RefusesWhatIsNoFile) {
    const auto read_message = [](const std::filesystem::path& path) {
        try {
            read_obj(path);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "razor_obj_reader_test";
    std::filesystem::create_directories(folder);
    EXPECT_NE(read_message(folder).find("is a directory"), std::string::npos);
    EXPECT_NE(read_message(folder / "none.obj").find("no such file"), std::string::npos);
    EXPECT_NE(read_message("").find("empty"), std::string::npos);
    std::ofstream(folder / "void.obj").close();
    EXPECT_NE(read_message(folder / "void.obj").find("is empty"), std::string::npos);
    std::filesystem::remove_all(folder);
}

/// One row of the tables in the shared folder's README.
struct Listed {
    std::size_t points = 0, faces = 0, texcoords = 0;
    int triangles = 0, quads = 0, polygons = 0, largest = 0;
    std::map<std::string, int> tags;
};

std::map<std::string, Listed> listed_files() {
    std::map<std::string, Listed> files;
    std::ifstream readme(std::string(RAZOR_SHARED_SCENES) + "/README.md");
    static const std::regex row(
        R"(\| (\S+\.obj) \| (\d+) \| (\d+) \| \S+ \| (\d+)/(\d+)/(\d+) \((\d+)\) \| \S+ \| \d+ \| \d+ \| \d+ \| \d+ )"
        R"(\| (-|\d+)[^|]*\| \d+ \| ([^|]*) \| \d+ \|)");
    for (std::string line; std::getline(readme, line);) {
        std::smatch m;
        if (!std::regex_match(line, m, row)) {
            continue;
        }
        Listed file{std::stoul(m[2]),
                    std::stoul(m[3]),
                    m[8] == "-" ? 0 : std::stoul(m[8]),
                    std::stoi(m[4]),
                    std::stoi(m[5]),
                    std::stoi(m[6]),
                    std::stoi(m[7]),
                    {}};
        std::istringstream tags(m[9]);
        for (std::string tag; tags >> tag;) {
            if (const std::size_t colon = tag.find(':'); colon != std::string::npos) {
                file.tags[tag.substr(0, colon)] = std::stoi(tag.substr(colon + 1));
            }
        }
        files[m[1]] = file;
    }
    return files;
}

TEST(ObjReader, EverySharedFileHasItsPublishedCounts) {
    const auto files = listed_files();
    if (files.empty()) {
        GTEST_SKIP() << "no shared scenes in " RAZOR_SHARED_SCENES;
    }
    EXPECT_GE(files.size(), 90U);
    // What cannot be a cage, and why. The rest loads.
    const std::map<std::string, std::string> refused{
        {"odd/empty.obj", ": no faces; a model needs at least one f line"},
        {"osd/catmark_nonman_quadpole360.obj",
         ":724: face names point 5 twice in a row; name each corner once"},
        {"osd/catmark_nonman_quadpole8.obj", ":20: face names point 5 twice in a row; name each corner once"},
        {"odd/notenoughindices.obj", ":9: face with 2 corners; a face needs 3 or more"},
    };
    for (const auto& [name, listed] : files) {
        const std::string path = std::string(RAZOR_SHARED_SCENES) + "/" + name;
        Mesh mesh;
        try {
            mesh = read_obj(path);
        } catch (const UserError& error) {
            const auto expected = refused.find(name);
            EXPECT_TRUE(expected != refused.end()) << error.what();
            if (expected != refused.end()) {
                EXPECT_EQ(error.what(), path + expected->second);
            }
            continue;
        }
        EXPECT_FALSE(refused.contains(name)) << name << " should have been refused";
        EXPECT_EQ(mesh.points.size(), listed.points) << name;
        EXPECT_EQ(mesh.face_sizes.size(), listed.faces) << name;
        EXPECT_EQ(mesh.texcoords.size(), listed.texcoords) << name;
        int triangles = 0, quads = 0, polygons = 0, largest = 0;
        std::size_t corners = 0;
        for (const int size : mesh.face_sizes) {
            ++(size == 3 ? triangles : size == 4 ? quads : polygons);
            largest = std::max(largest, size);
            corners += static_cast<std::size_t>(size);
        }
        EXPECT_EQ(triangles, listed.triangles) << name;
        EXPECT_EQ(quads, listed.quads) << name;
        EXPECT_EQ(polygons, listed.polygons) << name;
        EXPECT_EQ(largest, listed.largest) << name;
        EXPECT_EQ(mesh.face_vertices.size(), corners) << name;
        const auto tags = [&counts = listed.tags](const char* tag) {
            return counts.contains(tag) ? counts.at(tag) : 0;
        };
        EXPECT_EQ(mesh.creases.size(), static_cast<std::size_t>(tags("crease"))) << name;
        EXPECT_EQ(mesh.corners.size(), static_cast<std::size_t>(tags("corner"))) << name;
        EXPECT_EQ(mesh.holes.size(), static_cast<std::size_t>(tags("hole"))) << name;
    }
}

} // namespace
} // namespace razor
