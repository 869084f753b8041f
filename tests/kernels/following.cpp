// Frames that go from moment to moment: what they write anew, and that nothing of the moments before is left.
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"
#include "tests/scene/random_graph.h"

#include "razor/native/render.h"
#include "razor/scene/error.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <set>
#include <string>

namespace razor::test {
namespace {

using glm::dvec3;

Scene still_scene(int placements, int seed) {
    Random random(static_cast<unsigned>(seed));
    Scene s = scene_of(cube_cage(), 10);
    s.meshes[0].edge_length = 0; // by the camera
    s.meshes.push_back(bilinear(torus_cage(6, 5)));
    s.meshes.push_back(urchin_cage());
    for (Mesh& mesh : s.meshes)
        mesh.rest = mesh.points;
    s.graph.groups = {{"scene", {}}, {"pair", {place(0), place(2, {.translate = {2, 0.5, 0}})}}};
    for (int i = 0; i < placements; ++i) {
        Placement p = i % 4 == 3 ? place_group(1) : place(i % 3);
        p.local = random.transform(0.2);
        p.local.matrix.reset();
        if (i % 5 == 4) {
            p.copies = {2, 1, 3};
            p.spacing = {3, 0, 4};
        }
        s.graph.groups[0].placements.push_back(p);
    }
    s.camera.position = {0, 6, 40};
    s.camera.target = {0, 0, 0};
    s.settings = {
        .width = 16, .height = 16, .samples = 1, .light_samples = 1, .sky_samples = 1, .edge_pixels = 4};
    return s;
}

/// Numbers of records are those of the moments before; what is below which, in which order, is not.
void append_nodes(const FrameHeader& h, std::string& bytes) {
    std::vector<std::int32_t> open{0};
    while (!open.empty()) {
        GraphNodeRecord r = h.graph.get()[open.back()];
        open.pop_back();
        for (int k = r.instance < 0 ? r.child_count : 0; k-- > 0;)
            open.push_back(r.first_child + k);
        r.first_child = 0;
        bytes.append(reinterpret_cast<const char*>(&r), sizeof r);
    }
}

template <class T> void append(std::string& bytes, const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// All that outlives a frame, and the film, once it is rendered.
std::vector<std::pair<const char*, std::string>> contents(Frame& frame, std::size_t points) {
    const FrameHeader& h = frame.header();
    std::vector<std::pair<const char*, std::string>> all;
    append(all.emplace_back("instances", "").second, h.instances.get(),
           static_cast<std::size_t>(frame.instances()));
    append_nodes(h, all.emplace_back("graph", "").second);
    append(all.emplace_back("points", "").second, h.points.get(), 3 * points);
    std::string& boxes = all.emplace_back("cluster boxes", "").second;
    for (int k = 0; k < 6; ++k)
        append(boxes, h.cluster_boxes.get() + k * h.clusters_stride,
               static_cast<std::size_t>(h.cluster_count));
    std::string& view = all.emplace_back("view", "").second;
    append(view, h.camera, 3);
    append(view, &h.reach, 1);
    append(view, h.field_origin, 3);
    append(view, h.lights.get(), static_cast<std::size_t>(h.light_count));
    append(all.emplace_back("film", "").second, h.film.get(),
           static_cast<std::size_t>(h.width * h.height * film_planes));
    return all;
}

void expect_as_new(Frame& frame, const Scene& scene, const std::string& when) {
    const KernelTable& kernels = *native_targets().back();
    run_workers(frame, kernels);
    Frame fresh(scene, {.moves = true});
    run_workers(fresh, kernels);
    std::size_t points = 0;
    for (const Mesh& mesh : scene.meshes)
        points += mesh.points.size();
    const auto mine = contents(frame, points), expected = contents(fresh, points);
    for (std::size_t i = 0; i < mine.size(); ++i)
        EXPECT_TRUE(mine[i].second == expected[i].second) << mine[i].first << " " << when;
    EXPECT_EQ(frame.unit(), fresh.unit()) << when;
    EXPECT_EQ(frame.origin(), fresh.origin()) << when;
    EXPECT_EQ(frame.statistics().graph_nodes, fresh.statistics().graph_nodes) << when;
}

/// One step of a scene's life; what it does not change it does not name.
SceneChanges change(Scene& scene, Random& random) {
    SceneChanges changes;
    std::set<std::pair<int, int>> placements;
    for (int n = random.whole(0, 3); n > 0; --n) {
        const int group = random.whole(0, 4) == 0 ? 1 : 0;
        std::vector<Placement>& all = scene.graph.groups[static_cast<std::size_t>(group)].placements;
        const int which = random.whole(0, static_cast<int>(all.size()) - 1);
        Transform& t = all[static_cast<std::size_t>(which)].local;
        switch (random.whole(0, 7)) {
        case 0:
            t.translate += 0.01 * random.vector(-1, 1);
            break;
        case 1:
            t.translate = random.vector(-30, 30);
            break;
        case 2:
            t = {};
            break; // where the mesh stands
        case 3:
            t.translate.x += 1e6;
            break;
        case 4:
            t.scale = dvec3(1e-7);
            break;
        case 5:
            t.scale = random.vector(0.5, 4) * random.sign();
            break;
        case 6:
            t.translate = {};
            break;
        default:
            t.rotate = random.vector(-180, 180);
            break;
        }
        placements.insert({group, which});
    }
    for (const auto& [group, which] : placements)
        changes.placements.push_back({group, which});
    if (random.whole(0, 3) == 0) {
        const int mesh = random.whole(0, 2);
        Mesh& cage = scene.meshes[static_cast<std::size_t>(mesh)];
        const int how = random.whole(0, 3);
        for (dvec3& p : cage.points)
            p = how == 0 ? dvec3(0.5) : how == 1 ? -p : p + 0.1 * random.vector(-1, 1);
        changes.meshes.push_back(mesh);
    }
    if (random.whole(0, 4) == 0)
        scene.camera.position += random.vector(-3, 3);
    if (random.whole(0, 4) == 0)
        scene.lights[0].corner += random.vector(-1, 1);
    return changes;
}

TEST(Following, IsAsANewFrame) {
    for (const Lod lod : {Lod::recursive, Lod::fixed, Lod::object}) {
        Random random(static_cast<unsigned>(lod) + 3);
        Scene scene = still_scene(14, 5);
        scene.settings.lod = lod;
        Frame frame(scene, {.moves = true});
        std::int64_t little = 0;
        for (int step = 0; step < 60; ++step) {
            const Scene before = scene;
            const SceneChanges changes = change(scene, random);
            ASSERT_TRUE(frame.pose(scene, changes));
            expect_as_new(frame, scene, "after step " + std::to_string(step));
            little += frame.statistics().touched.instances < frame.instances() / 2 ? 1 : 0;
            if (frame.unit() != 1 || step % 7 == 6) { // 1e6 away, say, is not for ever
                scene = before;
                ASSERT_TRUE(step % 2 == 0 ? frame.pose(scene) : frame.pose(scene, changes));
            }
        }
        EXPECT_GT(little, 10) << "all is written anew again and again";
    }
}

// What is not rendered, or refused, is made good by the next one.
TEST(Following, SkippedAndImpossibleMomentsLeaveNothing) {
    Random random(2);
    Scene scene = still_scene(9, 1);
    Frame frame(scene, {.moves = true});
    for (int step = 0; step < 20; ++step) {
        SceneChanges changes = change(scene, random);
        if (step % 3 != 0) {
            ASSERT_TRUE(frame.pose(scene, changes));
            continue; // nobody looks at this moment
        }
        Scene wrong = scene;
        wrong.graph.groups[0].placements[2].local.translate.y = std::numeric_limits<double>::quiet_NaN();
        SceneChanges more = changes;
        more.placements.push_back({0, 2});
        EXPECT_THROW(frame.pose(wrong, more), UserError);
        ASSERT_TRUE(frame.pose(scene, changes));
        expect_as_new(frame, scene, "after step " + std::to_string(step));
    }
    scene.meshes[1].face_vertices = {0, 1, 2, 3};
    scene.meshes[1].face_sizes = {4};
    EXPECT_FALSE(frame.pose(scene, {{}, {1}}));
}

/// As many instances, but of other meshes in other places, need other tables.
TEST(Following, InstancesOfOtherMeshesAreAnotherFrame) {
    Scene scene = still_scene(9, 1);
    Frame frame(scene, {.moves = true});
    std::vector<Placement>& all = scene.graph.groups[0].placements;
    const auto other = std::find_if(all.begin(), all.end(), [&](const Placement& p) {
        return p.mesh >= 0 && all[0].mesh >= 0 && p.mesh != all[0].mesh;
    });
    ASSERT_NE(other, all.end());
    std::swap(all[0].mesh, other->mesh);
    EXPECT_FALSE(frame.pose(scene));
    std::swap(all[0].mesh, other->mesh);
    EXPECT_TRUE(frame.pose(scene));
}

/// Of many that stand still nothing is looked at: what is touched does not depend on how many there are.
TEST(Following, TouchesWhatMovesAlone) {
    std::vector<Touched> all;
    for (const int side : {8, 32, 64}) {
        Scene scene = still_scene(3, 4);
        Placement many = place(1);
        many.copies = {side, 1, side};
        many.spacing = {4, 0, -4};
        scene.graph.groups[0].placements.push_back(many);
        Frame frame(scene, {.moves = true});
        EXPECT_GT(frame.statistics().touched.instances, side * side);
        run_workers(frame, *native_targets().back());
        scene.graph.groups[0].placements[0].local.translate += dvec3(1e-4, 0, 0);
        ASSERT_TRUE(frame.pose(scene, {{{0, 0}}, {}}));
        all.push_back(frame.statistics().touched);
        EXPECT_EQ(all.back().instances, 1);
        EXPECT_EQ(all.back().meshes, 0);
        EXPECT_EQ(all.back().clusters, 0);
        EXPECT_GT(all.back().graph_nodes, 0);
        EXPECT_LT(all.back().graph_nodes, 12);
        expect_as_new(frame, scene, "of one among " + std::to_string(side * side));
        for (dvec3& p : scene.meshes[2].points)
            p *= 1.01;
        ASSERT_TRUE(frame.pose(scene, {{}, {2}}));
        EXPECT_EQ(frame.statistics().touched.meshes, 1);
        EXPECT_EQ(frame.statistics().touched.instances, 1);
        EXPECT_GT(frame.statistics().touched.clusters, 0);
        EXPECT_LT(frame.statistics().touched.clusters, frame.header().cluster_count);
        expect_as_new(frame, scene, "of one mesh");
    }
}

} // namespace
} // namespace razor::test
