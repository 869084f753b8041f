// Curves beside closed forms, trees of nodes, linear-blend skinning beside a sum by hand.
#include "razor/scene/animation/skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace razor {
namespace {

std::vector<double> at(const Curve& curve, double t) {
    std::vector<double> result(curve.width);
    curve.at(t, result);
    return result;
}

TEST(Curve, FollowsItsKeys) {
    const std::vector<double> times{1, 2, 4};
    const Curve linear{CurveKind::linear, 2, false, times, {10, 0, 20, 8, 0, 8}};
    const Curve step{CurveKind::step, 2, false, times, linear.values};
    for (const Curve& curve : {linear, step}) {
        EXPECT_EQ(at(curve, -5), (std::vector<double>{10, 0})) << "the first holds";
        EXPECT_EQ(at(curve, 2), (std::vector<double>{20, 8}));
        EXPECT_EQ(at(curve, 9), (std::vector<double>{0, 8})) << "the last holds";
    }
    EXPECT_EQ(at(linear, 1.25), (std::vector<double>{12.5, 2}));
    EXPECT_EQ(at(step, std::nextafter(2, 0)), (std::vector<double>{10, 0}));
    EXPECT_EQ(at(step, 3.99), (std::vector<double>{20, 8}));
    const Curve twice{CurveKind::linear, 1, false, {0, 1, 1, 2}, {0, 1, 5, 6}};
    EXPECT_EQ(at(twice, 1), (std::vector<double>{5})) << "two keys at once: a jump";
}

// The cubic with these values and slopes at both ends is unique: (t - 1)^3 + 2 t over [1, 3] here.
TEST(Curve, CubicSplineIsTheCubicOfItsTangents) {
    const auto value = [](double t) { return std::pow(t - 1, 3) + 2 * t; };
    const auto slope = [](double t) { return 3 * std::pow(t - 1, 2) + 2; };
    const Curve curve{
        CurveKind::cubic_spline, 1, false, {1, 3}, {77, value(1), slope(1), slope(3), value(3), -55}};
    for (double t = 1; t <= 3; t += 0.125)
        EXPECT_NEAR(at(curve, t)[0], value(t), 1e-13) << t;
    EXPECT_EQ(at(curve, 0)[0], value(1));
    EXPECT_EQ(at(curve, 4)[0], value(3));
}

std::vector<double> about_z(double degrees) {
    const double half = degrees / 360 * std::numbers::pi;
    return {0, 0, std::sin(half), std::cos(half)};
}
void append(std::vector<double>& list, const std::vector<double>& more, double factor = 1) {
    for (const double x : more)
        list.push_back(factor * x);
}

TEST(Curve, RotationsTurnEvenlyAndTheShortestWay) {
    for (const double sign : {1.0, -1.0, 0.5}) { // a quaternion and its negative are one rotation
        Curve curve{CurveKind::linear, 4, true, {0, 1}, about_z(20)};
        append(curve.values, about_z(120), sign);
        for (double x = 0; x <= 1; x += 0.125) {
            const std::vector<double> q = at(curve, x), expected = about_z(20 + 100 * x);
            double dot = 0, length = 0;
            for (std::size_t i = 0; i < 4; ++i)
                dot += q[i] * expected[i], length += q[i] * q[i];
            EXPECT_NEAR(std::abs(dot), 1, 1e-15) << x << " " << sign;
            EXPECT_NEAR(length, 1, 1e-15);
        }
    }
    Curve spline{CurveKind::cubic_spline, 4, true, {0, 2}, std::vector<double>(4, 0)};
    append(spline.values, about_z(0));
    append(spline.values, std::vector<double>(8, 0));
    append(spline.values, about_z(90));
    append(spline.values, std::vector<double>(4, 0));
    const std::vector<double> half = at(spline, 1), expected = about_z(45);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(half[i], expected[i], 1e-15) << "of unit length again";
}

SkeletonNode node(int parent, glm::dvec3 translation) {
    SkeletonNode result;
    result.parent = parent;
    result.translation = translation;
    return result;
}

TEST(Skeleton, ParentsMayComeLater) {
    Skeleton s{{node(2, {1, 0, 0}), node(0, {0, 1, 0}), node(-1, {0, 0, 5})}, {}};
    s.nodes[2].scale = {2, 3, 4};
    s.nodes[0].rotation = glm::dquat(std::sqrt(0.5), 0, 0, std::sqrt(0.5)); // x to y
    s.order = parents_first(s.nodes);
    EXPECT_EQ(s.order, (std::vector<int>{2, 0, 1}));
    const glm::dvec3 p = rest_pose(s).world[1]({1, 1, 1});
    EXPECT_NEAR(p.x, 2 * (1 - 2), 1e-14);
    EXPECT_NEAR(p.y, 3 * 1, 1e-14);
    EXPECT_NEAR(p.z, 4 * 1 + 5, 1e-14);
    Clip clip{"", {{0, Channel::Path::translation, {CurveKind::step, 3, false, {2}, {7, 0, 0}}}}};
    EXPECT_EQ(clip.length(), 2);
    EXPECT_EQ(moved_nodes(s, clip), (std::vector<bool>{true, true, false}));
    EXPECT_NEAR(pose_at(s, clip, 0).world[1]({1, 1, 1}).x, 2 * (7 - 2), 1e-14);
    s.nodes[2].parent = 1;
    EXPECT_TRUE(parents_first(s.nodes).empty()) << "a circle";
}

TEST(Skin, WeightsAreDividedByTheirSum) {
    Skin skin;
    skin.append_influences(std::vector<Influence>{{3, 0.5}, {1, 1.5}, {2, 0}});
    skin.append_influences(std::vector<Influence>{{2, 0}, {1, 0}});
    EXPECT_EQ(skin.influences, (std::vector<Influence>{{1, 0.75}, {3, 0.25}, {2, 1}}));
    EXPECT_EQ(skin.first, (std::vector<std::size_t>{0, 2, 3}));
}

struct Random {
    std::mt19937 engine{1};
    double operator()(double from = -1, double to = 1) {
        return std::uniform_real_distribution<double>(from, to)(engine);
    }
    glm::dvec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
};

// The sum over joints of weight times matrices, 4 by 4, entry by entry.
TEST(Skin, IsTheWeightedSumOfItsJoints) {
    Random random;
    constexpr int joints = 7, count = 50;
    Skeleton s;
    for (int j = 0; j <= joints; ++j) {
        s.nodes.push_back(node(j - 1, random.vector()));
        s.nodes.back().rotation = glm::normalize(glm::dquat(random(), random(), random(), random()));
        s.nodes.back().scale = {random(0.5, 2), random(0.5, 2), random(0.5, 2)};
    }
    s.nodes[0].weights = {0.25, -0.5};
    s.order = parents_first(s.nodes);
    Skin skin;
    skin.targets.resize(2);
    std::vector<std::vector<double>> weights(count, std::vector<double>(joints));
    for (int j = 1; j <= joints; ++j) {
        skin.joints.push_back(j);
        skin.inverse_bind.push_back({{random.vector(), random.vector(), random.vector()}, random.vector()});
    }
    for (std::vector<double>& of_point : weights) {
        skin.points.push_back(random.vector());
        skin.targets[0].push_back(random.vector());
        skin.targets[1].push_back(random.vector());
        std::vector<Influence> influences;
        for (int j = 0; j < joints; ++j)
            influences.push_back({j, of_point[static_cast<std::size_t>(j)] = random(0, 1)});
        skin.append_influences(influences);
    }
    const SkeletonPose rest = rest_pose(s);
    std::vector<glm::dvec3> posed(count);
    pose(skin, rest, posed);
    const auto row = [](const Affine& a, int r, const double* p) {
        return a.linear[0][r] * p[0] + a.linear[1][r] * p[1] + a.linear[2][r] * p[2] +
               a.translation[r] * p[3];
    };
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 morphed = skin.points[i] + 0.25 * skin.targets[0][i] - 0.5 * skin.targets[1][i];
        double sum = 0, expected[3] = {};
        for (std::size_t j = 0; j < joints; ++j) {
            const double p[4] = {morphed.x, morphed.y, morphed.z, 1};
            double bound[4] = {0, 0, 0, 1};
            for (int r = 0; r < 3; ++r)
                bound[r] = row(skin.inverse_bind[j], r, p);
            for (int r = 0; r < 3; ++r)
                expected[r] += weights[i][j] * row(rest.world[j + 1], r, bound);
            sum += weights[i][j];
        }
        for (int r = 0; r < 3; ++r)
            EXPECT_NEAR(posed[i][r], expected[r] / sum, 1e-12);
    }
}

