// The scene graph beside plain matrix products in extended precision, in any shape a graph can have.
#include "razor/scene/graph/records.h"

#include "razor/scene/error.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace razor {
namespace {

using Real = long double;
using Vector = std::array<Real, 3>;
/// Rows of a 3 x 4 matrix.
using Matrix = std::array<std::array<Real, 4>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            c[i][j] = j == 3 ? a[i][3] : 0;
            for (std::size_t k = 0; k < 3; ++k) {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    return c;
}

Matrix diagonal(Real x, Real y, Real z) {
    return {{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}};
}

Matrix rotation(std::size_t axis, Real degrees) {
    const Real angle = degrees * std::numbers::pi_v<Real> / 180;
    Matrix m = diagonal(1, 1, 1);
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    m[u][u] = m[v][v] = std::cos(angle);
    m[u][v] = -std::sin(angle);
    m[v][u] = std::sin(angle);
    return m;
}

Matrix matrix_of(const Affine& a) {
    Matrix m{};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = a.linear[j][i];
        }
        m[static_cast<std::size_t>(i)][3] = a.translation[i];
    }
    return m;
}

Matrix matrix_of(const Transform& t) {
    if (t.matrix) {
        return matrix_of(*t.matrix);
    }
    Matrix m = diagonal(t.scale.x, t.scale.y, t.scale.z);
    for (int axis = 0; axis < 3; ++axis) {
        m = product(rotation(static_cast<std::size_t>(axis), t.rotate[axis]), m);
    }
    for (int i = 0; i < 3; ++i) {
        m[static_cast<std::size_t>(i)][3] += t.translate[i];
    }
    return m;
}

Vector image(const Matrix& m, const glm::dvec3& p) {
    Vector r{};
    for (std::size_t i = 0; i < 3; ++i) {
        r[i] = m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3];
    }
    return r;
}

/// The largest entry of the linear part, or distance moved.
Real size_of(const Matrix& m, std::size_t first, std::size_t count) {
    Real size = 0;
    for (const auto& row : m) {
        for (std::size_t j = first; j < first + count; ++j) {
            size = std::max(size, std::abs(row[j]));
        }
    }
    return size;
}

class Random {
public:
    explicit Random(unsigned seed) : random_(seed) {}
    double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    glm::dvec3 vector(double low, double high) {
        return {uniform(low, high), uniform(low, high), uniform(low, high)};
    }
    double sign() { return whole(0, 1) == 0 ? 1 : -1; }
    /// Between 10^-decades and 10^decades.
    double scale(double decades) { return std::pow(10.0, uniform(-decades, decades)); }
    glm::dmat3 turn() {
        Transform t;
        t.rotate = vector(-400, 400);
        return to_affine(t).linear;
    }
    Transform transform(double decades) {
        Transform t;
        const double size = scale(decades);
        t.scale =
            size * glm::dvec3(sign() * uniform(0.3, 3), sign() * uniform(0.3, 3), sign() * uniform(0.3, 3));
        t.rotate = vector(-400, 400);
        t.translate = vector(-10, 10);
        if (whole(0, 2) == 0) {
            t.rotate = 90.0 * glm::dvec3(whole(-5, 5), whole(-5, 5), whole(-5, 5));
        }
        if (whole(0, 3) == 0) { // sheared
            t.matrix =
                Affine{to_affine(t).linear * glm::dmat3(1, 0, 0, uniform(-2, 2), 1, 0, 0, uniform(-2, 2), 1),
                       t.translate};
        }
        return t;
    }
    std::mt19937& engine() { return random_; }

private:
    std::mt19937 random_; // NOLINT(cert-msc32-c,cert-msc51-cpp)
};

std::string refusal(const SceneGraph& graph, const std::vector<Box>& boxes) {
    try {
        flatten(graph, boxes);
    } catch (const UserError& error) {
        return error.what();
    }
    return {};
}

const Box unit_box{{-1, -1, -1}, {1, 1, 1}};

Placement place(int mesh, const Transform& local = {}) {
    return {.name = "mesh", .mesh = mesh, .local = local};
}
Placement place_group(int group, const Transform& local = {}) {
    return {.name = "group", .group = group, .local = local};
}
Transform scaled(double s) {
    return {.scale = glm::dvec3(s)};
}

