// Objects that hang on tags of MD3 models, against the same by hand.
#include "razor/scene/attachment.h"

#include "razor/scene/animation/moving_scene.h"
#include "razor/scene/animation/pose.h"
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/same_scene.h"
#include "tests/scene/temporary_folder.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace razor {
namespace {

constexpr double quarter = std::numbers::pi / 2;

glm::dvec3 about_x(double angle, const glm::dvec3& p) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}

glm::dvec3 about_z(double angle, const glm::dvec3& p) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

/// How far a unit quaternion has turned from none towards a quarter turn, the chord between them being passed
/// evenly.
double turned(double x) {
    const double half = quarter / 2;
    return 2 * std::atan2(x * std::sin(half), 1 - x + x * std::cos(half));
}

constexpr std::array<float, 9> quarter_about_z{0, 1, 0, -1, 0, 0, 0, 0, 1};
constexpr std::array<float, 9> quarter_about_x{1, 0, 0, 0, 0, 1, 0, -1, 0};
constexpr std::array<float, 9> mirrored{1, 0, 0, 0, 1, 0, 0, 0, -1};

/// What tag_torso does to a point, and tag_head, `x` of the way from frame 0 to frame 1.
glm::dvec3 torso(double x, const glm::dvec3& p) {
    return glm::dvec3(4 * x, 0, 3) + about_z(turned(x), p);
}
glm::dvec3 head(double x, const glm::dvec3& p) {
    return glm::dvec3(0, 0, 2 + x) + about_x(turned(x), p);
}

/// A figure of three parts, a second from frame to frame.
class Attachments : public ::testing::Test {
protected:
    Attachments() {
        const auto model = [&](std::string_view name, const std::vector<Md3TagFrames>& tags) {
            folder_.file(name, write_md3(two_surfaces(), 2, tags));
        };
        model("lower.md3",
              {{"tag_floor", {{}, {}}}, {"tag_torso", {{{0, 0, 3}}, {{4, 0, 3}, quarter_about_z}}}});
        model("upper.md3",
              {{"tag_head", {{{0, 0, 2}}, {{0, 0, 3}, quarter_about_x}}}, {"tag_bad", {{}, {{}, mirrored}}}});
        model("head.md3", {});
        folder_.file("still.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    }

    /// With these keys in each mesh, and in each object.
    static std::string figure(std::string_view mesh_keys = "", std::string_view lower = "",
                              std::string_view upper = "", std::string_view head = "") {
        std::string text;
        for (const std::string_view part : {"lower", "upper", "head"})
            text += fmt::format("[[mesh]]\nfile = \"{}.md3\"\nframe_rate = 1\n{}\n", part, mesh_keys);
        // Carriers may come later, and need not stand first.
        return text +
               fmt::format("[[object]]\nmesh = \"head\"\nattach = \"upper\"\ntag = \"tag_head\"\n{}\n"
                           "[[object]]\nmesh = \"lower\"\n{}\n"
                           "[[object]]\nmesh = \"upper\"\nattach = \"lower\"\ntag = \"tag_torso\"\n{}\n",
                           head, lower, upper);
    }

    SceneDescription scene(std::string_view text) const {
        return parse_scene_file(text, "s.toml", folder_.path());
    }
    std::string message(std::string_view text) const {
        try {
            scene(text);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
            return error.what();
        }
        return {};
    }

    TemporaryFolder folder_;
};

/// Where object `number` of the scene puts points of its cage, `seconds` after the beginning.
Affine place_of(const SceneDescription& scene, std::size_t number, double seconds) {
    const SceneDescription posed = pose_at(scene, seconds);
    EXPECT_FALSE(posed.objects[number].attachment);
    const Affine local = to_affine(posed.objects[number].transform);
    const SceneGraph graph = build_graph(posed);
    EXPECT_EQ(to_affine(graph.groups[0].placements[number].local), local);
    return local;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-13 * (1 + glm::length(b)))
        << fmt::format("{} {} {} is not {} {} {}", a.x, a.y, a.z, b.x, b.y, b.z);
}

const std::array<glm::dvec3, 4> probes{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, -3, 5}}};

