// Scene graphs as frames see them: the pictures of models written out where the graph puts them, levels of
// detail, shared topology, bounds.
#include "razor/check/dump.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/scene/temporary_folder.h"

#include "razor/native/render.h"
#include "razor/scene/graph/records.h"
#include "razor/scene/models/obj_reader.h"
#include "razor/scene/scene_file.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace razor::test {
namespace {

const KernelTable& best_target() {
    return *native_targets().back();
}

std::vector<float> rendered(const Scene& scene, const KernelTable& kernels) {
    Frame frame(scene, {});
    frame.render(kernels, 0);
    const FrameHeader& h = frame.header();
    const float* film = h.film.get();
    return {film, film + static_cast<std::ptrdiff_t>(h.width) * h.height * film_planes};
}

/// Pixels whose depths differ by more than 1e-5 of them.
std::size_t other_depths(const std::vector<float>& film, const std::vector<float>& expected) {
    const std::size_t pixels = film.size() / film_planes;
    std::size_t others = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float a = film[film_depth * pixels + i];
        const float b = expected[film_depth * pixels + i];
        others += a == b || std::abs(a - b) <= 1e-5F * b ? 0 : 1;
    }
    return others;
}

std::size_t hit_pixels(const Scene& scene, const std::vector<float>& film) {
    const auto pixels =
        static_cast<std::size_t>(scene.settings.width) * static_cast<std::size_t>(scene.settings.height);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < pixels; ++i)
        hits += std::isfinite(film[film_depth * pixels + i]) ? 1 : 0;
    return hits;
}

std::size_t differing_bits(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size())
        return std::max(a.size(), b.size());
    std::size_t n = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        n += std::memcmp(&a[i], &b[i], sizeof(float)) != 0 ? 1 : 0;
    return n;
}

/// Coordinates become multiples of 2^-12, so that moving by such multiples, doubling and quarter turns are
/// exact.
Mesh snapped(Mesh mesh) {
    for (glm::dvec3& p : mesh.points)
        p = glm::round(p * 4096.0) / 4096.0;
    return mesh;
}

FlatGraph flattened(const Scene& scene) {
    std::vector<Box> boxes;
    for (const Mesh& mesh : scene.meshes)
        boxes.push_back(bounds_of_used_points(mesh.points, mesh.face_vertices));
    return flatten(drawn_graph(scene.graph, scene.meshes.size()), boxes);
}

const Affine& world_of(const FlatGraph& flat, const FlatInstance& instance) {
    return flat.nodes[static_cast<std::size_t>(instance.node)].world;
}

/// The same scene without a graph: every instance a model of its own, written to an OBJ file where it stands
/// and read again.
Scene written_out(const Scene& scene, const TemporaryFolder& folder) {
    Scene result = scene;
    result.graph = {};
    result.meshes.clear();
    const FlatGraph flat = flattened(scene);
    for (const FlatInstance& instance : flat.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        std::string text;
        for (const glm::dvec3& point : mesh.points) {
            const glm::dvec3 p = world_of(flat, instance)(point);
            text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        }
        std::size_t corner = 0;
        for (const int size : mesh.face_sizes) {
            text += 'f';
            for (int i = 0; i < size; ++i)
                text += fmt::format(" {}", mesh.face_vertices[corner++] + 1);
            text += '\n';
        }
        Mesh copy = read_obj(folder.file("copy.obj", text));
        copy.scheme = mesh.scheme;
        copy.edge_length = mesh.edge_length;
        copy.material = instance.material >= 0 ? instance.material : mesh.material;
        result.meshes.push_back(copy);
    }
    return result;
}

Placement place(const Transform& local) {
    return {.name = "mesh", .mesh = 0, .local = local};
}

/// A mesh many times: nested, in an array, mirrored, turned by quarters, at scales of powers of two.
Scene crowd(const Mesh& mesh) {
    Scene scene = scene_of(snapped(mesh), 40);
    SceneGraph& graph = scene.graph;
    graph.groups = {{"scene", {}}, {"pair", {}}};
    graph.groups[1].placements = {
        place({}), place({.scale = {-1, 1, 1}, .rotate = {0, 90, 0}, .translate = {0, 2.5, 0}})};
    Placement row{.name = "row", .group = 1, .local = {.scale = glm::dvec3(0.5), .rotate = {0, 0, -90}}};
    row.local.translate = {-2.25, 0.125, 0};
    row.copies = {2, 1, 2};
    row.spacing = {1.75, 0, -1.5};
    graph.groups[0].placements = {row, place({.scale = glm::dvec3(2), .translate = {0.5, -5, -1}})};
    Placement red = place({.scale = glm::dvec3(0.25), .rotate = {90, 0, 90}, .translate = {1.5, 0.5, 2}});
    scene.materials.push_back({"red", {0.9F, 0.1F, 0.1F}});
    red.material = 1;
    graph.groups[0].placements.push_back(red);
    return scene;
}