TEST(Affine, IsScaleThenTurnsThenTranslation) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Transform t = random.transform(12);
        const Affine a = to_affine(t);
        const Matrix m = matrix_of(t);
        const glm::dvec3 p = random.vector(-1, 1);
        const Vector expected = image(m, p);
        const glm::dvec3 got = a(p);
        const Real tolerance = (size_of(m, 0, 3) * 4 + size_of(m, 3, 1)) * 1e-15L;
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(static_cast<double>(got[k] - expected[static_cast<std::size_t>(k)]), 0,
                        static_cast<double>(tolerance));
        }
    }
    Transform quarter;
    quarter.rotate = {90, 180, -270};
    quarter.scale = {1, 2, 3};
    const glm::dmat3 m = to_affine(quarter).linear;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            EXPECT_EQ(m[i][j], std::round(m[i][j])) << "quarter turns are exact";
        }
    }
}

TEST(Affine, SingularValuesOfKnownProducts) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const double size = random.scale(12);
        glm::dvec3 values = size * glm::dvec3(1, random.scale(4), random.scale(4));
        const glm::dmat3 scaling(values.x, 0, 0, 0, values.y, 0, 0, 0, values.z);
        const glm::dmat3 m = random.turn() * scaling * random.turn();
        std::array<double, 3> sorted{values.x, values.y, values.z};
        std::sort(sorted.begin(), sorted.end());
        const glm::dvec3 got = singular_values(m);
        EXPECT_NEAR(got.x, sorted[2], 1e-14 * sorted[2]);
        // The product itself was rounded relative to its largest entries.
        EXPECT_NEAR(got.y, sorted[1], 1e-14 * sorted[2]);
        EXPECT_NEAR(got.z, sorted[0], 1e-14 * sorted[2]);
    }
    EXPECT_EQ(singular_values(glm::dmat3(4)), glm::dvec3(4));
    EXPECT_EQ(singular_values(glm::dmat3(0)), glm::dvec3(0));
    EXPECT_TRUE(std::isnan(singular_values(glm::dmat3(std::nan(""))).x));
    EXPECT_EQ(singular_values(glm::dmat3(1e300)), glm::dvec3(1e300));
    EXPECT_EQ(singular_values(glm::dmat3(1e-300)), glm::dvec3(1e-300));
}

TEST(Affine, InverseUndoes) {
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Affine a = to_affine(random.transform(12));
        const Affine back = inverse(a);
        const glm::dvec3 p = random.vector(-1, 1);
        const glm::dvec3 q = a(p);
        const double lost = glm::length(a.translation) / singular_values(a.linear).z + 1;
        EXPECT_NEAR(glm::length(back(q) - p), 0, 1e-13 * lost);
        EXPECT_EQ(is_mirrored(a.linear), is_mirrored(back.linear));
    }
}

TEST(Affine, KnowsMirrorsAndFlatThings) {
    EXPECT_FALSE(is_mirrored(glm::dmat3(1e-30)));
    EXPECT_TRUE(is_mirrored(glm::dmat3(-1e-30)));
    EXPECT_TRUE(is_mirrored(glm::dmat3(1e30, 0, 0, 0, -1e-30, 0, 0, 0, 1)));
    EXPECT_FALSE(is_degenerate(glm::dmat3(1e-30)));
    EXPECT_FALSE(is_degenerate(glm::dmat3(1, 0, 0, 0, 1e-8, 0, 0, 0, 1)));
    EXPECT_TRUE(is_degenerate(glm::dmat3(1, 0, 0, 0, 1e-10, 0, 0, 0, 1)));
    EXPECT_TRUE(is_degenerate(glm::dmat3(0)));
    EXPECT_TRUE(is_degenerate(glm::dmat3(1, 2, 3, 2, 4, 6, 0, 1, 0))) << "dependent columns";
    EXPECT_TRUE(is_degenerate(glm::dmat3(INFINITY)));
    EXPECT_TRUE(is_degenerate(glm::dmat3(std::nan(""))));
}