TEST_F(Attachments, ChainsGoWhereTagsGo) {
    const SceneDescription s = scene(figure());
    EXPECT_TRUE(is_animated(s));
    for (const double t : {0.0, 0.25, 0.5, 0.8, 1.0, 3.0}) {
        const double x = std::min(t, 1.0);
        for (const glm::dvec3& p : probes) {
            expect_near(place_of(s, 1, t)(p), p);
            expect_near(place_of(s, 2, t)(p), torso(x, p));
            expect_near(place_of(s, 0, t)(p), torso(x, head(x, p)));
        }
    }
    EXPECT_NEAR(turned(0.5), quarter / 2, 1e-15);
}

TEST_F(Attachments, FramesArePlayedAsThoseOfTheMesh) {
    const auto at = [&](std::string_view keys, double seconds) {
        return place_of(scene(figure(keys)), 0, seconds);
    };
    for (const glm::dvec3& p : probes) {
        const auto expected = [&](double x) { return torso(x, head(x, p)); };
        expect_near(at("cycle = 2", 4.25)(p), expected(0.25));
        expect_near(at("cycle = 2", 5.5)(p), expected(0.5)); // on the way back to frame 0
        expect_near(at("speed = 0.5\nstart = 0.2", 0.6)(p), expected(0.5));
        expect_near(at("moment = 0.75", 9)(p), expected(0.75));
        expect_near(at("frames = [1, 1]", 0)(p), expected(1));
        expect_near(at("interpolation = \"step\"", 0.9)(p), expected(0));
        expect_near(at("interpolation = \"smooth\"", 0.5)(p), expected(0.5)); // of two frames
    }
    EXPECT_FALSE(is_animated(scene(figure("frames = [1, 1]"))));
}

/// All three meshes in other units, turned and shifted: the figure is as the files say, and then that.
TEST_F(Attachments, MeshesOfOneFigureAreScaledTogether) {
    const SceneDescription s = scene(figure("scale = 0.25\nrotate = [-90, 0, 0]\ntranslate = [0, 7, 1]"));
    const auto placed = [](const glm::dvec3& p) { return glm::dvec3(0, 7, 1) + about_x(-quarter, 0.25 * p); };
    for (const double t : {0.0, 0.3, 1.0})
        for (const glm::dvec3& p : probes) {
            expect_near(place_of(s, 2, t)(placed(p)), placed(torso(t, p)));
            expect_near(place_of(s, 0, t)(placed(p)), placed(torso(t, head(t, p))));
        }
}

TEST_F(Attachments, TransformsAndKeysAreBesideTheTag) {
    const std::string keys = "[[object.key]]\ntime = 0\ntranslate = [0, 0, 0]\n[[object.key]]\ntime = 1\n"
                             "translate = [0, 8, 0]\n";
    const SceneDescription s =
        scene(figure("", "scale = 2\n" + keys, "rotate = [0, 0, 90]", "scale = 3\n" + keys));
    for (const double t : {0.0, 0.25, 1.0})
        for (const glm::dvec3& p : probes) {
            const auto lower = [&](const glm::dvec3& q) { return glm::dvec3(0, 8 * t, 0) + 2.0 * q; };
            const auto upper = [&](const glm::dvec3& q) { return lower(torso(t, about_z(quarter, q))); };
            expect_near(place_of(s, 2, t)(p), upper(p));
            expect_near(place_of(s, 0, t)(p), upper(head(t, glm::dvec3(0, 8 * t, 0) + 3.0 * p)));
        }
    // Built without being posed: as when the scene begins, without keys.
    for (std::size_t o = 0; o < 3; ++o)
        EXPECT_EQ(to_affine(build_graph(s).groups[0].placements[o].local), place_of(s, o, 0));
}

