// What pixels show, by name: against brute force over faces, and against the surface's own parameters.
#include "tests/kernels/cages.h"
#include "tests/kernels/reference_surface.h"
#include "tests/survey/reference.h"

#include "razor/scene/textures/shared_exponent.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace razor::test {
namespace {

using glm::dvec3;

struct Found {
    double t = 1e300;
    int instance = -1, mesh = -1, face = -1;
    double u = 0, v = 0;
    double inside = 0; // the least of the barycentric weights
};

/// Of meshes whose faces are triangles and flat convex quads: these are triangles 0-1-2 and 0-2-3.
class BruteForce {
public:
    explicit BruteForce(const Scene& scene) {
        int instance = 0;
        for (const Drawn& d : drawn(scene)) {
            const Mesh& mesh = scene.meshes[static_cast<std::size_t>(d.mesh)];
            std::size_t corner = 0;
            for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f) {
                std::vector<dvec3> p;
                for (int k = 0; k < mesh.face_sizes[f]; ++k)
                    p.push_back(d.world(mesh.points[static_cast<std::size_t>(mesh.face_vertices[corner++])]));
                const Found named{1e300, instance, d.mesh, static_cast<int>(f)};
                triangles_.push_back({p[0], p[1], p[2], false, named});
                if (p.size() == 4)
                    triangles_.push_back({p[0], p[2], p[3], true, named});
            }
            ++instance;
        }
    }
    Found nearest(const dvec3& from, const dvec3& way) const {
        Found best;
        for (const Triangle& tri : triangles_) {
            const dvec3 e1 = tri.b - tri.a, e2 = tri.c - tri.a, s = from - tri.a;
            const dvec3 p = glm::cross(way, e2), q = glm::cross(s, e1);
            const double det = glm::dot(e1, p);
            const double b = glm::dot(s, p) / det, c = glm::dot(way, q) / det, t = glm::dot(e2, q) / det;
            const double inside = std::min({b, c, 1 - b - c});
            if (!(inside >= 0) || t <= 0 || t >= best.t)
                continue;
            best = tri.named;
            best.t = t;
            best.inside = inside;
            // Corners (0, 0), (1, 0), (1, 1), or (0, 0), (1, 1), (0, 1).
            best.u = tri.second ? b : b + c;
            best.v = tri.second ? b + c : c;
        }
        return best;
    }

private:
    struct Triangle {
        dvec3 a, b, c;
        bool second;
        Found named;
    };
    std::vector<Triangle> triangles_;
};

void expect_picks(const Scene& scene, int least_hits) {
    const RenderResult r = surveyed(scene, layers({LayerGroup::pick}));
    const Pixels at(r.film, scene.settings);
    const BruteForce all(scene);
    int hits = 0, skipped = 0;
    for (int y = 0; y < scene.settings.height; ++y)
        for (int x = 0; x < scene.settings.width; ++x) {
            const Found f = all.nearest(start_of(scene, x, y), way_through(scene, x, y));
            SCOPED_TRACE(testing::Message() << x << ' ' << y);
            if (f.face >= 0 && f.inside < 1e-3) { // so near to an edge, rounding may choose
                ++skipped;
                continue;
            }
            ASSERT_EQ(at("pick.face", x, y), static_cast<float>(f.face));
            ASSERT_EQ(at("pick.mesh", x, y), static_cast<float>(f.mesh));
            ASSERT_EQ(at("pick.instance", x, y), static_cast<float>(f.instance));
            if (f.face < 0) {
                EXPECT_EQ(at("pick.part", x, y), -1);
                EXPECT_EQ(at("pick.u", x, y), -1);
                EXPECT_EQ(at("pick.v", x, y), -1);
                EXPECT_EQ(at("pick.Z", x, y), std::numeric_limits<float>::infinity());
                continue;
            }
            ++hits;
            EXPECT_EQ(at("pick.part", x, y), 0);
            EXPECT_NEAR(at("pick.u", x, y), f.u, 1e-4);
            EXPECT_NEAR(at("pick.v", x, y), f.v, 1e-4);
            EXPECT_NEAR(at("pick.Z", x, y), f.t, 1e-5 * f.t);
        }
    EXPECT_GE(hits, least_hits);
    EXPECT_LE(skipped, hits / 10);
}