/// What a graph draws, by plain recursion.
struct Drawn {
    int mesh = 0, level_offset = 0, material = -1;
    Real rate = 1;
    Matrix world{};
};
void draw(const SceneGraph& graph, std::size_t group, const Drawn& above, std::vector<Drawn>& all) {
    for (const Placement& p : graph.groups[group].placements) {
        for (int i = 0; i < p.copies.x; ++i) {
            for (int j = 0; j < p.copies.y; ++j) {
                for (int k = 0; k < p.copies.z; ++k) {
                    Matrix copy = matrix_of(p.local);
                    copy[0][3] += static_cast<Real>(i) * p.spacing.x;
                    copy[1][3] += static_cast<Real>(j) * p.spacing.y;
                    copy[2][3] += static_cast<Real>(k) * p.spacing.z;
                    const Drawn here{p.mesh, above.level_offset + p.level_offset,
                                     p.material >= 0 ? p.material : above.material, above.rate * p.rate,
                                     product(above.world, copy)};
                    if (p.group >= 0) {
                        draw(graph, static_cast<std::size_t>(p.group), here, all);
                    } else {
                        all.push_back(here);
                    }
                }
            }
        }
    }
}

/// Groups place meshes and groups of higher number.
SceneGraph random_graph(Random& random, int groups, int meshes) {
    SceneGraph graph;
    for (int g = 0; g < groups; ++g) {
        Group group{fmt::format("g{}", g), {}};
        const int count = random.whole(1, 3);
        for (int i = 0; i < count; ++i) {
            const bool deeper = g + 1 < groups && random.whole(0, 3) != 0;
            Placement p =
                deeper ? place_group(random.whole(g + 1, groups - 1)) : place(random.whole(0, meshes - 1));
            p.local = random.transform(1);
            p.level_offset = random.whole(-2, 2);
            p.rate = random.scale(0.3);
            p.material = random.whole(-2, 2);
            if (random.whole(0, 4) == 0) {
                p.copies = {random.whole(1, 3), random.whole(1, 2), random.whole(1, 2)};
                p.spacing = random.vector(-5, 5);
            }
            group.placements.push_back(p);
        }
        graph.groups.push_back(group);
    }
    return graph;
}

TEST(FlatGraph, DrawsWhatPlainRecursionDraws) {
    Random random(4);
    std::size_t compared = 0;
    for (int round = 0; round < 300; ++round) {
        const SceneGraph graph = random_graph(random, random.whole(1, 6), 3);
        std::vector<Drawn> expected;
        draw(graph, 0, {0, 0, -1, 1, diagonal(1, 1, 1)}, expected);
        std::vector<Box> boxes;
        for (int m = 0; m < 3; ++m) {
            boxes.push_back({});
            for (int i = 0; i < 4; ++i) {
                boxes.back().add(random.vector(-2, 2));
            }
        }
        const FlatGraph flat = flatten(graph, boxes);
        ASSERT_EQ(flat.instances.size(), expected.size());

        // In one order, by where a point lands that no two send to the same place.
        const auto key = [](const auto& p) { return p[0] + Real{1.37L} * p[1] + Real{2.11L} * p[2]; };
        const glm::dvec3 probe(0.31, 0.57, 0.83);
        std::sort(expected.begin(), expected.end(), [&](const Drawn& a, const Drawn& b) {
            return key(image(a.world, probe)) < key(image(b.world, probe));
        });
        std::vector<std::size_t> order(flat.instances.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto world = [&](std::size_t i) -> const Affine& {
            return flat.nodes[static_cast<std::size_t>(flat.instances[i].node)].world;
        };
        std::sort(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return key(world(a)(probe)) < key(world(b)(probe)); });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const FlatInstance& got = flat.instances[order[i]];
            const Drawn& want = expected[i];
            EXPECT_EQ(got.mesh, want.mesh);
            EXPECT_EQ(got.material, want.material);
            EXPECT_NEAR(got.rate, static_cast<double>(want.rate), 1e-14 * got.rate);
            const double largest = singular_values(world(order[i]).linear).x;
            EXPECT_NEAR(got.scale, largest, 2e-12 * largest);
            EXPECT_EQ(got.level_offset,
                      want.level_offset - static_cast<int>(std::lround(std::log2(largest))));
            const Box& bounds = flat.nodes[static_cast<std::size_t>(got.node)].bounds;
            const Real size = size_of(want.world, 0, 3) * 8 + size_of(want.world, 3, 1);
            const Box& box = boxes[static_cast<std::size_t>(got.mesh)];
            for (int sample = 0; sample < 20; ++sample) {
                glm::dvec3 p;
                for (int k = 0; k < 3; ++k) { // corners among them
                    const int where = random.whole(0, 3);
                    p[k] = where == 0   ? box.low[k]
                           : where == 1 ? box.high[k]
                                        : random.uniform(box.low[k], box.high[k]);
                }
                const Vector q = image(want.world, p);
                const glm::dvec3 mapped = world(order[i])(p);
                for (int k = 0; k < 3; ++k) {
                    const Real x = q[static_cast<std::size_t>(k)];
                    ASSERT_NEAR(static_cast<double>(mapped[k] - x), 0, static_cast<double>(size * 1e-13L));
                    ASSERT_TRUE(bounds.low[k] <= mapped[k] && mapped[k] <= bounds.high[k]);
                    ASSERT_TRUE(bounds.low[k] <= x && x <= bounds.high[k]);
                }
                ++compared;
            }
        }
        for (std::size_t n = 1; n < flat.nodes.size(); ++n) {
            const FlatNode& node = flat.nodes[n];
            const FlatNode& parent = flat.nodes[static_cast<std::size_t>(node.parent)];
            ASSERT_TRUE(parent.bounds.contains(node.bounds));
            ASSERT_LT(node.parent, static_cast<int>(n));
            ASSERT_TRUE(parent.first_child <= static_cast<int>(n) &&
                        static_cast<int>(n) < parent.first_child + parent.child_count);
        }
    }
    EXPECT_GT(compared, 50000U);
}

