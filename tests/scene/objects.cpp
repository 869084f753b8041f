// Objects, groups and tables of instances in scene files: every key, every kind of mistake, and what is
// printed loads again.
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>

namespace razor {
namespace {

constexpr std::string_view triangle = "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";

SceneDescription parse(std::string_view text, const std::filesystem::path& folder = {}) {
    return parse_scene_file(text, "s.toml", folder);
}

FlatGraph flattened(const SceneDescription& description) {
    return flatten(build_graph(description), mesh_bounds(description));
}

/// Where an instance puts a point.
glm::dvec3 put(const FlatGraph& flat, std::size_t instance, const glm::dvec3& p) {
    return flat.nodes[static_cast<std::size_t>(flat.instances[instance].node)].world(p);
}

void expect_same_flat(const FlatGraph& a, const FlatGraph& b) {
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (std::size_t i = 0; i < a.instances.size(); ++i) {
        EXPECT_EQ(a.instances[i].mesh, b.instances[i].mesh);
        EXPECT_EQ(a.instances[i].material, b.instances[i].material);
        EXPECT_EQ(a.instances[i].level_offset, b.instances[i].level_offset);
        EXPECT_EQ(a.instances[i].rate, b.instances[i].rate);
        EXPECT_EQ(a.nodes[static_cast<std::size_t>(a.instances[i].node)].world,
                  b.nodes[static_cast<std::size_t>(b.instances[i].node)].world);
    }
}

constexpr std::string_view every_key = R"(
    [[material]]
    name = "grey"
    [[material]]
    name = "red"
    [[mesh]]
    name = "alone"
    shape = "box"
    [[mesh]]
    name = "tri"
    file = "tri.obj"
    scale = 2
    [[group]]
    name = "outer"
    [[group.object]]
    group = "inner"
    scale = 0.25
    level_offset = 2
    rate = 0.5
    material = "red"
    [[group]]
    name = "inner"
    [[group.object]]
    name = "a"
    mesh = "tri"
    scale = [1, -2, 3]
    rotate = [0, 90, 0]
    translate = [10, 20, 30]
    level_offset = -1
    rate = 3
    [[group.object]]
    mesh = "tri"
    material = "grey"
    matrix = [[1, 0.5, 0, 7], [0, 2, 0, 8], [0, 0, 3, 9]]
    [[object]]
    name = "field"
    group = "outer"
    array = [2, 1, 3]
    spacing = [100, 0, 1000]
    translate = [1, 2, 3])";

TEST(Objects, ReadEveryKey) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    const SceneDescription description = parse(every_key, folder.path());
    const Scene scene = build_scene(description);
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(scene.meshes[1].points[0], glm::dvec3(2, 0, 0)) << "a mesh's own scale comes first";
    const FlatGraph flat = flattened(description);
    ASSERT_EQ(flat.instances.size(), 13U);
    EXPECT_EQ(flat.instances[0].mesh, 0) << "placed by no object: where it stands";
    EXPECT_EQ(put(flat, 0, {1, 2, 3}), glm::dvec3(1, 2, 3));
    for (std::size_t copy = 0; copy < 6; ++copy) {
        const glm::dvec3 at = glm::dvec3(1, 2, 3) + glm::dvec3(100 * (copy % 2), 0, 1000 * (copy / 2));
        const std::size_t a = 1 + 2 * copy;
        // Scaled to (1, -4, 9), about y: (x, y, z) -> (z, y, -x), moved, then a quarter of it.
        EXPECT_EQ(put(flat, a, {1, 2, 3}), at + 0.25 * glm::dvec3(9 + 10, -4 + 20, -1 + 30));
        EXPECT_EQ(put(flat, a + 1, {1, 2, 3}), at + 0.25 * glm::dvec3(2 + 7, 4 + 8, 9 + 9));
        EXPECT_EQ(flat.instances[a].mesh, 1);
        EXPECT_EQ(flat.instances[a].material, 1) << "as stated above";
        EXPECT_EQ(flat.instances[a + 1].material, 0) << "its own";
        EXPECT_EQ(flat.instances[a].level_offset, 2 - 1 + 0) << "largest scale 3/4, near 1";
        EXPECT_EQ(flat.instances[a].rate, 1.5);
        EXPECT_EQ(flat.instances[a + 1].rate, 0.5);
    }
    EXPECT_EQ(path_of(flat, scene.graph, flat.instances[1].node), "field/inner/a");
}