TEST_F(Attachments, GroupsOfFiguresArePlacedWhole) {
    std::string text = figure();
    for (std::size_t at = 0; (at = text.find("[[object]]", at)) != std::string::npos; at += 16)
        text.replace(at, 10, "[[group.object]]");
    text.insert(text.find("[[group.object]]"), "[[group]]\nname = \"figure\"\n");
    const SceneDescription s =
        scene(text + "[[object]]\ngroup = \"figure\"\narray = [2, 1, 1]\nspacing = [9, 0, 0]\n");
    const SceneDescription posed = pose_at(s, 0.5);
    const FlatGraph flat = flatten(build_graph(posed), mesh_bounds(posed));
    ASSERT_EQ(flat.instances.size(), 6U);
    for (std::size_t copy = 0; copy < 2; ++copy)
        for (const glm::dvec3& p : probes)
            expect_near(flat.nodes[static_cast<std::size_t>(flat.instances[3 * copy].node)].world(p),
                        glm::dvec3(9.0 * static_cast<double>(copy), 0, 0) + torso(0.5, head(0.5, p)));
}

TEST_F(Attachments, PrintedAndReadTheyAreTheSame) {
    const SceneDescription s = scene(figure("cycle = 2", "scale = 2", "", "rotate = [0, 10, 0]"));
    for (const SceneDescription& d : {s, pose_at(s, 0.75)}) {
        const SceneDescription again = scene(to_toml(d));
        EXPECT_EQ(to_toml(again), to_toml(d));
        for (const double t : {0.0, 0.3, 1.5})
            for (std::size_t o = 0; o < 3; ++o)
                EXPECT_EQ(place_of(again, o, t), place_of(d, o, t));
    }
}

TEST_F(Attachments, MovingScenesMoveThemWithTheirCarriers) {
    const SceneDescription s = scene(
        figure("", "[[object.key]]\ntime = 2\ntranslate = [0, 0, 0]\n[[object.key]]\ntime = 3\ntranslate "
                   "= [1, 0, 0]\n"));
    MovingScene moving(s);
    for (const double t : {0.0, 0.5, 1.0, 1.5, 2.5, 2.5, 0.25}) {
        moving.go_to(t);
        EXPECT_EQ(to_toml(moving.description()), to_toml(pose_at(s, t))) << t;
        expect_same(moving.scene(), build_scene(pose_at(s, t)));
        for (std::size_t o = 0; o < 3; ++o)
            EXPECT_EQ(to_affine(moving.scene().graph.groups[0].placements[o].local), place_of(s, o, t));
    }
    // Another place of the carrier takes all along.
    SceneDescription edited = s;
    edited.objects[1].keys = {};
    edited.objects[1].transform.translate = {0, 0, 50};
    moving.take_over(edited, std::array{PlacementName{-1, 1}});
    moving.go_to(0.5);
    EXPECT_EQ(moving.changes()->placements.size(), 3U);
    for (const glm::dvec3& p : probes)
        expect_near(to_affine(moving.scene().graph.groups[0].placements[0].local)(p),
                    glm::dvec3(0, 0, 50) + torso(0.5, head(0.5, p)));
}

