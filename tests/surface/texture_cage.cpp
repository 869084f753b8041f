// Texture coordinates by the weights of the texture cage against OpenSubdiv's own face-varying surfaces, at
// equal approximation levels: no case differs. Chaikin creases are left out, as Bfr has them wrong.
#include "meshes.h"
#include "patch_samples.h"

#include "razor/surface/refiner.h"
#include "razor/surface/texture_cage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <set>

namespace razor::test {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

constexpr int level = 6;
constexpr int exponent = 2; // 5 x 5 points a patch
constexpr int side = (1 << exponent) + 1;
constexpr std::array all_rules{
    FaceVaryingInterpolation::none,          FaceVaryingInterpolation::corners_only,
    FaceVaryingInterpolation::corners_plus1, FaceVaryingInterpolation::corners_plus2,
    FaceVaryingInterpolation::boundaries,    FaceVaryingInterpolation::all};

/// As make_refiner(), with the texture coordinates as a channel.
std::unique_ptr<Far::TopologyRefiner> refiner_with_channel(const Mesh& mesh) {
    std::vector<int> ends, vertices;
    std::vector<float> creases, corners;
    for (const Crease& c : mesh.creases) {
        ends.insert(ends.end(), {c.v0, c.v1});
        creases.push_back(c.sharpness);
    }
    for (const Corner& c : mesh.corners) {
        vertices.push_back(c.vertex);
        corners.push_back(c.sharpness);
    }
    Far::TopologyDescriptor d;
    d.numVertices = static_cast<int>(mesh.points.size());
    d.numFaces = static_cast<int>(mesh.face_sizes.size());
    d.numVertsPerFace = mesh.face_sizes.data();
    d.vertIndicesPerFace = mesh.face_vertices.data();
    d.numCreases = static_cast<int>(creases.size());
    d.creaseVertexIndexPairs = ends.data();
    d.creaseWeights = creases.data();
    d.numCorners = static_cast<int>(corners.size());
    d.cornerVertexIndices = vertices.data();
    d.cornerWeights = corners.data();
    Far::TopologyDescriptor::FVarChannel channel;
    channel.numValues = static_cast<int>(mesh.texcoords.size());
    channel.valueIndices = mesh.face_texcoords.data();
    d.numFVarChannels = 1;
    d.fvarChannels = &channel;
    Sdc::Options options = make_refiner(mesh)->GetSchemeOptions();
    options.SetFVarLinearInterpolation(
        static_cast<Sdc::Options::FVarLinearInterpolation>(static_cast<int>(mesh.face_varying)));
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(d, Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

/// One face after the other, its sub-faces in order, `side` x `side` points of each.
class Reference {
public:
    explicit Reference(const Mesh& mesh)
        : mesh_(mesh), refiner_(refiner_with_channel(mesh)),
          factory_(*refiner_, Bfr::SurfaceFactory::Options()
                                  .SetDefaultFVarID(0)
                                  .EnableCaching(false)
                                  .SetApproxLevelSmooth(level)
                                  .SetApproxLevelSharp(level)) {}

    std::vector<glm::dvec2> block(const PatchRecord& patch) {
        Bfr::Surface<double> surface;
        if (!factory_.InitFaceVaryingSurface(patch.face, &surface))
            throw std::logic_error("no face-varying surface");
        const int size = mesh_.face_sizes[static_cast<std::size_t>(patch.face)];
        const Bfr::Parameterization parameters(Sdc::SCHEME_CATMARK, size);
        std::vector<int> points(static_cast<std::size_t>(surface.GetNumControlPoints()));
        surface.GetControlPointIndices(points.data());
        std::vector<double> weights(points.size());
        std::vector<glm::dvec2> result;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                double uv[] = {static_cast<double>(i) / (side - 1), static_cast<double>(j) / (side - 1)};
                if (size != 4) {
                    const double own[] = {uv[0], uv[1]};
                    parameters.ConvertNormalizedSubFaceToCoord(patch.sub, own, uv);
                }
                surface.EvaluateStencil(uv, weights.data());
                glm::dvec2 sum(0);
                for (std::size_t k = 0; k < points.size(); ++k)
                    sum += weights[k] * glm::dvec2(mesh_.texcoords[static_cast<std::size_t>(points[k])]);
                result.push_back(sum);
            }
        return result;
    }

private:
    const Mesh& mesh_;
    std::unique_ptr<Far::TopologyRefiner> refiner_;
    Bfr::RefinerSurfaceFactory<> factory_;
};

double extent_of(const std::vector<glm::vec2>& all) {
    glm::dvec2 low(all[0]), high(low);
    for (const glm::dvec2 p : all) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return glm::length(high - low);
}

/// What linear coordinates are at a corner of a patch; see PatchRecord.
std::vector<glm::dvec2> linear_block(const Mesh& cage, const Topology& topology, const PatchRecord& patch) {
    const FaceRecord& face = topology.faces[static_cast<std::size_t>(patch.face)];
    std::vector<glm::dvec2> corners;
    glm::dvec2 middle(0);
    for (int k = 0; k < face.control_count; ++k) {
        const int point = topology.controls[static_cast<std::size_t>(face.control_first + k)];
        corners.emplace_back(cage.points[static_cast<std::size_t>(point)]);
        middle += corners.back() / double(face.control_count);
    }
    const std::size_t n = corners.size(), s = static_cast<std::size_t>(patch.sub);
    std::array<glm::dvec2, 4> of{corners[0], corners[1], corners[2], corners[n - 1]};
    if (n != 4)
        of = {corners[s], 0.5 * (corners[s] + corners[(s + 1) % n]), middle,
              0.5 * (corners[s] + corners[(s + n - 1) % n])};
    std::vector<glm::dvec2> result;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const double u = static_cast<double>(i) / (side - 1), v = static_cast<double>(j) / (side - 1);
            result.push_back((1 - v) * ((1 - u) * of[0] + u * of[1]) + v * ((1 - u) * of[3] + u * of[2]));
        }
    return result;
}

/// The largest difference, of the extent of all coordinates. `step`: every so many patches.
double worst_difference(const Mesh& mesh, std::size_t step = 1) {
    const Topology own = analyse_topology(mesh);
    const Mesh cage = texture_cage(mesh);
    const Topology topology = analyse_texture_cage(mesh, cage);
    const double size = extent_of(mesh.texcoords);
    Reference reference(mesh);
    std::unique_ptr<PagePool> pool;
    if (!has_linear_texcoords(mesh))
        pool = std::make_unique<PagePool>(cage, topology, level);
    double worst = 0;
    for (std::size_t p = 0; p < own.patches.size(); p += step) {
        const PatchRecord& patch = own.patches[p];
        const std::vector<glm::dvec2> exact = reference.block(patch);
        std::vector<glm::dvec2> ours;
        if (pool)
            for (const glm::dvec3& at : pool->block(patch, exponent).position)
                ours.emplace_back(at);
        else
            ours = linear_block(cage, topology, patch);
        for (std::size_t i = 0; i < exact.size(); ++i)
            worst = std::max(worst, glm::length(exact[i] - ours[i]) / size);
    }
    return worst;
}

void expect_same(Mesh mesh, std::size_t step = 1) {
    validate_mesh(mesh);
    for (const FaceVaryingInterpolation rule : all_rules) {
        mesh.face_varying = rule;
        const double worst = worst_difference(mesh, step);
        EXPECT_LT(worst, 1e-6) << mesh.name << ", rule " << static_cast<int>(rule);
    }
}

/// The coordinate of each corner is one of its point's, by `which`; all random.
template <class Which> Mesh& map_corners(Mesh& mesh, int most, Which which) {
    std::mt19937 random(7);
    const auto next = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    mesh.texcoords.clear();
    for (std::size_t i = 0; i < mesh.points.size() * static_cast<std::size_t>(most); ++i) {
        const float u = next(), v = next();
        mesh.texcoords.emplace_back(u, v);
    }
    mesh.face_texcoords.clear();
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f)
        for (int k = 0; k < mesh.face_sizes[f]; ++k, ++corner) {
            const int point = mesh.face_vertices[corner];
            mesh.face_texcoords.push_back(point * most + which(static_cast<int>(f), point));
        }
    return mesh;
}

