// Generated cages: closed where they should be, consistently oriented, and with the features they are there
// for.
#include "razor/scene/shapes/shapes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace razor {
namespace {

Mesh preset(std::string_view name) {
    std::vector<std::pair<std::string, double>> parameters;
    for (const ShapeParameter& parameter : find_shape_kind(name)->parameters) {
        parameters.emplace_back(parameter.name, parameter.preset);
    }
    return make_shape(name, parameters);
}

struct Census {
    int open_edges = 0;
    double volume = 0; // signed; positive if faces look outwards
    std::set<int> face_sizes;
    std::map<int, int> valences; // points by number of faces
    double twist = 0;            // largest distance of a quad's corner from the plane of the others
};

Census census_of(const Mesh& mesh) {
    Census census;
    std::map<std::pair<int, int>, int> edges;
    std::vector<int> faces_at(mesh.points.size());
    std::size_t first = 0;
    for (const int size : mesh.face_sizes) {
        const auto count = static_cast<std::size_t>(size);
        std::vector<int> face;
        for (std::size_t i = 0; i < count; ++i) {
            face.push_back(mesh.face_vertices[first + i]);
            ++faces_at[static_cast<std::size_t>(face.back())];
            EXPECT_EQ(++edges[std::make_pair(face.back(), mesh.face_vertices[first + (i + 1) % count])], 1)
                << mesh.name;
        }
        EXPECT_EQ(std::set<int>(face.begin(), face.end()).size(), count);
        const auto at = [&](std::size_t i) { return mesh.points.at(static_cast<std::size_t>(face[i])); };
        for (std::size_t i = 1; i + 1 < count; ++i) {
            census.volume += glm::dot(at(0), glm::cross(at(i), at(i + 1))) / 6;
        }
        if (count == 4) {
            const glm::dvec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
            census.twist = std::max(census.twist, std::abs(glm::dot(normal, at(3) - at(0))));
        }
        census.face_sizes.insert(size);
        first += count;
    }
    EXPECT_EQ(first, mesh.face_vertices.size());
    for (const auto& [edge, uses] : edges) {
        census.open_edges += edges.contains({edge.second, edge.first}) ? 0 : 1;
    }
    for (const int faces : faces_at) {
        EXPECT_GT(faces, 0) << "an unused point";
        ++census.valences[faces];
    }
    for (const Crease& crease : mesh.creases) {
        EXPECT_TRUE(edges.contains({crease.v0, crease.v1}) || edges.contains({crease.v1, crease.v0}))
            << "crease off the edges";
    }
    return census;
}

TEST(Shapes, AreClosedAndLookOutwards) {
    const std::set<std::string_view> open{"plane", "dish", "canopy"};
    for (const ShapeKind& kind : shape_kinds()) {
        SCOPED_TRACE(kind.name);
        const Census census = census_of(preset(kind.name));
        EXPECT_EQ(census.open_edges > 0, open.contains(kind.name));
        if (!open.contains(kind.name)) {
            EXPECT_GT(census.volume, 0);
        }
    }
}

TEST(Shapes, HoldAtTheEndsOfTheirRanges) {
    for (const ShapeKind& kind : shape_kinds()) {
        for (const ShapeParameter& varied : kind.parameters) {
            for (const double value :
                 {varied.least, varied.whole ? std::min(varied.most, 40.0) : varied.most}) {
                SCOPED_TRACE(std::string(kind.name) + "." + std::string(varied.name) + " = " +
                             std::to_string(value));
                std::vector<std::pair<std::string, double>> parameters;
                for (const ShapeParameter& parameter : kind.parameters) {
                    parameters.emplace_back(parameter.name,
                                            parameter.name == varied.name ? value : parameter.preset);
                }
                census_of(make_shape(kind.name, parameters));
            }
            EXPECT_LE(varied.least, varied.preset);
            EXPECT_GE(varied.most, varied.preset);
        }
    }
}

TEST(Shapes, ExerciseWhatTheyAreThereFor) {
    const Census box = census_of(preset("box"));
    EXPECT_NEAR(box.volume, 8, 1e-12);
    EXPECT_EQ(preset("box").creases.size(), 12U);
    const Census pawn = census_of(preset("pawn"));
    EXPECT_EQ(pawn.face_sizes, (std::set<int>{3, 4, 10}));
    EXPECT_GT(preset("pawn").creases.size(), 20U);
    const Census urchin = census_of(preset("urchin"));
    EXPECT_EQ(urchin.face_sizes, (std::set<int>{4, 5}));
    EXPECT_EQ(urchin.valences, (std::map<int, int>{{3, 60}, {6, 20}}));
    Census sponge = census_of(preset("sponge"));
    EXPECT_EQ(sponge.face_sizes, (std::set<int>{4}));
    EXPECT_EQ(sponge.valences[3], 8);
    EXPECT_GT(sponge.valences[5] + sponge.valences[6], 0);
    EXPECT_TRUE(census_of(preset("dish")).face_sizes.contains(12));
    EXPECT_GT(census_of(preset("canopy")).twist, 0.1);
    EXPECT_LT(census_of(preset("plane")).twist, 1e-15);
    EXPECT_GT(preset("plane").points.size(), 3U);
    const Census knot = census_of(preset("knot"));
    EXPECT_EQ(knot.valences, (std::map<int, int>{{4, 192}}));
    EXPECT_EQ(find_shape_kind("none"), nullptr);
}

/// Texture coordinates turn as faces do and are as far apart as points are, so that textures are neither
/// mirrored nor torn: of neighbouring faces either both ends of their edge have the same ones, or it is a
/// seam.
TEST(Shapes, TextureCoordinatesFollowTheFaces) {
    const std::map<std::string_view, int> seams{
        // Edges on whose sides they differ: a net of six squares keeps five of a box's twelve; of what is
        // turned
        // a foot's rim, a line along the profile, and all that meet at the pole.
        {"plane", 0},           {"box", 7}, {"knot", 48 + 4}, {"dish", 0}, {"bowl", 12 + 10 + 12},
        {"pawn", 10 + 13 + 10},
    };
    for (const ShapeKind& kind : shape_kinds()) {
        SCOPED_TRACE(kind.name);
        const Mesh mesh = preset(kind.name);
        const bool none = kind.name == "gear" || kind.name == "urchin" || kind.name == "canopy";
        ASSERT_EQ(mesh.face_texcoords.size(), none ? 0 : mesh.face_vertices.size());
        if (none)
            continue;
        std::map<std::pair<int, int>, std::pair<int, int>> sides; // of half-edges
        std::size_t first = 0;
        for (const int size : mesh.face_sizes) {
            const auto n = static_cast<std::size_t>(size);
            const auto at = [&](std::size_t i) {
                return glm::dvec2(
                    mesh.texcoords.at(static_cast<std::size_t>(mesh.face_texcoords[first + i % n])));
            };
            double area = 0;
            for (std::size_t i = 0; i < n; ++i) {
                area += 0.5 * (at(i).x * at(i + 1).y - at(i + 1).x * at(i).y);
                sides[{mesh.face_vertices[first + i], mesh.face_vertices[first + (i + 1) % n]}] = {
                    mesh.face_texcoords[first + i], mesh.face_texcoords[first + (i + 1) % n]};
            }
            EXPECT_GT(area, 0) << first;
            first += n;
        }
        int torn = 0;
        for (const auto& [edge, ends] : sides) {
            const auto other = sides.find({edge.second, edge.first});
            if (edge.first < edge.second && other != sides.end() &&
                other->second != std::pair(ends.second, ends.first))
                ++torn;
        }
        if (seams.contains(kind.name)) {
            EXPECT_EQ(torn, seams.at(kind.name));
        }
    }
}

} // namespace
} // namespace razor