TEST(Objects, PrintedConfigurationLoadsAgain) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    folder.file("t.instances", "tri.obj 1 2 90\n");
    for (const std::string& text :
         {std::string(every_key),
          std::string(every_key) + "\n[[object]]\ninstances = \"t.instances\"\nrate = 2\n",
          std::string(
              "[[object]]\ninstances = \"t.instances\"\nscheme = \"bilinear\"\narray = [3, 1, 1]\nspacing = "
              "[2, 0, 0]\n")}) {
        const SceneDescription description = parse(text, folder.path());
        const std::string printed = to_toml(description);
        const SceneDescription again = parse_scene_file(printed, "elsewhere/s.toml", "/nowhere");
        expect_same(build_scene(description), build_scene(again));
        expect_same_flat(flattened(description), flattened(again));
        EXPECT_EQ(to_toml(again), printed);
    }
}

TEST(Objects, ReadNoFileTwice) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    folder.file("t.instances", "tri.obj 1 2 90\n./tri.obj 3 4 0\n");
    const SceneDescription scene = parse(
        "[[mesh]]\nname = \"a\"\nfile = \"tri.obj\"\n[[mesh]]\nname = \"b\"\nfile = \"./tri.obj\"\nscheme = "
        "\"bilinear\"\n[[object]]\ninstances = \"t.instances\"\n[[object]]\ninstances = \"t.instances\"\n",
        folder.path());
    ASSERT_EQ(scene.meshes.size(), 2U) << "the table places the first mesh of its file";
    EXPECT_EQ(scene.meshes[0].cage, scene.meshes[1].cage);
    EXPECT_EQ(scene.objects[0].table, scene.objects[1].table);
    EXPECT_EQ(build_graph(scene).groups.size(), 2U) << "one group of rows for both objects";
    const FlatGraph flat = flattened(scene);
    ASSERT_EQ(flat.instances.size(), 5U);
    EXPECT_EQ(flat.instances[0].mesh, 1) << "nothing places the second";
    EXPECT_EQ(flat.instances[1].mesh, 0);
}

TEST(Objects, OfOneFileHaveOneScheme) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    folder.file("t.instances", "tri.obj 1 2 90\n");
    const std::string smooth = "[[object]]\ninstances = \"t.instances\"\n",
                      faces = smooth + "scheme = \"bilinear\"\n", mesh = "[[mesh]]\nfile = \"tri.obj\"\n";
    for (const std::string& text : {smooth + smooth, faces + faces, faces + smooth, mesh + smooth,
                                    mesh + "scheme = \"bilinear\"\n" + faces}) {
        EXPECT_EQ(parse(text, folder.path()).meshes.size(), 1U) << text;
    }
    for (const auto& [text, place] :
         {std::pair(smooth + faces, "s.toml:5:10: "), std::pair(mesh + faces, "s.toml:5:10: ")}) {
        std::string message;
        try {
            parse(text, folder.path());
        } catch (const UserError& error) {
            message = error.what();
        }
        EXPECT_TRUE(message.starts_with(place)) << message;
        EXPECT_NE(message.find("tri.obj is there already, as a mesh with scheme = \"catmark\""),
                  std::string::npos)
            << message;
    }
}

TEST(Objects, StaySmallFarAway) {
    const std::string text =
        "[[mesh]]\nname = \"b\"\nshape = \"box\"\n[[group]]\nname = \"g\"\n[[group.object]]\nmesh = "
        "\"b\"\nscale = 1e-12\n[[object]]\ngroup = \"g\"\ntranslate = [0.5, 0, 0]\n[[object]]\n"
        "group = \"g\"\nscale = 1e24\n";
    const FlatGraph flat = flattened(parse(text));
    ASSERT_EQ(flat.instances.size(), 2U);
    EXPECT_NEAR(put(flat, 0, {1, 1, 1}).y, 1e-12, 1e-27);
    EXPECT_NEAR(put(flat, 1, {1, 1, 1}).x, 1e12, 1e-3);
    EXPECT_EQ(flat.instances[0].level_offset, 40);
    EXPECT_EQ(flat.instances[1].level_offset, -40);
}

