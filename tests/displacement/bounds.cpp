// Rays from inside displaced bodies, at all levels of detail: none escapes, and hits are those of the finest
// triangulation by its definition. Where boxes were too small for what displacement makes of a surface, or
// neighbours disagreed about a point, rays would get through.
#include "razor/check/dump.h"
#include "razor/check/escapes.h"
#include "razor/check/field_surface.h"
#include "razor/frame/displacement.h"
#include "tests/displacement/heights.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace razor::test {
namespace {

using Cage = Mesh (*)();
Mesh creased_cube() {
    Mesh m = cube_cage();
    m.creases = {{0, 1, 10}, {1, 3, 2.5F}, {3, 2, 4}, {5, 7, 10}};
    m.corners = {{6, 10}};
    return m;
}
Mesh chaikin_cube() {
    Mesh m = creased_cube();
    m.crease_method = CreaseMethod::chaikin;
    return m;
}
Mesh small_torus() {
    return torus_cage(7, 5);
}
Mesh pyramid() { // triangles
    Mesh m;
    m.name = "pyramid";
    m.points = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1.4, 0}, {0, -1.2, 0}};
    for (int k = 0; k < 4; ++k) {
        const int a = k, b = (k + 1) % 4;
        m.face_sizes.insert(m.face_sizes.end(), {3, 3});
        m.face_vertices.insert(m.face_vertices.end(), {b, a, 4, a, b, 5});
    }
    return m;
}
template <Cage cage> Mesh stretched_one() {
    return stretched(cage());
}
template <Cage cage> Mesh straight_one() {
    return bilinear(cage());
}

struct Case {
    const char* name;
    Cage cage;
    double amplitude; // of the heights, the body being about 2 wide
};
const Case cases[] = {
    {"cube", cube_cage, 0.15},
    {"creased", creased_cube, 0.15},
    {"chaikin", chaikin_cube, 0.1},
    {"torus", small_torus, 0.1},
    {"urchin", urchin_cage, 0.1},
    {"pyramid", pyramid, 0.15},
    {"stretched_urchin", stretched_one<urchin_cage>, 0.05},
    {"stretched_torus", stretched_one<small_torus>, 0.05},
    {"tapered", tapered_cage, 0.1},
    {"straight_cube", straight_one<cube_cage>, 0.15},
    {"straight_urchin", straight_one<urchin_cage>, 0.1},
    {"straight_pyramid", straight_one<pyramid>, 0.1},
    {"straight_slab", straight_one<bevelled_slab>, 0.02},
};

void expect_none_escapes(Scene scene, Lod lod, const std::string& what, std::int64_t rays) {
    scene.settings.lod = lod;
    Frame frame(scene, {});
    check::EscapeOptions options;
    if (const char* text = std::getenv("RAZOR_DISPLACED_RAYS"))
        rays = std::strtoll(text, nullptr, 10);
    options.rays = rays;
    options.compared = check::sees_one_surface(lod) ? rays / 8 : 0;
    options.rays_an_origin = 400;
    const check::EscapeReport r = check::shoot_from_inside(frame, *native_targets().back(), lod, options);
    EXPECT_GT(r.origins, 0) << what;
    EXPECT_EQ(r.escapes, 0) << what << ": " << r.holes << " of them holes";
    EXPECT_EQ(r.different, 0) << what << ", of " << r.compared;
}

/// The box of all finest vertices under a block; counts where the block's own, or one under it, does not hold
/// them.
check::Extent hold_finest(Frame& frame, int line, int& outside, int& coarse) {
    const check::BlockView b = check::block_at(frame, line);
    const BlockHeader& h = *b.header;
    check::Extent all;
    if (h.level == 0)
        for (int v = 0; v < h.stride; ++v) {
            const check::Point p = b.vertex(v);
            all.add(glm::dvec3(p[0], p[1], p[2]));
        }
    else
        for (int k = 0; k < children_in(h.child_shape); ++k)
            all.add(hold_finest(frame, h.child_line + k * lines_between(h.child_shape), outside, coarse));
    coarse += h.level > 0 ? 1 : 0;
    for (int k = 0; k < 3; ++k)
        if (all.low[k] < double{h.box_low[k]} || all.high[k] > double{h.box_high[k]}) {
            ++outside;
            break;
        }
    return all;
}

/// `shaded`: what the camera sees had its normals before what is finer was made.
void expect_boxes_hold(const Scene& scene, const std::string& what, bool shaded = false) {
    Frame frame(scene, {});
    if (shaded)
        frame.render(*native_targets().back(), 0);
    frame.build_all(*native_targets().back());
    int outside = 0, coarse = 0;
    for (int n = 0; n < frame.instances(); ++n) {
        const InstanceRecord& instance = frame.header().instances.get()[n];
        for (int p = instance.first_patch; p < instance.first_patch + instance.patch_count; ++p) {
            const OpenPatch& open = frame.header().trees.get()->patches.get()[p];
            ASSERT_EQ(open.state.word, ready);
            hold_finest(frame, open.root, outside, coarse);
        }
    }
    EXPECT_GT(coarse, 40) << what;
    EXPECT_EQ(outside, 0) << what << ", blocks of " << coarse << " do not hold what is finer";
}

TEST(Bodies, BoxesHoldWhatIsFinerWhateverWasShadedBefore) {
    for (const Case& c : cases) {
        const Mesh cage = c.cage();
        if (cage.scheme == Scheme::bilinear) // flat ones have no levels
            continue;
        Scene scene = scene_of(cage, 600);
        scene.settings.lod = Lod::recursive;
        scene.settings.width = scene.settings.height = 128;
        expect_boxes_hold(scene, c.name, true);
    }
}

