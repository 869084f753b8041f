// The MD3 reader: every number of a small model, joined points, turned faces.
#include "razor/scene/models/md3_reader.h"

#include "razor/scene/error.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/sound_md3.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace razor {
namespace {

std::string small_file() {
    return write_md3(two_surfaces(), 2);
}

TEST(Md3Reader, ReadsEveryNumber) {
    const Md3Model model = parse_md3(small_file(), "models/imp.md3");
    EXPECT_EQ(model.cage.name, "imp");
    EXPECT_EQ(model.cage.scheme, Scheme::catmull_clark);
    ASSERT_EQ(model.frames.size(), 2U);
    EXPECT_EQ(model.cage.points, model.frames[0]);
    EXPECT_EQ(model.frames[0],
              (std::vector<glm::dvec3>{
                  {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 0}, {-512, 511.984375, -0.015625}}));
    EXPECT_EQ(model.frames[1], (std::vector<glm::dvec3>{{0, 0, 0.015625},
                                                        {1, 0, 0.03125},
                                                        {1, 1, 0.046875},
                                                        {0, 1, 0.0625},
                                                        {0, 1, 0.078125},
                                                        {2, 4, -8}}));
    EXPECT_EQ(model.cage.face_sizes, (std::vector<int>{3, 3, 3, 3}));
    EXPECT_EQ(model.cage.face_vertices, (std::vector<int>{0, 1, 2, 0, 2, 3, 1, 5, 2, 1, 4, 5}));
    EXPECT_EQ(model.cage.texcoords,
              (std::vector<glm::vec2>{
                  {0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5F, 0.25F}, {0.125F, 0}, {0, 1}, {-2, 0.5F}}));
    EXPECT_EQ(model.cage.face_texcoords, (std::vector<int>{0, 1, 2, 4, 2, 3, 5, 7, 2, 5, 6, 7}));
    EXPECT_EQ(model.face_surfaces, (std::vector<int>{0, 0, 1, 1}));
    EXPECT_TRUE(sound(model));
}

TEST(Md3Reader, ReadsShaders) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    const std::string full(64, 's'); // no zero byte ends it
    surfaces[0].shaders = {full, "", "b"};
    surfaces[1].shaders.clear();
    const Md3Model model = parse_md3(write_md3(surfaces, 2), "m.md3");
    ASSERT_EQ(model.surfaces.size(), 2U);
    EXPECT_EQ(model.surfaces[0].name, "left");
    EXPECT_EQ(model.surfaces[0].shaders, surfaces[0].shaders);
    EXPECT_EQ(model.surfaces[1].name, "right");
    EXPECT_TRUE(model.surfaces[1].shaders.empty());
}

TEST(Md3Reader, ReadsTags) {
    const std::string full(64, 'n'); // no zero byte ends it
    const std::string bytes = write_md3(
        two_surfaces(), 2,
        {{"tag_a", {{{1, 2, 3}}, {{-4, 5, 0.5F}, {0, 1, 0, -1, 0, 0, 0, 0, 1}}}}, {full, {{{7, 7, 7}}, {}}}});
    const Md3Model model = parse_md3(bytes, "m.md3");
    ASSERT_EQ(model.tags.size(), 2U);
    EXPECT_EQ(model.tags[0].name, "tag_a");
    EXPECT_EQ(model.tags[0].frames,
              (std::vector<Affine>{{glm::dmat3(1), {1, 2, 3}},
                                   {glm::dmat3({0, 1, 0}, {-1, 0, 0}, {0, 0, 1}), {-4, 5, 0.5}}}));
    EXPECT_EQ(model.tags[1].name, full);
    EXPECT_EQ(model.tags[1].frames, (std::vector<Affine>{{glm::dmat3(1), {7, 7, 7}}, {}}));
    EXPECT_EQ(model.cage.points, parse_md3(small_file(), "m.md3").cage.points);
    EXPECT_EQ(parse_md3(small_file(), "m.md3").tags.size(), 1U);
}

TEST(Md3Reader, FacesTurnCounterClockwise) {
    const Md3Model model = parse_md3(small_file(), "m.md3");
    for (const std::size_t face : {0U, 1U}) { // the quad, in the format clockwise seen from z above
        const auto point = [&](std::size_t i) {
            return model.cage.points[static_cast<std::size_t>(model.cage.face_vertices[3 * face + i])];
        };
        EXPECT_EQ(glm::cross(point(1) - point(0), point(2) - point(0)), glm::dvec3(0, 0, 1));
    }
}

