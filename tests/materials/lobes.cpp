// Sampling of reflecting lobes: directions come as often as their density says (chi-square), densities
// integrate to what is reflected at all, and reflectance is the same both ways.
#include "tests/kernels/target_functions.h"
#include "tests/materials/lobes_kernel.h"

#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(lobes, const LobeArrays&)

namespace {

using glm::dvec3;
using std::numbers::pi;

using Target = TargetFunction<const LobeArrays&>;

struct Lobe {
    float alpha;
    double degrees; // of the viewer, from the normal
};
constexpr std::array<Lobe, 7> cases{
    {{0.05F, 20}, {0.3F, 0.5}, {0.3F, 45}, {0.3F, 80}, {1, 10}, {1, 60}, {0.6F, 88}}};

double lobe_cosine(const Lobe& lobe) {
    return std::cos(glm::radians(lobe.degrees));
}

struct Arrays {
    Arrays(int n, const Lobe& lobe) {
        const auto count = static_cast<std::size_t>(n);
        for (std::vector<float>* values : {&u, &v, &density, &one, &other})
            values->resize(count);
        for (std::vector<float>* values : {&light, &reflected})
            values->resize(3 * count);
        a.count = n;
        a.alpha = lobe.alpha;
        a.view[0] = static_cast<float>(std::sin(glm::radians(lobe.degrees)));
        a.view[2] = static_cast<float>(lobe_cosine(lobe));
        a.square_u = u.data();
        a.square_v = v.data();
        a.light = light.data();
        a.reflected = reflected.data();
        a.density = density.data();
        a.reflectance = one.data();
        a.reverse_reflectance = other.data();
        std::fill(light.begin() + 2 * n, light.end(), 1.0F);
    }
    void set_light(int i, const dvec3& l) {
        for (int k = 0; k < 3; ++k)
            light[static_cast<std::size_t>(k * a.count + i)] = static_cast<float>(l[k]);
    }
    LobeArrays a;
    std::vector<float> u, v, light, reflected, density, one, other;
};

/// Bins of equal solid angle over the whole sphere.
constexpr int rings = 24, sectors = 24, fine = 16;
int bin_of(const dvec3& l) {
    const int ring = std::clamp(static_cast<int>((l.z + 1) / 2 * rings), 0, rings - 1);
    const double phi = std::atan2(l.y, l.x) / (2 * pi) + 0.5;
    return ring * sectors + std::clamp(static_cast<int>(phi * sectors), 0, sectors - 1);
}

/// Probability of each bin, by the target's densities at fine x fine places of it.
std::vector<double> expected(const Target& target, const Lobe& lobe) {
    Arrays arrays(rings * sectors * fine * fine, lobe);
    int n = 0;
    for (int ring = 0; ring < rings * fine; ++ring)
        for (int sector = 0; sector < sectors * fine; ++sector) {
            const double z = (ring + 0.5) / (rings * fine) * 2 - 1, s = std::sqrt(1 - z * z);
            const double phi = ((sector + 0.5) / (sectors * fine) - 0.5) * 2 * pi;
            arrays.set_light(n++, {s * std::cos(phi), s * std::sin(phi), z});
        }
    target.run(arrays.a);
    std::vector<double> p(rings * sectors, 0.0);
    for (int i = 0; i < n; ++i)
        if (arrays.light[static_cast<std::size_t>(2 * n + i)] >
            -lobe_cosine(lobe)) // else the normal is below
            p[static_cast<std::size_t>(i / (sectors * fine) / fine * sectors +
                                       i % (sectors * fine) / fine)] +=
                arrays.density[static_cast<std::size_t>(i)] * 4 * pi / n;
    return p;
}

TEST(Lobes, DirectionsComeAsOftenAsTheirDensitySays) {
    constexpr int samples = 1 << 16;
    for (const Target& target : lobes_of_targets())
        for (const Lobe& lobe : cases) {
            const std::vector<double> p = expected(target, lobe);
            double all = 0;
            for (const double part : p)
                all += part;
            EXPECT_NEAR(all, 1, lobe.alpha < 0.1F ? 0.02 : 0.003)
                << target.name << ", alpha " << lobe.alpha << " at " << lobe.degrees;
            Arrays arrays(samples, lobe);
            std::mt19937 random(7);
            for (int i = 0; i < samples; ++i) {
                arrays.u[static_cast<std::size_t>(i)] = static_cast<float>(random() >> 8U) / 16777216.0F;
                arrays.v[static_cast<std::size_t>(i)] = static_cast<float>(random() >> 8U) / 16777216.0F;
            }
            target.run(arrays.a);
            std::vector<int> found(p.size(), 0);
            for (int i = 0; i < samples; ++i) {
                const auto at = [&](int k) {
                    return arrays.reflected[static_cast<std::size_t>(k * samples + i)];
                };
                ++found[static_cast<std::size_t>(bin_of({at(0), at(1), at(2)}))];
            }
            // Bins that expect few are put together.
            double chi_square = 0, few_expected = 0;
            int few_found = 0, degrees = 0;
            for (std::size_t b = 0; b < p.size(); ++b) {
                const double expect = p[b] / all * samples;
                if (expect < 8) {
                    few_expected += expect;
                    few_found += found[b];
                    continue;
                }
                chi_square += (found[b] - expect) * (found[b] - expect) / expect;
                ++degrees;
            }
            if (few_expected > 0) {
                chi_square +=
                    (few_found - few_expected) * (few_found - few_expected) / std::max(few_expected, 8.0);
                ++degrees;
            }
            // Normal in the cube root (Wilson & Hilferty 1931); quadrature adds to narrow lobes' bins.
            const double d = degrees - 1,
                         z = (std::cbrt(chi_square / d) - (1 - 2 / (9 * d))) / std::sqrt(2 / (9 * d));
            EXPECT_LT(z, lobe.alpha < 0.1F ? 12 : 4)
                << target.name << ", alpha " << lobe.alpha << " at " << lobe.degrees << ": chi-square "
                << chi_square << " of " << d;
        }
}

TEST(Lobes, ReflectBothWaysAlike) {
    std::mt19937 random(3);
    for (const Target& target : lobes_of_targets())
        for (const Lobe& lobe : cases) {
            Arrays arrays(1024, lobe);
            for (int i = 0; i < 1024; ++i) {
                const double z = (static_cast<double>(random() % 10000) + 0.5) / 10000,
                             s = std::sqrt(1 - z * z);
                const double phi = static_cast<double>(random() % 10000) * 2 * pi / 10000;
                arrays.set_light(i, {s * std::cos(phi), s * std::sin(phi), z});
            }
            target.run(arrays.a);
            for (std::size_t i = 0; i < 1024; ++i)
                EXPECT_NEAR(arrays.one[i], arrays.other[i], 2e-6 * arrays.one[i]) << target.name;
        }
}

} // namespace
} // namespace razor::test