TEST(Pick, IsWhatBruteForceFinds) {
    for (const Lod lod : {Lod::object, Lod::recursive, Lod::discrete, Lod::patch, Lod::camera}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(lod));
        Scene scene = scene_of(bilinear(cube_cage()), 20);
        scene.settings.lod = lod;
        scene.settings.width = 45; // no multiple of a packet's or a tile's sides
        scene.settings.height = 27;
        expect_picks(scene, 200);
        Scene slab = scene_of(bilinear(bevelled_slab()), 20);
        slab.settings.lod = lod;
        expect_picks(slab, 150);
    }
}

TEST(Pick, IsByTheCamerasRays) {
    Scene scene = scene_of(bilinear(cube_cage()), 20);
    scene.settings.width = 45;
    scene.camera.projection = Projection::orthographic;
    scene.camera.height = 5;
    expect_picks(scene, 200);
    scene = scene_of(bilinear(cube_cage()), 20);
    scene.camera.aperture_radius = 0.8; // through the middle of the lens
    expect_picks(scene, 200);
}

TEST(Pick, TellsInstancesApartTurnedMirroredAndSheared) {
    Scene scene = instances_of(bilinear(cube_cage()), 20);
    scene.meshes.push_back(scene.meshes[0]); // two meshes
    scene.graph.groups[0].placements[1].mesh = 1;
    scene.settings.width = 96;
    scene.settings.height = 64;
    expect_picks(scene, 300);
}

/// The surface at the place that is named lies where the ray hit it: off by what is lost in single
/// precision, and on curved faces by what the finest triangles are, which `object` shows.
void expect_places(const Mesh& mesh, int least_parts) {
    Scene scene = scene_of(mesh, 60);
    scene.settings.width = scene.settings.height = 48;
    const RenderResult r = surveyed(scene, layers({LayerGroup::pick, LayerGroup::patch, LayerGroup::lod}));
    const Pixels at(r.film, scene.settings);
    Frame frame(scene, {});
    const ReferenceSurface surface(frame, scene.meshes[0]);
    const auto origin = frame.origin() + dvec3(frame.header().instances.get()->origin[0],
                                               frame.header().instances.get()->origin[1],
                                               frame.header().instances.get()->origin[2]);
    int hits = 0, parts = 0;
    for (int y = 0; y < scene.settings.height; ++y)
        for (int x = 0; x < scene.settings.width; ++x) {
            if (at("pick.face", x, y) < 0)
                continue;
            ++hits;
            SCOPED_TRACE(testing::Message() << x << ' ' << y);
            const PatchRecord& patch =
                surface.topology().patches.at(static_cast<std::size_t>(at("patch.id", x, y)));
            ASSERT_EQ(at("pick.face", x, y), static_cast<float>(patch.face));
            ASSERT_EQ(at("pick.part", x, y), static_cast<float>(patch.sub));
            parts += patch.sub > 0 ? 1 : 0;
            const auto [nu, nv] = surface.grid(patch);
            const double u = std::ldexp(at("pick.u", x, y), nu), v = std::ldexp(at("pick.v", x, y), nv);
            const int i = std::min(static_cast<int>(u), (1 << nu) - 1);
            const int j = std::min(static_cast<int>(v), (1 << nv) - 1);
            const double a = u - i, b = v - j;
            const dvec3 p00 = surface.grid_point(patch, i, j), p11 = surface.grid_point(patch, i + 1, j + 1);
            const dvec3 p10 = surface.grid_point(patch, i + 1, j), p01 = surface.grid_point(patch, i, j + 1);
            const dvec3 place = a >= b ? p00 + (a - b) * (p10 - p00) + b * (p11 - p00)
                                       : p00 + a * (p11 - p00) + (b - a) * (p01 - p00);
            const dvec3 hit = start_of(scene, x, y) + double{at("pick.Z", x, y)} * way_through(scene, x, y);
            // On sides, vertices may hang on a coarser edge.
            const bool inner = i > 0 && j > 0 && i + 1 < 1 << nu && j + 1 < 1 << nv;
            const double size = glm::length(hit - scene.camera.position);
            EXPECT_LT(glm::length(place + origin - hit), inner ? 1e-5 * size : scene.meshes[0].edge_length);
            EXPECT_EQ(at("lod.depth", x, y), 0);
        }
    EXPECT_GE(hits, 200);
    EXPECT_GE(parts, least_parts);
}