TEST(InstanceTable, ReadsEveryForm) {
    const InstanceTable table = parse_instance_table("# head\n\na.obj 1 2 90\r\n"
                                                     "b.obj 1 2 3 0 # tail\n"
                                                     "sub/../a.obj 1 2 3 180 0.5\n"
                                                     "a.obj 1 2 3 4 5 6 7 8 9 10 12 13\n",
                                                     "t", "/x");
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.files, (std::vector<std::string>{"/x/a.obj", "/x/b.obj"}));
    EXPECT_EQ(table.rows[0].file, 0);
    EXPECT_EQ(table.rows[0].line, 3);
    EXPECT_EQ(to_affine(table.rows[0].transform)({1, 5, 0}), glm::dvec3(1, 5, 3)) << "x turns towards z";
    EXPECT_EQ(to_affine(table.rows[1].transform)({1, 1, 1}), glm::dvec3(2, 3, 4));
    EXPECT_EQ(table.rows[1].file, 1);
    EXPECT_EQ(to_affine(table.rows[2].transform)({1, 1, 1}), glm::dvec3(0.5, 2.5, 2.5));
    EXPECT_EQ(table.rows[2].file, 0);
    EXPECT_EQ(to_affine(table.rows[3].transform)({1, 1, 1}),
              glm::dvec3(1 + 2 + 3 + 4, 5 + 6 + 7 + 8, 9 + 10 + 12 + 13));
}

TEST(InstanceTable, MistakesNameLineCauseAndMend) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"# nothing\n", "t: no instances; write at least one line"},
        {"a.obj\n", "t:1: 0 numbers after the file name; write `x z turn`"},
        {"a.obj 1 2 3\na.obj 1 2\n", "t:2: 2 numbers after the file name"},
        {"a.obj 1 2 3 4 5 6\n", "t:1: 6 numbers"},
        {"a.obj 1 2 3 4 5 6 7 8 9 10 11 12 13 14\n", "t:1: more than 12 numbers"},
        {"a.obj 1 2 x\n", "t:1: a number of the instance is 'x', not a number"},
        {"a.obj 1 2 nan\n", "not a finite number"},
        {"a.obj 1e31 2 3\n", "out of range"},
        {"a.obj 1 2 1e7\n", "out of range"},
        {"a.obj 1 2 3 4 0\n", "t:1: 0 is out of range"},
        {"a.obj 1 2 3 4 -1\n", "t:1: -1 is out of range"},
        {"a.obj 1 0 0 0 0 1 0 0 1 1 0 0\n", "t:1: the matrix flattens what it places"},
        {"1 2 3\n", "t:1: '1' is neither an OBJ nor a PLY file"},
        {"a.png 1 2 3\n", "t:1: 'a.png' is neither an OBJ nor a PLY file"},
    };
    for (const auto& [text, expected] : cases) {
        try {
            parse_instance_table(text, "t", "/x");
            ADD_FAILURE() << text;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos)
                << error.what() << "\n not: " << expected;
        }
    }
}