TEST(FlatGraph, BoundsAreTightToo) {
    const SceneGraph graph{{{"root", {place(0, {.scale = {2, 3, 4}, .translate = {10, 20, 30}})}}}};
    const Box box = flatten(graph, std::vector<Box>{unit_box}).nodes[0].bounds;
    for (int k = 0; k < 3; ++k) {
        const double half = 2 + k;
        EXPECT_NEAR(box.low[k], 10 * (k + 1) - half, 8.0 / 255);
        EXPECT_NEAR(box.high[k], 10 * (k + 1) + half, 8.0 / 255);
    }
}

TEST(FlatGraph, LevelOffsetIsScaleRoundedToAPowerOfTwo) {
    const auto level = [](const Transform& t, int stated = 0) {
        Placement p = place(0, t);
        p.level_offset = stated;
        return flatten(SceneGraph{{{"root", {p}}}}, std::vector<Box>{unit_box}).instances[0];
    };
    EXPECT_EQ(level({}).level_offset, 0);
    for (int k = -39; k <= 39; ++k) {
        EXPECT_EQ(level(scaled(std::ldexp(1.0, k))).level_offset, -k);
        EXPECT_EQ(level(scaled(std::ldexp(1.0, k))).scale, std::ldexp(1.0, k));
        EXPECT_EQ(level(scaled(std::ldexp(1.41, k))).level_offset, -k);
        EXPECT_EQ(level(scaled(std::ldexp(1.42, k))).level_offset, -k - 1);
        EXPECT_EQ(level(scaled(std::ldexp(-1.42, k))).level_offset, -k - 1) << "mirrored";
    }
    EXPECT_EQ(level({.scale = {1, 8, 0.5}}).level_offset, -3) << "the largest";
    // Shear (x, y) -> (x + 3 y, y): the largest singular value is (3 + sqrt(13)) / 2 = 3.30.
    EXPECT_EQ(level({.matrix = Affine{glm::dmat3(1, 0, 0, 3, 1, 0, 0, 0, 1), {}}}).level_offset, -2);
    EXPECT_NEAR(level({.matrix = Affine{glm::dmat3(1, 0, 0, 3, 1, 0, 0, 0, 1), {}}}).scale,
                (3 + std::sqrt(13.0)) / 2, 1e-14);
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const FlatInstance turned = level({.rotate = random.vector(-400, 400)});
        EXPECT_EQ(turned.level_offset, 0);
        EXPECT_EQ(turned.scale, 1) << "turning leaves no rounding";
    }
    EXPECT_EQ(level(scaled(4), 5).level_offset, 3) << "stated ones are added";
}

