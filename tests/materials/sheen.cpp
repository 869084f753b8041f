// Sheen by itself: equal to its definition, the same both ways, and its table the integral over it.
#include "tests/kernels/target_functions.h"
#include "tests/materials/plain_sheen.h"
#include "tests/materials/sheen_kernel.h"

#include "razor/frame/sheen_albedo.h"

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(sheen, const SheenArrays&)

namespace {

using glm::dvec3;
using std::numbers::pi;

using Target = TargetFunction<const SheenArrays&>;

constexpr int count = 2048;
constexpr double roughnesses[] = {0.1, 0.25, 0.5, 0.75, 1};

std::vector<dvec3> directions(unsigned seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return (static_cast<double>(random() >> 8U) + 0.5) / 16777216; };
    std::vector<dvec3> all;
    for (int i = 0; i < count; ++i) {
        const double z = std::max(i % 4 == 0 ? std::pow(next(), 3) : next(), 2e-4), phi = 2 * pi * next();
        const double s = std::sqrt(1 - z * z);
        all.emplace_back(s * std::cos(phi), s * std::sin(phi), z);
    }
    return all;
}

struct Found {
    std::vector<float> reflected, kept;
};
/// `rows`: where roughness has maps; else the first serves all.
Found run(const Target& target, const std::vector<double>& roughness, const std::vector<float>& albedos,
          const SheenRows* rows, const std::vector<dvec3>& view, const std::vector<dvec3>& light) {
    Found found{std::vector<float>(count), std::vector<float>(count)};
    std::vector<float> v(std::size_t{3} * count), l(v.size());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            v[k * count + i] = static_cast<float>(view[i][static_cast<int>(k)]);
            l[k * count + i] = static_cast<float>(light[i][static_cast<int>(k)]);
        }
    std::vector<float> of_maps(roughness.begin(), roughness.end());
    SheenArrays a;
    a.count = count;
    a.view = v.data();
    a.light = l.data();
    a.reflected = found.reflected.data();
    a.kept = found.kept.data();
    a.alpha = static_cast<float>(roughness[0] * roughness[0]);
    a.albedos = albedos.data();
    a.roughness = of_maps.data();
    a.rows = rows;
    target.run(a);
    return found;
}
Found run(const Target& target, double roughness, const std::vector<dvec3>& view,
          const std::vector<dvec3>& light) {
    return run(target, std::vector<double>(count, roughness), sheen_albedo(roughness * roughness), nullptr,
               view, light);
}
/// As maps say it, all within the rows.
Found run(const Target& target, const std::vector<double>& roughness, const SheenRows& rows,
          const std::vector<dvec3>& view, const std::vector<dvec3>& light) {
    return run(target, roughness, rows.albedo, &rows, view, light);
}

TEST(Sheen, IsThatOfItsDefinition) {
    const std::vector<dvec3> view = directions(1), light = directions(2);
    for (const Target& target : sheen_of_targets())
        for (const double roughness : roughnesses) {
            const Found found = run(target, roughness, view, light);
            const PlainSheen plain = plain_sheen(roughness);
            for (std::size_t i = 0; i < count; ++i) {
                const double want = pi * plain.reflectance(view[i], light[i]);
                // Tables are straight between their places: a hundredth where they bend most.
                EXPECT_NEAR(found.reflected[i], want, 0.03 * want + 1e-6)
                    << target.name << ", roughness " << roughness << ", cosines " << view[i].z << ' '
                    << light[i].z;
                EXPECT_NEAR(found.kept[i], 1 - plain.taken(view[i].z, light[i].z), 0.02);
            }
        }
}

TEST(Sheen, IsTheSameBothWays) {
    const std::vector<dvec3> view = directions(3), light = directions(4);
    for (const Target& target : sheen_of_targets())
        for (const double roughness : roughnesses) {
            const Found there = run(target, roughness, view, light),
                        back = run(target, roughness, light, view);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_NEAR(there.reflected[i], back.reflected[i], 1e-5 * there.reflected[i]) << target.name;
                EXPECT_NEAR(there.kept[i], back.kept[i], 1e-6) << target.name;
            }
        }
}