TEST(Objects, MistakesNamePlaceCauseAndMend) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    folder.file("lost.instances", "tri.obj 0 0 0\nlost.obj 0 0 0\n");
    folder.file("bad.instances", "tri.obj 0 0\n");
    folder.file("empty.instances", "");
    const std::string mesh = "[[mesh]]\nname = \"m\"\nshape = \"box\"\n"; // three lines
    const std::string object = mesh + "[[object]]\nmesh = \"m\"\n";       // and two
    const auto group = [](const std::string& name, const std::string& placed) {
        return fmt::format("[[group]]\nname = \"{}\"\n[[group.object]]\n{}\n", name, placed);
    };
    const std::vector<std::pair<std::string, std::string>> cases{
        {mesh + "[[object]]\n",
         "s.toml:4:1: an object needs one of mesh = \"name\", group = \"name\" or instances"},
        {object + "group = \"m\"\n", "s.toml:4:1: an object needs one of"},
        {mesh + "[[object]]\nmesh = \"n\"\n", "s.toml:5:8: object.mesh 'n' is unknown; known: m"},
        {mesh + "[[object]]\nmesh = 3\n", "object.mesh is a whole number; write text in quotes"},
        {mesh + "[[object]]\ngroup = \"n\"\n", "there is no group 'n'; write a [[group]] of that name"},
        {"[[object]]\nmesh = \"n\"\n", "s.toml:2:8: there is no mesh 'n'; write a [[mesh]] of that name"},
        {mesh + mesh + "[[object]]\nmesh = \"m\"\n",
         "2 [[mesh]] are called 'm'; give them names of their own"},
        {object + "scael = 2\n",
         "s.toml:6:1: unknown key 'object.scael'; did you mean 'scale'? Known: name, mesh, group, "},
        {object + "scale = 0\n", "s.toml:6:9: the object's scale flattens it"},
        {object + "scale = [1, 1, 1e-10]\n", "the object's scale flattens it"},
        {object + "scale = 1e31\n", "out of range"},
        {object + "rotate = 90\n", "object.rotate is a whole number; write three numbers"},
        {object + "matrix = 3\n", "object.matrix is a whole number; write three rows of four numbers"},
        {object + "matrix = [1, 2, 3]\n", "a row of object.matrix is a whole number; write three rows"},
        {object + "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1]]\n",
         "a row of object.matrix is an array of 3"},
        {object + "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, \"1\", 0]]\n", "object.matrix is text"},
        {object + "matrix = [[1, 0, 0, 0], [2, 0, 0, 0], [0, 0, 1, 0]]\n",
         "s.toml:6:10: the object's matrix flattens it"},
        {object + "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\nscale = 2\n",
         "s.toml:7:9: a matrix and scale"},
        {object + "array = [2, 1]\n", "object.array is an array of 2; write three whole numbers"},
        {object + "array = [2, 1, 0]\n", "object.array = 0 is out of range"},
        {object + "array = [2, 1, 1.5]\n", "object.array is a number; write a whole number"},
        {object + "array = [2, 1, 1]\n", "s.toml:6:9: an array of 2 along x without spacing there"},
        {object + "spacing = [1, 0, 0]\n", "s.toml:6:11: spacing of one object; write array"},
        {object + "array = [2, 3, 1]\nspacing = [1, 0, 0]\n", "an array of 3 along y without spacing there"},
        {object + "array = [1000000, 1000000, 1]\nspacing = [1, 1, 1]\n",
         "s.toml:4:1: the scene graph has more than 4194304 instances"},
        {object + "level_offset = 33\n", "object.level_offset = 33 is out of range"},
        {object + "level_offset = 0.5\n", "object.level_offset is a number; write a whole number"},
        {object + "rate = 0\n", "object.rate = 0 is out of range"},
        {object + "material = \"red\"\n", "object.material 'red' is unknown; known: default"},
        {object + "scheme = \"bilinear\"\n", "s.toml:6:10: an object of a mesh or group has no scheme"},
        {mesh + "[[object]]\ninstances = \"none.instances\"\n", "none.instances: no such file"},
        {mesh + "[[object]]\ninstances = \"\"\n", "the file name is empty; give a table of instances"},
        {mesh + "[[object]]\ninstances = \".\"\n", "is a directory"},
        {mesh + "[[object]]\ninstances = \"empty.instances\"\n", "empty.instances: is empty"},
        {mesh + "[[object]]\ninstances = \"bad.instances\"\n", "bad.instances:1: 2 numbers"},
        {mesh + "[[object]]\ninstances = \"lost.instances\"\n", "lost.instances:2: "},
        {mesh + "[[object]]\ninstances = \"lost.instances\"\n", "lost.obj: no such file"},
        {mesh + "[[object]]\ninstances = \"tri.obj\"\n", "tri.obj:1: 'v' is neither an OBJ nor a PLY file"},
        {mesh + "[[group]]\n", "s.toml:4:1: a group without a name"},
        {mesh + "[[group]]\nname = \"g\"\n", "the group 'g' is empty; write at least one [[group.object]]"},
        {mesh + group("g", "mesh = \"m\"") + group("g", "mesh = \"m\""),
         "s.toml:9:8: the name 'g' is used twice"},
        {mesh + group("g", "mesh = \"m\"\n[[group]]\nnam = 1"), "a group without a name"},
        {mesh + group("g", "mesh = \"m\"\nsize = 1"), "unknown key 'group.object.size'"},
        {mesh + "[group]\nname = \"g\"\n", "group is a table; write [[group]]"},
        {mesh + "object = 1\n", "object"},
        {mesh + group("g", "group = \"g\""), "s.toml:5:8: groups contain each other ('g' in 'g')"},
        {mesh + group("a", "group = \"b\"") + group("b", "group = \"a\"") + "[[object]]\ngroup = \"a\"\n",
         "s.toml:5:8: groups contain each other ('a' in 'b' in 'a'); remove one"},
        {mesh + group("thin", "mesh = \"m\"\nscale = [1, 1e-5, 1]") +
             "[[object]]\ngroup = \"thin\"\nscale = [1, 1e-5, 1]\n",
         "object 'thin/m' is flattened"},
        {object + "translate = [1e30, 0, 0]\nscale = 1e30\n", "object 'm' reaches beyond 1e+30"},
        {mesh + group("g", "mesh = \"m\""), "s.toml:4:1: the scene graph places no mesh; add an object"},
    };
    for (const auto& [text, expected] : cases) {
        std::string message;
        try {
            parse(text, folder.path());
        } catch (const UserError& error) {
            message = error.what();
        }
        EXPECT_NE(message.find(expected), std::string::npos)
            << text << "\n says: '" << message << "'\n not: " << expected;
        EXPECT_TRUE(message.starts_with("s.toml:")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(Objects, TenThousandInstancesLoadQuickly) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    std::string table;
    for (int i = 0; i < 100; ++i) {
        table += fmt::format("tri.obj {} {} 90\n", i % 10, i / 10);
    }
    folder.file("t.instances", table);
    const auto start = std::chrono::steady_clock::now();
    const SceneDescription scene =
        parse("[[object]]\ninstances = \"t.instances\"\narray = [10, 1, 10]\nspacing = [10, 0, 10]\n",
              folder.path());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const FlatGraph flat = flattened(scene);
    EXPECT_EQ(flat.instances.size(), 10000U);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(put(flat, 9999, {0, 0, 0}), glm::dvec3(99, 0, 99));
    EXPECT_LT(seconds, 2);
}

TEST(Objects, TablesFrameThemselves) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    const std::filesystem::path table = folder.file("t.instances", "tri.obj 100 0 0\ntri.obj 104 0 90\n");
    FramingOptions options;
    options.scheme = Scheme::bilinear;
    const SceneDescription scene = describe(table, options);
    EXPECT_EQ(scene.name, "t");
    EXPECT_NEAR(scene.camera.target.x, 102, 1.01);
    EXPECT_EQ(scene.lights.size(), 1U);
    ASSERT_EQ(scene.meshes.size(), 2U) << "the triangle and a floor";
    EXPECT_EQ(scene.meshes[0].scheme, Scheme::bilinear);
    const FlatGraph flat = flattened(scene);
    ASSERT_EQ(flat.instances.size(), 3U);
    EXPECT_EQ(put(flat, 1, {1, 0, 0}), glm::dvec3(101, 0, 0));
    EXPECT_EQ(put(flat, 2, {1, 0, 0}), glm::dvec3(104, 0, 1));
    options.floor = false;
    options.up = Up::z;
    const SceneDescription turned = describe(table, options);
    EXPECT_EQ(turned.meshes.size(), 1U);
    EXPECT_EQ(put(flattened(turned), 0, {0, 0, 1}), glm::dvec3(100, 1, 0));
    const std::string printed = to_toml(scene);
    EXPECT_EQ(to_toml(parse_scene_file(printed, "s.toml", "/nowhere")), printed);
}

