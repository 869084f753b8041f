#include "tests/materials/compare_paths.h"

#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"
#include "tests/materials/room.h"

#include <fmt/format.h>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

using glm::dvec3;

constexpr int size = room_size, side = 4, seeds = 16; // pixels of a picture and of a block

struct Comparison {
    double worst = 0;  // difference of blocks, in standard errors
    double square = 0; // of these differences, the mean square
    dvec3 relative{0}; // of the whole pictures' means
    dvec3 noise{0};    // of these: one standard error
};

Comparison compare(Scene scene, const std::string& target, const std::vector<BlockMean>& plain) {
    std::vector<SampleSums> ours(plain.size()); // one sample a seed
    scene.settings.samples /= 2;                // more pictures say better how much they differ
    for (int seed = 0; seed < seeds; ++seed) {
        scene.settings.seed = seed;
        RenderOptions options;
        options.threads = 1;
        options.isa = target;
        const Film film = render_native(scene, options).film;
        std::vector<dvec3> sums(plain.size(), dvec3(0));
        for (std::size_t p = 0; p < film.pixel_count(); ++p)
            sums[p / size / side * (size / side) + p % size / side] +=
                dvec3(film.find("R")->values[p], film.find("G")->values[p], film.find("B")->values[p]) /
                double(side * side);
        for (std::size_t b = 0; b < sums.size(); ++b)
            ours[b].add(sums[b]);
    }
    Comparison c;
    dvec3 all(0), all_plain(0), variance(0);
    for (std::size_t b = 0; b < plain.size(); ++b) {
        // Few seeds may agree by chance: never less than 0.1 %.
        const dvec3 floor = 1e-3 * plain[b].mean;
        const dvec3 square = plain[b].variance + ours[b].variance() + floor * floor;
        const dvec3 apart = glm::abs(ours[b].mean() - plain[b].mean) / glm::sqrt(glm::max(square, 1e-12));
        c.worst = std::max({c.worst, apart.x, apart.y, apart.z});
        c.square += glm::dot(apart, apart) / (3.0 * double(plain.size()));
        all += ours[b].mean();
        all_plain += plain[b].mean;
        variance += square;
    }
    c.relative = all / all_plain - dvec3(1);
    c.noise = glm::sqrt(variance) / all_plain;
    return c;
}

} // namespace

PlainPicture expect_same_picture(const Scene& scene, int samples_a_pixel, const Scene* alike) {
    PlainPicture plain{scene.name, plain_picture(scene, side, samples_a_pixel)};
    for (const KernelTable* target : best_target()) {
        const Comparison c = compare(alike != nullptr ? *alike : scene, target->name, plain.blocks);
        fmt::print("  {}, {}: blocks differ by {:.1f} standard errors at most (mean square {:.2f}), means by "
                   "{:+.2f} {:+.2f} {:+.2f} "
                   "% (noise {:.2f} %)\n",
                   scene.name, target->name, c.worst, c.square, 100 * c.relative.x, 100 * c.relative.y,
                   100 * c.relative.z, 100 * c.noise.y);
        EXPECT_LT(c.worst, 5) << scene.name;
        EXPECT_LT(c.square, 2.4) << scene.name; // 1.2 of Student's distribution; it deviates by 0.3 itself
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(std::abs(c.relative[k]), 4 * c.noise[k]) << scene.name;
        EXPECT_LT(c.noise.y, 0.007) << "noise hides mistakes: " << scene.name;
    }
    return plain;
}

void expect_other_picture(const PlainPicture& plain, const Scene& other) {
    for (const KernelTable* target : best_target()) {
        const Comparison c = compare(other, target->name, plain.blocks);
        fmt::print("    not as others: blocks differ by {:.1f} standard errors at most, their mean square is "
                   "{:.1f}\n",
                   c.worst, c.square);
        EXPECT_TRUE(c.square > 3 || c.worst > 6.5) << plain.name;
    }
}

} // namespace razor::test