TEST(FlatGraph, NestsDeeply) {
    // 200,000 groups in one another, each moving by 1/8 and turning by 90 degrees about y.
    constexpr int depth = 200000;
    SceneGraph graph;
    for (int g = 0; g < depth; ++g) {
        Transform t;
        t.translate = {0.125, 0.125, 0};
        t.rotate = {0, 90, 0};
        graph.groups.push_back({"g", {g + 1 < depth ? place_group(g + 1, t) : place(0, t)}});
    }
    const FlatGraph flat = flatten(graph, std::vector<Box>{unit_box});
    ASSERT_EQ(flat.instances.size(), 1U);
    const Affine& world = flat.nodes.back().world;
    EXPECT_EQ(world.linear, glm::dmat3(1)) << "a multiple of four quarter turns";
    EXPECT_EQ(world.translation, glm::dvec3(0, 0.125 * depth, 0));
    EXPECT_LT(path_of(flat, graph, static_cast<int>(flat.nodes.size()) - 1).size(), 100U);
}

TEST(FlatGraph, ManyCopiesAreQuick) {
    SceneGraph graph{{{"root", {place_group(1)}}, {"tile", {}}}};
    graph.groups[0].placements[0].copies = {100, 1, 100};
    graph.groups[0].placements[0].spacing = {2, 1, 3};
    for (int i = 0; i < 100; ++i) {
        graph.groups[1].placements.push_back(place(0, {.translate = {0.01 * i, 0, 0}}));
    }
    const auto start = std::chrono::steady_clock::now();
    const FlatGraph flat = flatten(graph, std::vector<Box>{unit_box});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(flat.instances.size(), 1000000U);
    EXPECT_LT(seconds, 20) << "a million";
    EXPECT_EQ(flat.nodes[static_cast<std::size_t>(flat.instances.back().node)].world.translation,
              glm::dvec3(0.01 * 99 + 198, 0, 297));
}

TEST(FlatGraph, RefitFollowsWhatMoved) {
    Random random(6);
    const std::vector<Box> boxes(3, unit_box);
    for (int round = 0; round < 50; ++round) {
        SceneGraph graph = random_graph(random, 5, 3);
        FlatGraph flat = flatten(graph, boxes);
        for (Group& group : graph.groups) {
            for (Placement& p : group.placements) {
                p.local = random.transform(1);
            }
        }
        refit(flat, graph, boxes);
        const FlatGraph fresh = flatten(graph, boxes);
        ASSERT_EQ(flat.nodes.size(), fresh.nodes.size());
        for (std::size_t n = 0; n < fresh.nodes.size(); ++n) {
            EXPECT_EQ(flat.nodes[n].world, fresh.nodes[n].world);
            EXPECT_EQ(flat.nodes[n].bounds, fresh.nodes[n].bounds);
        }
        for (std::size_t i = 0; i < fresh.instances.size(); ++i) {
            EXPECT_EQ(flat.instances[i].level_offset, fresh.instances[i].level_offset);
            EXPECT_EQ(flat.instances[i].scale, fresh.instances[i].scale);
        }
    }
}