/// Bytes thrown at both readers: a scene, or one line that says why not.
TEST(Objects, DamagedFilesAreReadOrRefused) {
    const TemporaryFolder folder;
    folder.file("tri.obj", triangle);
    folder.file("t.instances", "tri.obj 1 2 90\n");
    const std::string scene = std::string(every_key) + "\n[[object]]\ninstances = \"t.instances\"\n";
    const std::string table = "tri.obj 1 2 90\ntri.obj 1 2 3 0\ntri.obj 1 2 3 180 0.5\n"
                              "tri.obj 1 0 0 4 0 1 0 8 0 0 1 12\n";
    std::mt19937 random(11); // NOLINT(cert-msc32-c,cert-msc51-cpp)
    const auto damaged = [&](std::string text) {
        constexpr std::string_view bytes = "0123456789-.e[]=\"\n #abgmx\0\xff";
        for (std::size_t n = 1 + random() % 4; n > 0; --n) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
            case 0:
                text[at] = bytes[random() % bytes.size()];
                break;
            case 1:
                text.erase(at, 1 + random() % 8);
                break;
            case 2:
                text.insert(at, 1, bytes[random() % bytes.size()]);
                break;
            default:
                text.insert(at, text.substr(random() % text.size(), random() % 40));
            }
        }
        return text;
    };
    const auto try_both = [&](const auto& read) {
        try {
            read();
            return 1;
        } catch (const UserError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
            return 0;
        }
    };
    int read = 0;
    for (int i = 0; i < 4000; ++i) {
        read += try_both([&] {
            const SceneDescription got = parse(damaged(scene), folder.path());
            EXPECT_EQ(to_toml(parse_scene_file(to_toml(got), "s.toml", "/nowhere")), to_toml(got));
        });
        read += try_both([&] { EXPECT_FALSE(parse_instance_table(damaged(table), "t", "/x").rows.empty()); });
    }
    EXPECT_GT(read, 300);
    EXPECT_LT(read, 7500);
}

} // namespace
} // namespace razor