std::vector<Scene> crowds() {
    std::vector<Scene> all;
    for (const Mesh& mesh :
         {cube_cage(), urchin_cage(), bilinear(torus_cage(9, 6)), bilinear(stretched(cube_cage()))})
        all.push_back(crowd(mesh));
    all.push_back(all.front());
    all.back().meshes[0].edge_length = 0; // as the camera sees it
    return all;
}

TEST(Instances, LookLikeModelsWrittenOut) {
    const TemporaryFolder folder;
    for (const Scene& scene : crowds()) {
        const Scene copies = written_out(scene, folder);
        ASSERT_EQ(copies.meshes.size(), 10U);
        for (const KernelTable* target : all_targets()) {
            const std::vector<float> film = rendered(scene, *target);
            EXPECT_GT(hit_pixels(scene, film), 150U) << scene.name;
            EXPECT_EQ(differing_bits(film, rendered(copies, *target)), 0U)
                << scene.name << ", " << target->name;
        }
    }
}

/// Any turn and distance: control points may differ by single-precision rounding of what double precision
/// rounded before.
TEST(Instances, LookNearlyLikeModelsWrittenOutWhereRoundingDiffers) {
    const TemporaryFolder folder;
    std::mt19937 random(3); // NOLINT(cert-msc32-c,cert-msc51-cpp)
    std::uniform_real_distribution<double> any(-1, 1);
    for (const Mesh& mesh : {cube_cage(), urchin_cage(), bilinear(torus_cage(9, 6))}) {
        Scene scene = scene_of(mesh, 40);
        scene.graph.groups = {{"scene", {}}};
        for (int i = 0; i < 6; ++i)
            scene.graph.groups[0].placements.push_back(
                place({.scale = glm::dvec3(i % 2 == 0 ? 0.5 : -0.5),
                       .rotate = 180.0 * glm::dvec3(any(random), any(random), any(random)),
                       .translate = 1.5 * glm::dvec3(any(random), any(random), any(random))}));
        const std::vector<float> film = rendered(scene, best_target());
        const std::vector<float> expected = rendered(written_out(scene, folder), best_target());
        EXPECT_GT(hit_pixels(scene, film), 100U);
        const std::size_t pixels = film.size() / film_planes;
        const std::size_t moved = other_depths(film, expected);
        EXPECT_LE(moved, pixels / 200) << scene.name;
    }
}

TEST(Instances, TargetEdgesFollowOffsetsRatesAndScale) {
    const auto edge = [](const Transform& local, int level_offset, double rate, double stated) {
        Scene scene = scene_of(cube_cage(), 40);
        scene.meshes[0].edge_length = stated;
        Placement p = place(local);
        p.level_offset = level_offset;
        p.rate = rate;
        scene.graph.groups = {{"scene", {p}}};
        Frame frame(scene, {});
        return frame.header().instances.get()[0].edge_length;
    };
    EXPECT_EQ(edge({}, 0, 1, 0.25), 0.25F);
    EXPECT_EQ(edge({}, 3, 1, 0.25), 2.0F);
    EXPECT_EQ(edge({}, -3, 1, 0.25), 0.03125F);
    EXPECT_EQ(edge({}, 0, 1.4, 0.25), 0.25F) << "rounded with the length it multiplies";
    EXPECT_EQ(edge({}, 0, 1.5, 0.25), 0.5F);
    EXPECT_EQ(edge({}, 0, 1.5, 0.2), 0.25F) << "0.3 rounds down";
    EXPECT_EQ(edge({.scale = glm::dvec3(8)}, 0, 1, 0.25), 0.25F) << "world units";
    EXPECT_EQ(edge({.scale = glm::dvec3(8), .rotate = {10, 20, 30}}, 0, 1, 0.25), 0.25F);
    // Scaled by 1.25, the mesh is diced as if by 1: instances of nearby scale share levels.
    EXPECT_EQ(edge({.scale = glm::dvec3(1.25)}, 0, 1, 0.25), 0.25F * 1.25F);
    EXPECT_EQ(edge({.scale = {1, 1.75, 0.1}}, 0, 1, 0.25), 0.25F * 1.75F / 2);
    EXPECT_EQ(edge({}, 0, 2, 0), 2 * edge({}, 0, 1, 0));

    // And as a picture: one level up is the mesh diced at twice the length.
    Scene coarse = scene_of(urchin_cage(), 40);
    coarse.graph.groups = {{"scene", {place({})}}};
    coarse.graph.groups[0].placements[0].level_offset = 1;
    Scene twice = scene_of(urchin_cage(), 20);
    EXPECT_EQ(differing_bits(rendered(coarse, best_target()), rendered(twice, best_target())), 0U);
    EXPECT_GT(
        differing_bits(rendered(coarse, best_target()), rendered(scene_of(urchin_cage(), 40), best_target())),
        0U);
}