TEST(FlatGraph, RefusesWhatCannotBeDrawn) {
    const std::vector<Box> boxes{unit_box};
    const auto root = [](Placement p) { return SceneGraph{{{"root", {std::move(p)}}}}; };
    const auto expect = [&](const SceneGraph& graph, std::string_view cause) {
        const std::string message = refusal(graph, boxes);
        EXPECT_NE(message.find(cause), std::string::npos) << message << "\n not: " << cause;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    };
    expect({{{"root", {}}}}, "places no mesh");
    expect({{{"a", {place_group(0)}}}}, "groups contain each other ('a' in 'a')");
    expect({{{"r", {place_group(1)}},
             {"a", {place(0), place_group(2)}},
             {"b", {place_group(3)}},
             {"c", {place_group(1)}}}},
           "groups contain each other ('a' in 'b' in 'c' in 'a'); remove one");
    expect({{{"r", {place(0)}}, {"a", {place_group(2)}}, {"b", {place_group(1)}}}}, "('a' in 'b' in 'a')");
    SceneGraph doubling;
    for (int g = 0; g < 70; ++g) {
        doubling.groups.push_back(
            {"g", {g < 69 ? place_group(g + 1) : place(0), g < 69 ? place_group(g + 1) : place(0)}});
    }
    expect(doubling, "more than 4194304 instances");
    Placement many = place(0);
    many.copies = glm::ivec3(1000000);
    expect(root(many), "more than 4194304 instances");
    expect(root(place(0, scaled(0))), "object 'mesh' is flattened");
    expect(root(place(0, {.scale = {1, 1e-10, 1}})),
           "is flattened: its world transform scales by 1 in one direction and "
           "by 1e-10 in another");
    // Each is fine by itself, their product is not.
    const Transform thin{.scale = {1, 1e-5, 1}};
    expect({{{"r", {place_group(1, thin)}}, {"g", {place(0, thin)}}}}, "object 'group/mesh' is flattened");
    EXPECT_EQ(refusal({{{"r", {place_group(1, thin)}}, {"g", {place(0, {.scale = {1, 1e5, 1}})}}}}, boxes),
              "");
    expect({{{"r", {place_group(1, scaled(1e-20))}}, {"g", {place(0, scaled(1e-20))}}}},
           "is scaled by 1e-40");
    expect({{{"r", {place_group(1, scaled(1e20))}}, {"g", {place(0, scaled(1e20))}}}}, "is scaled by 1e+40");
    expect(root(place(0, {.translate = {1.1e18, 0, 0}})), "reaches beyond 1e+18");
    EXPECT_EQ(refusal(root(place(0, {.translate = {9.9e17, 0, 0}})), boxes), "");
    Placement faint = place_group(1);
    faint.rate = 1e-4;
    Placement faint_mesh = place(0);
    faint_mesh.rate = 1e-4;
    expect({{{"r", {faint}}, {"g", {faint_mesh}}}}, "has rates that multiply to 1e-08");
    Placement coarse = place_group(1);
    coarse.level_offset = 33;
    Placement coarse_mesh = place(0);
    coarse_mesh.level_offset = 32;
    expect({{{"r", {coarse}}, {"g", {coarse_mesh}}}}, "has level offsets that add up to 65");
}

/// Every instance that is drawn is below the root once; boxes hold what is below, and no more; nodes have few
/// children, and the tree is as deep as halving makes it.
void check_hierarchy(const FlatGraph& flat, const std::vector<bool>& drawn) {
    const std::vector<HierarchyNode> nodes = build_hierarchy(flat, drawn);
    std::vector<int> seen(flat.instances.size(), 0);
    std::vector<Box> boxes(nodes.size());
    std::vector<int> depth(nodes.size(), 0);
    std::size_t next = 1;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodes[n].instance >= 0) {
            ++seen[static_cast<std::size_t>(nodes[n].instance)];
            ASSERT_EQ(nodes[n].child_count, 0);
            continue;
        }
        ASSERT_GE(nodes[n].child_count, 2);
        ASSERT_LE(nodes[n].child_count, most_children);
        ASSERT_EQ(static_cast<std::size_t>(nodes[n].first_child), next) << "one after the other";
        next += static_cast<std::size_t>(nodes[n].child_count);
        for (int k = 0; k < nodes[n].child_count; ++k) {
            depth.at(static_cast<std::size_t>(nodes[n].first_child + k)) = depth[n] + 1;
        }
    }
    ASSERT_EQ(next, nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;) {
        if (nodes[n].instance >= 0) {
            boxes[n] = flat.nodes[static_cast<std::size_t>(
                                      flat.instances[static_cast<std::size_t>(nodes[n].instance)].node)]
                           .bounds;
        }
        for (int k = 0; k < nodes[n].child_count; ++k) {
            boxes[n].add(boxes[static_cast<std::size_t>(nodes[n].first_child + k)]);
        }
        ASSERT_TRUE(nodes[n].bounds.contains(boxes[n]));
    }
    EXPECT_EQ(nodes[0].bounds, boxes[0]);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i], drawn[i] ? 1 : 0);
    }
}