TEST(Skin, PointsAreAlikeOnlyInEverything) {
    Skin skin;
    skin.joints = {0, 1};
    skin.inverse_bind.resize(2);
    skin.targets.resize(1);
    const auto add = [&](glm::dvec3 point, glm::dvec3 target, std::vector<Influence> influences) {
        skin.points.push_back(point);
        skin.targets[0].push_back(target);
        skin.append_influences(influences);
    };
    add({1, 2, 3}, {0, 0, 0}, {{0, 1}});
    add({1, 2, 3}, {0, 0, 1}, {{0, 1}});
    add({1, 2, 3}, {0, 0, 0}, {{1, 1}});
    add({1, 2, 3}, {0, 0, 0}, {{0, 0.5}, {1, 0.5}});
    add({1, 2, 3}, {0, -0.0, 0}, {{1, 0}, {0, 1}});
    add({1, 2, 4}, {0, 0, 0}, {{0, 1}});
    add({1, 2, 3}, {0, 0, 1}, {{0, 2}});
    EXPECT_EQ(first_alike(skin), (std::vector<int>{0, 1, 2, 3, 0, 5, 1}));
    const Skin some = gather(skin, std::vector<int>{3, 1});
    EXPECT_EQ(some.targets[0][1], glm::dvec3(0, 0, 1));
    EXPECT_EQ(some.influences_of(0).size(), 2U);
    EXPECT_EQ(some.influences_of(1).size(), 1U);
}

} // namespace
} // namespace razor
