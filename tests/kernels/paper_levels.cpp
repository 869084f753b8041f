// The paper's scheme against its definition in double precision: along each ray one pair of whole meshes
// after the other, every vertex of the finer one blended by where it projects on the ray.
#include "razor/check/escapes.h"
#include "razor/check/field_surface.h"
#include "razor/frame/transition.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace razor::test {
namespace {

glm::dvec3 vec(const Point& p) {
    return {p[0], p[1], p[2]};
}

/// Times level_rounding, at a distance along the ray.
double asked_at(const Ray& ray, double t) {
    const double blurred = std::abs(ray.base + glm::dot(vec(ray.slope), vec(ray.direction)) * t);
    return std::max((blurred + ray.growth * std::max(t, 0.0)) * level_rounding, double{least_target_edge});
}

/// What a ray meets in one patch at most: hits that are there whatever is rounded how, and hits that may be.
struct Crossings {
    struct One {
        double t, slack;
    };
    std::vector<One> certain, possible;
    bool edge_on = false; // a triangle is seen so that its hit may be anywhere
    int pairs = 0;        // whose stretches have a possible hit
    int between = 0;      // of those, with a vertex between two levels
};

class PaperSurface {
public:
    explicit PaperSurface(const FieldSurface& surface) : surface_(surface) {}

    Crossings crossings(const Ray& ray) {
        Crossings found;
        for (int patch = 0; patch < static_cast<int>(surface_.patches()); ++patch) {
            const FieldSurface::Shape shape = surface_.shape(patch);
            for (int k = shape.first_level - 1; k <= surface_.coarsest_level(); ++k)
                meet(ray, patch, shape, k, found);
        }
        return found;
    }

private:
    const std::vector<glm::dvec3>& level(int k, int patch) {
        auto at = levels_.find(k);
        if (at == levels_.end()) {
            Ray whole;
            whole.base = static_cast<float>(std::ldexp(1.0, k) / level_rounding * 1.05);
            at = levels_.try_emplace(k, surface_, whole).first;
        }
        return at->second.points(patch);
    }

    void meet(const Ray& ray, int patch, const FieldSurface::Shape& shape, int k, Crossings& found) {
        const glm::dvec3 from = vec(ray.origin) - shape.origin, d = vec(ray.direction);
        const std::vector<glm::dvec3>&fine = level(k, patch), &coarse = level(k + 1, patch);
        const int step = 1 << std::min(std::max(k - shape.first_level, 0), std::min(shape.nu, shape.nv));
        const int across = 1 << shape.nu, up = 1 << shape.nv, width = across + 1;
        glm::dvec3 low(1e300), high(-1e300);
        double apart = 0;
        bool between = false;
        seen_.resize(fine.size());
        for (int j = 0; j <= up; j += step)
            for (int i = 0; i <= across; i += step) {
                const auto at = static_cast<std::size_t>(j * width + i);
                const double part = asked_at(ray, glm::dot(fine[at] - from, d)) / std::ldexp(1.0, k + 1);
                const double x = std::clamp((part - morph_begin) / (1 - morph_begin), 0.0, 1.0);
                const double b = 1 - x * x * (3 - 2 * x);
                seen_[at] = b * fine[at] + (1 - b) * coarse[at];
                low = glm::min(low, seen_[at]);
                high = glm::max(high, seen_[at]);
                const double way = glm::length(fine[at] - coarse[at]);
                apart = std::max(apart, way);
                between = between || (b > 0 && b < 1 && way > 0);
            }
        const glm::dvec3 centre = 0.5 * (low + high) - from;
        if (glm::length(centre - glm::dot(centre, d) * d) > 0.51 * glm::length(high - low) + 1e-4)
            return;
        const std::size_t before = found.possible.size();
        const int lowest = shape.first_level - 1;
        for (int j = 0; j < up; j += step)
            for (int i = 0; i < across; i += step) {
                const auto p = [&](int u, int v) -> const glm::dvec3& {
                    return seen_[static_cast<std::size_t>((j + v * step) * width + i + u * step)];
                };
                const Stretch stretch{k, lowest, surface_.coarsest_level()};
                triangle(ray, from, d, {p(0, 0), p(1, 0), p(1, 1)}, apart, stretch, found);
                if (shape.triangles > 1)
                    triangle(ray, from, d, {p(0, 0), p(1, 1), p(0, 1)}, apart, stretch, found);
            }
        if (found.possible.size() > before) {
            ++found.pairs;
            found.between += between ? 1 : 0;
        }
    }

    struct Stretch {
        int pair, lowest, highest;
        bool holds(double target) const {
            return std::clamp(static_cast<int>(std::floor(std::log2(target))), lowest, highest) == pair;
        }
    };
    static void triangle(const Ray& ray, const glm::dvec3& from, const glm::dvec3& d,
                         const std::array<glm::dvec3, 3>& p, double apart, const Stretch& stretch,
                         Crossings& found) {
        const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0], s = from - p[0];
        const double reach = glm::length(p[0]) + glm::length(from) + glm::length(p[0] - from);
        const double e = 40.0 / 16777216 * reach + 1e-5 * apart;
        const glm::dvec3 q = glm::cross(s, e1), o = glm::cross(d, e2);
        const double det = glm::dot(e1, o);
        const double size = std::max({glm::length(e1), glm::length(e2), glm::length(e1 - e2)});
        if (std::abs(det) <= 32 * e * size) {
            // Seen edge-on: whoever passes near it is not judged.
            const glm::dvec3 middle = (p[0] + p[1] + p[2]) / 3.0 - from;
            found.edge_on = found.edge_on || glm::length(middle - glm::dot(middle, d) * d) <= size + e;
            return;
        }
        const double u = glm::dot(s, o) / det, v = glm::dot(d, q) / det, t = glm::dot(e2, q) / det;
        const double inside = std::min({u, v, 1 - u - v}), off = e * size / std::abs(det);
        const double cosine = std::abs(det) / glm::length(glm::cross(e1, e2));
        const double slack = e / cosine * (1 + size * size / std::abs(det));
        if (inside < -off || t < ray.t_min - slack || t > ray.t_max + slack)
            return;
        const bool ends[2] = {stretch.holds(asked_at(ray, t - slack) * (1 - 1e-5)),
                              stretch.holds(asked_at(ray, t + slack) * (1 + 1e-5))};
        if (ends[0] || ends[1])
            found.possible.push_back({t, slack});
        if (ends[0] && ends[1] && inside > off && t > ray.t_min + slack && t < ray.t_max - slack)
            found.certain.push_back({t, slack});
    }