TEST(Instances, OfOneFixedLevelShareTheirMeshsFinest) {
    Scene scene = scene_of(cube_cage(), 40);
    scene.meshes[0].edge_length = 0; // as the camera sees it
    scene.meshes.push_back(scene.meshes[0]);
    const glm::dvec3 away = glm::normalize(scene.camera.target - scene.camera.position);
    Placement other = place({.translate = away * 900.0});
    other.mesh = 1;
    scene.graph.groups = {{"scene",
                           {place({.translate = away * 40.0}), place({}),
                            place({.scale = glm::dvec3(4), .translate = away * 300.0}), other}}};
    const auto edges = [&](LevelOfDetail lod, float InstanceRecord::*of) {
        scene.settings.lod = lod;
        Frame frame(scene, {});
        const auto& instances = frame.header().instances;
        std::vector<float> lengths;
        for (int i = 0; i < 4; ++i)
            lengths.push_back(instances.get()[i].*of);
        return lengths;
    };
    const std::vector<float> own = edges(Lod::object, &InstanceRecord::edge_length);
    EXPECT_GT(own[0], own[1]);
    EXPECT_GT(own[2], own[0]);
    EXPECT_GT(own[3], own[2]);
    EXPECT_EQ(edges(Lod::fixed, &InstanceRecord::edge_length),
              (std::vector{own[1], own[1], 4 * own[1], own[3]}));
    EXPECT_EQ(edges(Lod::fixed, &InstanceRecord::mesh_edge_length),
              (std::vector{own[1], own[1], own[1], own[3]}));
    EXPECT_EQ(edges({Lod::fixed, 2}, &InstanceRecord::mesh_edge_length)[0], 4 * own[1]);
    EXPECT_EQ(edges({Lod::object, 2}, &InstanceRecord::edge_length)[0], 4 * own[0]);
    EXPECT_EQ(edges(Lod::recursive, &InstanceRecord::edge_length), own);
}

TEST(Instances, ShareTopologyAndItsPages) {
    const auto statistics = [](int copies) {
        Scene scene = scene_of(urchin_cage(), 40);
        Placement p = place({});
        p.copies = {copies, 1, 1};
        p.spacing = {4, 0, 0};
        scene.graph.groups = {{"scene", {p}}};
        Frame frame(scene, {});
        frame.build_all(best_target());
        return frame.statistics();
    };
    Scene apart = scene_of(urchin_cage(), 40);
    apart.meshes.resize(9, apart.meshes[0]);
    Frame nine(apart, {});
    nine.build_all(best_target());
    const FrameStatistics one = statistics(1);
    EXPECT_EQ(nine.statistics().page_bytes, 9 * one.page_bytes) << "meshes of their own do not";
    const FrameStatistics many = statistics(9);
    EXPECT_GT(one.page_bytes, 0);
    EXPECT_EQ(many.page_bytes, one.page_bytes);
    EXPECT_EQ(many.meshes, 1);
    EXPECT_EQ(many.instances, 9);
    EXPECT_EQ(many.patches, 9 * one.patches);
    EXPECT_EQ(many.counters.patches_opened, 9 * one.counters.patches_opened);
}

TEST(Instances, LieInTheirBounds) {
    std::mt19937 random(8); // NOLINT(cert-msc32-c,cert-msc51-cpp)
    std::uniform_real_distribution<double> any(-1, 1);
    std::size_t vertices = 0;
    for (const Mesh& mesh : {cube_cage(), stretched(urchin_cage()), bilinear(torus_cage(9, 6))}) {
        Scene scene = scene_of(mesh, 30);
        scene.graph.groups = {{"scene", {}}};
        for (int i = 0; i < 12; ++i) {
            Affine map{glm::dmat3(0), 20.0 * glm::dvec3(any(random), any(random), any(random))};
            for (int column = 0; column < 3; ++column)
                map.linear[column] = glm::dvec3(any(random), any(random), any(random));
            if (!is_degenerate(map.linear))
                scene.graph.groups[0].placements.push_back(place({.matrix = map}));
        }
        const FlatGraph flat = flattened(scene);
        Frame frame(scene, {});
        frame.build_all(best_target());
        const FrameHeader& h = frame.header();
        const std::vector<GraphNodeRecord> nodes(h.graph.get(), h.graph.get() + h.graph_count);
        ASSERT_GT(nodes.size(), scene.graph.groups[0].placements.size());
        std::vector<int> leaf_of(flat.instances.size(), -1);
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (nodes[n].instance >= 0)
                leaf_of[static_cast<std::size_t>(nodes[n].instance)] = static_cast<int>(n);
        for (int p = 0; p < h.patch_count; ++p) {
            const float* origin = instance_of(frame, p).origin;
            for (const BlockView& b : blocks_of(frame, p)) {
                const int leaf = leaf_of.at(static_cast<std::size_t>(b.header->instance));
                ASSERT_GE(leaf, 0);
                const GraphNodeRecord& r = nodes[static_cast<std::size_t>(leaf)];
                const Box box{{r.low[0], r.low[1], r.low[2]}, {r.high[0], r.high[1], r.high[2]}};
                for (int v = 0; v < b.header->stride; ++v, ++vertices) {
                    const Point x = b.vertex(v);
                    ASSERT_TRUE(box.contains(
                        {double{x[0]} + origin[0], double{x[1]} + origin[1], double{x[2]} + origin[2]}));
                }
            }
        }
    }
    EXPECT_GT(vertices, 20000U);
}