/// Its faces unfolded to a cross: 14 coordinates, seams along 7 of 12 edges.
Mesh unfolded_cube() {
    Mesh mesh = cube();
    mesh.name = "unfolded cube";
    mesh.texcoords = {{1, 0}, {2, 0}, {1, 1}, {2, 1}, {1, 2}, {2, 2}, {1, 3},
                      {2, 3}, {1, 4}, {2, 4}, {0, 1}, {0, 2}, {3, 1}, {3, 2}};
    mesh.face_texcoords = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 7, 6, 6, 7, 9, 8, 12, 13, 5, 3, 11, 10, 2, 4};
    return mesh;
}

/// Left and right of a column have coordinates of their own.
Mesh grid_with_seam() {
    Mesh mesh = quad_grid(6, 6);
    mesh.name = "grid with a seam";
    return map_corners(mesh, 2, [](int f, int p) { return p % 7 == 3 && f % 6 >= 3 ? 1 : 0; });
}

/// A seam that ends inside.
Mesh grid_with_dart() {
    Mesh mesh = quad_grid(6, 6);
    mesh.name = "grid with a dart";
    return map_corners(mesh, 2, [](int f, int p) { return p % 7 == 3 && p / 7 < 3 && f % 6 >= 3 ? 1 : 0; });
}