/// A box whose sides share no vertex, as exporters write hard edges.
TEST(Md3Reader, JoinsSplitPointsToAClosedCage) {
    const std::array<int, 3> extents{100, 200, 300};
    Md3SurfaceData box{"box", {}, {}, {{}, {}, {}}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
            const int first = static_cast<int>(box.texcoords.size());
            for (const auto& [s, t] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                box.texcoords.push_back({static_cast<float>(s), static_cast<float>(t)});
                for (std::size_t f = 0; f < 3; ++f) {
                    std::array<int, 3> p{};
                    p[axis] = side;
                    p[(axis + 1) % 3] = s;
                    p[(axis + 2) % 3] = t;
                    for (std::size_t i = 0; i < 3; ++i) {
                        p[i] *= extents[i] + static_cast<int>(f);
                    }
                    box.frame_steps[f].push_back(p);
                }
            }
            const int second = first + (side == 0 ? 1 : 3), last = first + (side == 0 ? 3 : 1);
            box.triangles.push_back({first, second, first + 2});
            box.triangles.push_back({first, first + 2, last});
        }
    }
    ASSERT_EQ(box.texcoords.size(), 24U);
    const Md3Model model = parse_md3(write_md3({box}, 3), "box.md3");
    EXPECT_TRUE(sound(model));
    EXPECT_EQ(model.frames.size(), 3U);
    EXPECT_EQ(model.cage.points.size(), 8U);
    EXPECT_EQ(model.cage.texcoords.size(), 20U); // at two corners all three sides agree
    ASSERT_EQ(model.cage.face_sizes.size(), 12U);
    std::set<std::pair<int, int>> edges; // each once in each direction: closed and of one orientation
    double six_volumes = 0;              // positive if faces are counter-clockwise seen from outside
    for (std::size_t c = 0; c < 36; c += 3) {
        const int* const face = &model.cage.face_vertices[c];
        for (std::size_t i = 0; i < 3; ++i) {
            edges.emplace(face[i], face[(i + 1) % 3]);
        }
        const auto point = [&](std::size_t i) {
            return model.cage.points[static_cast<std::size_t>(face[i])];
        };
        six_volumes += glm::dot(point(0), glm::cross(point(1), point(2)));
    }
    EXPECT_EQ(edges.size(), 36U);
    for (const auto& [from, to] : edges) {
        EXPECT_TRUE(edges.contains({to, from}));
    }
    EXPECT_EQ(six_volumes, 6 * 100 * 200 * 300 / 262144.0);
}

TEST(Md3Reader, PointsThatPartInOneFrameStayApart) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    surfaces[0].frame_steps[1][5][1] += 1; // 5 no longer goes with 2
    const Md3Model model = parse_md3(write_md3(surfaces, 2), "m.md3");
    EXPECT_EQ(model.cage.points.size(), 7U);
    EXPECT_EQ(model.cage.face_vertices, (std::vector<int>{0, 1, 2, 0, 4, 3, 1, 6, 2, 1, 5, 6}));
    EXPECT_EQ(model.frames[0][2], model.frames[0][4]);
    EXPECT_EQ(model.frames[1][4], glm::dvec3(1, 1.015625, 0.046875));
}

TEST(Md3Reader, TakesSurfacesWithoutTrianglesAndTrailingBytes) {
    std::vector<Md3SurfaceData> surfaces = two_surfaces();
    const Md3Model expected = parse_md3(write_md3(surfaces, 2), "m.md3");
    surfaces.insert(surfaces.begin() + 1, Md3SurfaceData{"tag_only", {}, {}, {{}, {}}});
    const Md3Model model = parse_md3(write_md3(surfaces, 2) + "trailing", "m.md3");
    EXPECT_EQ(model.frames, expected.frames);
    EXPECT_EQ(model.cage.face_vertices, expected.cage.face_vertices);
}

TEST(Md3Reader, ReadsWhereverTheBytesLie) {
    std::string shifted(1, 'x');
    shifted += small_file();
    EXPECT_EQ(parse_md3(std::string_view(shifted).substr(1), "m.md3").frames,
              parse_md3(small_file(), "m.md3").frames);
}

TEST(Md3Reader, ReadsFiles) {
    const TemporaryFolder folder;
    const Md3Model model = read_md3(folder.file("imp_1.md3", small_file()));
    EXPECT_EQ(model.cage.name, "imp_1");
    EXPECT_EQ(model.frames, parse_md3(small_file(), "m.md3").frames);
    const auto message = [](const std::filesystem::path& path) {
        try {
            read_md3(path);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message(folder / "none.md3"),
              (folder / "none.md3").string() + ": no such file; check the path");
    EXPECT_EQ(message(folder.file("empty.md3", "")),
              (folder / "empty.md3").string() + ": is empty; give an MD3 model");
}

} // namespace
} // namespace razor
