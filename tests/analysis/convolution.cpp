// Separated filters against plain two-dimensional sums.
#include "analysis/metrics/convolution.h"

#include "analysis/metrics/flip_filters.h"
#include "tests/analysis/pictures.h"
#include "tests/analysis/plain_flip.h"

#include <gtest/gtest.h>

#include <numeric>

namespace analysis {
namespace {

double total(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

void expect_near(const std::vector<float>& a, const std::vector<double>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_NEAR(a[i], b[i], tolerance) << i;
    }
}

std::vector<double> widened(const std::vector<float>& values) {
    return {values.begin(), values.end()};
}

TEST(Convolution, EqualsThePlainSum) {
    const std::vector<float> row{0.5F, -1, 2, 0.25F, 3}, column{1, -2, 0.5F};
    for (const auto& [width, height] : {std::pair{11, 7}, {1, 9}, {9, 1}, {1, 1}, {2, 2}}) {
        const std::vector<float> plane = noise(width, height, 3).planes[0];
        plain::Kernel kernel{2, 1, {}};
        for (const float c : column) {
            for (const float r : row) {
                kernel.weights.push_back(double{r} * double{c});
            }
        }
        expect_near(convolve(plane, width, height, row, column),
                    plain::convolve(widened(plane), width, height, kernel), 1e-5);
    }
}

TEST(FlipFilters, AreThoseOfThePaper) {
    for (const double ppd : {1.0, 12.0, 40.0, pixels_per_degree({})}) {
        const int width = 37, height = 23;
        const std::vector<float> plane = noise(width, height, 4).planes[0];
        const auto filtered = [&](const GaussianSum& filter) {
            std::vector<float> sum(plane.size());
            for (const auto& [weight, row] : filter.terms) {
                const std::vector<float> term = convolve(plane, width, height, row, row);
                for (std::size_t i = 0; i < sum.size(); ++i) {
                    sum[i] += weight * term[i];
                }
            }
            return sum;
        };
        const auto expected = [&](const plain::Kernel& kernel) {
            return plain::convolve(widened(plane), width, height, kernel);
        };
        const SensitivityFilters filters = sensitivity_filters(ppd);
        expect_near(filtered(filters.achromatic), expected(plain::sensitivity_kernel('A', ppd)), 2e-6);
        expect_near(filtered(filters.red_green), expected(plain::sensitivity_kernel('R', ppd)), 2e-6);
        expect_near(filtered(filters.blue_yellow), expected(plain::sensitivity_kernel('B', ppd)), 2e-6);
        const FeatureFilters features = feature_filters(ppd);
        expect_near(convolve(plane, width, height, features.first, features.gaussian),
                    expected(plain::feature_kernel(1, false, ppd)), 2e-6);
        expect_near(convolve(plane, width, height, features.gaussian, features.second),
                    expected(plain::feature_kernel(2, true, ppd)), 2e-6);
    }
}

TEST(FlipFilters, AreNormalised) {
    // 0.7 m, 3840 pixels on 0.7 m: 3840 pi / 180.
    EXPECT_NEAR(pixels_per_degree({}), 67.0206, 1e-4);
    EXPECT_NEAR(pixels_per_degree({1.4, 0.7, 3840}), 134.0413, 1e-4);
    const SensitivityFilters filters = sensitivity_filters(pixels_per_degree({}));
    EXPECT_EQ(filters.achromatic.terms[0].row.size(), 21U); // radius 3 sigma = 9.05 pixels
    ASSERT_EQ(filters.blue_yellow.terms.size(), 2U);
    EXPECT_NEAR(filters.blue_yellow.terms[0].weight + filters.blue_yellow.terms[1].weight, 1, 1e-6);
    EXPECT_NEAR(total(filters.blue_yellow.terms[1].row), 1, 1e-6);
    const FeatureFilters features = feature_filters(pixels_per_degree({}));
    EXPECT_EQ(features.first.size(), 19U); // radius 3 sigma = 8.24 pixels
    for (const std::vector<float>& derivative : {features.first, features.second}) {
        double positive = 0, negative = 0;
        for (const float weight : derivative) {
            (weight > 0 ? positive : negative) += double{weight};
        }
        EXPECT_NEAR(positive, 1, 1e-6);
        EXPECT_NEAR(negative, -1, 1e-6);
    }
}

} // namespace
} // namespace analysis
