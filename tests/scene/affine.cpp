// Transforms, their inverses and singular values, beside plain matrix products in extended precision.
#include "tests/scene/graph_matrices.h"
#include "tests/scene/random_graph.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace razor {
namespace {

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

} // namespace
} // namespace razor