/// Between rows, at what plain_sheen() has tables of, another from direction to direction.
std::vector<double> mapped_roughness() {
    constexpr double some[] = {0.1, 0.125, 0.175, 0.275, 0.4, 0.55, 0.85, 1};
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i)
        all.push_back(some[(i / 3) % std::size(some)]);
    return all;
}

TEST(SheenRows, HoldThoseOfEachRoughness) {
    const SheenRows rows = sheen_albedo_rows(0.1F, 1);
    ASSERT_EQ(rows.albedo.size(), static_cast<std::size_t>(rows.last + 1) * sheen_steps);
    for (const int row : {0, 1, 7, 20, rows.last}) {
        const double root = rows.first_root + row / double{rows.per_root};
        const std::vector<float> want = sheen_albedo(std::pow(root, 4));
        for (std::size_t k = 0; k < sheen_steps; ++k)
            EXPECT_NEAR(rows.albedo[static_cast<std::size_t>(row) * sheen_steps + k], want[k],
                        2e-5 * want[k] + 1e-7)
                << row << ' ' << k;
    }
}

TEST(SheenRows, ShowTheDefinitionBetweenThem) {
    const std::vector<dvec3> view = directions(5), light = directions(6);
    const std::vector<double> roughness = mapped_roughness();
    const SheenRows rows = sheen_albedo_rows(0.1F, 1);
    for (const Target& target : sheen_of_targets()) {
        const Found found = run(target, roughness, rows, view, light);
        for (std::size_t i = 0; i < count; ++i) {
            const PlainSheen plain = plain_sheen(roughness[i]);
            const double want = pi * plain.reflectance(view[i], light[i]);
            EXPECT_NEAR(found.reflected[i], want, 0.03 * want + 1e-6) << target.name << ' ' << roughness[i];
            EXPECT_NEAR(found.kept[i], 1 - plain.taken(view[i].z, light[i].z), 0.02);
        }
    }
}

// A row's own roughness is as if it had no map.
TEST(SheenRows, EndAtWhatHasNone) {
    const std::vector<dvec3> view = directions(7), light = directions(8);
    const SheenRows rows = sheen_albedo_rows(0.25F, 0.75F);
    for (const Target& target : sheen_of_targets())
        for (const double roughness : {0.25, 0.75}) {
            const Found mapped = run(target, std::vector<double>(count, roughness), rows, view, light),
                        plain = run(target, roughness, view, light);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_NEAR(mapped.reflected[i], plain.reflected[i], 2e-5 * plain.reflected[i] + 1e-9);
                EXPECT_NEAR(mapped.kept[i], plain.kept[i], 2e-5) << target.name << ' ' << roughness;
            }
        }
}

TEST(SheenRows, AreTheSameBothWays) {
    const std::vector<dvec3> view = directions(9), light = directions(10);
    const std::vector<double> roughness = mapped_roughness();
    const SheenRows rows = sheen_albedo_rows(0.1F, 1);
    for (const Target& target : sheen_of_targets()) {
        const Found there = run(target, roughness, rows, view, light),
                    back = run(target, roughness, rows, light, view);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(there.reflected[i], back.reflected[i], 1e-5 * there.reflected[i]) << target.name;
            EXPECT_NEAR(there.kept[i], back.kept[i], 1e-6) << target.name;
        }
    }
}

// And what is below gets no more than it leaves.
TEST(Sheen, GivesNoMoreThanItGets) {
    for (const double roughness : roughnesses) {
        const std::vector<float> albedos = sheen_albedo(roughness * roughness);
        ASSERT_EQ(albedos.size(), std::size_t{sheen_steps});
        for (int k = 1; k < sheen_steps; ++k) {
            const double root = double(k) / (sheen_steps - 1), cosine = root * root;
            const double reflected = plain_sheen(roughness).reflected(cosine);
            EXPECT_LT(reflected, 1.001) << roughness << ' ' << cosine;
            EXPECT_LT(reflected, albedos[static_cast<std::size_t>(k)] * 1.01 + 1e-4)
                << roughness << ' ' << cosine;
        }
    }
}

} // namespace
} // namespace razor::test