TEST(TextureCage, EqualsFaceVaryingSurfaces) {
    for (const BoundaryInterpolation boundary :
         {BoundaryInterpolation::edge_only, BoundaryInterpolation::edge_and_corner,
          BoundaryInterpolation::none}) {
        std::vector<Mesh> meshes = {unfolded_cube(), grid_with_seam(), grid_with_dart()};
        meshes.push_back(quad_grid(5, 5));
        meshes.back().name = "one region";
        map_corners(meshes.back(), 1, [](int, int) { return 0; });
        meshes.push_back(quad_pole(7));
        meshes.back().name = "three regions at a point";
        map_corners(meshes.back(), 3, [](int f, int p) { return p == 0 || p % 2 != 0 ? f / 3 : 0; });
        meshes.push_back(quad_grid(4, 4));
        meshes.back().name = "a face by itself";
        map_corners(meshes.back(), 2, [](int f, int) { return f == 5 ? 1 : 0; });
        meshes.push_back(quad_grid(4, 4));
        meshes.back().name = "faces by themselves";
        map_corners(meshes.back(), 16, [](int f, int) { return f; });
        meshes.push_back(quad_grid(4, 4));
        meshes.back().name = "opposite faces at a point";
        map_corners(meshes.back(), 2, [](int f, int) { return (f / 4 + f) % 2; });
        meshes.push_back(prism(7));
        meshes.back().name = "lids of their own";
        map_corners(meshes.back(), 2, [](int f, int) { return f < 2 ? 1 : 0; });
        meshes.push_back(triangle_pole(9));
        meshes.back().name = "triangles in halves";
        map_corners(meshes.back(), 2, [](int f, int) { return f < 9 ? 1 : 0; });
        meshes.push_back(meshes.back());
        meshes.back().name = "smooth triangles in halves";
        meshes.back().triangles = TriangleSubdivision::smooth;
        for (Mesh& mesh : meshes) {
            mesh.boundary = boundary;
            expect_same(mesh);
        }
    }
}