TEST(Pick, NamesThePlaceOnALimitSurface) {
    expect_places(torus_cage(9, 6), 0);
}
TEST(Pick, NamesThePlaceOnPartsOfNgons) {
    expect_places(urchin_cage(), 10);
}

/// Parts of a polygon that is cut into triangles: place and part give back the point.
TEST(Pick, NamesTrianglesOfAConcavePolygon) {
    Mesh m;
    m.name = "arrow";
    m.scheme = Scheme::bilinear;
    m.points = {{-1, -1, 0}, {0, -0.2, 0}, {1, -1, 0}, {0, 1, 0}};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    Scene scene = scene_of(m, 30);
    const RenderResult r = surveyed(scene, layers({LayerGroup::pick, LayerGroup::patch}));
    const Pixels at(r.film, scene.settings);
    const Topology topology = analyse_topology(m);
    std::array<int, 2> hits{};
    for (int y = 0; y < scene.settings.height; ++y)
        for (int x = 0; x < scene.settings.width; ++x) {
            if (at("pick.face", x, y) < 0)
                continue;
            const PatchRecord& patch = topology.patches.at(static_cast<std::size_t>(at("patch.id", x, y)));
            EXPECT_EQ(at("pick.part", x, y), static_cast<float>(patch.sub));
            ++hits.at(static_cast<std::size_t>(patch.sub));
            const double u = at("pick.u", x, y), v = at("pick.v", x, y);
            const auto corner = [&](int k) { return m.points[static_cast<std::size_t>(patch.corner[k])]; };
            const dvec3 place = corner(0) + (u - v) * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
            const dvec3 hit = start_of(scene, x, y) + double{at("pick.Z", x, y)} * way_through(scene, x, y);
            EXPECT_LT(glm::length(place - hit), 1e-5);
        }
    EXPECT_GE(hits[0], 20);
    EXPECT_GE(hits[1], 20);
}

/// Transparent everywhere.
Texture nothing() {
    auto pyramid = std::make_shared<TexturePyramid>();
    TextureLevel level{1, 1, {}, {}};
    level.texels.assign(16, pack_shared_exponent(glm::vec3(1)));
    level.opacity.assign(16, pack_shared_exponent(glm::vec3(0)));
    pyramid->levels.push_back(level);
    Texture t;
    t.name = "nothing";
    t.pyramid = pyramid;
    return t;
}

TEST(Pick, LooksThroughWhatIsCutOut) {
    Mesh board;
    board.name = "board";
    board.scheme = Scheme::bilinear;
    board.points = {{-9, -9, 1.5}, {9, -9, 1.5}, {9, 9, 1.5}, {-9, 9, 1.5}};
    board.face_sizes = {4};
    board.face_vertices = {0, 1, 2, 3};
    board.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    board.face_texcoords = {0, 1, 2, 3};
    Scene scene = scene_of(bilinear(cube_cage()), 20);
    const Film without = surveyed(scene, layers({LayerGroup::pick})).film;
    Material paper = scene.materials[0];
    paper.albedo_map.texture = 0;
    paper.alpha_cutoff = 0.5F;
    scene.materials.push_back(paper);
    board.material = 1;
    scene.meshes.push_back(board);
    scene.textures = {nothing()};
    EXPECT_EQ(surveyed(scene, layers({LayerGroup::pick})).film.find("pick.face")->ids,
              without.find("pick.face")->ids);
    scene.materials[1].alpha_cutoff = 0; // opaque
    const Film opaque = surveyed(scene, layers({LayerGroup::pick})).film;
    for (const std::uint32_t mesh : opaque.find("pick.mesh")->ids)
        EXPECT_EQ(mesh, 1);
}

} // namespace
} // namespace razor::test
