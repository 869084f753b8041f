// The baseline draws what Razor draws.
#include "razor/native/render.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/shapes/shapes.h"
#include "tests/benchmarks/embree/renderer.h"
#include "tests/benchmarks/embree/tessellation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

namespace razor::baseline {
namespace {

/// Both kinds of patches, polygons, creases, a lens, things turned, squeezed, mirrored and seen from inside,
/// repeated.
Scene scene_of(const std::string& scheme) {
    const std::string text = R"(
[settings]
size = [96, 80]
samples = 4
light_samples = 3
sky_samples = 5
edge_pixels = 0.25
[camera]
position = [1, 2.4, 6.5]
target = [0, 0.6, 0]
fov = 40
aperture_radius = 0.05
focus_distance = 6
[sky]
radiance = [0.3, 0.4, 0.5]
[[light]]
corner = [-4, 7, 3]
edge_u = [2, 0, 0]
edge_v = [0, 0.5, 2]
radiance = [12, 11, 9]
[[material]]
name = "red"
albedo = [0.8, 0.2, 0.1]
[[material]]
name = "blue"
albedo = [0.1, 0.3, 0.7]
[[mesh]]
name = "floor"
shape = "plane"
scheme = "bilinear"
[mesh.parameters]
width = 30
depth = 30
[[mesh]]
name = "knot"
shape = "knot"
scheme = "SCHEME"
material = "red"
scale = 0.8
translate = [0.4, 1.2, 0]
[[mesh]]
name = "gear"
shape = "gear"
scheme = "SCHEME"
[mesh.parameters]
sharpness = 2.6
[[mesh]]
name = "limb"
shape = "urchin"
scheme = "SCHEME"
material = "blue"
[[object]]
mesh = "floor"
translate = [0, -0.5, 0]
[[object]]
mesh = "knot"
[[object]]
mesh = "gear"
translate = [-2.4, 0.6, 0]
rotate = [70, 20, 0]
scale = 0.7
array = [2, 1, 2]
spacing = [4.6, 0, -2.5]
[[object]]
mesh = "limb"
translate = [1.6, 0.4, 2]
scale = [-0.5, 0.4, 0.3]
rotate = [0, 30, 10]
array = [1, 1, 3]
spacing = [0, 0, -3]
[[object]]
mesh = "limb"
translate = [-1.5, 0.3, 3]
scale = 0.4
)";
    std::string with = text;
    for (std::size_t at = with.find("SCHEME"); at != std::string::npos; at = with.find("SCHEME"))
        with.replace(at, 6, scheme);
    return build_scene(parse_scene_file(with, "scene", "."));
}

struct Difference {
    double mean = 0;  // of R, G and B
    double wrong = 0; // part of the pixels that differ by more than a tenth and a hundredth
    double hits = 0;  // part of the pixels whose depth differs by more than a thousandth
};

Difference compare(const Film& a, const Film& b) {
    Difference d;
    const std::size_t pixels = a.pixel_count();
    for (std::size_t p = 0; p < pixels; ++p) {
        bool wrong = false;
        for (const char* name : {"R", "G", "B"}) {
            const float x = a.find(name)->values[p], y = b.find(name)->values[p];
            d.mean += std::abs(x - y) / 3 / static_cast<double>(pixels);
            wrong = wrong || std::abs(x - y) > 0.1F * std::abs(y) + 0.01F;
        }
        d.wrong += (wrong ? 1.0 : 0.0) / static_cast<double>(pixels);
        const float x = a.find("depth.Z")->values[p], y = b.find("depth.Z")->values[p];
        d.hits += (x == y || std::abs(x - y) <= 1e-3F * y ? 0.0 : 1.0) / static_cast<double>(pixels);
    }
    return d;
}

Film by_razor(Scene scene) {
    scene.settings.lod = Lod::fixed;
    RenderOptions options;
    options.threads = 2;
    return render_native(scene, options).film;
}

Film by_embree(const Scene& scene, const Options& options) {
    Report report;
    return Renderer(options).render(scene, report);
}

Options options_of(Levels levels, std::int64_t flatten, Quality quality) {
    Options o;
    o.threads = 2;
    o.levels = levels;
    o.flatten = flatten;
    o.quality = quality;
    return o;
}

class Baseline : public testing::TestWithParam<std::string> {};

TEST_P(Baseline, DrawsWhatRazorDraws) {
    const Scene scene = scene_of(GetParam());
    const Film ours = by_razor(scene);
    for (const Options& options : {options_of(Levels::mesh, 0, Quality::medium),
                                   options_of(Levels::mesh, 1'000'000'000, Quality::low)}) {
        const Difference d = compare(by_embree(scene, options), ours);
        EXPECT_LT(d.mean, 3e-4);
        EXPECT_LT(d.wrong, 0.003);
        EXPECT_LT(d.hits, 0.003);
    }
}

/// What shadow rays that pass an edge on the other side, for last bits of where they begin, make of pictures
/// of equal geometry.
constexpr double last_bits = 2e-4;

TEST_P(Baseline, ComesNearerLevelByLevel) {
    const Scene scene = scene_of(GetParam());
    const Film ours = by_razor(scene);
    struct Steps {
        Levels levels;
        std::array<int, 3> finer;
    };
    for (const auto& [levels, steps] :
         {Steps{Levels::instance, {-4, -2, 0}}, Steps{Levels::deviation, {-5, -1, 1}},
          Steps{Levels::uniform, {0, 2, 4}}}) {
        Options options = options_of(levels, 0, Quality::medium);
        double before = 1;
        for (const int finer : steps) {
            options.finer = finer;
            const double mean = compare(by_embree(scene, options), ours).mean;
            EXPECT_LT(mean, std::max(before * 0.7, last_bits)) << finer;
            before = mean;
        }
    }
}

/// A cube's faces are alike, so that both cut them into the same triangles, coarse ones, whose normals and
/// shadows are all but those of the surface.
TEST(CoarseBaseline, DrawsTheTrianglesThatRazorDraws) {
    Scene scene = scene_of("catmark");
    Mesh& mesh = scene.meshes[1];
    const Mesh cube =
        make_shape("box", {{"width", 2.0}, {"height", 2.0}, {"depth", 2.0}, {"sharpness", 0.0}});
    mesh.points = cube.points;
    mesh.face_sizes = cube.face_sizes;
    mesh.face_vertices = cube.face_vertices;
    mesh.creases = cube.creases;
    mesh.texcoords = cube.texcoords;
    mesh.face_texcoords = cube.face_texcoords;
    mesh.edge_length = 0.3;
    scene.meshes.resize(2);
    scene.graph = {};
    for (glm::dvec3& p : scene.meshes[0].points)
        p.y -= 1.2;
    const Film ours = by_razor(scene);
    Difference least{1, 1, 1};
    for (const int finer : {-2, -1, 0, 1}) {
        Options options = options_of(Levels::mesh, 0, Quality::medium);
        options.finer = finer;
        const Difference d = compare(by_embree(scene, options), ours);
        if (d.mean < least.mean)
            least = d;
    }
    EXPECT_LT(least.mean, last_bits);
    EXPECT_LT(least.wrong, 1e-3);
    EXPECT_LT(least.hits, 1e-3);
}

/// What was rendered before leaves no trace.
TEST_P(Baseline, FramesDoNotDependOnFramesBefore) {
    const Scene scene = scene_of(GetParam());
    Scene other = scene;
    for (glm::dvec3& p : other.meshes[1].points)
        p = glm::dvec3(0.5, 1.5, 0) + 0.3 * p;
    other.camera.position.x += 2;
    other.settings.edge_pixels = 4;
    const Options options = options_of(Levels::instance, 0, Quality::medium);
    Renderer renderer(options);
    Report report;
    renderer.render(other, report);
    const Film after = renderer.render(scene, report);
    EXPECT_EQ(report.seconds.topology > 0, true);
    const Film alone = by_embree(scene, options);
    for (const Plane& plane : alone.planes)
        EXPECT_EQ(after.find(plane.name)->values, plane.values) << plane.name;
}

INSTANTIATE_TEST_SUITE_P(Schemes, Baseline, testing::Values("catmark", "bilinear"),
                         [](const auto& i) { return i.param; });

/// Where the vertices of all patches lie, bit by bit.
std::set<std::array<float, 3>> places(const Mesh& mesh, int level) {
    const Topology topology = analyse_topology(mesh);
    std::unique_ptr<PageMaker> pages;
    if (mesh.scheme == Scheme::catmull_clark)
        pages = std::make_unique<PageMaker>(mesh, topology);
    const GridMesh grid = make_grid_mesh(topology, pages.get(), level);
    std::vector<float> points;
    for (const glm::dvec3& p : mesh.points)
        for (int k = 0; k < 3; ++k)
            points.push_back(static_cast<float>(p[k]));
    std::vector<float> positions(static_cast<std::size_t>(3 * grid.vertices)), normals(positions.size());
    tessellate({{&grid, points.data(), positions.data(), normals.data()}}, choose_kernels("auto"), 1);
    std::set<std::array<float, 3>> found;
    for (std::size_t v = 0; v < positions.size(); v += 3)
        found.insert({positions[v], positions[v + 1], positions[v + 2]});
    return found;
}

/// Too many are refused before memory is taken.
TEST(GridMesh, TrianglesAreCountedBeforehand) {
    for (const char* scheme : {"catmark", "bilinear"})
        for (const Mesh& mesh : scene_of(scheme).meshes) {
            const Topology topology = analyse_topology(mesh);
            std::unique_ptr<PageMaker> pages;
            if (mesh.scheme == Scheme::catmull_clark)
                pages = std::make_unique<PageMaker>(mesh, topology);
            for (const int level : {0, 1, 3, 4})
                EXPECT_EQ(triangles_at(topology, level),
                          make_grid_mesh(topology, pages.get(), level).triangles)
                    << mesh.name << level;
        }
    Options options = options_of(Levels::uniform, 0, Quality::medium);
    options.finer = finest_level;
    options.most_triangles = 1'000'000;
    EXPECT_THROW(by_embree(scene_of("catmark"), options), UserError);
}

/// A sphere of q quads has q + 2 vertices: none is there twice with other last bits.
TEST(GridMesh, ClosedSurfacesHaveNoCracks) {
    for (const Scheme scheme : {Scheme::catmull_clark, Scheme::bilinear})
        for (const int level : {0, 1, 2, 3, 4, 5}) {
            Mesh cube;
            cube.scheme = scheme;
            for (int i = 0; i < 8; ++i) // no face is flat, no place round
                cube.points.emplace_back((i & 1) + 0.1 * (i & 2), (i >> 1 & 1) - 0.07 * (i & 4),
                                         (i >> 2) + 0.3 * (i == 7));
            cube.face_sizes.assign(6, 4);
            cube.face_vertices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
            cube.rest = cube.points;
            EXPECT_EQ(places(cube, level).size(), (6U << (2 * level)) + 2) << level;
        }
}

/// Two pentagons and five quads: a prism, whose pentagons are cut in five.
TEST(GridMesh, PolygonsMeetQuadsWithoutCracks) {
    for (const Scheme scheme : {Scheme::catmull_clark, Scheme::bilinear})
        for (const int level : {1, 2, 4, 5}) {
            Mesh prism;
            prism.scheme = scheme;
            for (int i = 0; i < 10; ++i) {
                const double angle = 0.3 + (i % 5) * 1.2566370614359172;
                prism.points.emplace_back(std::cos(angle), i / 5 + 0.1 * (i % 3), 1.1 * std::sin(angle));
            }
            prism.face_sizes = {5, 5, 4, 4, 4, 4, 4};
            prism.face_vertices = {0, 1, 2, 3, 4, 9, 8, 7, 6, 5};
            for (int i = 0; i < 5; ++i)
                for (const int v : {i, i + 5, (i + 1) % 5 + 5, (i + 1) % 5})
                    prism.face_vertices.push_back(v);
            prism.rest = prism.points;
            const std::size_t quads = (10U << (2 * (level - 1))) + (5U << (2 * level));
            EXPECT_EQ(places(prism, level).size(), quads + 2) << level;
        }
}

} // namespace
} // namespace razor::baseline