TEST(TextureCage, CreasesAndCornersGoOnAcrossSeams) {
    for (const float sharpness : {0.5F, 2.3F, infinite_sharpness})
        for (Mesh mesh : {grid_with_seam(), grid_with_dart()}) {
            mesh.name += fmt::format(" and creases of {}", sharpness);
            mesh.creases = {{15, 16, sharpness}, {16, 17, sharpness}};
            expect_same(mesh); // to a point of the seam from one side
            mesh.creases.push_back({17, 18, sharpness});
            expect_same(mesh); // across it
            mesh.creases.push_back({24, 31, sharpness});
            mesh.creases.push_back({31, 38, sharpness});
            mesh.creases.push_back({38, 39, sharpness});
            expect_same(mesh); // along it, and away
            mesh.creases = {{23, 24, 1.5F}, {24, 25, sharpness}};
            expect_same(mesh); // not as sharp on either side
            mesh.corners = {{17, sharpness}, {31, sharpness}, {25, sharpness}};
            expect_same(mesh);
        }
}

// Three faces at an edge, and two cones that meet in a point.
TEST(TextureCage, IsSharpWhereTheMeshIsNoManifold) {
    for (Mesh mesh : hard_meshes()) {
        if (mesh.name != "three faces at an edge" && mesh.name != "bow tie" &&
            mesh.name != "two cubes' corners" && mesh.name != "faces that run the same way")
            continue;
        map_corners(mesh, 2, [](int f, int) { return f % 2; });
        expect_same(mesh);
    }
}

// Regions of any shape, on cages of quads and of other polygons.
TEST(TextureCage, EqualsFaceVaryingSurfacesOfRandomRegions) {
    std::mt19937 random(11);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int n = 0; n < 90; ++n) {
        Mesh mesh = n % 3 == 0 ? quad_grid(4, 4) : n % 3 == 1 ? triangle_pole(5) : prism(5);
        mesh.name = fmt::format("random regions {}", n);
        if (n % 2 == 0)
            map_corners(mesh, 3, [&](int, int) { return std::max(below(4) - 1, 0); });
        else { // whole faces
            std::vector<int> of(mesh.face_sizes.size());
            for (int& region : of)
                region = below(2 + n % 2);
            map_corners(mesh, 3, [&](int f, int) { return of[static_cast<std::size_t>(f)]; });
        }
        std::set<std::pair<int, int>> tagged;
        for (int k = below(4); k > 0; --k) {
            const int f = below(static_cast<int>(mesh.face_sizes.size()));
            int first = 0;
            for (int i = 0; i < f; ++i)
                first += mesh.face_sizes[static_cast<std::size_t>(i)];
            const int size = mesh.face_sizes[static_cast<std::size_t>(f)], c = below(size);
            const std::pair<int, int> edge =
                std::minmax(mesh.face_vertices[static_cast<std::size_t>(first + c)],
                            mesh.face_vertices[static_cast<std::size_t>(first + (c + 1) % size)]);
            if (tagged.insert(edge).second)
                mesh.creases.push_back({edge.first, edge.second, below(2) == 0 ? infinite_sharpness : 1.7F});
        }
        expect_same(mesh);
    }
}

TEST(TextureCage, EqualsFaceVaryingSurfacesOfSharedMeshes) {
    if (!have_shared_scenes())
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    for (const auto& [name, step] : {std::pair{"spot/spot_control_mesh.obj", 7},
                                     {"makehuman/proxy741.obj", 5},
                                     {"osd/catmark_fvar_bound0.obj", 1},
                                     {"osd/catmark_fvar_bound2.obj", 1},
                                     {"osd/catmark_fvar_bound4.obj", 1},
                                     {"osd/catmark_fvar_project0.obj", 1}}) {
        Mesh mesh = shared_mesh(name);
        ASSERT_FALSE(mesh.face_texcoords.empty()) << name;
        expect_same(mesh, static_cast<std::size_t>(step));
    }
}

} // namespace
} // namespace razor::test