    const FieldSurface& surface_;
    std::map<int, SeenSurface> levels_;
    std::vector<glm::dvec3> seen_;
};

class PaperLevels : public testing::TestWithParam<std::string> {};

TEST_P(PaperLevels, HitsAreThoseOfTheDefinition) {
    std::optional<NamedScene> scene = named_scene(GetParam());
    if (!scene)
        GTEST_SKIP() << "the shared scenes are not there";
    scene->scene.settings.lod = Lod::paper;
    std::vector<Hit> first;
    for (const KernelTable* target : all_targets()) {
        Frame frame(scene->scene, {});
        constexpr int batch = 512;
        Tracer tracer(frame, batch);
        // One is built as rays come, the other whole, for the definition.
        Frame eager(scene->scene, {});
        eager.build_all(*target);
        const FieldSurface surface(eager);
        const std::vector<Triangle> triangles = triangles_of(eager);
        RayMaker make(triangles, instance_origins(eager), 12);
        const float edge = eager.header().instances.get()[0].edge_length;
        const std::size_t wanted = std::clamp<std::size_t>(3'000'000 / surface.vertices(), 64, batch);
        constexpr float growths[] = {-0.1F, 0, 0.01F, 0.05F, 0.125F};
        std::vector<Ray> rays;
        while (rays.size() < wanted) {
            Ray r = rays.size() % 3 == 0 ? make.at_edge() : make.random_ray();
            r.t_max = 3.0e38F;
            const glm::dvec3 unit = glm::normalize(vec(r.direction)); // what stretches are measured along
            for (int k = 0; k < 3; ++k)
                r.direction[static_cast<std::size_t>(k)] = static_cast<float>(unit[k]);
            r.base = edge * std::exp2(make.uniform(-1, 7));
            r.growth = growths[make.pick(5)];
            if (make.pick(4) == 0) { // through a lens
                const Point axis = make.random_direction();
                for (std::size_t k = 0; k < 3; ++k)
                    r.slope[k] = 0.1F * axis[k];
                r.growth = std::clamp(r.growth, -0.025F, 0.025F);
            }
            rays.push_back(r);
        }
        const std::vector<Hit> hits = tracer.closest(*target, rays);
        const std::vector<bool> any = tracer.any(*target, rays);
        for (std::size_t i = 0; i < rays.size(); ++i)
            EXPECT_EQ(any[i], hits[i].patch >= 0) << target->name << ", ray " << i;
        if (target->name != std::string("sse4")) {
            if (first.empty())
                first = hits;
            EXPECT_TRUE(hits == first) << target->name << ": other bits than the first target's";
        }
        if (target != native_targets().back() && target->name != std::string("sse4"))
            continue; // the others have the same bits
        PaperSurface paper(surface);
        int wrong = 0, judged = 0, met = 0, between = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Crossings seen = paper.crossings(rays[i]);
            if (seen.edge_on)
                continue;
            ++judged;
            between += seen.between > 0 ? 1 : 0;
            double nearest = 1e300;
            for (const Crossings::One& c : seen.certain)
                nearest = std::min(nearest, c.t + c.slack);
            bool right = hits[i].patch < 0 && seen.certain.empty();
            if (hits[i].patch >= 0) {
                ++met;
                const double t = hits[i].t;
                right =
                    t <= nearest && std::any_of(seen.possible.begin(), seen.possible.end(),
                                                [&](const auto& c) { return std::abs(c.t - t) <= c.slack; });
            }
            if (!right && ++wrong <= 3)
                ADD_FAILURE() << target->name << ", ray " << i << ": base " << rays[i].base / edge
                              << " edges, growth " << rays[i].growth << ": hit at "
                              << (hits[i].patch < 0 ? -1.0F : hits[i].t) << ", expected "
                              << (seen.certain.empty() ? -1.0 : nearest) << " of " << seen.possible.size();
        }
        EXPECT_EQ(wrong, 0) << target->name;
        EXPECT_GT(judged, static_cast<int>(rays.size()) / 5); // slivers are often seen edge-on
        EXPECT_GT(met, judged / 10);
        if (scene->name == "torus_stretched") {
            EXPECT_GT(between, judged / 20) << "no vertex was between two levels: nothing was tried";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PaperLevels, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

/// Where one pair hands over to the next, and beside hanging vertices.
TEST(PaperLevelsOfTorus, RaysEscape) {
    Scene scene = scene_of(stretched(torus_cage(9, 6)), 60);
    scene.settings.lod = Lod::paper;
    Frame frame(scene, {});
    EscapeOptions options;
    options.rays = 100'000;
    options.growth = 0.1;
    options.compared = 100;
    const EscapeReport r = shoot_from_inside(frame, *native_targets().back(), Lod::paper, options);
    EXPECT_GT(r.escapes, 0);
    EXPECT_LT(r.escapes, r.rays / 100);
    EXPECT_EQ(r.compared, 0);
}

} // namespace
} // namespace razor::test
