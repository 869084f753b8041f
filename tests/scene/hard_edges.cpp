// Edges on whose two sides a file's normals differ become creases.
#include "razor/scene/models/hard_edges.h"
#include "razor/scene/error.h"
#include "razor/scene/models/gltf_reader.h"
#include "razor/scene/models/md3_reader.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/temporary_folder.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace razor {
namespace {

using glm::dvec3;

/// A prism about z with a lid of triangles at both ends, as exporters write it: corners have the normals of
/// their flat side, or of a round surface through all sides; those of lids are apart in any case. Nothing is
/// shared between faces.
struct Prism {
    int sides;
    std::vector<dvec3> points, normals;
    std::vector<int> triangles;

    Prism(int count, bool round) : sides(count) {
        const auto about = [&](double side) {
            const double angle = glm::radians(360 * side / sides);
            return dvec3(std::cos(angle), std::sin(angle), 0);
        };
        const auto corner = [&](int side, double z) { return about(side % sides) + dvec3(0, 0, z); };
        for (int s = 0; s < sides; ++s) {
            const auto normal = [&](int side) { return about(round ? side % sides : s + 0.5); };
            add({corner(s, 0), corner(s + 1, 0), corner(s + 1, 1), corner(s, 1)},
                {normal(s), normal(s + 1), normal(s + 1), normal(s)});
            add({dvec3(0, 0, 1), corner(s, 1), corner(s + 1, 1)}, std::vector<dvec3>(3, dvec3(0, 0, 1)));
            add({dvec3(0, 0, 0), corner(s + 1, 0), corner(s, 0)}, std::vector<dvec3>(3, dvec3(0, 0, -1)));
        }
    }
    void add(const std::vector<dvec3>& face, const std::vector<dvec3>& of_corners) {
        const int v = static_cast<int>(points.size());
        points.insert(points.end(), face.begin(), face.end());
        normals.insert(normals.end(), of_corners.begin(), of_corners.end());
        for (int k = 2; k < static_cast<int>(face.size()); ++k)
            triangles.insert(triangles.end(), {v, v + k - 1, v + k});
    }
};

GltfWriter gltf_of(const Prism& p, bool with_normals = true) {
    GltfWriter w;
    const auto numbers = [](const std::vector<dvec3>& list) {
        std::vector<float> all;
        for (const dvec3& v : list)
            for (int axis = 0; axis < 3; ++axis)
                all.push_back(static_cast<float>(v[axis]));
        return all;
    };
    GltfWriter::Json attributes{{"POSITION", w.floats(numbers(p.points), 3)}};
    if (with_normals)
        attributes["NORMAL"] = w.floats(numbers(p.normals), 3);
    const int indices = w.accessor(std::vector<std::uint32_t>(p.triangles.begin(), p.triangles.end()), 1);
    w.add("meshes", {{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}});
    w.add("nodes", {{"mesh", 0}});
    return w;
}

std::string md3_of(const Prism& p) {
    Md3SurfaceData data{"prism", {}, {}, {{}}};
    for (std::size_t c = 0; c < p.triangles.size(); c += 3)
        data.triangles.push_back({p.triangles[c], p.triangles[c + 2], p.triangles[c + 1]}); // clockwise
    const auto steps_a_turn = [](double angle) {
        const double steps = angle / (2 * 3.14159265358979) * 255;
        return static_cast<int>(std::lround(steps < 0 ? steps + 255 : steps)) & 255;
    };
    for (std::size_t v = 0; v < p.points.size(); ++v) {
        const dvec3 at = p.points[v], n = p.normals[v];
        data.texcoords.push_back({0, 0});
        data.frame_steps[0].push_back({static_cast<int>(std::lround(64 * at.x)),
                                       static_cast<int>(std::lround(64 * at.y)),
                                       static_cast<int>(std::lround(64 * at.z))});
        data.normals.push_back(steps_a_turn(std::acos(n.z)) | steps_a_turn(std::atan2(n.y, n.x)) << 8);
    }
    return write_md3({data}, 1);
}

/// How many creases run along z, and how many about lids; all others, and what is not sharp, are mistakes.
std::pair<int, int> sides_and_lids(const Mesh& cage, int sides) {
    EXPECT_EQ(cage.points.size(), static_cast<std::size_t>(2 * sides + 2)) << "joined";
    std::pair<int, int> count{0, 0};
    std::set<std::pair<int, int>> seen;
    for (const Crease& c : cage.creases) {
        EXPECT_EQ(c.sharpness, infinite_sharpness);
        EXPECT_TRUE(seen.emplace(std::minmax(c.v0, c.v1)).second) << "twice";
        const dvec3 a = cage.points[static_cast<std::size_t>(c.v0)],
                    b = cage.points[static_cast<std::size_t>(c.v1)], along = b - a;
        const bool on_rim = glm::length(a) > 0.9 && glm::length(b) > 0.9;
        EXPECT_TRUE(on_rim) << "within a lid";
        EXPECT_TRUE(along.z == 0 || (along.x == 0 && along.y == 0)) << "across a side";
        ++(along.z == 0 ? count.second : count.first);
    }
    return count;
}

TEST(HardEdges, AreWhereNormalsOfTheFileDiffer) {
    const TemporaryFolder folder;
    using Count = std::pair<int, int>;
    for (const int sides : {5, 8, 40})
        for (const bool round : {false, true}) {
            const Prism prism(sides, round);
            const auto file = folder.file("m.glb", gltf_of(prism).glb());
            const std::string md3 = md3_of(prism);
            const double between = 360.0 / sides; // normals of two flat sides
            for (const double angle : {between - 4, between + 4, 86.0, 94.0, 180.0}) {
                const Count expected{!round && between > angle ? sides : 0, angle < 90 ? 2 * sides : 0};
                EXPECT_EQ(sides_and_lids(*read_gltf(file, "", 0, nullptr, {}, angle).cage, sides), expected)
                    << sides << " sides, round " << round << ", " << angle << " degrees";
                EXPECT_EQ(sides_and_lids(parse_md3(md3, "m.md3", angle).cage, sides), expected)
                    << "MD3, " << sides << " sides, round " << round << ", " << angle << " degrees";
            }
            EXPECT_TRUE(read_gltf(file, "", 0).cage->creases.empty()) << "unless asked for";
        }
    const auto bare = folder.file("bare.glb", gltf_of(Prism(5, false), false).glb());
    EXPECT_TRUE(read_gltf(bare, "", 0, nullptr, {}, 30).cage->creases.empty()) << "no normals";
}

/// Two faces beside each other whose normals agree at one end of their edge.
TEST(HardEdges, EndWhereNormalsMeet) {
    const std::vector<int> triangles{0, 1, 2, 1, 0, 3};
    const glm::vec3 up(0, 0, 2), side(0, 0.5F, 0), none(0);
    const std::vector<Crease> crease{{0, 1, infinite_sharpness}};
    EXPECT_EQ(hard_edges(triangles, {up, up, up, up, side, up}, 60), crease);
    EXPECT_EQ(hard_edges(triangles, {up, up, up, side, up, up}, 60), crease);
    EXPECT_TRUE(hard_edges(triangles, {up, up, side, up, up, side}, 60).empty()) << "ends elsewhere";
    EXPECT_TRUE(hard_edges(triangles, {none, up, up, up, side, up}, 60).empty()) << "no normal";
    EXPECT_TRUE(hard_edges(triangles, {}, 60).empty());
}

TEST(HardEdges, OfScenesStayWhileTheModelMoves) {
    const TemporaryFolder folder;
    GltfWriter w = gltf_of(Prism(6, false));
    w.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 2, 3}, 3);
    folder.file("m.glb", w.glb());
    const auto parsed = [&](const std::string& lines) {
        return parse_scene_file("[[mesh]]\nfile = \"m.glb\"\n" + lines, "s.toml", folder.path());
    };
    EXPECT_TRUE(parsed("").meshes[0].cage->creases.empty());
    const SceneDescription scene = parsed("crease_angle = 50\n"),
                           again = parse_scene_file(to_toml(scene), "s", folder.path());
    for (const SceneDescription* s : {&scene, &again}) {
        EXPECT_EQ(s->meshes[0].crease_angle, 50);
        ASSERT_TRUE(s->meshes[0].motion);
        EXPECT_EQ(sides_and_lids(*s->meshes[0].motion->at(0.5), 6), std::pair(6, 12));
        EXPECT_EQ(build_scene(*s).meshes[0].creases.size(), 18U);
    }
    // Both of one file: each as it states.
    const SceneDescription both =
        parsed("name = \"a\"\n[[mesh]]\nname = \"b\"\nfile = \"m.glb\"\ncrease_angle = 70\n");
    EXPECT_TRUE(both.meshes[0].cage->creases.empty());
    EXPECT_EQ(both.meshes[1].cage->creases.size(), 12U);
    const auto wrong = [&](const std::string& text) {
        try {
            parse_scene_file(text, "s.toml", folder.path());
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(wrong("[[mesh]]\nshape = \"box\"\ncrease_angle = 30\n"),
              "s.toml:3:16: only MD3 and glTF models have normals instead of creases; leave it out");
    EXPECT_NE(wrong("[[mesh]]\nfile = \"m.glb\"\ncrease_angle = 181\n").find("180"), std::string::npos);
}

} // namespace
} // namespace razor
