// Levels: closed, nested, and born where the definition says.
#include "tests/reference/distance.h"
#include "tests/reference/experiment.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <bit>

namespace razor::reference {
namespace {

class LevelsOf : public testing::TestWithParam<std::tuple<std::string, bool>> {
protected:
    LevelsOf() : levels_(make_levels(setting())) {}
    static Setting setting() {
        Setting s;
        std::tie(s.scene, s.random_exponents) = GetParam();
        s.e0 = 0.15;
        s.seed = 3;
        return s;
    }
    Levels levels_;
};

TEST_P(LevelsOf, AreClosed) {
    ASSERT_GE(levels_.top(), 3);
    for (int k = 0; k <= levels_.top(); ++k)
        EXPECT_EQ(open_edges(discrete_soup(levels_, k)), 0) << "level " << k;
}

// Each level is flat on every triangle of the next: parents are the ends of the coarse edge or diagonal.
TEST_P(LevelsOf, AreNested) {
    for (const Patch& patch : levels_.patches())
        for (int level = 1; level <= patch.coarsest(); ++level) {
            const std::vector<glm::dvec3>& at = levels_.discrete(level);
            int size = 1 << level;
            auto point = [&](int i, int j) { return at[static_cast<std::size_t>(patch.vertex(i, j))]; };
            for (int j = 0; j <= 1 << patch.nv; ++j)
                for (int i = 0; i <= 1 << patch.nu; ++i) {
                    int ci = std::min(i / size * size, (1 << patch.nu) - size);
                    int cj = std::min(j / size * size, (1 << patch.nv) - size);
                    double x = static_cast<double>(i - ci) / size;
                    double y = static_cast<double>(j - cj) / size;
                    glm::dvec3 p00 = point(ci, cj);
                    glm::dvec3 p11 = point(ci + size, cj + size);
                    glm::dvec3 flat = x >= y ? (1 - x) * p00 + (x - y) * point(ci + size, cj) + y * p11
                                             : (1 - y) * p00 + (y - x) * point(ci, cj + size) + x * p11;
                    ASSERT_LT(length(flat - point(i, j)), 1e-14) << "level " << level;
                }
        }
}

TEST_P(LevelsOf, ComeFromTheCurveOnACurve) {
    for (const Curve& curve : levels_.curves()) {
        int segments = 1 << curve.depth;
        for (int k = 1; k < segments; ++k) {
            int depth = curve.depth - std::countr_zero(static_cast<unsigned>(k));
            const Vertex& v =
                levels_.vertices()[static_cast<std::size_t>(curve.vertices[static_cast<std::size_t>(k)])];
            EXPECT_EQ(v.index, curve.exponent - depth);
        }
    }
    for (const Patch& patch : levels_.patches())
        for (int j = 1; j < 1 << patch.nv; ++j)
            for (int i = 1; i < 1 << patch.nu; ++i)
                EXPECT_EQ(levels_.vertices()[static_cast<std::size_t>(patch.vertex(i, j))].index,
                          std::countr_zero(static_cast<unsigned>(i | j)));
}

TEST_P(LevelsOf, ParentsStandBeforeChildren) {
    for (int v = 0; v < levels_.vertex_count(); ++v) {
        const Vertex& vertex = levels_.vertices()[static_cast<std::size_t>(v)];
        EXPECT_EQ(vertex.index == every_level, vertex.parents[0] < 0);
        EXPECT_LT(vertex.parents[0], v);
        EXPECT_LT(vertex.parents[1], v);
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, LevelsOf, testing::Combine(testing::ValuesIn(case_names()), testing::Bool()),
                         [](const auto& info) {
                             return std::get<0>(info.param) + (std::get<1>(info.param) ? "_random" : "");
                         });

} // namespace
} // namespace razor::reference