/// Where the frame puts control point i of an instance, relative to the instance's origin.
glm::dvec3 placed(Frame& frame, int instance, std::size_t i) {
    const InstanceRecord& r = frame.header().instances.get()[instance];
    const float* p = frame.header().points.get() + 3 * i;
    if (r.moved == 0)
        return {p[0], p[1], p[2]};
    glm::dvec3 q(r.offset[0], r.offset[1], r.offset[2]);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            q[row] += double{r.linear[3 * row + column]} * p[column];
    return q;
}

/// A unit cube 1e12 away, where double precision is 1e-4 fine: its edges keep their lengths.
TEST(Instances, KeepTheirShapeFarAway) {
    Scene scene = scene_of(snapped(cube_cage()), 40);
    scene.graph.groups = {
        {"scene",
         {place({.scale = glm::dvec3(0.37), .rotate = {0, 90, 0}, .translate = {1e12 + 0.3, 0.1, 7}})}}};
    Frame frame(scene, {});
    const std::vector<glm::dvec3>& cage = scene.meshes[0].points;
    for (std::size_t i = 0; i < cage.size(); ++i) {
        const glm::dvec3 turned(cage[i].z, cage[i].y, -cage[i].x);
        const glm::dvec3 first(cage[0].z, cage[0].y, -cage[0].x);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR((placed(frame, 0, i) - placed(frame, 0, 0))[k], 0.37 * (turned - first)[k], 1e-6);
    }
}

TEST(Instances, StandWhereDoublePrecisionPutsThem) {
    Scene scene = scene_of(cube_cage(), 40);
    scene.graph.groups = {{"scene",
                           {place({.rotate = {10, 20, 30}, .translate = {1000.3, 0.1, 7.7}}),
                            place({.scale = {0.3, -0.7, 1.1}, .translate = {-57.7, 3.3, 0.9}})}}};
    const FlatGraph flat = flattened(scene);
    Frame frame(scene, {});
    const std::vector<glm::dvec3>& cage = scene.meshes[0].points;
    for (int n = 0; n < 2; ++n)
        for (std::size_t i = 0; i < cage.size(); ++i) {
            const glm::dvec3 expected = world_of(flat, flat.instances[static_cast<std::size_t>(n)])(cage[i]);
            const float* origin = frame.header().instances.get()[n].origin;
            const glm::dvec3 at = placed(frame, n, i);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(frame.origin()[k] + origin[k] + at[k], expected[k], 5e-7);
        }
}

TEST(Instances, CityLooksLikeModelsWrittenOut) {
    const std::filesystem::path table =
        std::filesystem::path(RAZOR_SHARED_SCENES) / "kenney_city/city.instances";
    if (!std::filesystem::exists(table))
        GTEST_SKIP() << "no shared scene " << table;
    FramingOptions framing;
    framing.scheme = Scheme::bilinear;
    framing.settings = {.width = 96, .height = 64, .samples = 1, .light_samples = 1, .sky_samples = 1};
    const Scene scene = build_scene(describe(table, framing));
    EXPECT_EQ(scene.meshes.size(), 16U) << "15 models and the floor";
    const TemporaryFolder folder;
    const std::vector<float> film = rendered(scene, best_target());
    const std::vector<float> expected = rendered(written_out(scene, folder), best_target());
    EXPECT_GT(hit_pixels(scene, film), 96U * 64U / 2);
    const std::size_t pixels = film.size() / film_planes;
    const std::size_t moved = other_depths(film, expected);
    EXPECT_LE(moved, pixels / 1000);
    Frame frame(scene, {});
    EXPECT_EQ(frame.statistics().instances, 122);
}

} // namespace
} // namespace razor::test