TEST_F(Attachments, MistakesAreNamed) {
    const auto expect = [&](const std::string& text, std::string_view part) {
        const std::string found = message(text);
        EXPECT_EQ(found.find("s.toml:"), 0U) << found;
        EXPECT_NE(found.find(part), std::string::npos) << found;
    };
    const auto replaced = [](std::string text, std::string_view what, std::string_view by) {
        const std::size_t at = text.find(what);
        EXPECT_NE(at, std::string::npos);
        return text.replace(at, what.size(), by);
    };
    const std::string good = figure();
    expect(replaced(good, "tag = \"tag_head\"", ""), "write attach and one of them, or nothing");
    expect(replaced(good, "attach = \"lower\"", ""), "write attach and one of them, or nothing");
    expect(
        replaced(good, "attach = \"upper\"", "attach = \"uper\""),
        "there is no object 'uper' beside this one, in the group or the scene that holds it; it has: head, "
        "lower, upper");
    expect(replaced(good, "tag_torso", "tag_torsoe"),
           "the mesh 'lower' has no tag 'tag_torsoe'; it has: tag_floor, tag_torso");
    expect(replaced(good, "tag_head", "tag_bad"),
           "the axes of the tag 'tag_bad' of 'upper' are flat, mirrored or not finite in frame 1; ");
    expect(figure("frames = [1, 1]") + "[[object]]\nmesh = \"head\"\nname = \"x\"\nattach = \"upper\"\ntag = "
                                       "\"tag_bad\"\n",
           "not finite in frame 1; ");
    expect(good + "[[object]]\nmesh = \"lower\"\n", "2 objects beside this one are called 'lower'");
    expect(figure("", "array = [2, 1, 1]\nspacing = [1, 0, 0]"), "'lower' is an array");
    expect(figure("[[mesh.deform]]\nkind = \"wave\"\n"), "the mesh 'upper' has deformations");
    expect(figure("", "attach = \"lower\"\ntag = \"tag_floor\""),
           "'lower' hangs on itself: lower on lower; ");
    expect(figure("", "attach = \"upper\"\ntag = \"tag_head\""),
           "hangs on itself: upper on lower on upper; attach one of them to nothing");
    expect("[[mesh]]\nfile = \"still.obj\"\n[[object]]\nmesh = \"still\"\n[[object]]\nname = \"b\"\nmesh = "
           "\"still\"\nattach = \"still\"\ntag = \"tag\"\n",
           "'still' has no tags to attach to");
    expect(
        "[[mesh]]\nfile = \"still.obj\"\n[[group]]\nname = \"g\"\n[[group.object]]\nmesh = "
        "\"still\"\n[[object]]\ngroup = \"g\"\n[[object]]\nmesh = \"still\"\nattach = \"g\"\ntag = \"tag\"\n",
        "'g' has no tags to attach to");
}

/// Axes as exporters round them, and worse; flat ones and mirrored ones are of no use.
TEST(Tags, AxesAreMadeATurn) {
    const auto one = [](const glm::dmat3& axes) { return Tags({{"t", {{axes, {1, 2, 3}}}}}, 1, {}); };
    const Tags skewed = one({{2, 0, 0}, {0.1, 3, 0}, {0.2, -0.1, 0.5}});
    ASSERT_FALSE(skewed.bad_frame(0));
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LT(glm::length(skewed.at(0, 0).linear[axis] - glm::dmat3(1)[axis]), 1e-15);
    EXPECT_EQ(skewed.at(0, 7).translation, glm::dvec3(1, 2, 3));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const glm::dmat3& bad :
         {glm::dmat3(0), glm::dmat3({1, 0, 0}, {0, 1, 0}, {0, 0, -1}),
          glm::dmat3({1, 0, 0}, {1, 0, 0}, {0, 0, 1}), glm::dmat3({1, 0, 0}, {0, 1, 0}, {1, 1, 0}),
          glm::dmat3({1, 0, 0}, {0, nan, 0}, {0, 0, 1})})
        EXPECT_EQ(one(bad).bad_frame(0), 0U);
}

/// The stored sign of a quaternion says nothing: from 150 to 210 degrees it is 60 degrees, not 300.
TEST(Tags, TurnsGoTheShortWay) {
    const auto turn = [](double degrees) {
        const double a = degrees * std::numbers::pi / 180;
        return Affine{{{std::cos(a), std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, {0, 0, 1}}, {}};
    };
    for (const Interpolation between : {Interpolation::linear, Interpolation::smooth})
        for (double first = 0; first < 360; first += 30) {
            const Tags tags({{"t", {turn(first), turn(first + 60), turn(first + 120)}}}, 1,
                            {.interpolation = between});
            for (const double t : {0.0, 0.5, 1.0, 1.5, 2.0}) {
                const glm::dvec3 x = tags.at(0, t).linear[0], about = turn(first + 60 * t).linear[0];
                // Cubics are not even: they are within some degrees.
                EXPECT_LT(glm::length(x - about), between == Interpolation::linear ? 1e-14 : 0.1)
                    << first << ' ' << t;
            }
        }
}

} // namespace
} // namespace razor