TEST(Hierarchy, HoldsEveryInstanceOnce) {
    Random random(11);
    for (int round = 0; round < 200; ++round) {
        SceneGraph graph = random_graph(random, random.whole(1, 5), 2);
        graph.groups[0].placements[0].copies.x += random.whole(0, 30); // wide
        const FlatGraph flat = flatten(graph, std::vector<Box>(2, unit_box));
        std::vector<bool> drawn;
        for (std::size_t i = 0; i < flat.instances.size(); ++i) {
            drawn.push_back(round % 2 == 0 || random.whole(0, 2) != 0);
        }
        drawn[0] = true;
        check_hierarchy(flat, drawn);
    }
}

TEST(Hierarchy, OfAnArrayIsShallowAndApart) {
    SceneGraph graph{{{"scene", {place(0)}}}};
    graph.groups[0].placements[0].copies = {100, 1, 100};
    graph.groups[0].placements[0].spacing = {3, 0, 3};
    const FlatGraph flat = flatten(graph, std::vector<Box>(1, unit_box));
    const std::vector<bool> drawn(flat.instances.size(), true);
    check_hierarchy(flat, drawn);
    const std::vector<HierarchyNode> nodes = build_hierarchy(flat, drawn);
    EXPECT_LT(nodes.size(), 10000U * 8 / 5);
    // The root's children are strips of the square: nothing overlaps by more than the boxes' growth.
    for (int k = 0; k < nodes[0].child_count; ++k) {
        const Box& box = nodes[static_cast<std::size_t>(nodes[0].first_child + k)].bounds;
        const glm::dvec3 extent = box.high - box.low;
        EXPECT_LT(extent.x * extent.z, 1.1 * 300 * 300 / 8);
        EXPECT_LT(std::max(extent.x, extent.z), 2.5 * std::min(extent.x, extent.z));
    }
}

/// Members that all lie at one place are told apart by their numbers.
TEST(Hierarchy, ManyInOnePlace) {
    SceneGraph graph{{{"scene", {}}}};
    graph.groups[0].placements.assign(1000, place(0));
    const FlatGraph flat = flatten(graph, std::vector<Box>(1, unit_box));
    check_hierarchy(flat, std::vector<bool>(1000, true));
}

TEST(GraphRecords, HoldTheDoubleOnes) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        SceneGraph graph = random_graph(random, 4, 2);
        graph.groups[0].placements[0].local.translate += random.vector(-1, 1) * random.scale(6);
        const FlatGraph flat = flatten(graph, std::vector<Box>(2, unit_box));
        const glm::dvec3 origin = flat.nodes[0].bounds.centre();
        const std::vector<HierarchyNode> nodes =
            build_hierarchy(flat, std::vector<bool>(flat.instances.size(), true));
        const std::vector<GraphNodeRecord> records = pack(nodes, origin);
        ASSERT_EQ(records.size(), nodes.size());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const GraphNodeRecord& r = records[n];
            for (int k = 0; k < 3; ++k) {
                const Real low = static_cast<Real>(nodes[n].bounds.low[k]) - origin[k];
                const Real high = static_cast<Real>(nodes[n].bounds.high[k]) - origin[k];
                const Real slack = std::max(std::abs(low), std::abs(high)) * 2.6e-6L;
                ASSERT_LE(static_cast<Real>(r.low[k]), low);
                ASSERT_GE(static_cast<Real>(r.high[k]), high);
                ASSERT_GE(static_cast<Real>(r.low[k]), low - (slack + 1e-30L));
                ASSERT_LE(static_cast<Real>(r.high[k]), high + (slack + 1e-30L));
            }
            EXPECT_EQ(r.child_count, nodes[n].child_count);
            EXPECT_EQ(r.first_child, nodes[n].first_child);
            EXPECT_EQ(r.instance, nodes[n].instance);
        }
    }
}

} // namespace
} // namespace razor
