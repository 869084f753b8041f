// Spawned rays: how far their surface is from their parent's, and where they must begin.
#include "tests/reference/experiment.h"
#include "tests/reference/leaving.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace razor::reference {
namespace {

struct Spawned {
    const Structures& structures;
    const Surface& parent;
    Hit hit;
    glm::dvec3 normal; // towards the parent's origin
    View view;
};

Setting setting(const std::string& scene, bool random_exponents) {
    Setting s;
    s.scene = scene;
    s.random_exponents = random_exponents;
    s.e0 = 0.1;
    return s;
}

/// Parents from outside, and children of each growth.
void each_spawned(Setting s, const std::function<void(const Spawned&)>& visit) {
    Levels levels = make_levels(s);
    Structures structures(levels);
    std::mt19937 random(s.seed);
    for (double growth : {0.01, 0.1, 0.4, 1.6})
        for (int o = 0; o < 3; ++o) {
            s.growth = growth;
            View view = make_view(s, (1.8 + uniform(random)) * random_direction(random));
            Surface parent(levels, view);
            Soup soup = recursive_soup(structures, parent);
            for (int n = 0; n < 5; ++n) {
                Ray ray{view.origin,
                        glm::normalize(0.8 * uniform(random) * random_direction(random) - view.origin)};
                Hits h = hits(ray, soup);
                if (h.nearest.triangle < 0)
                    continue;
                const Triangle& t = soup.triangles[static_cast<std::size_t>(h.nearest.triangle)];
                std::array<glm::dvec3, 3> p;
                for (std::size_t k = 0; k < 3; ++k)
                    p[k] = soup.points[static_cast<std::size_t>(t.points[k])];
                glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
                if (glm::dot(normal, ray.direction) > 0)
                    normal = -normal;
                Hit hit{ray.origin + h.nearest.t * ray.direction, view.footprint.at(h.nearest.t), t.points};
                for (double child : {-1.0, -0.1, 0.0, 0.1, 0.8, 4.0}) {
                    View next = view;
                    next.origin = hit.point;
                    next.footprint.w0 = hit.footprint;
                    next.footprint.growth = child;
                    visit({structures, parent, hit, normal, next});
                }
            }
        }
}

class Leaving : public testing::TestWithParam<std::tuple<std::string, bool>> {
protected:
    static Setting of_parameters() { return setting(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(Leaving, SurfacesAreAsFarApartAsTheBoundAtMost) {
    double tightest = 0;
    int moved = 0;
    each_spawned(of_parameters(), [&](const Spawned& s) {
        double growth =
            std::max(std::abs(s.view.footprint.growth), std::abs(s.parent.view().footprint.growth));
        Apart bound = apart(s.structures.levels, s.view.transition, s.hit, growth);
        Surface child(s.structures.levels, s.view);
        double most = 0;
        for (int v : s.hit.vertices)
            most = std::max(most, glm::length(s.parent.position(v, 0) - child.position(v, 0)));
        EXPECT_LE(most, bound.from_each_other + 1e-14);
        moved += most > 0;
        if (most > 0)
            tightest = std::max(tightest, most / bound.from_each_other);
    });
    EXPECT_GT(moved, 50);
    EXPECT_GT(tightest, 0.9); // no idle bound
}

INSTANTIATE_TEST_SUITE_P(Cases, Leaving,
                         testing::Combine(testing::Values("ball", "sphere", "relief"), testing::Bool()),
                         [](const auto& info) {
                             return std::get<0>(info.param) + (std::get<1>(info.param) ? "_random" : "");
                         });

class LeavingConvex : public testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(LeavingConvex, NoChildMeetsWhatItLeaves) {
    std::mt19937 random(9);
    int rays = 0, cleared = 0, apart_only = 0, at_once = 0;
    double height = 0, footprint = 0;
    each_spawned(setting(std::get<0>(GetParam()), std::get<1>(GetParam())), [&](const Spawned& s) {
        Soup soup = recursive_soup(s.structures, Surface(s.structures.levels, s.view));
        double growth =
            std::max(std::abs(s.view.footprint.growth), std::abs(s.parent.view().footprint.growth));
        double bound = apart(s.structures.levels, s.view.transition, s.hit, growth).from_each_other;
        double clear = clearance(s.parent, s.hit, s.normal);
        height += clear;
        footprint += std::max(s.hit.footprint, s.view.transition.e0);
        for (int n = 0; n < 6; ++n) {
            glm::dvec3 d = random_direction(random);
            if (glm::dot(d, s.normal) < 0)
                d = -d;
            if (n % 2 == 1) // near the facet's plane
                d = glm::normalize(d - 0.95 * glm::dot(d, s.normal) * s.normal);
            constexpr double rounding = 1e-12;
            auto shadowed = [&](double off) {
                return hits({s.hit.point + (off + rounding) * s.normal, d}, soup).count > 0;
            };
            ++rays;
            at_once += shadowed(0);
            apart_only += shadowed(bound);
            cleared += shadowed(clear);
        }
    });
    EXPECT_GT(rays, 1500);
    EXPECT_EQ(cleared, 0);
    EXPECT_GT(at_once, rays / 20);
    EXPECT_GT(apart_only, 0);           // why the bound alone will not do
    EXPECT_LT(height, 0.3 * footprint); // contact shadows are kept beyond a part of the target edge
    RecordProperty("rays", rays);
    RecordProperty("shadowed_at_once", at_once);
    RecordProperty("shadowed_beyond_the_bound", apart_only);
    RecordProperty("clearance_of_target_edge", std::to_string(height / footprint));
}

INSTANTIATE_TEST_SUITE_P(Cases, LeavingConvex,
                         testing::Combine(testing::Values("ball", "prism"), testing::Bool()),
                         [](const auto& info) {
                             return std::get<0>(info.param) + (std::get<1>(info.param) ? "_random" : "");
                         });

} // namespace
} // namespace razor::reference