class DisplacedBodies : public testing::TestWithParam<Case> {};

TEST_P(DisplacedBodies, LetNoRayThrough) {
    const Case& c = GetParam();
    const struct {
        const char* name;
        Texture texture;
        double scale;
    } maps[] = {{"smooth", smooth_heights(), 1},
                {"random", random_heights(), -0.6},
                {"steps", stepped_heights(), 0.7},
                {"noise", pattern_heights(PatternKind::noise), 0.5},
                {"checks", pattern_heights(PatternKind::checker), -0.3}};
    for (const auto& map : maps)
        for (const bool seams : {false, true}) {
            if (map.texture.pattern && !seams)
                continue;
            const Mesh mesh = seams ? with_seams(c.cage()) : with_smooth_texcoords(c.cage());
            const Scene scene = displaced_scene(mesh, 150, map.texture, map.scale * c.amplitude, 0.3);
            const std::string what = fmt::format("{}, {}{}", c.name, map.name, seams ? ", seams" : "");
            expect_boxes_hold(scene, what);
            expect_none_escapes(scene, Lod::recursive, what, 12'000);
        }
}

INSTANTIATE_TEST_SUITE_P(Cages, DisplacedBodies, testing::ValuesIn(cases),
                         [](const auto& c) { return std::string(c.param.name); });

// An edge of the slab's walls spans 32 quads. Where its vertices hang from it at level 0 they do at all
// levels, though at coarser ones the wall's side is a longer edge yet, which displacement leaves elsewhere:
// two blocks that share the edge's quarter, of which one finds it from its parents, have it at one place. In
// millions of rays one hit neither.
TEST(DisplacedEdges, HangFromTheSameEdgeAtAllLevels) {
    const Mesh mesh = with_seams(straight_one<bevelled_slab>());
    Scene scene = displaced_scene(mesh, 150, smooth_heights(), 0.02, 0.3);
    scene.settings.lod = Lod::recursive;
    for (const KernelTable* kernels : native_targets()) {
        Frame frame(scene, {});
        check::Tracer tracer(frame, 1, 1);
        frame.build_all(*kernels);
        const check::Ray ray{.origin = {0x1.a6efbcp-2F, -0x1.226026p-6F, 0x1.0e5a1ep-5F},
                             .direction = {0x1.5dd1dp-3F, -0x1.33bc02p-3F, 0x1.f29328p-1F},
                             .base = 0x1.af20e8p-5F,
                             .growth = -0x1.99999ap-4F};
        const check::FieldSurface surface(frame);
        const auto crossings = check::SeenSurface(surface, ray).crossings(ray, 0);
        ASSERT_EQ(crossings.size(), 1U);
        const check::Hit hit = tracer.closest(*kernels, {ray}).front();
        ASSERT_GE(hit.patch, 0) << kernels->name << ": through the wall";
        EXPECT_NEAR(hit.t, crossings.front().t, 1e-5) << kernels->name;
    }
}

// What is made finer later is bounded by how fast heights change.
TEST(HeightSlopes, BoundPatterns) {
    for (int kind = 0; kind < 6; ++kind) {
        Texture t = pattern_heights(static_cast<PatternKind>(kind));
        const HeightSlopes slopes = height_slopes(t).at(0);
        double steepest = 0;
        for (int k = 0; k < 40'000; ++k) {
            const glm::dvec2 at(0.0173 * k, 0.0117 * k + 0.3 * std::sin(k));
            constexpr double step = 1e-5;
            const double u = std::abs(lookup(t, at + glm::dvec2(step, 0), 0) - lookup(t, at, 0));
            const double v = std::abs(lookup(t, at + glm::dvec2(0, step), 0) - lookup(t, at, 0));
            EXPECT_LE(u, double{slopes.u} * step * (1 + 1e-3)) << kind;
            EXPECT_LE(v, double{slopes.v} * step * (1 + 1e-3)) << kind;
            steepest = std::max({steepest, u / double{slopes.u} / step, v / double{slopes.v} / step});
        }
        if (kind >= static_cast<int>(PatternKind::noise)) {
            EXPECT_GT(steepest, 0.2) << kind << ": bounds that say nothing";
        }
    }
}

TEST(DisplacedInstances, LetNoRayThrough) {
    Scene scene = displaced_scene(with_seams(creased_cube()), 60, smooth_heights(), 0.2, 0.5);
    scene.graph = instances_of(cube_cage(), 60).graph;
    expect_boxes_hold(scene, "instances");
    expect_none_escapes(scene, Lod::recursive, "instances", 12'000);
    expect_none_escapes(scene, Lod::object, "instances, one level", 12'000);
}

TEST(DisplacedFaces, OfSeveralMaterialsLetNoRayThrough) {
    Mesh mesh = with_seams(urchin_cage());
    for (std::size_t f = 0; f < mesh.face_sizes.size(); ++f)
        mesh.face_materials.push_back(static_cast<int>(f % 3));
    Scene scene = displaced_scene(mesh, 120, smooth_heights(), 0.1, 0.5);
    scene.materials.resize(3, scene.materials[0]);
    scene.materials[1].displacement_map.texture = -1; // not displaced
    scene.materials[2].displacement_scale = -0.05F;
    scene.materials[2].displacement_map.scale = {2, 3};
    expect_boxes_hold(scene, "faces of three materials");
    expect_none_escapes(scene, Lod::recursive, "faces of three materials", 20'000);
}

} // namespace
} // namespace razor::test
